#include <gridmorph/app/cli/wheel_text.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/report/quality_json.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace gridmorph::cli {

namespace {

std::vector<std::string> zone_names(Mesh const& mesh, WheelRow const& row) {
  std::vector<std::string> out;
  for (int const z : row.zones) out.push_back(mesh.zones[z].name);
  return out;
}

std::string blades_text(std::vector<std::string> const& blades) {
  std::string out;
  for (auto const& blade : blades) out += (out.empty() ? "" : ", ") + (blade.empty() ? "-" : blade);
  return out;
}

std::string line(std::string const& passage, std::string const& blade, std::size_t width,
                 std::string const& displacement, QualityReport const& q) {
  auto const smallest = [&](Measure m) {
    return q.near_field.cells == 0 ? q.far_field[m].min : std::min(q.near_field[m].min, q.far_field[m].min);
  };
  auto const largest = [&](Measure m) { return std::max(q.near_field[m].max, q.far_field[m].max); };
  std::string const aspect_ratio = q.fast ? "-" : fmt::format("{:.4g}", largest(Measure::aspect_ratio));
  return fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11.4g}  {:>9.4g}  {:>12}\n", passage, blade, width, displacement,
                     q.near_field.inverted + q.far_field.inverted, smallest(Measure::determinant_3x3x3),
                     smallest(Measure::minimum_angle_deg), aspect_ratio);
}

}  // namespace

std::string describe_rows(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup) {
  std::string text;
  for (std::size_t r = 0; r < rows.rows.size(); ++r) {
    auto const zones = quote_list(zone_names(mesh, rows.rows[r]), 6);
    text += rows.rows[r].periodic()
                ? fmt::format("row of {}: {} of {} passages\n", zones, setup.blades[r].passages, rows.rows[r].passages)
                : fmt::format("{}: no periodic interface, kept as it is\n", zones);
  }
  return text;
}

std::string passage_table(WheelResult const& result) {
  std::size_t width = 5;
  for (auto const& p : result.passages) width = std::max(width, blades_text(p.blades).size());
  std::string text = fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11}  {:>9}  {:>12}\n", "passage", "blade", width,
                                 "displacement", "inverted", "determinant", "angle", "aspect ratio");
  text += line("baseline", "", width, "", result.baseline);
  for (std::size_t p = 0; p < result.passages.size(); ++p)
    text += line(std::to_string(p + 1), blades_text(result.passages[p].blades), width,
                 fmt::format("{:.4g}", result.passages[p].largest_displacement), result.passages[p].quality);
  return text;
}

nlohmann::json wheel_json(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup, WheelResult const& result) {
  nlohmann::json json{{"gridmorph", GRIDMORPH_VERSION}, {"nodes", result.nodes}, {"notes", result.notes}};
  json["rows"] = nlohmann::json::array();
  for (std::size_t r = 0; r < rows.rows.size(); ++r)
    json["rows"].push_back({{"zones", zone_names(mesh, rows.rows[r])},
                            {"passages_of_wheel", rows.rows[r].passages},
                            {"passages", setup.blades[r].passages}});
  json["baseline"] = result.baseline;
  json["passages"] = nlohmann::json::array();
  for (std::size_t p = 0; p < result.passages.size(); ++p) {
    auto const& passage = result.passages[p];
    nlohmann::json shortfalls = nlohmann::json::array();
    for (auto const& s : passage.shortfalls)
      shortfalls.push_back(
          {{"severity", s.severity == Shortfall::Severity::failure ? "failure" : "warning"}, {"message", s.message}});
    json["passages"].push_back({{"passage", p + 1},
                                {"blades", passage.blades},
                                {"largest_displacement", passage.largest_displacement},
                                {"quality", passage.quality},
                                {"shortfalls", std::move(shortfalls)}});
  }
  json["certificate"] = certificate_json(result.whole);
  json["largest_seam_gap"] = result.gap.distance;
  json["times"] = times_json(result.times, result.nodes);
  return json;
}

}  // namespace gridmorph::cli
