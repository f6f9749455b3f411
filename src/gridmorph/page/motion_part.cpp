#include <gridmorph/page/canvas.hpp>
#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>

#include <fmt/format.h>

namespace gridmorph::page {

using nlohmann::json;

std::string scale_html(ColourScale const& scale, double low, double high, std::string_view what) {
  std::string stops;
  constexpr int n = 10;
  for (int s = 0; s <= n; ++s) {
    Colour const c = scale.at(double(s) / n);
    stops += fmt::format(",rgb({} {} {})", c.red, c.green, c.blue);
  }
  return fmt::format(
      "<div class=\"scale\" role=\"img\" aria-label=\"colours from {2} {3} to {0}\"><span>{3}</span>"
      "<i style=\"background:linear-gradient(90deg{1})\"></i><span>{0}</span><em>{2}</em></div>\n",
      number(high), stops, escaped(what), number(low));
}

std::string motion_part(ReportPage const& page) {
  std::string out = "<section id=\"moved\"><h2>What moved</h2>\n<p>" + escaped(page.mesh_summary) + "</p>\n";
  if (!page.surfaces.empty() && page.steps.empty()) {
    out += "<div class=\"figures\">";
    for (Figure const& f : page.surfaces) out += figure(f.body, f.caption);
    out += "</div>\n" + scale_of_displacement(page.scale_end);
  }
  if (page.report.contains("passages")) {
    std::string const step =
        page.report.contains("sequence")
            ? fmt::format(" at step {}, the worst one", page.report["sequence"]["worst_step"].get<Index>())
            : std::string();
    return out + fmt::format("<p>Passage {}, the worst one{}, where its mesh file has it.</p>\n</section>\n",
                             page.report["worst_passage"].get<Index>(), step);
  }
  Table table({{"rule"}, {"patches"}, {"from"}, {"nodes", true}, {"largest displacement", true}, {"mean", true}});
  for (RuleRow const& row : page.rules)
    table.add({escaped(row.rule), escaped(row.patches),
               "<span class=\"word\">" + escaped(row.where.substr(row.where.find_last_of('/') + 1)) + "</span>",
               count(row.nodes), number(row.largest), number(row.mean)});
  out += table.html();
  if (page.report.contains("targets") && !page.report["targets"].empty()) {
    out += "<p>How far nodes are from their target is among the notes above.</p>\n";
  }
  if (page.report.contains("fields") && !page.report["fields"].empty())
    out += fmt::format(
        "<p>{} rule{} from points or structural models; distances of the mapping are among the notes "
        "above.</p>\n",
        page.report["fields"].size(),
        page.report["fields"].size() == 1 ? " takes its displacement" : "s take their displacements");
  return out + "</section>\n";
}

std::string sections_part(ReportPage const& page) {
  if (page.sections.empty()) return {};
  std::string out =
      "<section id=\"sections\"><h2>Sections</h2>\n<p>Baseline and morphed mesh to one scale, and in one frame where "
      "nothing else is said. "
      "Cells are coloured by their determinant 3\u00d73\u00d73: grey is good, yellow near a half, red near zero. "
      "Blue: walls that move.</p>\n";
  for (FigureGroup const& group : page.sections) {
    out += "<h3>" + escaped(group.title) + "</h3>\n<div class=\"figures pair\">";
    for (Figure const& f : group.figures) out += figure(f.body, f.caption);
    out += "</div>\n";
  }
  return out + "</section>\n";
}

}  // namespace gridmorph::page
