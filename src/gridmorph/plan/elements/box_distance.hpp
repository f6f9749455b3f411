// Whether a polygon comes close to a box.
#pragma once

#include <gridmorph/plan/elements/wrap.hpp>

#include <span>

namespace gridmorph::detail {

/// Whether a polygon (fan of triangles from its first corner; two corners are a line) meets the box made larger by
/// `offset` along each axis, on both sides, by the separating axes of triangle and box (T. Akenine-Moller 2001).
/// Touching does not count.
bool polygon_meets_box(std::span<std::array<double, 3> const> corners, LatticeBox const& box,
                       std::array<double, 3> const& offset);

}  // namespace gridmorph::detail
