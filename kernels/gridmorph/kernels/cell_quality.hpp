// Quality of one hexahedral cell from its 8 corners.
//
// Everything derives from the trilinear map x(xi, eta, zeta) of the unit cube onto the cell and from its 12 edges:
//
//   tangents      x_xi at (eta, zeta): bilinear in the 4 edge vectors along i, and so on for eta (j) and zeta (k)
//   Jacobian      J = (x_xi x x_eta) . x_zeta, times the handedness of the zone (+1 or -1)
//   determinant   2x2x2: min J / max J over the 8 corners; 3x3x3: over the 27 points with parameters 0, 1/2, 1
//   volume        integral of J by Simpson's rule in each parameter, exact because J is of degree 2 in each of them
//   aspect ratio  longest / shortest of the 12 edges
//   angles        between the two edges that meet in each corner of each of the 6 faces (24 angles)
//   skewness      max((largest angle - 90) / 90, (90 - smallest angle) / 90), angles in degrees
//   scaled        smallest over the corners of J / product of the lengths of the three edges there
//   Jacobian
//   relative      for each grid direction the largest |u_p - u_q| over the 4 edges pq along it, divided by the mean
//   displacement  baseline length of these edges; the largest of the three directions counts (u: displacement)
//
// Collapsed edges (poles, wedges) are shorter than `collapsed_fraction` of the longest edge of the cell. They leave no
// trace: aspect ratio and angles skip them, the Jacobian is not evaluated where a tangent consists of collapsed edges
// only, and a direction whose 4 edges are collapsed has no relative displacement. Every measure of a cell with finite
// corners is therefore defined; `invalid_cell()` is the answer for corners that are not finite.
//
// Jacobians below jacobian_tolerance() are zero as far as the coordinates can tell; they count as zero, so that
// round-off decides about nothing. A cell is inverted where a corner has a negative Jacobian, flat where the smallest
// one is zero.
//
// Cost of cell_measures: about 1000 flops, 12 square roots, 24 divisions, 2 arc cosines; 24 coordinates are read.
#pragma once

#include <gridmorph/kernels/arc_cosine.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>

namespace gridmorph::kernels {

/// Corners of a hexahedron: corner[i + 2 j + 4 k] for i, j, k in {0, 1}.
struct HexCell {
  Vec3 corner[8];
};

/// An edge below this fraction of the longest edge of its cell counts as collapsed to a point.
inline constexpr double collapsed_fraction = 1e-12;

/// What stands for an unbounded ratio: plain arithmetic so that it is the same on host and device.
inline constexpr double unbounded = HUGE_VAL;

KOKKOS_INLINE_FUNCTION bool is_finite(double a) { return a - a == 0; }

/// Jacobians below this share of the product of the cell's longest edges along its three directions are zero: an angle
/// of 6e-7 degrees.
inline constexpr double flat_fraction = 1e-8;

/// A cell is looked at again where its smallest Jacobian is below this share of the largest one, ...
inline constexpr double nearly_flat = 1e-6;
/// ... or its volume is below this share of its longest edge cubed.
inline constexpr double nearly_no_volume = 1e-10;

/// Size of Jacobians that mean zero [length^3]: flat_fraction a b c + 64 eps x (a b + b c + c a), eps = 2^-52. a, b, c:
/// longest edges along three directions; x: the largest coordinate in size, whose rounding moves the ends of edges.
KOKKOS_INLINE_FUNCTION double jacobian_tolerance(double a, double b, double c, double x) {
  return flat_fraction * a * b * c + 0x1p-46 * x * (a * b + b * c + c * a);
}

/// The size of Jacobians that mean zero in 2-D, where they are areas [length^2].
KOKKOS_INLINE_FUNCTION double jacobian_tolerance(double a, double b, double x) {
  return flat_fraction * a * b + 0x1p-46 * x * (a + b);
}

KOKKOS_INLINE_FUNCTION double without_noise(double jacobian, double tolerance) {
  return jacobian > tolerance || jacobian < -tolerance ? jacobian : 0;
}

KOKKOS_INLINE_FUNCTION double largest_component(Vec3 const* points, int count) {
  double low = 0, high = 0;
  for (int n = 0; n < count; ++n) {
    low = smaller(low, smaller(points[n].x, smaller(points[n].y, points[n].z)));
    high = larger(high, larger(points[n].x, larger(points[n].y, points[n].z)));
  }
  return larger(high, -low);
}

/// The 12 edge vectors: of[d][e] runs along direction d (0 = i, 1 = j, 2 = k); e = p + 2 q, where p and q are the sides
/// (0 or 1) of the other two directions in ascending order.
struct HexEdges {
  Vec3 of[3][4];
};

KOKKOS_INLINE_FUNCTION HexEdges hex_edges(HexCell const& c) {
  HexEdges edges;
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      edges.of[0][p + 2 * q] = c.corner[1 + 2 * p + 4 * q] - c.corner[2 * p + 4 * q];
      edges.of[1][p + 2 * q] = c.corner[p + 2 + 4 * q] - c.corner[p + 4 * q];
      edges.of[2][p + 2 * q] = c.corner[p + 2 * q + 4] - c.corner[p + 2 * q];
    }
  return edges;
}

/// Which edges are collapsed, bit d * 4 + e for edge of[d][e]; 0 for almost every cell.
KOKKOS_INLINE_FUNCTION unsigned collapsed_edges(HexEdges const& edges) {
  double square[12], longest = 0, shortest = unbounded;
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 4; ++e) {
      double const s = dot(edges.of[d][e], edges.of[d][e]);
      square[d * 4 + e] = s;
      longest = larger(longest, s);
      shortest = smaller(shortest, s);
    }
  double const limit = collapsed_fraction * collapsed_fraction * longest;
  unsigned bits = 0;
  if (shortest <= limit)
    for (int n = 0; n < 12; ++n)
      if (square[n] <= limit) bits |= 1u << n;
  return bits;
}

/// Extremes of the Jacobian determinant over the 8 corners and the 27 points, and its integral.
struct JacobianRange {
  double min8 = unbounded, max8 = -unbounded;
  double min27 = unbounded, max27 = -unbounded;
  double volume = 0;
};

/// Tangents along one direction at parameters (p, q) / 2 of the other two, p, q in {0, 1, 2}.
struct HexTangents {
  Vec3 at[3][3];
};

KOKKOS_INLINE_FUNCTION HexTangents hex_tangents(Vec3 const (&edge)[4]) {
  HexTangents t;
  for (int p = 0; p < 2; ++p) {
    t.at[2 * p][0] = edge[p];
    t.at[2 * p][1] = 0.5 * (edge[p] + edge[p + 2]);
    t.at[2 * p][2] = edge[p + 2];
  }
  for (int q = 0; q < 3; ++q) t.at[1][q] = 0.5 * (t.at[0][q] + t.at[2][q]);
  return t;
}

/// Whether every edge that the tangent at (p, q) is made of is collapsed; bits: the direction's 4 bits.
KOKKOS_INLINE_FUNCTION bool tangent_collapsed(unsigned bits, int p, int q) {
  for (int b = q / 2; b <= (q + 1) / 2; ++b)
    for (int a = p / 2; a <= (p + 1) / 2; ++a)
      if ((bits >> (a + 2 * b) & 1u) == 0) return false;
  return true;
}

/// Jacobian determinants times `handedness`. `collapsed`: result of collapsed_edges.
KOKKOS_INLINE_FUNCTION JacobianRange jacobian_range(HexEdges const& edges, unsigned collapsed, double handedness) {
  HexTangents const a = hex_tangents(edges.of[0]);  // at (eta, zeta)
  HexTangents const b = hex_tangents(edges.of[1]);  // at (xi, zeta)
  HexTangents const c = hex_tangents(edges.of[2]);  // at (xi, eta)
  constexpr double weight[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  JacobianRange r;
  for (int z = 0; z < 3; ++z)
    for (int e = 0; e < 3; ++e)
      for (int x = 0; x < 3; ++x) {
        double const j = handedness * dot(cross(a.at[e][z], b.at[x][z]), c.at[x][e]);
        r.volume += weight[x] * weight[e] * weight[z] * j;
        if (collapsed != 0 &&
            (tangent_collapsed(collapsed & 15u, e, z) || tangent_collapsed(collapsed >> 4 & 15u, x, z) ||
             tangent_collapsed(collapsed >> 8 & 15u, x, e)))
          continue;
        r.min27 = smaller(r.min27, j);
        r.max27 = larger(r.max27, j);
        if (x != 1 && e != 1 && z != 1) {
          r.min8 = smaller(r.min8, j);
          r.max8 = larger(r.max8, j);
        }
      }
  return r;
}

/// Smallest / largest Jacobian determinant: 1 for a parallelepiped, negative when any is, never below -1. Where the
/// largest is not positive: -1, and 0 for a cell that is flat everywhere (or has no point to look at, largest <
/// smallest).
KOKKOS_INLINE_FUNCTION double determinant_ratio(double smallest, double largest) {
  if (largest > 0) return larger(smallest / largest, -1.0);
  return smallest < 0 ? -1.0 : 0.0;
}

/// jacobian_range() of a cell, round-off taken for zero.
KOKKOS_INLINE_FUNCTION JacobianRange jacobian_range(HexCell const& cell, HexEdges const& edges, unsigned collapsed,
                                                    double handedness) {
  JacobianRange r = jacobian_range(edges, collapsed, handedness);
  double longest[3] = {0, 0, 0};
  for (int d = 0; d < 3; ++d) {
    for (int e = 0; e < 4; ++e) longest[d] = larger(longest[d], dot(edges.of[d][e], edges.of[d][e]));
    longest[d] = compat::math::sqrt(longest[d]);
  }
  double const tolerance = jacobian_tolerance(longest[0], longest[1], longest[2], largest_component(cell.corner, 8));
  r.min8 = without_noise(r.min8, tolerance);
  r.max8 = without_noise(r.max8, tolerance);
  r.min27 = without_noise(r.min27, tolerance);
  r.max27 = without_noise(r.max27, tolerance);
  return r;
}

/// Smallest over the 8 corners of J / product of the lengths of the three edges there: 1 for right angles, whatever the
/// lengths; negative where the cell is inverted. Corners with a collapsed edge are left out, 1 where all have one; -1
/// where a corner is not finite.
KOKKOS_INLINE_FUNCTION double scaled_jacobian(HexEdges const& edges, unsigned collapsed, double handedness) {
  double smallest = 1;
  for (int z = 0; z < 2; ++z)
    for (int e = 0; e < 2; ++e)
      for (int x = 0; x < 2; ++x) {
        int const of[3] = {e + 2 * z, x + 2 * z, x + 2 * e};
        if ((collapsed >> of[0] & 1u) != 0 || (collapsed >> (4 + of[1]) & 1u) != 0 ||
            (collapsed >> (8 + of[2]) & 1u) != 0)
          continue;
        Vec3 const a = edges.of[0][of[0]], b = edges.of[1][of[1]], c = edges.of[2][of[2]];
        double const value = handedness * dot(cross(a, b), c) / (norm(a) * norm(b) * norm(c));
        smallest = is_finite(value) ? smaller(smallest, value) : -1.0;
      }
  return smallest;
}

/// The 3x3x3 determinant alone; -1 when a corner is not finite.
KOKKOS_INLINE_FUNCTION double determinant_3x3x3(HexCell const& cell, double handedness) {
  HexEdges const edges = hex_edges(cell);
  JacobianRange const j = jacobian_range(cell, edges, collapsed_edges(edges), handedness);
  return is_finite(j.volume) ? determinant_ratio(j.min27, j.max27) : -1.0;
}

/// Cosines of the smallest (cos_max) and of the largest (cos_min) face angle.
struct FaceAngles {
  double cos_max = -2, cos_min = 2;
};

/// length[d][e] belongs to edges.of[d][e]; angles with a collapsed edge are left out.
KOKKOS_INLINE_FUNCTION FaceAngles face_angles(HexEdges const& edges, double const (&length)[3][4], unsigned collapsed) {
  FaceAngles angles;
  for (int w = 0; w < 3; ++w) {  // faces of constant parameter w, spanned by directions u < v
    int const u = w == 0 ? 1 : 0, v = w == 2 ? 1 : 2;
    for (int corner = 0; corner < 8; ++corner) {
      int const side[3] = {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
      int const eu = side[u == 0 ? 1 : 0] + 2 * side[u == 2 ? 1 : 2];
      int const ev = side[v == 0 ? 1 : 0] + 2 * side[v == 2 ? 1 : 2];
      if ((collapsed >> (4 * u + eu) & 1u) != 0 || (collapsed >> (4 * v + ev) & 1u) != 0) continue;
      double const cosine = dot(edges.of[u][eu], edges.of[v][ev]) / (length[u][eu] * length[v][ev]);
      // At side 1 of u or v the edge points into the corner: the inner angle has the opposite cosine.
      double const inner = side[u] == side[v] ? cosine : -cosine;
      angles.cos_max = larger(angles.cos_max, inner);
      angles.cos_min = smaller(angles.cos_min, inner);
    }
  }
  return angles;
}

/// What is measured on one cell of one mesh.
struct CellMeasures {
  double determinant_2x2x2 = -1, determinant_3x3x3 = -1;
  double smallest_corner_jacobian = -1;  ///< inverted where this is negative, flat where it is zero; unit length^3
  double volume = 0;
  double aspect_ratio = unbounded;
  double minimum_angle_deg = 0;
  double equiangle_skewness = 1;
  bool collapsed = false;              ///< has at least one collapsed edge
  double largest_corner_jacobian = 0;  ///< what a negative one is compared with; unit length^3
};

/// The measures of a cell whose corners are not all finite: the worst there is.
KOKKOS_INLINE_FUNCTION CellMeasures invalid_cell() { return {}; }

/// All measures of one cell; handedness: +1 or -1, that of the cell's zone.
KOKKOS_INLINE_FUNCTION CellMeasures cell_measures(HexCell const& cell, double handedness) {
  HexEdges const edges = hex_edges(cell);
  unsigned const collapsed = collapsed_edges(edges);
  JacobianRange const j = jacobian_range(cell, edges, collapsed, handedness);
  if (!is_finite(j.volume)) return invalid_cell();

  CellMeasures m;
  m.collapsed = collapsed != 0;
  m.volume = j.volume;
  m.determinant_2x2x2 = determinant_ratio(j.min8, j.max8);
  m.determinant_3x3x3 = determinant_ratio(j.min27, j.max27);
  m.smallest_corner_jacobian = is_finite(j.min8) ? j.min8 : 0;  // all corners collapsed: no volume
  m.largest_corner_jacobian = is_finite(j.max8) ? j.max8 : 0;

  double length[3][4], shortest = unbounded, longest = 0;
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 4; ++e) {
      double const l = norm(edges.of[d][e]);
      length[d][e] = l;
      longest = larger(longest, l);
      if ((collapsed >> (4 * d + e) & 1u) == 0) shortest = smaller(shortest, l);
    }
  if (is_finite(shortest) && shortest > 0) m.aspect_ratio = longest / shortest;

  FaceAngles const angles = face_angles(edges, length, collapsed);
  if (angles.cos_max >= angles.cos_min) {
    constexpr double degrees = 57.295779513082320877;
    double const amin = degrees * arc_cosine(angles.cos_max);
    double const amax = degrees * arc_cosine(angles.cos_min);
    m.minimum_angle_deg = amin;
    m.equiangle_skewness = larger((amax - 90) / 90, (90 - amin) / 90);
  }
  return m;
}

/// Mean length of the 4 edges along each direction, and 0 for a direction whose 4 edges are all collapsed.
KOKKOS_INLINE_FUNCTION Vec3 mean_edge_lengths(HexEdges const& edges, unsigned collapsed) {
  double mean[3];
  for (int d = 0; d < 3; ++d) {
    double sum = 0;
    for (int e = 0; e < 4; ++e) sum += norm(edges.of[d][e]);
    mean[d] = (collapsed >> (4 * d) & 15u) == 15u ? 0 : 0.25 * sum;
  }
  return {mean[0], mean[1], mean[2]};
}

/// Relative displacement per grid direction (x: i, y: j, z: k) of a cell that moved from `baseline` to `morphed`;
/// `unbounded` where a corner is not finite.
KOKKOS_INLINE_FUNCTION Vec3 relative_displacement(HexCell const& baseline, HexCell const& morphed) {
  HexCell displacement;
  for (int n = 0; n < 8; ++n) displacement.corner[n] = morphed.corner[n] - baseline.corner[n];
  HexEdges const edges = hex_edges(baseline), differences = hex_edges(displacement);
  Vec3 const mean = mean_edge_lengths(edges, collapsed_edges(edges));
  double const lengths[3] = {mean.x, mean.y, mean.z};
  double value[3];
  for (int d = 0; d < 3; ++d) {
    double worst = 0;
    for (int e = 0; e < 4; ++e) {
      double const difference = norm(differences.of[d][e]);
      worst = is_finite(difference) ? larger(worst, difference) : unbounded;
    }
    double const ratio = lengths[d] == 0 ? 0 : worst / lengths[d];
    value[d] = is_finite(ratio) ? ratio : unbounded;
  }
  return {value[0], value[1], value[2]};
}

}  // namespace gridmorph::kernels
