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

/// The cell where one of them is the worst.
std::string fallen_place(QualityReport const& judged, FallenCells const& fallen) {
  MeasureStatistics at;
  at.worst_zone = fallen.worst_zone;
  at.worst_cell = fallen.worst_cell;
  return worst_place(judged, at);
}

void inverted_cells(QualityReport const& judged, RegionPair const& r, std::vector<Shortfall>& list) {
  FallenCells const& fallen = (*r.judged)[Fall::inverted];
  if (r.judged->inverted == 0 && fallen.cells == 0) return;
  std::string message = fmt::format("{}: {} of {} cells are inverted", r.name,
                                    std::max(r.judged->inverted, fallen.cells), r.judged->cells);
  bool const made_by_morph = r.before == nullptr || r.judged->newly_inverted > 0;
  if (r.before == nullptr) {
    MeasureStatistics const& det = (*r.judged)[Measure::determinant_2x2x2];
    message += fmt::format(" (a corner Jacobian is negative); the worst is {} with determinant 2x2x2 {}",
                           worst_place(judged, det), format_value(det.worst));
  } else if (!made_by_morph) {
    message += ", all of them in the baseline already";
  } else {
    message += fmt::format(
        ", {} of them were not inverted in the baseline; the worst is {}, where a corner Jacobian "
        "is {} times the cell's largest in the baseline",
        r.judged->newly_inverted, fallen_place(judged, fallen), format_value(fallen.worst));
  }
  list.push_back({made_by_morph ? Severity::failure : Severity::warning, std::move(message)});
}

/// A limit, the measure that it is for, and how cells fall short of it.
struct LimitOf {
  Fall fall;
  Measure measure;
  std::string_view what, unit, beyond;
  double limit;
};

void beyond_limit(QualityReport const& judged, RegionPair const& r, LimitOf const& l, std::vector<Shortfall>& list) {
  MeasureStatistics const& now = (*r.judged)[l.measure];
  bool const larger = larger_is_worse(l.measure);
  auto const is_beyond = [&](double value) { return larger ? value > l.limit : value < l.limit; };
  FallenCells const& fallen = (*r.judged)[l.fall];
  if (r.before == nullptr || fallen.cells == 0) {
    if (now.worst_zone < 0 || !is_beyond(now.worst)) return;
    std::string message = fmt::format("{}: {} is {}{}, {} {}, in {}", r.name, l.what, format_value(now.worst), l.unit,
                                      l.beyond, format_value(l.limit), worst_place(judged, now));
    if (r.before != nullptr) message += "; every cell that is was so in the baseline";
    list.push_back({r.before == nullptr ? Severity::failure : Severity::warning, std::move(message)});
    return;
  }
  list.push_back(
      {Severity::failure,
       fmt::format("{}: {} is {}{}, {} {}, in {}; {} {} so that {} not in the baseline", r.name, l.what,
                   format_value(fallen.worst), l.unit, l.beyond, format_value(l.limit), fallen_place(judged, fallen),
                   fallen.cells, fallen.cells == 1 ? "cell is" : "cells are", fallen.cells == 1 ? "was" : "were")});
}

void large_losses(QualityReport const& judged, RegionPair const& r, QualityThresholds const& limits,
                  std::vector<Shortfall>& list) {
  FallenCells const& fallen = (*r.judged)[Fall::loss];
  if (r.before == nullptr || fallen.cells == 0) return;
  list.push_back(
      {Severity::failure,
       fmt::format("{}: {} {} lost more than {:.4g} % of {} determinant or smallest angle; the worst, {:.4g} %, is {}",
                   r.name, fallen.cells, fallen.cells == 1 ? "cell" : "cells", 100 * limits.cells.max_loss,
                   fallen.cells == 1 ? "its" : "their", 100 * fallen.worst, fallen_place(judged, fallen))});
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

void collapsed_cells(QualityReport const& judged, RegionPair const& r, std::vector<Shortfall>& list) {
  FallenCells const& fallen = (*r.judged)[Fall::collapsed];
  if (r.before == nullptr || fallen.cells == 0) return;
  list.push_back(
      {Severity::failure,
       fmt::format("{}: {} {} an edge of length zero that had a length in the baseline; the first is {}", r.name,
                   fallen.cells, fallen.cells == 1 ? "cell has" : "cells have", fallen_place(judged, fallen))});
}

}  // namespace

std::vector<Shortfall> shortfalls(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                                  QualityThresholds const& thresholds) {
  QualityReport const& judged = morphed ? *morphed : baseline;
  std::vector<Shortfall> list;
  for (RegionPair const& r : {RegionPair{"near field", &judged.near_field, morphed ? &baseline.near_field : nullptr},
                              RegionPair{"far field", &judged.far_field, morphed ? &baseline.far_field : nullptr}}) {
    CellLimits const& cells = thresholds.cells;
    inverted_cells(judged, r, list);
    beyond_limit(judged, r,
                 {Fall::determinant, Measure::determinant_3x3x3, "smallest determinant 3x3x3", "", "below",
                  cells.min_determinant},
                 list);
    beyond_limit(judged, r,
                 {Fall::angle, Measure::minimum_angle_deg, "smallest angle", " degrees", "below", cells.min_angle_deg},
                 list);
    beyond_limit(judged, r,
                 {Fall::skewness, Measure::equiangle_skewness, "largest skewness", "", "above", cells.max_skewness},
                 list);
    large_losses(judged, r, thresholds, list);
    collapsed_cells(judged, r, list);
    large_displacements(judged, r, thresholds, list);
  }
  return list;
}

bool any_failure(std::vector<Shortfall> const& list) {
  return std::any_of(list.begin(), list.end(), [](Shortfall const& s) { return s.severity == Severity::failure; });
}

}  // namespace gridmorph
