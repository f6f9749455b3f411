// The parts of a report page, each as HTML; empty where there is nothing to say.
#pragma once

#include <gridmorph/page/canvas.hpp>
#include <gridmorph/page/report_page.hpp>

#include <string>

namespace gridmorph::page {

std::string verdict_part(ReportPage const& page);
std::string motion_part(ReportPage const& page);
std::string plan_part(ReportPage const& page);
std::string quality_part(ReportPage const& page);
std::string sections_part(ReportPage const& page);
std::string sequence_part(ReportPage const& page);
std::string passages_part(ReportPage const& page);
std::string times_part(ReportPage const& page);
std::string repeat_part(ReportPage const& page);

/// How people call a step of the report's sequence: "step", of a sweep "design".
inline std::string step_word(ReportPage const& page) {
  return page.report["sequence"].contains("parameters") ? "design" : "step";
}
/// A number of the report: format_value(); "unbounded" for null.
std::string number(nlohmann::json const& value);
std::string number(double value);
/// "200,000"
std::string count(nlohmann::json const& value);

/// The worst value of a measure over near and far field, and where it is; null where it was not measured.
nlohmann::json worst_of(nlohmann::json const& quality, std::string const& measure, bool larger_is_bad);
/// "zone 'A' cell (i 3, j 1, k 7)" for {"zone", "cell"} or {"zone", "element"}.
std::string place_of(nlohmann::json const& worst);
/// Scale of colours with its ends.
std::string scale_html(ColourScale const& scale, double low, double high, std::string_view what);
inline std::string scale_of_displacement(double end) {
  return scale_html(displacement_colours(), 0, end, "displacement");
}

/// A page up to what stands in <main>, and from there on; `header` is HTML. The policy in its head lets it ask for
/// nothing from elsewhere.
std::string page_begin(std::string_view title, std::string_view header);
std::string page_end();

}  // namespace gridmorph::page
