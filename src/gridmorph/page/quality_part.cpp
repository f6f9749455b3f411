#include <gridmorph/core/text.hpp>
#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>
#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>

namespace gridmorph::page {

using nlohmann::json;

namespace {

constexpr std::array shown{Measure::determinant_3x3x3,  Measure::determinant_2x2x2,    Measure::minimum_angle_deg,
                           Measure::equiangle_skewness, Measure::aspect_ratio,         Measure::volume_ratio,
                           Measure::growth_ratio,       Measure::relative_displacement};

/// A measure of a region, or null.
json measure_of(json const& report, char const* mesh, char const* region, std::string const& measure) {
  if (!report.contains(mesh) || !report[mesh].contains(region)) return {};
  json const& all = report[mesh][region]["measures"];
  return all.contains(measure) ? all[measure] : json();
}

std::string statistics(ReportPage const& page, char const* region) {
  Table table({{"measure"},
               {"worst before", true},
               {"worst after", true},
               {"mean before", true},
               {"mean after", true},
               {"worst after, at"}});
  for (Measure const m : shown) {
    std::string const name(to_string(m));
    json const before = measure_of(page.report, "baseline", region, name),
               after = measure_of(page.report, "morphed", region, name);
    if (after.is_null()) continue;
    auto const value = [&](json const& from, char const* what) {
      if (from.is_null()) return std::string("\u2013");
      return number(std::string_view(what) == "worst" ? from["worst"]["value"] : from[what]);
    };
    bool const verdict = page.report["morphed"].value("verdict_only", false);
    table.add({std::string("<abbr title=\"") + escaped(page.report["definitions"][name]["formula"].get<std::string>()) +
                   "\">" + escaped(text_of(m).title) + "</abbr>",
               value(before, "worst"), value(after, "worst"), verdict ? "\u2013" : value(before, "mean"),
               verdict ? "\u2013" : value(after, "mean"), escaped(place_of(after["worst"]))});
  }
  return table.html();
}

std::string histograms(std::vector<Histogram> const& list) {
  std::string out = "<div class=\"figures charts\">";
  for (Histogram const& h : list) out += figure(histogram_svg(h), h.title);
  return out + "</div>\n";
}

std::string region_part(ReportPage const& page, char const* region, char const* title,
                        std::vector<Histogram> const& charts) {
  json const& now = page.report["morphed"][region];
  if (now["cells"].get<Index>() == 0) return {};
  std::string out = fmt::format("<h3>{}, {} {}</h3>\n", title, count(now["cells"]), page.kind);
  if (!charts.empty()) out += histograms(charts);
  return out + statistics(page, region);
}

std::string walls_part(ReportPage const& page) {
  json const& morphed = page.report["morphed"];
  if (!morphed.contains("walls") || morphed["walls"]["groups"].empty()) return {};
  Table table({{"wall"},
               {"nodes", true},
               {"first height, mean", true},
               {"largest change", true},
               {"angle to the normal, mean", true},
               {"largest", true},
               {"largest change", true}});
  for (auto const& [name, wall] : morphed["walls"]["groups"].items())
    table.add({escaped(name), count(wall["nodes"]), number(wall["first_height"]["mean"]),
               number(100 * wall["first_height_change"]["max"].get<double>()) + " %",
               number(wall["orthogonality_deg"]["mean"]) + "\u00b0",
               number(wall["orthogonality_deg"]["max"]) + "\u00b0",
               number(wall["orthogonality_change_deg"]["max"]) + "\u00b0"});
  return "<h3>First layer on the walls</h3>\n" + table.html();
}

std::string before_and_after(double before, double after) { return number(before) + " \u2192 " + number(after); }

std::string worst_part(ReportPage const& page) {
  if (page.worst.empty()) return {};
  Table table({{"why"},
               {"where"},
               {"x, y, z"},
               {"determinant 3\u00d73\u00d73", true},
               {"smallest angle", true},
               {"aspect ratio", true}});
  std::string drawings;
  for (WorstCell const& w : page.worst) {
    std::string const place = to_string(w.name);
    table.add({escaped(w.reason), escaped(place), escaped(to_text(w.centre, 6)),
               before_and_after(w.before.determinant_3x3x3, w.after.determinant_3x3x3),
               before_and_after(w.before.minimum_angle_deg, w.after.minimum_angle_deg),
               before_and_after(w.before.aspect_ratio, w.after.aspect_ratio)});
    if (!w.drawing) continue;
    std::string const stretch =
        w.drawing->stretch > 1.05 ? fmt::format("; stretched {} times across", number(w.drawing->stretch)) : "";
    drawings += "<figure class=\"two\"><div>" + w.drawing->baseline + w.drawing->morphed + "</div><figcaption>" +
                escaped(fmt::format("{}: {}, baseline and morphed{}", w.reason, place, stretch)) +
                "</figcaption></figure>\n";
  }
  return "<h3>Worst " + escaped(page.kind) + "</h3>\n" + table.html() + "<div class=\"figures\">" + drawings +
         "</div>\n" +
         "<p class=\"dim\">Thin cells are drawn stretched, both drawings by one linear map: signs of Jacobians and "
         "ratios of determinants stay, "
         "angles do not.</p>\n";
}

std::string clearances_part(ReportPage const& page) {
  if (!page.report.contains("clearances")) return {};
  Table table({{"clearance"}, {"nodes", true}, {"smallest before"}, {"smallest after"}, {"distance"}});
  auto const range = [](json const& gap) {
    return fmt::format("{}, mean {}", number(gap["smallest"]), number(gap["mean"]));
  };
  for (json const& c : page.report["clearances"])
    table.add({escaped(c.value("name", std::string())), count(c.value("nodes", json(0))), range(c["before"]),
               range(c["after"]), escaped(c.value("distance", std::string()))});
  return "<h3>Clearances</h3>\n" + table.html();
}

}  // namespace

std::string quality_part(ReportPage const& page) {
  std::string out = "<section id=\"quality\"><h2>Quality before and after</h2>\n";
  if (page.report.contains("sequence"))
    out += fmt::format("<p>Of {} {}, the worst one.</p>\n", step_word(page),
                       page.report["sequence"]["worst_step"].get<Index>());
  if (page.report.contains("passages"))
    out += fmt::format("<p>Of passage {}, the worst one; the baseline is the same in all.</p>\n",
                       page.report["worst_passage"].get<Index>());
  if (!page.near_histograms.empty() || !page.far_histograms.empty())
    out += "<p class=\"key\"><i class=\"before\"></i> baseline <i class=\"after\"></i> morphed; numbers of " +
           escaped(page.kind) + " on a logarithmic scale. " + escaped(page.histogram_note) + "</p>\n";
  else if (!page.histogram_note.empty())
    out += "<p>" + escaped(page.histogram_note) + "</p>\n";
  out += region_part(page, "near_field", "Near field", page.near_histograms) +
         region_part(page, "far_field", "Far field", page.far_histograms);
  out += worst_part(page) + walls_part(page) + clearances_part(page);
  json const& limits = page.report["thresholds"];
  out += fmt::format(
      "<p class=\"dim\">Thresholds: determinant {}, angle {}\u00b0, skewness {}, loss of determinant or angle {} "
      "%.</p>\n",
      number(limits["min_determinant"]), number(limits["min_angle_deg"]), number(limits["max_skewness"]),
      number(100 * limits["max_loss"].get<double>()));
  return out + "</section>\n";
}

}  // namespace gridmorph::page
