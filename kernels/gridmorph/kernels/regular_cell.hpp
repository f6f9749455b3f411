// Measures of regular cells, the definitions of cell_quality.hpp for hexahedra without collapsed edges, so that there
// is nothing to leave out and nothing to branch on. T is double (one cell) or Lanes (as many neighbouring cells of a
// row).
//
//   normals       N = x_eta x x_zeta on a plane of constant xi is bilinear in eta and zeta: cross products at the 4
//                 corners only, the other 5 of the 9 points by sums. J = x_xi . N.
//   points        bilinear vectors are kept as sums over corners: 1 x the value at corners, 2 x at edge mids, 4 x at
//                 the centre. Powers of two scale without rounding, so extremes are scaled once and not point by point.
//   volume        in these sums the weights 1, 4, 1 of Simpson's rule become 1 everywhere: the sum of all 27 / 216.
//   angles        dot products of unit edge vectors; arc cosines only of the largest and the smallest per cell.
//
// A cell that is not regular (a collapsed edge, a corner that is not finite, a Jacobian that is negative or may be
// round-off) gets a nonzero mark; its other results mean nothing, and the general functions of cell_quality.hpp take
// over.
//
// Cost per cell of a row, where neighbours share the planes between them: determinants about 530 flops and 1 division;
// all measures about 770 flops, 11 square roots, 13 divisions; relative displacement about 190, 9 and 3.
#pragma once

#include <gridmorph/kernels/arc_cosine.hpp>
#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/lanes.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// A vector at the corners 00, 10, 01, 11 of a quadrilateral.
template <class T>
struct FourVectors {
  LaneVec3<T> v00, v10, v01, v11;
};

/// Edge vectors along i at (j, k), along j at (i, k), along k at (i, j).
template <class T>
struct CellEdges {
  FourVectors<T> i, j, k;
};

/// Edges in a plane of constant i: along j at k = 0, 1, along k at j = 0, 1.
template <class T>
struct PlaneEdges {
  LaneVec3<T> j0, j1, k0, k1;
};

/// Position of a corner relative to the first cell of the lanes: at(i, j, k) with i, j, k in {0, 1}.
template <class T, class CornerAt>
KOKKOS_FORCEINLINE_FUNCTION CellEdges<T> cell_edges(CornerAt const& at) {
  LaneVec3<T> const p000 = at(0, 0, 0), p100 = at(1, 0, 0), p010 = at(0, 1, 0), p110 = at(1, 1, 0);
  LaneVec3<T> const p001 = at(0, 0, 1), p101 = at(1, 0, 1), p011 = at(0, 1, 1), p111 = at(1, 1, 1);
  return {{p100 - p000, p110 - p010, p101 - p001, p111 - p011},
          {p010 - p000, p110 - p100, p011 - p001, p111 - p101},
          {p001 - p000, p101 - p100, p011 - p010, p111 - p110}};
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> square_extremes(FourVectors<T> const& e) {
  return extremes<T>(dot(e.v00, e.v00), dot(e.v10, e.v10), dot(e.v01, e.v01), dot(e.v11, e.v11));
}

/// Smallest and largest squared length of the 12 edges.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> square_extremes(CellEdges<T> const& e) {
  return merged(merged(square_extremes(e.i), square_extremes(e.j)), square_extremes(e.k));
}

/// A mark that is 0 for a regular cell, from the extremes of its squared edge lengths and a result that all corners
/// enter.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T irregularity(Extremes<T> const& squares, T const& result) {
  T const limit = collapsed_fraction * collapsed_fraction * squares.max;
  return (squares.min > limit ? broadcast<T>(0) : broadcast<T>(1)) + (result - result);
}

/// A mark that is 0 for a regular cell, from the extremes of its squared edge lengths, its volume and its determinant
/// over 27 points, among which the corners are.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T irregularity(Extremes<T> const& squares, T const& volume, T const& determinant) {
  T const cubed = squares.max * squares.max * squares.max;
  T const doubtful =
      (determinant > nearly_flat ? broadcast<T>(0) : broadcast<T>(1)) +
      (volume * volume > nearly_no_volume * nearly_no_volume * cubed ? broadcast<T>(0) : broadcast<T>(1));
  return irregularity(squares, volume) + doubtful;
}

/// A bilinear vector on 3 x 3 points: corners, twice the edge mids, four times the centre.
template <class T>
struct NineVectors {
  FourVectors<T> corner, mid;
  LaneVec3<T> centre;
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION NineVectors<T> nine_vectors(FourVectors<T> const& v) {
  LaneVec3<T> const low = v.v00 + v.v10, high = v.v01 + v.v11;
  return {v, {low, high, v.v00 + v.v01, v.v10 + v.v11}, low + high};
}

/// Jacobian determinants at the 9 points of a plane of constant xi.
template <class T>
struct PlaneJacobians {
  Extremes<T> four, nine;
  T sum;  ///< weighted as Simpson's rule in eta and zeta does, times 36
};

/// a: x_xi at (eta, zeta); b0, b1: x_eta at zeta = 0, 1; c0, c1: x_zeta at eta = 0, 1.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION PlaneJacobians<T> plane_jacobians(NineVectors<T> const& a, LaneVec3<T> const& b0,
                                                              LaneVec3<T> const& b1, LaneVec3<T> const& c0,
                                                              LaneVec3<T> const& c1) {
  NineVectors<T> const n = nine_vectors<T>({cross(b0, c0), cross(b0, c1), cross(b1, c0), cross(b1, c1)});
  T const j00 = dot(a.corner.v00, n.corner.v00), j10 = dot(a.corner.v10, n.corner.v10);
  T const j01 = dot(a.corner.v01, n.corner.v01), j11 = dot(a.corner.v11, n.corner.v11);
  T const m00 = dot(a.mid.v00, n.mid.v00), m10 = dot(a.mid.v10, n.mid.v10);
  T const m01 = dot(a.mid.v01, n.mid.v01), m11 = dot(a.mid.v11, n.mid.v11);
  T const centre = dot(a.centre, n.centre), centre_j = 0.0625 * centre;
  Extremes<T> const four = extremes<T>(j00, j10, j01, j11), mids = 0.25 * extremes<T>(m00, m10, m01, m11);
  return {four, merged(merged(four, mids), {centre_j, centre_j}),
          ((j00 + j10) + (j01 + j11)) + ((m00 + m10) + (m01 + m11)) + centre};
}

/// The JacobianRange of regular cells.
template <class T>
struct CellJacobians {
  Extremes<T> eight, all;  ///< over the 8 corners, over the 27 points
  T volume;
};

/// Extremes of handedness (+1 or -1) times the values.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> oriented(double handedness, Extremes<T> const& e) {
  T const a = handedness * e.min, b = handedness * e.max;
  return {smaller(a, b), larger(a, b)};
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION CellJacobians<T> cell_jacobians(CellEdges<T> const& e, double handedness) {
  NineVectors<T> const a = nine_vectors(e.i);
  PlaneJacobians<T> const low = plane_jacobians(a, e.j.v00, e.j.v01, e.k.v00, e.k.v01);
  PlaneJacobians<T> const high = plane_jacobians(a, e.j.v10, e.j.v11, e.k.v10, e.k.v11);
  // Sums of both sides: twice b and c, four times J, which is its weight against the sides.
  PlaneJacobians<T> const mid =
      plane_jacobians(a, e.j.v00 + e.j.v10, e.j.v01 + e.j.v11, e.k.v00 + e.k.v10, e.k.v01 + e.k.v11);
  return {oriented(handedness, merged(low.four, high.four)),
          oriented(handedness, merged(merged(low.nine, high.nine), 0.25 * mid.nine)),
          handedness / 216 * ((low.sum + high.sum) + mid.sum)};
}

/// determinant_ratio of cell_quality.hpp per lane.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T determinant_ratio(Extremes<T> const& jacobians) {
  T const ratio = jacobians.min / jacobians.max;
  return jacobians.max > 0 ? larger(broadcast<T>(-1), ratio) : broadcast<T>(-1);
}

/// A vector along an edge of length 1, and the square of the edge's length.
template <class T>
struct UnitEdge {
  T square;
  LaneVec3<T> unit;

  KOKKOS_FORCEINLINE_FUNCTION explicit UnitEdge(LaneVec3<T> const& edge)
      : square(dot(edge, edge)), unit(1 / square_root(square) * edge) {}
};

/// Extremes of the cosines of the 4 angles of a face with unit vectors u0, u1 along its edges on the sides 0 and 1 of
/// v, and v0, v1 on the sides of u. At side 1 of one of them the edge points into the corner, so its cosine has the
/// other sign.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> face_cosines(LaneVec3<T> const& u0, LaneVec3<T> const& u1,
                                                     LaneVec3<T> const& v0, LaneVec3<T> const& v1) {
  T const a = dot(u0, v0), b = dot(u1, v1), c = dot(u0, v1), d = dot(u1, v0);
  return {smaller(smaller(a, b), -larger(c, d)), larger(larger(a, b), -smaller(c, d))};
}

/// What cells on both sides of a plane of constant i share: unit vectors along its edges, the extremes of the cosines
/// of the 4 angles between them, and the extremes of the squared lengths.
template <class T>
struct PlaneShape {
  LaneVec3<T> j0, j1, k0, k1;  ///< along j at k = 0, 1; along k at j = 0, 1
  Extremes<T> cosines, squares;
};

/// The shape of a plane, from its edges.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION PlaneShape<T> plane_shape(LaneVec3<T> const& j0, LaneVec3<T> const& j1,
                                                      LaneVec3<T> const& k0, LaneVec3<T> const& k1) {
  UnitEdge<T> const a(j0), b(j1), c(k0), d(k1);
  return {a.unit,
          b.unit,
          c.unit,
          d.unit,
          face_cosines(a.unit, b.unit, c.unit, d.unit),
          extremes(a.square, b.square, c.square, d.square)};
}

/// Extremes of the cosines of the 24 face angles and of the squared lengths of the 12 edges.
template <class T>
struct CellShape {
  Extremes<T> cosines, squares;
};

/// i: edges along i; p, q: the planes on both sides.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION CellShape<T> cell_shape(FourVectors<T> const& i, PlaneShape<T> const& p,
                                                    PlaneShape<T> const& q) {
  UnitEdge<T> const a(i.v00), b(i.v10), c(i.v01), d(i.v11);
  Extremes<T> const k_faces =
      merged(face_cosines(a.unit, b.unit, p.j0, q.j0), face_cosines(c.unit, d.unit, p.j1, q.j1));
  Extremes<T> const j_faces =
      merged(face_cosines(a.unit, c.unit, p.k0, q.k0), face_cosines(b.unit, d.unit, p.k1, q.k1));
  return {merged(merged(p.cosines, q.cosines), merged(j_faces, k_faces)),
          merged(merged(p.squares, q.squares), extremes(a.square, b.square, c.square, d.square))};
}

/// How two edges on one side of a cell change: the larger squared difference, the sum of both, the lengths before.
template <class T>
struct PairChange {
  T largest, sum, length;
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION PairChange<T> pair_change(LaneVec3<T> const& before0, LaneVec3<T> const& before1,
                                                      LaneVec3<T> const& after0, LaneVec3<T> const& after1) {
  LaneVec3<T> const change0 = after0 - before0, change1 = after1 - before1;
  T const square0 = dot(change0, change0), square1 = dot(change1, change1);
  return {larger(square0, square1), square0 + square1,
          square_root(dot(before0, before0)) + square_root(dot(before1, before1))};
}

template <class T>
struct MarkedDirections {
  T i, j, k, mark;  ///< mark: 0 for regular cells
};

/// Relative displacement along each direction, which comes in two pairs of edges.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION MarkedDirections<T> relative_displacement(PairChange<T> const (&i)[2],
                                                                      PairChange<T> const (&j)[2],
                                                                      PairChange<T> const (&k)[2]) {
  T const mean_i = 0.25 * (i[0].length + i[1].length), mean_j = 0.25 * (j[0].length + j[1].length),
          mean_k = 0.25 * (k[0].length + k[1].length);
  T const square_i = larger(i[0].largest, i[1].largest) / (mean_i * mean_i),
          square_j = larger(j[0].largest, j[1].largest) / (mean_j * mean_j),
          square_k = larger(k[0].largest, k[1].largest) / (mean_k * mean_k);
  T const shortest = smaller(smaller(mean_i, mean_j), mean_k), longest = larger(larger(mean_i, mean_j), mean_k);
  // No edge is longer than 4 means: above this limit no direction has 4 collapsed edges.
  T const limit = 4 * collapsed_fraction * longest;
  // Every corner is the end of an edge along i; extremes may drop what is no number, sums do not.
  T const finite = (i[0].sum + i[1].sum) + ((mean_i + mean_j) + mean_k) + (square_i + square_j + square_k);
  return {square_root(square_i), square_root(square_j), square_root(square_k),
          (shortest > limit ? broadcast<T>(0) : broadcast<T>(1)) + (finite - finite)};
}

}  // namespace gridmorph::kernels
