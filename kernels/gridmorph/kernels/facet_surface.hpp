// A discrete surface made smooth: the foot of a point on curved facets.
//
// The foot of p is where the line through p along the surface's normal field meets it,
//
//   s(u, v) + d n(u, v) = p,
//
// with facet s and interpolated normals n of facet_patch.hpp ("Phong projection", Panozzo, Baran, Diamanti and
// Sorkine-Hornung 2013). Where the surface is smooth that is its closest point up to O(d h^2) along it. Unlike the
// closest point of a faceted surface it moves continuously and without stops as p crosses from facet to facet, because
// both facets have the edge's curve and normals in common.
//
// Search: the nearest place on the flat facets (facet_tree.hpp), from there Newton's method, going on in the next facet
// where it leaves one. At a crease the foot stays where the wedge between the two normals begins; a convex crease
// catches what is in the wedge. Beyond a rim the foot is on the rim, and slide() goes on along the tangent plane there.
//
// No allocation, bounded stack and steps. Cost: O(log facets) for the search and about 5 Newton steps of 300 flops.
#pragma once

#include <gridmorph/kernels/facet_tree.hpp>

#include <cmath>

namespace gridmorph::kernels {

struct FacetFoot {
  enum class Place { inside, crease, rim };
  Vec3 point;
  Vec3 normal;  ///< unit; of one sign all over a part of the surface that hangs together
  int facet = -1;
  double u = 0, v = 0;  ///< local coordinates (FacetPatch)
  double distance = 0;  ///< from the point to its foot
  Place place = Place::inside;
};

/// A surface of curved facets as kernels see it. Borrows its tables; usable where they are.
struct FacetSurfaceView {
  FacetTreeView tree;
  Vec3 const* normals = nullptr;
  Vec3 const* bends = nullptr;

  KOKKOS_INLINE_FUNCTION FacetPatch patch(int facet) const { return {tree.facets[facet], tree.points, normals, bends}; }

  KOKKOS_INLINE_FUNCTION FacetFoot closest_point(Vec3 const& p) const {
    FlatPlace const flat = tree.nearest(p);
    Walk walk{flat.facet, -1, flat.u, flat.v, {}};
    bool crossed_crease = false;
    for (int step = 0; step < max_steps; ++step) {
      FacetPatch const patch = this->patch(walk.facet);
      Facet const& facet = tree.facets[walk.facet];
      patch.clamp(walk.u, walk.v);
      FacetPlace at;
      newton(patch, p, walk.u, walk.v, at);
      int const q = patch.beyond(walk.u, walk.v, edge_tolerance);
      if (q < 0) {
        patch.clamp(walk.u, walk.v);
        at = patch.at(walk.u, walk.v);
        walk.offer(p, at.s, at.n, FacetFoot::Place::inside);
        break;
      }
      int const next = facet.neighbour[q];
      bool const smooth = next >= 0 && !facet.is_crease(q);
      if (smooth && next / 4 != walk.from) {
        cross(walk, next, 1 - patch.along_edge(q, walk.u, walk.v));
        continue;
      }
      double const t = foot_on_edge(patch, q, p);
      patch.on_edge(q, t, walk.u, walk.v);
      walk.offer(p, patch.edge(q, t), patch.edge_normal(q, t),
                 smooth     ? FacetFoot::Place::inside
                 : next < 0 ? FacetFoot::Place::rim
                            : FacetFoot::Place::crease);
      if (t == 0 || t == 1) {  // round the corner, along the rim or crease
        int const beside = t == 0 ? (q > 0 ? q - 1 : patch.size - 1) : (q + 1 < patch.size ? q + 1 : 0);
        int const there = facet.neighbour[beside];
        if (there >= 0 && !facet.is_crease(beside) && there / 4 != walk.from) {
          cross(walk, there, t == 0 ? 0 : 1);
          continue;
        }
      }
      if (next < 0 || smooth || crossed_crease) break;
      crossed_crease = true;
      cross(walk, next, 1 - t);
    }
    if (walk.best.facet < 0) stay_near(walk, flat, p);
    return walk.best;
  }

  /// How the foot moves where p moves by `rate` per unit of time: the derivative of closest_point() at an inside foot;
  /// elsewhere the part of `rate` along the tangent plane (rim) or along the edge's tangent plane (crease).
  KOKKOS_INLINE_FUNCTION Vec3 foot_rate(FacetFoot const& foot, Vec3 const& p, Vec3 const& rate) const {
    if (foot.place == FacetFoot::Place::inside) {
      FacetPlace const at = patch(foot.facet).at(foot.u, foot.v);
      double const d = dot(p - at.s, at.n) / dot(at.n, at.n);
      Vec3 const a = at.s_u + d * at.n_u, b = at.s_v + d * at.n_v, b_n = gridmorph::cross(b, at.n);
      double const det = dot(a, b_n);
      if (regular(det, a, b, at.n))
        return (dot(rate, b_n) / det) * at.s_u + (dot(a, gridmorph::cross(rate, at.n)) / det) * at.s_v;
    }
    return rate - dot(rate, foot.normal) * foot.normal;
  }

  /// The point p put on the surface, which beyond its rims is continued by their tangent planes.
  KOKKOS_INLINE_FUNCTION Vec3 slide(FacetFoot const& foot, Vec3 const& p) const {
    return foot.place == FacetFoot::Place::rim ? p - dot(p - foot.point, foot.normal) * foot.normal : foot.point;
  }

 private:
  static constexpr int max_steps = 64, max_newton = 12, max_chords = 60;
  static constexpr double edge_tolerance = 1e-12;

  struct Walk {
    int facet, from;
    double u, v;
    FacetFoot best;

    KOKKOS_INLINE_FUNCTION void offer(Vec3 const& p, Vec3 const& s, Vec3 const& n, FacetFoot::Place place) {
      double const far = distance(p, s);
      if (best.facet >= 0 && !(far < best.distance)) return;
      double const length = norm(n);
      best = {s, length > 0 ? (1 / length) * n : n, facet, u, v, far, place};
    }
  };

  /// Where grid lines have kinks, local coordinates of facets beside them may fold, and the way from facet to facet go
  /// in circles: the foot is then the nearest place of the flat facets, on the curved one; on a rim that across from p.
  KOKKOS_INLINE_FUNCTION void stay_near(Walk& walk, FlatPlace const& flat, Vec3 const& p) const {
    using std::fabs;
    constexpr double on_edge = 1e-9;
    FacetPatch const patch = this->patch(flat.facet);
    walk.facet = flat.facet;
    for (int q = 0; q < patch.size; ++q) {
      if (tree.facets[flat.facet].neighbour[q] >= 0) continue;
      patch.on_edge(q, patch.along_edge(q, flat.u, flat.v), walk.u, walk.v);
      if (fabs(walk.u - flat.u) + fabs(walk.v - flat.v) > on_edge) continue;
      double const t = foot_on_edge(patch, q, p);
      patch.on_edge(q, t, walk.u, walk.v);
      walk.offer(p, patch.edge(q, t), patch.edge_normal(q, t), FacetFoot::Place::rim);
    }
    if (walk.best.facet >= 0) return;
    walk.u = flat.u;
    walk.v = flat.v;
    FacetPlace const at = patch.at(walk.u, walk.v);
    walk.offer(p, at.s, at.n, FacetFoot::Place::inside);
  }

  /// Goes on to the place t of an edge (4 * facet + edge).
  KOKKOS_INLINE_FUNCTION void cross(Walk& walk, int edge, double t) const {
    walk.from = walk.facet;
    walk.facet = edge / 4;
    patch(walk.facet).on_edge(edge % 4, t, walk.u, walk.v);
  }

  KOKKOS_INLINE_FUNCTION static bool regular(double det, Vec3 const& a, Vec3 const& b, Vec3 const& n) {
    using std::fabs;
    return fabs(det) > 1e-12 * norm(a) * norm(b) * norm(n);
  }

  /// Newton's method for s + d n = p. Stops early well outside of the facet.
  KOKKOS_INLINE_FUNCTION static void newton(FacetPatch const& patch, Vec3 const& p, double& u, double& v,
                                            FacetPlace& at) {
    using std::fabs;
    at = patch.at(u, v);
    double d = dot(p - at.s, at.n) / dot(at.n, at.n);
    for (int m = 0; m < max_newton; ++m) {
      Vec3 const a = at.s_u + d * at.n_u, b = at.s_v + d * at.n_v, r = (p - at.s) - d * at.n;
      Vec3 const b_n = gridmorph::cross(b, at.n);
      double const det = dot(a, b_n);
      if (!regular(det, a, b, at.n)) return;
      double const du = dot(r, b_n) / det, dv = dot(a, gridmorph::cross(r, at.n)) / det;
      d += dot(a, gridmorph::cross(b, r)) / det;
      u += du;
      v += dv;
      if (u < -0.5 || u > 1.5 || v < -0.5 || v > 1.5) return;
      if (fabs(du) + fabs(dv) < 1e-15) return;
      at = patch.at(u, v);
    }
  }

  /// Where p is across from an edge, seen along the normals: (p - c(t)) . tangent(t) = 0, or the end that is nearer.
  KOKKOS_INLINE_FUNCTION static double foot_on_edge(FacetPatch const& patch, int q, Vec3 const& p) {
    using std::fabs;
    double low = 0, high = 1, at_low = ahead(patch, q, 0, p), at_high = ahead(patch, q, 1, p);
    if (!(at_low > 0)) return 0;
    if (!(at_high < 0)) return 1;
    // Regula falsi, an end that stays being given half its weight (Illinois method).
    double t = 0.5, before = 2;
    int stayed = 0;
    for (int m = 0; m < max_chords; ++m) {
      t = low + at_low / (at_low - at_high) * (high - low);
      if (fabs(t - before) < 1e-16) break;
      before = t;
      double const here = ahead(patch, q, t, p);
      if (here == 0) break;
      if (here > 0) {
        low = t;
        at_low = here;
        if (stayed == 1) at_high *= 0.5;
        stayed = 1;
      } else {
        high = t;
        at_high = here;
        if (stayed == -1) at_low *= 0.5;
        stayed = -1;
      }
    }
    return t;
  }
  KOKKOS_INLINE_FUNCTION static double ahead(FacetPatch const& patch, int q, double t, Vec3 const& p) {
    Vec3 const c = patch.edge_derivative(q, t), n = patch.edge_normal(q, t);
    Vec3 const tangent = c - (dot(c, n) / dot(n, n)) * n;
    return dot(p - patch.edge(q, t), tangent);
  }
};

}  // namespace gridmorph::kernels
