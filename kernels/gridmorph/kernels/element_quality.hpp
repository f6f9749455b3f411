// Quality of one unstructured element from its corners; the counterpart of cell_quality.hpp, and the same numbers for
// hexahedra.
//
//   hexahedron     cell_measures() of cell_quality.hpp
//   determinant    prism, pyramid, quadrilateral: min J / max J over the corners (2x2x2), and over the corners and the
//                  points half way between them (3x3x3), J the Jacobian determinant of the element's own map
//     prism          x = linear in the triangle times linear along the columns; 9 points are enough, because J is
//                    linear in the triangle at each height
//     pyramid        x = (1 - t) b(r, s) + t apex, b the bilinear base: J = (1 - t)^2 (b_r x b_s) . (apex - b). The
//                    factor, which vanishes at the apex whatever the shape, is left out: 4 and 9 points of the base
//   determinant    tetrahedron, triangle: J is constant, so the ratio says nothing. Instead the scaled Jacobian
//                  sqrt(2) J / max over the corners of the product of their 3 edge lengths (triangle: 2/sqrt(3) J / max
//                  of the product of 2), 1 for the regular element; P. Knupp, "Algebraic mesh quality metrics", SIAM J.
//                  Sci. Comput. 23 (2001) 193; C. Stimpson et al., "The Verdict geometric quality library",
//                  SAND2007-1751
//   volume         integral of J, exact; the area in 2-D
//   aspect ratio   longest / shortest edge
//   angles         between the edges in each corner of each face
//   skewness       max((amax - a) / (180 - a), (a - amin) / a), a = 60 degrees in triangles, 90 in quadrilaterals
//   relative       for each set of edges along one direction (edge_direction) the largest |u_p - u_q| over its edges
//   displacement   pq, divided by their mean baseline length; the largest of them (u: displacement)
//
// In 2-D, J is taken along the unit normal of the plane. Edges shorter than collapsed_fraction of the longest one leave
// no trace, and Jacobians that are round-off count as zero, as in cell_quality.hpp. Cost: 170 flops, 12 divisions, 5
// square roots and 2 arc cosines (tetrahedron) to 1000 flops (hexahedron).
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/element_shape.hpp>
#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/packed_vec3.hpp>

namespace gridmorph::kernels {

struct ElementCorners {
  Vec3 at[max_corners];
};

/// Elements read their corners from all over the mesh, so x, y and z should come at once.
template <class MemorySpace>
struct PackPoints {
  Field<double const> x;
  Kokkos::View<PackedVec3*, MemorySpace> points;

  [[nodiscard]] Index size() const { return Index(points.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { put(points(n), x[n]); }
};

template <class Exec>
void pack_points(Exec const& exec, Field<double const> const& x,
                 Kokkos::View<PackedVec3*, typename Exec::memory_space> const& points) {
  launch("gridmorph::quality::pack", exec, PackPoints<typename Exec::memory_space>{x, points});
}

/// Corners of a hexahedron in SIDS order as those of a cell.
KOKKOS_INLINE_FUNCTION HexCell hex_cell(ElementCorners const& c) {
  return {{c.at[0], c.at[1], c.at[3], c.at[2], c.at[4], c.at[5], c.at[7], c.at[6]}};
}

namespace element {

/// Squared edge lengths, their extremes, and which edges are collapsed.
struct EdgeLengths {
  double square[max_edges] = {};
  double longest = 0, shortest = unbounded;  ///< squared; the shortest of those that are not collapsed
  unsigned collapsed = 0;

  KOKKOS_INLINE_FUNCTION bool is_collapsed(int edge) const { return (collapsed >> edge & 1u) != 0; }
};

template <ElementType type>
KOKKOS_INLINE_FUNCTION EdgeLengths edge_lengths(ElementCorners const& c) {
  EdgeLengths e;
  constexpr int n = n_edges(type);
  for (int i = 0; i < n; ++i) {
    Vec3 const v = c.at[edge_corner(type, i, 1)] - c.at[edge_corner(type, i, 0)];
    e.square[i] = dot(v, v);
    e.longest = larger(e.longest, e.square[i]);
  }
  double const limit = collapsed_fraction * collapsed_fraction * e.longest;
  for (int i = 0; i < n; ++i) {
    if (e.square[i] <= limit)
      e.collapsed |= 1u << i;
    else
      e.shortest = smaller(e.shortest, e.square[i]);
  }
  return e;
}

/// Extremes of cos |cos|, which grows with the cosine and needs no square root.
struct AngleRange {
  double largest = -unbounded, smallest = unbounded;

  KOKKOS_INLINE_FUNCTION static double angle_deg(double signed_square) {
    constexpr double degrees = 57.295779513082320877;
    double const size = compat::math::sqrt(signed_square < 0 ? -signed_square : signed_square);
    return degrees * arc_cosine(signed_square < 0 ? -size : size);
  }
};

/// Takes the angles of one face; `triangles` and `quadrilaterals` gather those of all.
template <ElementType type>
KOKKOS_INLINE_FUNCTION void face_angles(ElementCorners const& c, int face, double limit, AngleRange& triangles,
                                        AngleRange& quadrilaterals) {
  constexpr bool self = is_surface(type);
  int const n = self ? n_corners(type) : n_face_corners(type, face);
  AngleRange& angles = n == 3 ? triangles : quadrilaterals;
  for (int k = 0; k < n; ++k) {
    int const at = self ? k : face_corner(type, face, k);
    int const next = self ? (k + 1) % n : face_corner(type, face, (k + 1) % n);
    int const previous = self ? (k + n - 1) % n : face_corner(type, face, (k + n - 1) % n);
    Vec3 const u = c.at[next] - c.at[at], v = c.at[previous] - c.at[at];
    double const uu = dot(u, u), vv = dot(v, v);
    if (uu <= limit || vv <= limit) continue;
    double const uv = dot(u, v);
    double const signed_square = uv * (uv < 0 ? -uv : uv) / (uu * vv);
    angles.largest = larger(angles.largest, signed_square);
    angles.smallest = smaller(angles.smallest, signed_square);
  }
}

/// The range of angles in all faces of a tetrahedron: an angle for every two edges that meet, from the six edges alone.
KOKKOS_INLINE_FUNCTION void tetrahedron_angles(ElementCorners const& c, EdgeLengths const& e, AngleRange& angles) {
  constexpr ElementType type = ElementType::tetrahedron;
  Vec3 edge[n_edges(type)];
  for (int i = 0; i < n_edges(type); ++i) edge[i] = c.at[edge_corner(type, i, 1)] - c.at[edge_corner(type, i, 0)];
  auto const take = [&](int i, int j, double product) {
    if (((e.collapsed >> i | e.collapsed >> j) & 1u) != 0) return;
    double const signed_square = product * (product < 0 ? -product : product) / (e.square[i] * e.square[j]);
    angles.largest = larger(angles.largest, signed_square);
    angles.smallest = smaller(angles.smallest, signed_square);
  };
  // Edges 0, 1 and 2 run around the base and 3, 4 and 5 from its corners to the top.
  for (int k = 0; k < 3; ++k) {
    int const next = (k + 1) % 3, previous = (k + 2) % 3;
    take(k, previous, -dot(edge[k], edge[previous]));
    take(k, 3 + k, dot(edge[k], edge[3 + k]));
    take(previous, 3 + k, -dot(edge[previous], edge[3 + k]));
    take(3 + k, 3 + next, dot(edge[3 + k], edge[3 + next]));
  }
}

/// Adds faces whose ideal angle is `ideal` degrees to smallest angle and skewness of the element.
KOKKOS_INLINE_FUNCTION void add_angles(AngleRange const& angles, double ideal, double& smallest_angle,
                                       double& skewness) {
  if (angles.largest < angles.smallest) return;
  double const amin = AngleRange::angle_deg(angles.largest), amax = AngleRange::angle_deg(angles.smallest);
  smallest_angle = smaller(smallest_angle, amin);
  skewness = larger(skewness, larger((amax - ideal) / (180 - ideal), (ideal - amin) / ideal));
}

struct Determinants {
  double corner_min = unbounded, corner_max = -unbounded;  ///< 2x2x2
  double all_min = unbounded, all_max = -unbounded;        ///< 3x3x3

  KOKKOS_INLINE_FUNCTION void take(double j, bool corner) {
    all_min = smaller(all_min, j);
    all_max = larger(all_max, j);
    if (!corner) return;
    corner_min = smaller(corner_min, j);
    corner_max = larger(corner_max, j);
  }
};

/// Jacobians over a bilinear base, along `axis(point)`: pyramids (towards the apex) and quadrilaterals (plane normal).
/// x: corners 0 ... 3; collapsed: bits of the base's 4 edges. Returns Simpson's integral over the base.
template <class Axis>
KOKKOS_INLINE_FUNCTION double base_jacobians(ElementCorners const& c, unsigned collapsed, double sign, Axis const& axis,
                                             Determinants& d) {
  constexpr double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  Vec3 const r0 = c.at[1] - c.at[0], r1 = c.at[2] - c.at[3], s0 = c.at[3] - c.at[0], s1 = c.at[2] - c.at[1];
  bool const no_r0 = (collapsed & 1u) != 0, no_r1 = (collapsed & 4u) != 0, no_s0 = (collapsed & 8u) != 0,
             no_s1 = (collapsed & 2u) != 0;
  double integral = 0;
  for (int q = 0; q < 3; ++q)
    for (int p = 0; p < 3; ++p) {
      double const r = 0.5 * p, s = 0.5 * q;
      Vec3 const along_r = (1 - s) * r0 + s * r1, along_s = (1 - r) * s0 + r * s1;
      Vec3 const base = (1 - r) * (1 - s) * c.at[0] + r * (1 - s) * c.at[1] + r * s * c.at[2] + (1 - r) * s * c.at[3];
      double const j = sign * dot(cross(along_r, along_s), axis(base));
      integral += weight[p] * weight[q] * j;
      bool const skip = ((q == 2 || no_r0) && (q == 0 || no_r1)) || ((p == 2 || no_s0) && (p == 0 || no_s1));
      if (!skip) d.take(j, p != 1 && q != 1);
    }
  return integral;
}

KOKKOS_INLINE_FUNCTION double pyramid_jacobians(ElementCorners const& c, EdgeLengths const& e, double sign,
                                                Determinants& d) {
  Vec3 const apex = c.at[4];
  return base_jacobians(
             c, e.collapsed & 15u, sign, [&](Vec3 const& base) { return apex - base; }, d) /
         3;
}

KOKKOS_INLINE_FUNCTION double prism_jacobians(ElementCorners const& c, EdgeLengths const& e, double sign,
                                              Determinants& d) {
  constexpr double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  double volume = 0;
  Vec3 const mean_height = (1.0 / 3) * ((c.at[3] - c.at[0]) + (c.at[4] - c.at[1]) + (c.at[5] - c.at[2]));
  for (int level = 0; level < 3; ++level) {
    double const t = 0.5 * level;
    Vec3 x[3];
    for (int k = 0; k < 3; ++k) x[k] = (1 - t) * c.at[k] + t * c.at[k + 3];
    volume += 0.5 * weight[level] * sign * dot(cross(x[1] - x[0], x[2] - x[0]), mean_height);
    for (int k = 0; k < 3; ++k) {
      int const next = (k + 1) % 3, previous = (k + 2) % 3;
      // Edges k of the bottom and 6 + k of the top run from corner k to the next one; edge 3 + k is the column.
      bool const flat_next = (level == 2 || e.is_collapsed(k)) && (level == 0 || e.is_collapsed(6 + k));
      bool const flat_previous =
          (level == 2 || e.is_collapsed(previous)) && (level == 0 || e.is_collapsed(6 + previous));
      if (flat_next || flat_previous || e.is_collapsed(3 + k)) continue;
      double const j = sign * dot(cross(x[next] - x[k], x[previous] - x[k]), c.at[k + 3] - c.at[k]);
      d.take(j, level != 1);
    }
  }
  return volume;
}

/// Smallest (`least`) or largest product over the corners of a simplex of the squares of the edges that meet there.
template <ElementType type>
KOKKOS_INLINE_FUNCTION double corner_product(EdgeLengths const& e, bool least) {
  double extreme = least ? unbounded : 0;
  for (int corner = 0; corner < n_corners(type); ++corner) {
    double product = 1;
    for (int i = 0; i < n_edges(type); ++i)
      if (edge_corner(type, i, 0) == corner || edge_corner(type, i, 1) == corner) product *= e.square[i];
    extreme = least ? smaller(extreme, product) : larger(extreme, product);
  }
  return extreme;
}

/// Scaled Jacobian of a simplex with Jacobian j.
template <ElementType type>
KOKKOS_INLINE_FUNCTION double scaled_simplex(EdgeLengths const& e, double j) {
  constexpr double scale = type == ElementType::triangle ? 1.1547005383792515290 : 1.4142135623730950488;
  double const largest = corner_product<type>(e, false);
  if (!(largest > 0)) return 0;
  double const ratio = scale * j / compat::math::sqrt(largest);
  return smaller(1.0, larger(-1.0, ratio));
}

/// Size of Jacobians that mean zero. Directions: those of edge_direction in quadrilaterals, the base and the longest of
/// the lateral edges in pyramids, triangles and columns in prisms, the corner with the shortest edges in simplices.
template <ElementType type>
KOKKOS_INLINE_FUNCTION double tolerance(ElementCorners const& c, EdgeLengths const& e) {
  double const x = largest_component(c.at, n_corners(type)), longest = compat::math::sqrt(e.longest);
  if constexpr (type == ElementType::triangle || type == ElementType::tetrahedron) {
    double const rounding =
        type == ElementType::triangle ? jacobian_tolerance(0, longest, x) : jacobian_tolerance(0, longest, longest, x);
    return rounding + flat_fraction * compat::math::sqrt(corner_product<type>(e, true));
  }
  double square[3] = {0, 0, 0};
  for (int i = 0; i < n_edges(type); ++i) {
    int const direction = edge_direction(type, i);
    int const d = type == ElementType::prism ? (direction == 3 ? 2 : 0) : direction < 2 ? direction : 2;
    square[d] = larger(square[d], e.square[i]);
  }
  if constexpr (type == ElementType::prism) square[1] = square[0];
  double const a = compat::math::sqrt(square[0]), b = compat::math::sqrt(square[1]);
  if constexpr (type == ElementType::quadrilateral) return jacobian_tolerance(a, b, x);
  return jacobian_tolerance(a, b, compat::math::sqrt(square[2]), x);
}

/// Whether a volume (in 2-D an area) is so small against the longest edge that it may be round-off.
template <ElementType type>
KOKKOS_INLINE_FUNCTION bool may_be_flat(EdgeLengths const& e, double volume) {
  constexpr double share = nearly_no_volume * nearly_no_volume;
  return !(volume * volume > share * e.longest * e.longest * (is_surface(type) ? 1 : e.longest));
}

/// Jacobians of an element at all points where they are taken: volume and determinants.
template <ElementType type>
KOKKOS_INLINE_FUNCTION void take_jacobians(ElementCorners const& c, EdgeLengths const& e, double sign,
                                           Vec3 const& plane_normal, CellMeasures& m) {
  if constexpr (type == ElementType::tetrahedron || type == ElementType::triangle) {
    constexpr bool solid = type == ElementType::tetrahedron;
    Vec3 const third = solid ? c.at[3] - c.at[0] : plane_normal;
    double j = sign * dot(cross(c.at[1] - c.at[0], c.at[2] - c.at[0]), third);
    m.volume = j / (solid ? 6 : 2);
    if (may_be_flat<type>(e, m.volume)) j = without_noise(j, tolerance<type>(c, e));
    m.smallest_corner_jacobian = m.largest_corner_jacobian = j;
    m.determinant_2x2x2 = m.determinant_3x3x3 = scaled_simplex<type>(e, j);
  } else {
    Determinants d;
    if constexpr (type == ElementType::quadrilateral)
      m.volume = base_jacobians(
          c, e.collapsed, sign, [&](Vec3 const&) { return plane_normal; }, d);
    else if constexpr (type == ElementType::pyramid)
      m.volume = pyramid_jacobians(c, e, sign, d);
    else
      m.volume = prism_jacobians(c, e, sign, d);
    if (!(d.all_min > nearly_flat * d.all_max) || may_be_flat<type>(e, m.volume)) {
      double const zero = tolerance<type>(c, e);
      d = {without_noise(d.corner_min, zero), without_noise(d.corner_max, zero), without_noise(d.all_min, zero),
           without_noise(d.all_max, zero)};
    }
    m.determinant_2x2x2 = determinant_ratio(d.corner_min, d.corner_max);
    m.determinant_3x3x3 = determinant_ratio(d.all_min, d.all_max);
    m.smallest_corner_jacobian = is_finite(d.corner_min) ? d.corner_min : 0;
    m.largest_corner_jacobian = is_finite(d.corner_max) ? d.corner_max : 0;
  }
}

/// All measures of an element of one type: a copy of this per type, whose loops unroll.
template <ElementType type>
KOKKOS_INLINE_FUNCTION CellMeasures measures(ElementCorners const& c, double sign, Vec3 const& plane_normal) {
  EdgeLengths const e = edge_lengths<type>(c);
  CellMeasures m;
  take_jacobians<type>(c, e, sign, plane_normal, m);
  if (!is_finite(m.volume)) return invalid_cell();
  m.collapsed = e.collapsed != 0;
  if (is_finite(e.shortest) && e.shortest > 0)
    m.aspect_ratio = compat::math::sqrt(e.longest) / compat::math::sqrt(e.shortest);
  AngleRange triangles, quadrilaterals;
  if constexpr (type == ElementType::tetrahedron) {
    tetrahedron_angles(c, e, triangles);
  } else {
    double const limit = collapsed_fraction * collapsed_fraction * e.longest;
    constexpr int faces = is_surface(type) ? 1 : n_faces(type);
    for (int f = 0; f < faces; ++f) face_angles<type>(c, f, limit, triangles, quadrilaterals);
  }
  double angle = unbounded, skewness = -unbounded;
  add_angles(triangles, 60, angle, skewness);
  add_angles(quadrilaterals, 90, angle, skewness);
  if (is_finite(angle)) {
    m.minimum_angle_deg = angle;
    m.equiangle_skewness = skewness;
  }
  return m;
}

template <ElementType type>
KOKKOS_INLINE_FUNCTION double determinant(ElementCorners const& c, double sign, Vec3 const& plane_normal) {
  CellMeasures m;
  take_jacobians<type>(c, edge_lengths<type>(c), sign, plane_normal, m);
  return is_finite(m.volume) ? m.determinant_3x3x3 : -1;
}

/// The relative displacement of a simplex, whose edges have a direction each: no sums, and one square root.
template <ElementType type>
KOKKOS_INLINE_FUNCTION double simplex_relative_displacement(ElementCorners const& baseline,
                                                            ElementCorners const& morphed) {
  EdgeLengths const e = edge_lengths<type>(baseline);
  double worst = 0;
  for (int i = 0; i < n_edges(type); ++i) {
    if (e.is_collapsed(i)) continue;
    int const a = edge_corner(type, i, 0), b = edge_corner(type, i, 1);
    Vec3 const d = (morphed.at[b] - baseline.at[b]) - (morphed.at[a] - baseline.at[a]);
    double const ratio = dot(d, d) / e.square[i];
    worst = is_finite(ratio) ? larger(worst, ratio) : unbounded;
  }
  return is_finite(worst) ? compat::math::sqrt(worst) : unbounded;
}

template <ElementType type>
KOKKOS_INLINE_FUNCTION double relative_displacement_of(ElementCorners const& baseline, ElementCorners const& morphed) {
  EdgeLengths const e = edge_lengths<type>(baseline);
  double length[max_edges] = {}, difference[max_edges] = {};
  int members[max_edges] = {};
  bool whole[max_edges] = {};
  for (int i = 0; i < n_edges(type); ++i) {
    int const a = edge_corner(type, i, 0), b = edge_corner(type, i, 1), direction = edge_direction(type, i);
    double const d = norm((morphed.at[b] - baseline.at[b]) - (morphed.at[a] - baseline.at[a]));
    length[direction] += compat::math::sqrt(e.square[i]);
    difference[direction] = is_finite(d) ? larger(difference[direction], d) : unbounded;
    members[direction] += 1;
    whole[direction] = whole[direction] || !e.is_collapsed(i);
  }
  double worst = 0;
  for (int k = 0; k < n_edges(type); ++k) {
    if (members[k] == 0 || !whole[k]) continue;
    double const ratio = difference[k] * members[k] / length[k];
    double const bounded = is_finite(ratio) ? ratio : unbounded;
    worst = larger(worst, bounded);
  }
  return worst;
}

}  // namespace element

/// All measures of one element that is no polyhedron. sign: +1, or -1 for elements that are numbered inside out.
/// plane_normal: unit normal of a 2-D mesh, along which a counter-clockwise element is positive; not used in 3-D.
KOKKOS_INLINE_FUNCTION CellMeasures element_measures(ElementType type, ElementCorners const& c, double sign,
                                                     Vec3 const& plane_normal) {
  switch (type) {
    case ElementType::triangle: return element::measures<ElementType::triangle>(c, sign, plane_normal);
    case ElementType::quadrilateral: return element::measures<ElementType::quadrilateral>(c, sign, plane_normal);
    case ElementType::tetrahedron: return element::measures<ElementType::tetrahedron>(c, sign, plane_normal);
    case ElementType::pyramid: return element::measures<ElementType::pyramid>(c, sign, plane_normal);
    case ElementType::prism: return element::measures<ElementType::prism>(c, sign, plane_normal);
    case ElementType::hexahedron: return cell_measures(hex_cell(c), sign);
    case ElementType::polyhedron: break;
  }
  return CellMeasures();
}

/// Measure determinant_3x3x3 alone; -1 where a corner is not finite.
KOKKOS_INLINE_FUNCTION double element_determinant(ElementType type, ElementCorners const& c, double sign,
                                                  Vec3 const& plane_normal) {
  switch (type) {
    case ElementType::triangle: return element::determinant<ElementType::triangle>(c, sign, plane_normal);
    case ElementType::quadrilateral: return element::determinant<ElementType::quadrilateral>(c, sign, plane_normal);
    case ElementType::tetrahedron: return element::determinant<ElementType::tetrahedron>(c, sign, plane_normal);
    case ElementType::pyramid: return element::determinant<ElementType::pyramid>(c, sign, plane_normal);
    case ElementType::prism: return element::determinant<ElementType::prism>(c, sign, plane_normal);
    case ElementType::hexahedron: return determinant_3x3x3(hex_cell(c), sign);
    case ElementType::polyhedron: break;
  }
  return -1;
}

/// Volume alone (area in 2-D), negative for elements that are numbered inside out.
KOKKOS_INLINE_FUNCTION double element_volume(ElementType type, ElementCorners const& c, double sign,
                                             Vec3 const& plane_normal) {
  element::Determinants unused;
  element::EdgeLengths const none{};
  switch (type) {
    case ElementType::tetrahedron:
      return sign * dot(cross(c.at[1] - c.at[0], c.at[2] - c.at[0]), c.at[3] - c.at[0]) / 6;
    case ElementType::triangle: return sign * dot(cross(c.at[1] - c.at[0], c.at[2] - c.at[0]), plane_normal) / 2;
    case ElementType::quadrilateral:
      return element::base_jacobians(
          c, 0, sign, [&](Vec3 const&) { return plane_normal; }, unused);
    case ElementType::pyramid: return element::pyramid_jacobians(c, none, sign, unused);
    case ElementType::prism: return element::prism_jacobians(c, none, sign, unused);
    case ElementType::hexahedron: return jacobian_range(hex_edges(hex_cell(c)), 0, sign).volume;
    case ElementType::polyhedron: break;
  }
  return 0;
}

/// Relative displacement of an element that moved from `baseline` to `morphed`; `unbounded` where a corner is not
/// finite.
KOKKOS_INLINE_FUNCTION double element_relative_displacement(ElementType type, ElementCorners const& baseline,
                                                            ElementCorners const& morphed) {
  using element::relative_displacement_of, element::simplex_relative_displacement;
  switch (type) {
    case ElementType::triangle: return simplex_relative_displacement<ElementType::triangle>(baseline, morphed);
    case ElementType::quadrilateral: return relative_displacement_of<ElementType::quadrilateral>(baseline, morphed);
    case ElementType::tetrahedron: return simplex_relative_displacement<ElementType::tetrahedron>(baseline, morphed);
    case ElementType::pyramid: return relative_displacement_of<ElementType::pyramid>(baseline, morphed);
    case ElementType::prism: return relative_displacement_of<ElementType::prism>(baseline, morphed);
    case ElementType::hexahedron: {
      Vec3 const r = relative_displacement(hex_cell(baseline), hex_cell(morphed));
      return larger(r.x, larger(r.y, r.z));
    }
    case ElementType::polyhedron: break;
  }
  return 0;
}

}  // namespace gridmorph::kernels
