// Which cells fell short of their limits by a morph; internal to the quality part.
//
// Few cells of a mesh come near a limit. A cheap look at every cell (CellScreen) finds those that may have fallen
// whatever they were in the baseline; only they are measured there too and judged.
#pragma once

#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/quality/detail/partial_sums.hpp>

namespace gridmorph::detail {

/// Below these values a loss is measured against them: a determinant of 0.01 that becomes 0.001 lost nothing worth a
/// failure.
inline constexpr double least_determinant = 0.05, least_angle_deg = 1;

/// Cells beyond one of these may have fallen. No determinant is above 1 and no smallest angle above 90 degrees, so what
/// is above 1 - max_loss of that cannot have lost more.
struct CellScreen {
  double determinant, angle_deg, skewness;
  double angle_cosine, skewness_cosine;  ///< the same two as cosines, for cells of structured meshes

  explicit CellScreen(CellLimits const& limits);

  KOKKOS_INLINE_FUNCTION bool may_fall(double determinant_, double angle_deg_, double skewness_, bool collapsed) const {
    return collapsed ||
           !(determinant_ > 0 && determinant_ >= determinant && angle_deg_ >= angle_deg && skewness_ <= skewness);
  }
  /// The same from the largest and the smallest cosine of the face angles of a hexahedron.
  KOKKOS_INLINE_FUNCTION bool may_fall_by_cosines(double determinant_, double largest, double smallest) const {
    return !(determinant_ > 0 && determinant_ >= determinant && largest <= angle_cosine &&
             kernels::larger(largest, -smallest) <= skewness_cosine);
  }
};

/// (before - now) / max(|before|, floor)
KOKKOS_INLINE_FUNCTION double loss(double before, double now, double floor) {
  return (before - now) / kernels::larger(before < 0 ? -before : before, floor);
}

/// Counts a cell as what its corners make it.
KOKKOS_INLINE_FUNCTION void count_state(PartialRegion& region, double smallest_corner_jacobian) {
  region.inverted += smallest_corner_jacobian < 0 ? 1 : 0;
  region.flat += smallest_corner_jacobian == 0 ? 1 : 0;
}

/// Adds a cell to those that fell, in every way in which it did; what is inverted now has no loss. flat_cell(): its
/// FlatCell, asked for where the sign of a Jacobian is not what it was.
template <class Flat>
KOKKOS_INLINE_FUNCTION void judge(PartialRegion& region, CellLimits const& limits, kernels::CellMeasures const& before,
                                  kernels::CellMeasures const& now, Index cell, Flat const& flat_cell) {
  auto const fall = [&](Fall f, double value) {
    region.fallen[int(f)].take(larger_is_worse(f) ? -value : value, cell);
  };
  double const was = before.smallest_corner_jacobian, is = now.smallest_corner_jacobian;
  kernels::FlatCell const flat = is < 0 && was >= 0 ? flat_cell() : kernels::FlatCell{};
  if (flat.stays_flat())
    fall(Fall::flat_before, flat.now);
  else if ((is < 0 && was >= 0) || (is == 0 && was > 0))
    fall(Fall::inverted,
         before.largest_corner_jacobian > 0 ? is / before.largest_corner_jacobian : now.determinant_2x2x2);
  if (now.collapsed && !before.collapsed) fall(Fall::collapsed, 0);
  if (now.determinant_3x3x3 < limits.min_determinant && before.determinant_3x3x3 >= limits.min_determinant)
    fall(Fall::determinant, now.determinant_3x3x3);
  if (now.minimum_angle_deg < limits.min_angle_deg && before.minimum_angle_deg >= limits.min_angle_deg)
    fall(Fall::angle, now.minimum_angle_deg);
  if (now.equiangle_skewness > limits.max_skewness && before.equiangle_skewness <= limits.max_skewness)
    fall(Fall::skewness, now.equiangle_skewness);
  double const lost = kernels::larger(loss(before.determinant_3x3x3, now.determinant_3x3x3, least_determinant),
                                      loss(before.minimum_angle_deg, now.minimum_angle_deg, least_angle_deg));
  if (is > 0 && lost > limits.max_loss) fall(Fall::loss, lost);
}

}  // namespace gridmorph::detail
