#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/shortfalls.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace gridmorph {

namespace {

using Severity = Shortfall::Severity;

struct RegionPair {
  std::string_view name;
  QualityRegion const* judged;
  QualityRegion const* before;  ///< null when the baseline itself is judged
};

void inverted_cells(QualityReport const& judged, RegionPair const& r, std::vector<Shortfall>& list) {
  if (r.judged->inverted == 0) return;
  MeasureStatistics const& det = (*r.judged)[Measure::determinant_2x2x2];
  std::string message = fmt::format("{}: {} of {} cells are inverted (a corner Jacobian is not positive)", r.name,
                                    r.judged->inverted, r.judged->cells);
  bool const made_by_morph = r.before == nullptr || r.judged->newly_inverted > 0;
  if (r.before != nullptr)
    message += made_by_morph ? fmt::format(", {} of them were not inverted in the baseline", r.judged->newly_inverted)
                             : std::string(", all of them in the baseline already");
  message +=
      fmt::format("; the worst is {} with determinant 2x2x2 {}", worst_place(judged, det), format_value(det.worst));
  list.push_back({made_by_morph ? Severity::failure : Severity::warning, std::move(message)});
}

void low_determinants(QualityReport const& judged, RegionPair const& r, QualityThresholds const& limits,
                      std::vector<Shortfall>& list) {
  MeasureStatistics const& det = (*r.judged)[Measure::determinant_3x3x3];
  if (det.worst_zone < 0 || det.min >= limits.min_determinant) return;
  std::string message =
      fmt::format("{}: smallest determinant 3x3x3 is {}, below {}, in {}", r.name, format_value(det.min),
                  format_value(limits.min_determinant), worst_place(judged, det));
  bool made_by_morph = true;
  if (r.before != nullptr) {
    double const before = (*r.before)[Measure::determinant_3x3x3].min;
    made_by_morph = det.min < before;
    message += fmt::format("; the baseline has {}", format_value(before));
  }
  list.push_back({made_by_morph ? Severity::failure : Severity::warning, std::move(message)});
}

void large_displacements(QualityReport const& judged, RegionPair const& r, QualityThresholds const& limits,
                         std::vector<Shortfall>& list) {
  MeasureStatistics const& relative = (*r.judged)[Measure::relative_displacement];
  if (relative.worst_zone < 0 || relative.max <= limits.max_relative_displacement) return;
  list.push_back(
      {Severity::warning,
       fmt::format("{}: largest relative displacement is {}, above {}, in {}; judge the mesh by its determinants",
                   r.name, format_value(relative.max), format_value(limits.max_relative_displacement),
                   worst_place(judged, relative))});
}

void collapsed_cells(RegionPair const& r, std::vector<Shortfall>& list) {
  if (r.before == nullptr || r.judged->collapsed <= r.before->collapsed) return;
  list.push_back({Severity::failure, fmt::format("{}: {} cells have an edge of length zero, the baseline had {}",
                                                 r.name, r.judged->collapsed, r.before->collapsed)});
}

}  // namespace

std::vector<Shortfall> shortfalls(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                                  QualityThresholds const& thresholds) {
  QualityReport const& judged = morphed ? *morphed : baseline;
  std::vector<Shortfall> list;
  for (RegionPair const& r : {RegionPair{"near field", &judged.near_field, morphed ? &baseline.near_field : nullptr},
                              RegionPair{"far field", &judged.far_field, morphed ? &baseline.far_field : nullptr}}) {
    inverted_cells(judged, r, list);
    low_determinants(judged, r, thresholds, list);
    collapsed_cells(r, list);
    large_displacements(judged, r, thresholds, list);
  }
  return list;
}

bool any_failure(std::vector<Shortfall> const& list) {
  return std::any_of(list.begin(), list.end(), [](Shortfall const& s) { return s.severity == Severity::failure; });
}

}  // namespace gridmorph
