#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>

#include <fmt/format.h>

#include <string>
#include <vector>

namespace gridmorph::page {

using nlohmann::json;

namespace {

/// Names of the blades of the rows that have this passage; those that [[motion]] moves have none.
std::string blade_names(json const& passage) {
  std::string out;
  for (json const& blade : passage["blades"]) {
    std::string const name = blade.get<std::string>();
    out += (out.empty() ? "" : ", ") + (name.empty() ? std::string("[[motion]]") : name);
  }
  return out;
}

std::string worst_value(json const& worst) { return worst.is_null() ? "\u2013" : number(worst["value"]); }

std::string failures_of_passage(json const& passage) {
  std::string out;
  for (json const& s : passage["shortfalls"])
    if (s["severity"] == "failure") out += (out.empty() ? "" : "; ") + s["message"].get<std::string>();
  return out;
}

/// A row per passage: the largest displacement and the worst of all steps. blades: passages of the worst step.
std::string passages_over_time(json const& passages, json const& blades) {
  Table table({{"passage", true},
               {"blade"},
               {"largest displacement", true},
               {"at step", true},
               {"smallest determinant", true},
               {"at step", true},
               {"newly inverted, at most", true}});
  for (std::size_t p = 0; p < passages.size(); ++p) {
    json const& all = passages[p];
    table.add({std::to_string(p + 1), escaped(blade_names(blades[p])), number(all["largest_displacement"]),
               std::to_string(all["farthest_step"].get<Index>()), number(all["min_determinant"]),
               std::to_string(all["worst_step"].get<Index>()), count(all["newly_inverted"])});
  }
  return "<h3>Over all steps</h3>\n" + table.html();
}

}  // namespace

std::string passages_part(ReportPage const& page) {
  if (!page.report.contains("passages")) return {};
  json const& passages = page.report["passages"];
  auto const worst = page.report["worst_passage"].get<std::size_t>();
  std::string out = fmt::format("<section id=\"passages\"><h2>The {} passages</h2>\n", passages.size());
  if (page.report.contains("sequence"))
    out += passages_over_time(page.report["sequence"]["passages"], passages) +
           fmt::format("<h3>At step {}, the worst one</h3>\n", page.report["sequence"]["worst_step"].get<Index>());
  Table table({{"passage", true},
               {"blade"},
               {"largest displacement", true},
               {"smallest determinant", true},
               {"at"},
               {"smallest angle", true},
               {"newly inverted", true},
               {"short of a threshold"}});
  for (json const& passage : passages) {
    auto const number_of = passage["passage"].get<std::size_t>();
    json const determinant = worst_of(passage["quality"], "determinant_3x3x3", false);
    json const angle = worst_of(passage["quality"], "minimum_angle_deg", false);
    table.add({number_of == worst ? fmt::format("<b>{}</b>", number_of) : std::to_string(number_of),
               escaped(blade_names(passage)), number(passage["largest_displacement"]), worst_value(determinant),
               determinant.is_null() ? "" : escaped(place_of(determinant)),
               worst_value(angle) + (angle.is_null() ? "" : "\u00b0"), count(passage["newly_inverted"]),
               escaped(failures_of_passage(passage))});
  }
  json const before = worst_of(page.report["baseline"], "determinant_3x3x3", false);
  json const angle_before = worst_of(page.report["baseline"], "minimum_angle_deg", false);
  out += table.html();
  if (!before.is_null() && !angle_before.is_null())
    out += fmt::format("<p class=\"dim\">The baseline: smallest determinant {}, smallest angle {}\u00b0.</p>\n",
                       worst_value(before), worst_value(angle_before));
  return out + "</section>\n";
}

}  // namespace gridmorph::page
