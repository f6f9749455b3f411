// Which cells are in a wrap: those that walls come close to, and those that make it simple.
#pragma once

#include <gridmorph/plan/elements/wrap.hpp>

#include <span>

namespace gridmorph::detail {

/// Whether a polygon (fan of triangles from its first corner; two corners are a line) meets the box made larger by
/// `offset` along each axis, on both sides, by the separating axes of triangle and box (T. Akenine-Moller 2001).
/// Touching does not count.
bool polygon_meets_box(std::span<std::array<double, 3> const> corners, LatticeBox const& box,
                       std::array<double, 3> const& offset);

/// Closes gaps of one cell, fills dents and enclosed hollows and joins cells that touch only along an edge or at a
/// corner, by adding cells. What no node of the mesh lies in and nothing but the limits of the mesh opens counts as
/// enclosed: the inside of a body that stands on a plane of symmetry. `coordinates`: of all nodes, in the chart.
void fill(Coordinates const& coordinates, LatticeBox const& domain, Wrap& wrap);

}  // namespace gridmorph::detail
