// A tree of boxes over flat facets, and the nearest place on them.
#pragma once

#include <gridmorph/kernels/facet_patch.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// A box around some facets, or around two boxes that follow one another.
struct FacetBox {
  Vec3 low, high;
  std::int32_t first = 0;  ///< first of its facets, or first of its two boxes, which come after it
  std::int32_t count = 0;  ///< number of its facets, 0: it holds boxes

  /// Square of the distance from p to the box.
  KOKKOS_INLINE_FUNCTION double distance2(Vec3 const& p) const {
    Vec3 const d{outside(low.x, high.x, p.x), outside(low.y, high.y, p.y), outside(low.z, high.z, p.z)};
    return dot(d, d);
  }

 private:
  KOKKOS_INLINE_FUNCTION static double outside(double low, double high, double at) {
    return at < low ? low - at : at > high ? at - high : 0.0;
  }
};

/// A place on a flat facet; quadrilaterals are two triangles, cut from corner 0 to corner 2.
struct FlatPlace {
  int facet = -1;
  double u = 0, v = 0;
  double distance2 = 0;
};

/// part / whole within 0 and 1; 0 where there is no whole.
KOKKOS_INLINE_FUNCTION double share(double part, double whole) {
  return whole > 0 && part > 0 ? (part < whole ? part / whole : 1.0) : 0.0;
}

/// Weights of b and c at the place of triangle a, b, c nearest to p (Ericson, Real-Time Collision Detection
/// 2005, 5.1.5, with guards for triangles without area).
KOKKOS_INLINE_FUNCTION void nearest_on_triangle(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c,
                                                double& to_b, double& to_c) {
  Vec3 const ab = b - a, ac = c - a;
  Vec3 const ap = p - a, bp = p - b, cp = p - c;
  double const b_a = dot(ab, ap), c_a = dot(ac, ap), b_b = dot(ab, bp), c_b = dot(ac, bp), b_c = dot(ab, cp),
               c_c = dot(ac, cp);
  double const at_c = b_a * c_b - b_b * c_a, at_b = b_c * c_a - b_a * c_c, at_a = b_b * c_c - b_c * c_b;
  to_b = to_c = 0;
  if (b_a <= 0 && c_a <= 0) return;
  if (b_b >= 0 && c_b <= b_b) {
    to_b = 1;
  } else if (at_c <= 0 && b_a >= 0 && b_b <= 0) {
    to_b = share(b_a, b_a - b_b);
  } else if (c_c >= 0 && b_c <= c_c) {
    to_c = 1;
  } else if (at_b <= 0 && c_a >= 0 && c_c <= 0) {
    to_c = share(c_a, c_a - c_c);
  } else if (at_a <= 0 && c_b >= b_b && b_c >= c_c) {
    to_c = share(c_b - b_b, (c_b - b_b) + (b_c - c_c));
    to_b = 1 - to_c;
  } else {
    double const whole = at_a + at_b + at_c;
    to_b = share(at_b, whole);
    to_c = share(at_c, whole);
  }
}

/// A list of facets under a tree. Borrows its tables.
struct FacetTreeView {
  static constexpr int max_depth = 40;  ///< of the tree, which halves its facets at every step

  Vec3 const* points = nullptr;
  Facet const* facets = nullptr;
  FacetBox const* boxes = nullptr;  ///< [0] holds all facets

  /// The place nearest to p; of places equally near the one on the facet with the lowest number. Cost O(log facets)
  /// near the surface.
  KOKKOS_INLINE_FUNCTION FlatPlace nearest(Vec3 const& p) const {
    std::int32_t pending[max_depth];
    double pending_distance2[max_depth];
    int n_pending = 0;
    FlatPlace best;
    std::int32_t box = 0;
    double distance2 = boxes[0].distance2(p);
    for (;;) {
      if (best.facet < 0 || distance2 <= best.distance2) {
        FacetBox const& here = boxes[box];
        if (here.count == 0) {
          double const left = boxes[here.first].distance2(p), right = boxes[here.first + 1].distance2(p);
          bool const left_first = left <= right;
          pending[n_pending] = left_first ? here.first + 1 : here.first;
          pending_distance2[n_pending++] = left_first ? right : left;
          box = left_first ? here.first : here.first + 1;
          distance2 = left_first ? left : right;
          continue;
        }
        for (int f = here.first; f < here.first + here.count; ++f) look_at(f, p, best);
      }
      if (n_pending == 0) return best;
      box = pending[--n_pending];
      distance2 = pending_distance2[n_pending];
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION void look_at(int f, Vec3 const& p, FlatPlace& best) const {
    Facet const& facet = facets[f];
    Vec3 const a = points[facet.corner[0]], b = points[facet.corner[1]], c = points[facet.corner[2]];
    double to_b = 0, to_c = 0;
    nearest_on_triangle(p, a, b, c, to_b, to_c);
    bool const quad = facet.n_corners() == 4;
    take({f, quad ? to_b + to_c : to_b, to_c, square(p, a, b, c, to_b, to_c)}, best);
    if (!quad) return;
    Vec3 const d = points[facet.corner[3]];
    nearest_on_triangle(p, a, c, d, to_b, to_c);
    take({f, to_b, to_b + to_c, square(p, a, c, d, to_b, to_c)}, best);
  }
  KOKKOS_INLINE_FUNCTION static double square(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c, double to_b,
                                              double to_c) {
    Vec3 const d = (p - a) - (to_b * (b - a) + to_c * (c - a));
    return dot(d, d);
  }
  KOKKOS_INLINE_FUNCTION static void take(FlatPlace const& place, FlatPlace& best) {
    bool const better = best.facet < 0 || place.distance2 < best.distance2 ||
                        (place.distance2 == best.distance2 && place.facet < best.facet);
    if (better) best = place;
  }
};

}  // namespace gridmorph::kernels
