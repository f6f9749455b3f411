#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/quality_json.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace gridmorph {

namespace {

using nlohmann::json;

json one_based(Index3 const& p) { return {p[0] + 1, p[1] + 1, p[2] + 1}; }

json worst_json(QualityReport const& report, MeasureStatistics const& s) {
  json worst{{"value", finite_or_null(s.worst)}, {"zone", report.zone_names.at(std::size_t(s.worst_zone))}};
  if (report.unstructured)
    worst["element"] = s.worst_cell[0] + 1;
  else
    worst["cell"] = one_based(s.worst_cell);
  return worst;
}

json statistics_json(QualityReport const& report, MeasureStatistics const& s) {
  return {{"min", finite_or_null(s.min)},
          {"mean", finite_or_null(s.mean)},
          {"max", finite_or_null(s.max)},
          {"worst", worst_json(report, s)}};
}

json cells_json(QualityReport const& report, FallenCells const& cells) {
  json entry{{"cells", cells.cells}};
  if (cells.cells == 0) return entry;
  MeasureStatistics at;
  at.worst_zone = cells.worst_zone;
  at.worst_cell = cells.worst_cell;
  at.worst = cells.worst;
  entry["worst"] = worst_json(report, at);
  return entry;
}

json fallen_json(QualityReport const& report, QualityRegion const& region) {
  json list = json::object();
  for (std::size_t f = 0; f < n_falls; ++f)
    if (Fall(f) != Fall::flat_before) list[std::string(to_string(Fall(f)))] = cells_json(report, region.fallen[f]);
  return list;
}

json region_json(QualityReport const& report, QualityRegion const& region) {
  json measures = json::object();
  for (std::size_t m = 0; m < n_measures; ++m)
    if (region.measure[m].worst_zone >= 0)
      measures[std::string(to_string(Measure(m)))] = statistics_json(report, region.measure[m]);
  json out{{"cells", region.cells}, {"inverted", region.inverted},   {"newly_inverted", region.newly_inverted},
           {"flat", region.flat},   {"collapsed", region.collapsed}, {"measures", std::move(measures)}};
  if (report.against_baseline) {
    out["fallen"] = fallen_json(report, region);
    out["flat_before"] = cells_json(report, region[Fall::flat_before]);
  }
  return out;
}

json place_json(QualityReport const& report, NodeLocation const& location) {
  if (location.zone < 0) return nullptr;
  return {{"zone", report.zone_names.at(std::size_t(location.zone))},
          {"node", report.unstructured ? json(location.node[0] + 1) : one_based(location.node)}};
}

json wall_json(QualityReport const& report, WallQuality const& w) {
  json walls = {{"nodes", w.nodes},
                {"first_height",
                 {{"min", finite_or_null(w.first_height_min)},
                  {"mean", finite_or_null(w.first_height_mean)},
                  {"max", finite_or_null(w.first_height_max)}}},
                {"orthogonality_deg",
                 {{"mean", finite_or_null(w.orthogonality_deg_mean)},
                  {"max", finite_or_null(w.orthogonality_deg_max)},
                  {"worst", place_json(report, w.orthogonality_worst)}}}};
  if (report.against_baseline) {
    walls["first_height_change"] = {{"max", finite_or_null(w.height_change_max)},
                                    {"worst", place_json(report, w.height_change_worst)}};
    walls["orthogonality_change_deg"] = {{"max", finite_or_null(w.orthogonality_change_deg_max)},
                                         {"worst", place_json(report, w.orthogonality_change_worst)}};
  }
  return walls;
}

json definitions(bool unstructured) {
  json list = json::object();
  for (std::size_t m = 0; m < n_measures; ++m)
    list[std::string(to_string(Measure(m)))] = {
        {"formula", unstructured ? element_formula(Measure(m)) : text_of(Measure(m)).formula},
        {"worse", larger_is_worse(Measure(m)) ? "larger" : "smaller"}};
  list["inverted"] = {
      {"formula",
       "number of cells whose smallest corner Jacobian, times the handedness of the zone or the sign of "
       "the element's numbering, is negative; newly_inverted: cells with a negative one that was not "
       "negative in the baseline, or a zero one that was positive"}};
  list["flat"] = {
      {"formula",
       "number of cells whose smallest corner Jacobian is zero: not above 1e-8 of the product of the cell's "
       "longest edges in its three directions, or what rounding of coordinates can make of it; after a morph those of "
       "flat_before too"}};
  list["flat_before"] = {
      {"formula",
       "cells with a negative Jacobian that were flat in the baseline and are so still, which is no shortfall: the "
       "smallest over their corners of J / product of the lengths of the edges there, the value, was within 1e-10 of "
       "zero and is above -0.001"}};
  list["fallen"] = {
      {"formula",
       "cells beyond a threshold that were not so in the baseline; inverted: the value is the smallest corner "
       "Jacobian / the cell's largest in the baseline; loss: (before - after) / max(|before|, floor) of "
       "determinant 3x3x3 (floor 0.05) or smallest angle (floor 1 degree), whichever is larger"}};
  list["certificate"] = {
      {"formula",
       "cells by the sign of their Jacobian everywhere in them, from its Bezier coefficients; zero: negative nowhere, "
       "as far as coordinates can tell, or flat_before; broken: negative somewhere, and not in the baseline"}};
  list["collapsed"] = {{"formula",
                        "number of cells with an edge shorter than 1e-12 of the longest edge of the cell; "
                        "points where a collapsed edge makes the Jacobian vanish do not count"}};
  list["first_height"] = {{"formula",
                           "|v . n|, v from a wall node to the first node on the grid line that leaves the wall, "
                           "n the wall normal by differences of wall nodes"}};
  list["groups"] = {{"formula", "the same by family of the wall patches, by BC name where they have none"}};
  list["orthogonality_deg"] = {{"formula", "angle between v and n in degrees; best 0"}};
  list["first_height_change"] = {{"formula", "|h / h_baseline - 1|"}};
  list["near_field"] = {{"formula", "the boundary-layer region of the moving walls; far_field: everything else"}};
  list["regions"] = {{"formula", "cells of each [[region]], of near and far field, once more by themselves"}};
  list["indices"] = {{"formula", unstructured ? "numbers of elements and nodes as the mesh file counts them"
                                              : "1-based, as in the mesh file; cell i lies between nodes i and i + 1"}};
  return list;
}

}  // namespace

nlohmann::json certificate_json(QualityReport const& report) {
  Certificate const& c = *report.certificate;
  json out{{"cells", c.cells},
           {"zero", c.zero},
           {"flat_before", c.flat_before},
           {"negative", c.negative},
           {"undecided", c.undecided},
           {"holds", c.holds()},
           {"broken", {{"cells", c.broken.cells}}}};
  if (c.holds()) return out;
  MeasureStatistics first;
  first.worst_zone = c.broken.worst_zone;
  first.worst_cell = c.broken.worst_cell;
  out["broken"]["first"] = worst_json(report, first);
  out["broken"]["first"].erase("value");
  return out;
}

void to_json(nlohmann::json& json, QualityReport const& report) {
  json = {{"near_field", region_json(report, report.near_field)},
          {"far_field", region_json(report, report.far_field)},
          {"left_handed_zones", report.left_handed_zones},
          {"verdict_only", report.fast}};
  if (report.certificate) json["certificate"] = certificate_json(report);
  if (report.fast) return;
  if (!report.regions.empty()) {
    nlohmann::json& regions = json["regions"] = nlohmann::json::object();
    for (NamedRegion const& region : report.regions) regions[region.name] = region_json(report, region.quality);
  }
  json["walls"] = wall_json(report, report.wall);
  nlohmann::json& groups = json["walls"]["groups"] = nlohmann::json::object();
  for (WallGroup const& group : report.wall_groups) groups[group.name] = wall_json(report, group.quality);
}

nlohmann::json quality_json(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                            QualityThresholds const& thresholds) {
  json result = {{"definitions", definitions(morphed ? morphed->unstructured : baseline.unstructured)},
                 {"thresholds",
                  {{"min_determinant", thresholds.cells.min_determinant},
                   {"min_angle_deg", thresholds.cells.min_angle_deg},
                   {"max_skewness", thresholds.cells.max_skewness},
                   {"max_loss", thresholds.cells.max_loss},
                   {"max_relative_displacement", thresholds.max_relative_displacement}}}};
  if (baseline.cells() > 0) result["baseline"] = baseline;
  if (morphed) result["morphed"] = *morphed;
  result["shortfalls"] = shortfalls_json(shortfalls(baseline, morphed, thresholds));
  return result;
}

nlohmann::json shortfalls_json(std::vector<Shortfall> const& list) {
  json out = json::array();
  for (Shortfall const& s : list)
    out.push_back(
        {{"severity", s.severity == Shortfall::Severity::failure ? "failure" : "warning"}, {"message", s.message}});
  return out;
}

}  // namespace gridmorph
