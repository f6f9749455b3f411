// How far an element of second order is from turning inside out between its nodes, and how its further nodes are pulled
// until it is not.
//
// margin: smallest / largest |b| over the Bezier coefficients b of its Jacobian (curved_element.hpp). J is nowhere
// smaller than that share of the largest: above 0 the element is valid everywhere, 1 is a parallelepiped.
//
// The offset of a node amid an edge is c = x - (mean of the edge's ends). Where a wall gives its nodes an offset, those
// of the edges beside are interpolated:
//
//   c_m = sum of w_mk c_k / sum of w_mk,   w_mk = s_mk / |x_m - x_k| in the baseline
//
// over the edges k of the elements around m, s_mk = 1 for those opposite to it, or that run alike (offset_share()): a
// harmonic function between what is given, whose differences are in proportion to lengths. A node goes a share s of the
// way there: x + s (x* - x).
//
// Cost: 150,000 flops per margin; 12 flops per pair.
#pragma once

#include <gridmorph/kernels/curved_element.hpp>

namespace gridmorph::kernels {

/// The margin of a curved element. c: complete. -1 where a node is not finite; sign: -1 where the element is numbered
/// inside out.
KOKKOS_INLINE_FUNCTION double curved_margin(CurvedElement const& c, double sign, Vec3 const& plane_normal) {
  double least = unbounded, largest = 0, sum = 0;
  curved::bezier_box(c, sign, plane_normal).for_each([&](double b, bool) {
    least = smaller(least, b);
    largest = larger(largest, b < 0 ? -b : b);
    sum += b;
  });
  return is_finite(sum) && largest > 0 ? least / largest : -1.0;
}

/// How much of the offset of edge `other` of an element is one for edge `edge`: 1 where it is opposite to it. Where an
/// edge has no opposite, cos^8 of the angle between them, that only those that run almost alike count; their ways are
/// given in the baseline.
KOKKOS_INLINE_FUNCTION double offset_share(ElementType type, int edge, int other, Vec3 const& way,
                                           Vec3 const& other_way) {
  if (other == edge) return 0;
  bool alone = true;
  for (int e = 0; e < n_edges(type); ++e)
    alone = alone && (e == edge || edge_direction(type, e) != edge_direction(type, edge));
  if (!alone) return edge_direction(type, other) == edge_direction(type, edge) ? 1 : 0;
  double const squares = dot(way, way) * dot(other_way, other_way), product = dot(way, other_way);
  if (!(squares > 0)) return 0;
  double const cos2 = product * product / squares;
  double const share = cos2 * cos2 * cos2 * cos2;
  return share < 0.25 ? 0 : share;  // 33 degrees
}

/// A weighted mean of offsets, or 0 where there are none.
struct OffsetMean {
  Vec3 sum;
  double weights = 0;

  KOKKOS_INLINE_FUNCTION void add(Vec3 const& offset, double share, double distance) {
    double const w = share / larger(distance, 1e-300);
    sum += w * offset;
    weights += w;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 value() const { return weights > 0 ? (1 / weights) * sum : Vec3{}; }
};

}  // namespace gridmorph::kernels
