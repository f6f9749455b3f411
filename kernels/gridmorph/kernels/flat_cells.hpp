// Cells that were flat before a morph: how much of a negative Jacobian is no loss.
//
// A cell without volume, as at a collapsed tip, gets some of either sign from any morph, and none of it is worth a
// failure. What tells is J in the corners against the lengths of the edges that meet there, which is 1 where they are
// at right angles whatever their lengths: a cell within `flat_before` of zero was flat, and it stays so as long as no
// corner falls to -`flat_allowance`. Asked of cells alone whose sign changed, so its cost is none.
#pragma once

#include <gridmorph/kernels/element_quality.hpp>

namespace gridmorph::kernels {

inline constexpr double flat_before = 1e-10, flat_allowance = 1e-3;

/// Scaled Jacobians before and after a morph.
struct FlatCell {
  double before = 1, now = 1;

  KOKKOS_INLINE_FUNCTION bool stays_flat() const {
    return before <= flat_before && before >= -flat_before && now > -flat_allowance;
  }
};

namespace element {

/// Gathers J / product of the lengths of the edges over corners. x: the largest coordinate, whose rounding moves the
/// ends of edges; what that can make of J is zero. Corners with an edge not longer than `collapsed` are left out.
struct ScaledCorners {
  double sign, x, collapsed;
  double smallest = unbounded;

  KOKKOS_INLINE_FUNCTION void take(double j, double product, double shortest, double rounding) {
    if (!is_finite(product))
      smallest = -1;
    else if (shortest > collapsed)
      smallest = smaller(smallest, without_noise(sign * j, rounding) / product);
  }
  KOKKOS_INLINE_FUNCTION void take(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
    double const la = norm(a), lb = norm(b), lc = norm(c);
    take(dot(cross(a, b), c), la * lb * lc, smaller(la, smaller(lb, lc)), 0x1p-46 * x * (la * lb + lb * lc + lc * la));
  }
  /// Takes a corner of a 2-D element, whose J is that along the unit normal of the plane.
  KOKKOS_INLINE_FUNCTION void take_in_plane(Vec3 const& a, Vec3 const& b, Vec3 const& normal) {
    double const la = norm(a), lb = norm(b);
    take(dot(cross(a, b), normal), la * lb, smaller(la, lb), 0x1p-46 * x * (la + lb));
  }
};

/// Numbers of corners run around a base of m corners; above it lie as many (prism, hexahedron) or one.
template <ElementType type>
KOKKOS_INLINE_FUNCTION double scaled_corners(ElementCorners const& c, double sign, Vec3 const& plane_normal) {
  constexpr int m =
      type == ElementType::quadrilateral || type == ElementType::pyramid || type == ElementType::hexahedron ? 4 : 3;
  constexpr bool extruded = n_corners(type) == 2 * m;
  EdgeLengths const e = edge_lengths<type>(c);
  ScaledCorners s{sign, largest_component(c.at, n_corners(type)), collapsed_fraction * compat::math::sqrt(e.longest)};
  auto const edge = [&](int from, int to) { return c.at[to] - c.at[from]; };
  for (int k = 0; k < m; ++k) {
    int const next = (k + 1) % m, previous = (k + m - 1) % m;
    if constexpr (is_surface(type)) {
      s.take_in_plane(edge(k, next), edge(k, previous), plane_normal);
    } else {
      s.take(edge(k, next), edge(k, previous), edge(k, extruded ? k + m : m));
      if (extruded) s.take(edge(k + m, previous + m), edge(k + m, next + m), edge(k + m, k));
    }
  }
  if (type == ElementType::tetrahedron) s.take(edge(3, 0), edge(3, 2), edge(3, 1));
  return is_finite(s.smallest) ? s.smallest : 0;
}

}  // namespace element

/// Smallest over the corners (the apex of a pyramid left out) of J / product of the lengths of the edges there; 0 where
/// all corners are collapsed, -1 where one is not finite. Of elements that are no polyhedra; sign and plane_normal as
/// in element_measures().
KOKKOS_INLINE_FUNCTION double scaled_jacobian(ElementType type, ElementCorners const& c, double sign,
                                              Vec3 const& plane_normal) {
  using element::scaled_corners;
  switch (type) {
    case ElementType::triangle: return scaled_corners<ElementType::triangle>(c, sign, plane_normal);
    case ElementType::quadrilateral: return scaled_corners<ElementType::quadrilateral>(c, sign, plane_normal);
    case ElementType::tetrahedron: return scaled_corners<ElementType::tetrahedron>(c, sign, plane_normal);
    case ElementType::pyramid: return scaled_corners<ElementType::pyramid>(c, sign, plane_normal);
    case ElementType::prism: return scaled_corners<ElementType::prism>(c, sign, plane_normal);
    case ElementType::hexahedron: return scaled_corners<ElementType::hexahedron>(c, sign, plane_normal);
    case ElementType::polyhedron: break;
  }
  return 1;
}

/// How flat a cell of blocks was before and is now.
KOKKOS_INLINE_FUNCTION FlatCell flat_cell(HexCell const& before, HexCell const& now, double handedness) {
  auto const scaled = [&](HexCell const& c) {
    ElementCorners const corners{
        {c.corner[0], c.corner[1], c.corner[3], c.corner[2], c.corner[4], c.corner[5], c.corner[7], c.corner[6]}};
    return scaled_jacobian(ElementType::hexahedron, corners, handedness, {});
  };
  return {scaled(before), scaled(now)};
}

}  // namespace gridmorph::kernels
