#include <gridmorph/run/inspect_text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

namespace gridmorph::cli {

namespace {

constexpr std::size_t most_zones = 60;
constexpr std::size_t most_problems = 12;
constexpr std::size_t most_blocks = 40;

using Row = std::vector<std::string>;

/// Columns as wide as their widest entry; the last one is not padded. Numbers to the right where `right` says so.
std::string table(std::vector<Row> const& rows, std::string_view right) {
  std::vector<std::size_t> width;
  for (auto const& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c >= width.size()) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  std::string out;
  for (auto const& row : rows) {
    std::string line = " ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      bool const to_right = c < right.size() && right[c] == 'r';
      line += to_right ? fmt::format(" {:>{}} ", row[c], width[c]) : fmt::format(" {:<{}} ", row[c], width[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string range_text(double low, double high) {
  if (!(low <= high)) return "-";
  return fmt::format("{:.5g} .. {:.5g}", low == 0 ? 0.0 : low, high == 0 ? 0.0 : high);
}

/// 1234567 -> "1,234,567"
std::string count_text(Index n) {
  std::string digits = std::to_string(n);
  for (int at = int(digits.size()) - 3; at > 0; at -= 3) digits.insert(std::size_t(at), ",");
  return digits;
}

std::string plural(Index n, std::string_view word) {
  return fmt::format("{} {}{}", count_text(n), word, n == 1 ? "" : "s");
}

std::string blocks_text(BlocksSummary const& s) {
  std::string text = fmt::format("  {} after cutting at every patch and interface limit, {} after merging\n",
                                 plural(s.pieces, "piece"), plural(Index(s.blocks.size()), "block"));
  for (std::size_t b = 0; b < std::min(s.blocks.size(), most_blocks); ++b) {
    auto const& block = s.blocks[b];
    text += fmt::format("  {:3}  {} x {} x {} nodes, {}{}: {} - {}, {} - {}, {} - {}\n", b + 1, block.extent[0],
                        block.extent[1], block.extent[2], block.where,
                        block.pieces > 1 ? " and " + plural(block.pieces - 1, "more piece") : "", block.faces[0],
                        block.faces[1], block.faces[2], block.faces[3], block.faces[4], block.faces[5]);
  }
  if (s.blocks.size() > most_blocks)
    text += fmt::format("  ... and {} more (--json lists all)\n", s.blocks.size() - most_blocks);
  return text;
}

std::string kinds_text(BoundarySummary const& b) {
  std::string text;
  for (auto const kind : b.kinds) text += (text.empty() ? "" : ", ") + std::string(to_string(kind));
  return text;
}

std::string_view source_text(BoundarySummary::Source source) {
  switch (source) {
    case BoundarySummary::Source::family: return "family";
    case BoundarySummary::Source::boundary_condition: return "BC";
    case BoundarySummary::Source::connection: return "connection";
  }
  return "";
}

std::string list_some(std::vector<std::string> const& names, std::size_t at_most) {
  std::size_t const n = std::min(names.size(), at_most);
  std::string text = fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(n), ", "));
  if (names.size() > n) text += fmt::format(" and {} more", names.size() - n);
  return text;
}

std::string zones_text(MeshSummary const& s) {
  std::vector<Row> rows{{"zone", "i", "j", "k", "nodes", "x", "y", "z"}};
  for (std::size_t z = 0; z < std::min(s.zones.size(), most_zones); ++z) {
    auto const& zone = s.zones[z];
    rows.push_back({zone.name, std::to_string(zone.extent[0]), std::to_string(zone.extent[1]),
                    std::to_string(zone.extent[2]), count_text(zone.nodes), range_text(zone.box.low.x, zone.box.high.x),
                    range_text(zone.box.low.y, zone.box.high.y), range_text(zone.box.low.z, zone.box.high.z)});
  }
  std::string text = table(rows, "lrrrrlll");
  if (s.zones.size() > most_zones)
    text += fmt::format("  ... and {} more (--json lists all)\n", s.zones.size() - most_zones);
  return text;
}

std::string connections_text(MeshSummary const& s) {
  int periodic = 0;
  for (auto const& p : s.periodics) periodic += p.interfaces;
  std::string text =
      fmt::format("  {} in the file; {} periodic, by their nodes", plural(s.interfaces, "1-to-1 interface"), periodic);
  if (s.self_interfaces > 0) text += fmt::format("; {} of a zone with itself", s.self_interfaces);
  text += "\n";
  for (auto const& p : s.periodics) {
    text += fmt::format(
        "  periodic by {}: {}; zones {}\n",
        p.angle_deg > 0
            ? fmt::format("rotation of {:.6g} degrees about ({:.4g}, {:.4g}, {:.4g}){}", p.angle_deg,
                          p.axis.direction.x, p.axis.direction.y, p.axis.direction.z,
                          p.sectors > 0 ? fmt::format(", {} sectors", p.sectors) : std::string())
            : fmt::format("translation ({:.6g}, {:.6g}, {:.6g})", p.translation.x, p.translation.y, p.translation.z),
        list_some(p.names, 8), list_some(p.zones, 4));
  }
  return text;
}

}  // namespace

std::string boundaries_text(MeshSummary const& s) {
  if (s.boundaries.empty()) return "  none\n";
  std::vector<Row> rows{
      {"name", "is a", "type:", s.unstructured ? "faces" : "ranges", "nodes", "x", "y", "z", "first cell"}};
  for (auto const& b : s.boundaries)
    rows.push_back({b.selector, std::string(source_text(b.source)), kinds_text(b),
                    s.unstructured ? count_text(b.faces) : std::to_string(b.patches.size()), count_text(b.nodes),
                    range_text(b.box.low.x, b.box.high.x), range_text(b.box.low.y, b.box.high.y),
                    range_text(b.box.low.z, b.box.high.z),
                    b.first_height_mean > 0 ? fmt::format("{:.3g}", b.first_height_mean) : "-"});
  std::string text = table(rows, "lllrrlllr");
  std::string more;
  for (auto const& b : s.boundaries) {
    if (b.source == BoundarySummary::Source::family && !(b.names.size() == 1 && b.names.front() == b.selector))
      more += fmt::format("  {}: BC {}\n", b.selector, list_some(b.names, 8));
    if (b.paired) more += fmt::format("  {}: periodic connections pair its nodes\n", b.selector);
    if (!b.guess.empty()) more += fmt::format("  {}: looks like {}\n", b.selector, b.guess);
  }
  return more.empty() ? text : text + "\n" + more;
}

std::string inspect_text(MeshSummary const& s, std::string const& quality, SnippetOptions const& options) {
  std::string text =
      fmt::format("{}: {}, {}, {}{}\n", s.source, plural(Index(s.zones.size()), "zone"), plural(s.nodes, "node"),
                  plural(s.cells, "cell"), s.two_dimensional ? ", 2-D (one cell thick)" : "");
  text += "\nZones\n" + zones_text(s);
  text += "\nBoundaries that a case file can name\n" + boundaries_text(s);
  if (!s.unused_families.empty())
    text += fmt::format("  families without a boundary: {}\n", list_some(s.unused_families, 20));
  text += "\nConnections\n" + connections_text(s);
  if (!s.notes.empty()) text += "\nNotes of the reader\n";
  for (auto const& note : s.notes) text += "  " + note + "\n";
  if (s.open_faces)
    text +=
        "\nFaces that nothing claims may be interfaces: --match looks for them, --write-side-file also writes them "
        "down\n";
  if (!s.problems.empty())
    text += s.remedied ? "\nProblems that the settings of the case file below deal with\n"
                       : "\nProblems that stop a morph\n";
  for (std::size_t p = 0; p < std::min(s.problems.size(), most_problems); ++p) text += "  " + s.problems[p] + "\n";
  if (s.problems.size() > most_problems)
    text += fmt::format("  ... and {} more (--json lists all)\n", s.problems.size() - most_problems);
  if (s.blocks) text += "\nBlocks that plans are made on\n" + blocks_text(*s.blocks);
  if (!quality.empty()) text += "\n" + quality;
  text += "\nA case file to start from\n\n" + case_snippet(s, options);
  return text;
}

namespace {

nlohmann::json json_of(Vec3 const& v) { return {v.x, v.y, v.z}; }

nlohmann::json json_of(Box const& box) { return {{"min", json_of(box.low)}, {"max", json_of(box.high)}}; }

nlohmann::json json_of(BoundarySummary const& b) {
  std::vector<std::string> kinds;
  for (auto const kind : b.kinds) kinds.emplace_back(to_string(kind));
  nlohmann::json json{
      {"name", b.selector}, {"source", source_text(b.source)},
      {"kinds", kinds},     {"bc_types", b.bc_types},
      {"members", b.names}, {"ranges", b.patches.size()},
      {"nodes", b.nodes},   {"first_height", {{"min", b.first_height_min}, {"mean", b.first_height_mean}}},
      {"guess", b.guess}};
  json["box"] = b.box.low.x <= b.box.high.x ? json_of(b.box) : nlohmann::json();
  return json;
}

nlohmann::json json_of(PeriodicSummary const& p) {
  nlohmann::json json{{"names", p.names}, {"zones", p.zones}, {"interfaces", p.interfaces}};
  if (p.angle_deg > 0) {
    json["rotation"] = {{"angle_deg", p.angle_deg},
                        {"axis", {{"origin", json_of(p.axis.origin)}, {"direction", json_of(p.axis.direction)}}},
                        {"sectors", p.sectors}};
  } else {
    json["translation"] = json_of(p.translation);
  }
  return json;
}

}  // namespace

nlohmann::json inspect_json(MeshSummary const& s, SnippetOptions const& options) {
  nlohmann::json json{{"source", s.source},
                      {"nodes", s.nodes},
                      {"cells", s.cells},
                      {"two_dimensional", s.two_dimensional},
                      {"box", json_of(s.box)},
                      {"families", s.families},
                      {"families_without_boundary", s.unused_families},
                      {"interfaces", {{"stored", s.interfaces}, {"of_a_zone_with_itself", s.self_interfaces}}},
                      {"notes", s.notes},
                      {"problems", s.problems},
                      {"problems_remedied", s.remedied},
                      {"case_file", case_snippet(s, options)}};
  json["zones"] = nlohmann::json::array();
  for (auto const& z : s.zones)
    json["zones"].push_back({{"name", z.name}, {"extent", z.extent}, {"nodes", z.nodes}, {"box", json_of(z.box)}});
  if (s.blocks) {
    json["pieces"] = s.blocks->pieces;
    json["blocks"] = nlohmann::json::array();
    for (auto const& b : s.blocks->blocks)
      json["blocks"].push_back(
          {{"extent", b.extent}, {"first_piece", b.where}, {"pieces", b.pieces}, {"faces", b.faces}});
  }
  json["boundaries"] = nlohmann::json::array();
  for (auto const& b : s.boundaries) json["boundaries"].push_back(json_of(b));
  json["periodic"] = nlohmann::json::array();
  for (auto const& p : s.periodics) json["periodic"].push_back(json_of(p));
  return json;
}

}  // namespace gridmorph::cli
