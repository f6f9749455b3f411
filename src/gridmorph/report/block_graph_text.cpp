#include <gridmorph/report/block_graph_text.hpp>

#include <fmt/format.h>

#include <array>

namespace gridmorph {

namespace {

/// In double quotes.
std::string dot_string(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string node_label(BlockGraph::Block const& block) {
  std::string label = block.name;
  if (block.other_zones > 0) label += fmt::format("\nand {} more zones", block.other_zones);
  return label + fmt::format("\n{} cells", block.cells);
}

/// Text with line feeds as dot reads them.
std::string dot_label(std::string const& text) {
  std::string out;
  for (char const c : dot_string(text)) out += c == '\n' ? std::string("\\n") : std::string(1, c);
  return out;
}

}  // namespace

std::string_view stage_colour(std::size_t stage) {
  constexpr std::array<std::string_view, 8> colours{"#8c9bb0", "#4c9f70", "#d98c3f", "#7a6fc0",
                                                    "#c75d7c", "#3f9fb8", "#a08a3a", "#5f6f52"};
  return colours[stage % colours.size()];
}

std::string dot_text(BlockGraph const& graph) {
  std::string out =
      "graph plan {\n  fontname = \"Helvetica\";\n  fontsize = 11;\n  node [shape = box, style = \"rounded,filled\", "
      "fillcolor = white, fontname "
      "= "
      "\"Helvetica\", fontsize = 10];\n  edge [fontname = \"Helvetica\", fontsize = 9];\n";
  for (std::size_t c = 0; c < graph.chains.size(); ++c) {
    BlockGraph::Chain const& chain = graph.chains[c];
    std::string const name = fmt::format("{}, chain {}", graph.stages[chain.stage], chain.number);
    std::string ends;
    if (chain.ends[1].empty() || chain.ends[0].empty())
      ends = chain.ends[0] + chain.ends[1];
    else
      ends = chain.ends[0] + " to " + chain.ends[1];
    if (!ends.empty()) ends = "\n" + ends;
    out += fmt::format(
        "  subgraph cluster_{} {{\n    label = {};\n    tooltip = {};\n    style = \"rounded,filled\";\n    "
        "fillcolor = \"{}55\";\n    color = \"{}\";\n",
        c, dot_label(name + ends), dot_label(chain.reason), stage_colour(std::size_t(chain.stage)),
        stage_colour(std::size_t(chain.stage)));
    for (int const b : chain.blocks) out += fmt::format("    b{};\n", b);
    for (std::size_t n = 1; n < chain.blocks.size(); ++n)
      out += fmt::format("    b{} -- b{} [dir = forward, penwidth = 2.5, color = \"{}\"];\n", chain.blocks[n - 1],
                         chain.blocks[n], stage_colour(std::size_t(chain.stage)));
    out += "  }\n";
  }
  for (std::size_t b = 0; b < graph.blocks.size(); ++b) {
    std::string patches;
    for (std::string const& patch : graph.blocks[b].patches) patches += (patches.empty() ? "" : ", ") + patch;
    out += fmt::format("  b{} [label = {}, tooltip = {}];\n", b, dot_label(node_label(graph.blocks[b])),
                       dot_label(patches));
  }
  for (BlockGraph::Interface const& face : graph.interfaces)
    out += fmt::format(
        "  b{} -- b{} [{}tooltip = \"{} faces\"];\n", face.a, face.b,
        face.periodic ? "style = dashed, color = \"#b3261e\", label = \"periodic\", " : "color = \"#8a8f98\", ",
        face.faces);
  return out + "}\n";
}

}  // namespace gridmorph
