#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>

#include <fmt/format.h>

namespace gridmorph::page {

using nlohmann::json;

namespace {

/// The plan of blocks: a line per stage.
std::string stages_table(ReportPage const& page) {
  Table table(
      {{"stage"}, {"chains", true}, {"cells", true}, {"smallest determinant after it", true}, {"the first chain"}});
  json const& stages = page.plan["stages"];
  json const measured = page.report.value("stages", json::array());
  for (std::size_t s = 0; s < stages.size(); ++s) {
    json const& stage = stages[s];
    json const worst = s < measured.size() ? measured[s]["min_determinant"] : json();
    std::string const first = stage["chains"].empty() ? std::string() : stage["chains"][0].get<std::string>();
    table.add({escaped(stage["name"].get<std::string>()), count(stage["chains"].size()), count(stage["cells"]),
               worst.is_null() ? "" : number(worst["value"]), escaped(first)});
  }
  return table.html();
}

/// The plan of elements: how many are near, and what carries the rest.
std::string regions_table(ReportPage const& page) {
  json const& plan = page.report["plan"];
  json const& e = plan["elements"];
  double const all = std::max(1.0, double(page.report["elements"].get<Index>()));
  std::string bar =
      "<div class=\"share\" role=\"img\" aria-label=\"shares of near, partially wrapped and far elements\">";
  Table table({{"region"}, {"elements", true}, {"share", true}, {"what moves its nodes"}});
  struct Row {
    char const *key, *name, *how;
  };
  for (Row const& row : {Row{"near", "near", "columns on moving walls, then layers, one at a time"},
                         Row{"partially_wrapped", "partially wrapped", "layers, up to the wrap"},
                         Row{"far", "far", "the background mesh"}}) {
    double const share = 100 * e[row.key].get<double>() / all;
    bar += fmt::format("<i class=\"{}\" style=\"flex-grow:{:.3f}\"></i>", row.key, share);
    table.add({row.name, count(e[row.key]), number(share) + " %", row.how});
  }
  std::string out = bar + "</div>\n" + table.html();
  Table stages({{"stage"}, {"size", true}});
  stages.add({"columns on moving walls", count(plan["columns"])});
  stages.add({"height of the highest column", number(plan["layer_height"])});
  stages.add({"layers", count(plan["layers"])});
  stages.add({"offset of the wrap", number(plan["offset"])});
  stages.add({"nodes of the wrap", count(plan["wrap_nodes"])});
  json const& background = plan["background"];
  if (background["nodes"].get<Index>() > 0)
    stages.add(
        {escaped("background mesh: " + background["shape"].get<std::string>()), count(background["nodes"]) + " nodes"});
  stages.add({"nodes that take their displacement from it", count(plan["far_nodes"])});
  return out + stages.html();
}

}  // namespace

std::string plan_part(ReportPage const& page) {
  if (page.report.contains("passages")) return {};
  std::string out = "<section id=\"plan\"><h2>Plan</h2>\n";
  if (page.structured) {
    out +=
        "<p>Displacements go along chains of blocks, stage by stage; each stage takes what the ones before it made "
        "known.</p>\n" +
        stages_table(page);
    if (!page.graph.empty())
      out += "<div class=\"graph\" tabindex=\"0\" role=\"region\" aria-label=\"drawing of blocks and chains\">" +
             page.graph +
             "</div>\n"
             "<p class=\"dim\">The drawing scrolls where it is larger than the page. It is what <code>gridmorph plan "
             "--graph</code> writes.</p>\n";
  } else if (page.report.contains("plan")) {
    out += regions_table(page);
  }
  return out + "</section>\n";
}

}  // namespace gridmorph::page
