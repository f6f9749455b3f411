// Whether an unstructured element contains a point, and its place nearest to one outside.
//
// Nearest place. It lies on a face: on each of them the nearest place of its two triangles (exact for triangular
// faces), for quadrilateral faces improved by Gauss-Newton steps on the bilinear face that stay within it, where the
// face can still be nearest: it is nowhere further from its triangles than a quarter of its warp |a - b + c - d|. Never
// further away than the nearest corner. Distances are those from x(local), so that they belong to the weights there.
// Cost 500 (tetrahedron) to 2500 flops (hexahedron).
#pragma once

#include <gridmorph/kernels/element_map.hpp>
#include <gridmorph/kernels/facet_tree.hpp>

namespace gridmorph::kernels {

/// A place in an element, and how far from a point it is.
struct ElementPlace {
  Vec3 local;
  double distance = unbounded;
};

/// Local coordinates of the point, when no place of the element is further from it than `tolerance`: true; then they
/// lie within the element, else nothing is written. Elements without volume contain nothing: nearest_in_element() sees
/// them.
KOKKOS_INLINE_FUNCTION bool element_contains(ElementType type, ElementCorners const& c, Vec3 const& p, double tolerance,
                                             Vec3& local) {
  constexpr double reach = 0.01;  // round-off in coordinates may be so much of a flat element
  if (type == ElementType::tetrahedron) {
    // Most candidates are far from holding the point: no division before that is clear.
    Vec3 const a = c.at[1] - c.at[0], b = c.at[2] - c.at[0], d = c.at[3] - c.at[0], q = p - c.at[0];
    Vec3 const ab = cross(a, b), qd = cross(q, d);
    double det = dot(ab, d), r = -dot(b, qd), s = dot(a, qd), t = dot(ab, q);
    if (det < 0) {
      det = -det;
      r = -r;
      s = -s;
      t = -t;
    }
    double const low = -reach * det;
    if (r < low || s < low || t < low || r + s + t > det - low) return false;
  }
  ElementInverse const inverse = invert_element(type, c, p, reach);
  if (!inverse.converged) return false;
  double const outside = element::excess(type, inverse.local);
  if (!(outside <= reach)) return false;
  Vec3 const clamped = clamp_local(type, inverse.local);
  if (outside > 0 && !(distance(element_position(type, c, clamped), p) <= tolerance)) return false;
  local = clamped;
  return true;
}

namespace element {

/// A quadrilateral face relative to the point: x(u, v), its corners in order at (0, 0), (1, 0), (1, 1), (0, 1).
struct QuadFace {
  Vec3 a, along_u, along_v, both;

  KOKKOS_INLINE_FUNCTION Vec3 operator()(double u, double v) const {
    return a + u * along_u + v * along_v + (u * v) * both;
  }

  /// Gauss-Newton steps within the face, as long as they lead nearer; along the sides where u or v is at its limit.
  KOKKOS_INLINE_FUNCTION void improve(double& u, double& v) const {
    constexpr int max_steps = 8, halvings = 3;
    Vec3 x = (*this)(u, v);
    double best = dot(x, x);
    for (int step = 0; step < max_steps; ++step) {
      Vec3 const by_u = along_u + v * both, by_v = along_v + u * both;
      double const gu = -dot(x, by_u), gv = -dot(x, by_v);
      double const uu = dot(by_u, by_u), vv = dot(by_v, by_v), uv = dot(by_u, by_v);
      bool const fixed_u = (u <= 0 && gu <= 0) || (u >= 1 && gu >= 0) || !(uu > 0);
      bool const fixed_v = (v <= 0 && gv <= 0) || (v >= 1 && gv >= 0) || !(vv > 0);
      double du = 0, dv = 0;
      double const det = uu * vv - uv * uv;
      if (!fixed_u && !fixed_v && det > 1e-12 * uu * vv) {
        du = (gu * vv - gv * uv) / det;
        dv = (gv * uu - gu * uv) / det;
      } else {
        if (!fixed_u) du = gu / uu;
        if (!fixed_v) dv = gv / vv;
        if (!fixed_u && !fixed_v) {  // parallel: each alone would go too far
          du *= 0.5;
          dv *= 0.5;
        }
      }
      bool nearer = false;
      double fraction = 1, gained = 0;
      for (int h = 0; h <= halvings && !nearer; ++h, fraction *= 0.5) {
        double const tu = within(u + fraction * du), tv = within(v + fraction * dv);
        Vec3 const there = (*this)(tu, tv);
        double const d2 = dot(there, there);
        nearer = d2 < best;
        if (!nearer) continue;
        gained = best - d2;
        u = tu;
        v = tv;
        x = there;
        best = d2;
      }
      if (!nearer || gained <= 1e-12 * best) return;
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION static double within(double a) { return a > 0 ? (a < 1 ? a : 1.0) : 0.0; }
};

/// Nearest of a face's triangles to the origin: face coordinates of the place, squared distance.
struct FlatFacePlace {
  double u = 0, v = 0, distance2 = 0;
};

KOKKOS_INLINE_FUNCTION FlatFacePlace nearest_on_face(Vec3 const* x, int n) {
  FlatFacePlace out;
  double to_b = 0, to_c = 0;
  Vec3 const origin;
  nearest_on_triangle(origin, x[0], x[1], x[2], to_b, to_c);
  Vec3 const first = x[0] + to_b * (x[1] - x[0]) + to_c * (x[2] - x[0]);
  out = {n == 4 ? to_b + to_c : to_b, to_c, dot(first, first)};
  if (n < 4) return out;
  nearest_on_triangle(origin, x[0], x[2], x[3], to_b, to_c);
  Vec3 const second = x[0] + to_b * (x[2] - x[0]) + to_c * (x[3] - x[0]);
  double const d2 = dot(second, second);
  if (d2 < out.distance2) out = {to_b, to_b + to_c, d2};
  return out;
}

}  // namespace element

/// Whether an element may have a nearer place: false only when no place of the element is nearer to p than `limit`: its
/// corners all lie beyond a plane that is so far away. Planes across the way from the point to the nearest corner, and
/// across `towards` (both seen from p). 60 flops per corner at most.
KOKKOS_INLINE_FUNCTION bool may_be_nearer(ElementType type, ElementCorners const& c, Vec3 const& p, Vec3 const& towards,
                                          double limit) {
  constexpr double safe = 1 - 1e-6;
  int const corners = n_corners(type);
  double const limit2 = limit * limit;
  double least = unbounded;
  Vec3 nearest;
  double beyond = unbounded;
  for (int k = 0; k < corners; ++k) {
    Vec3 const d = c.at[k] - p;
    double const d2 = dot(d, d);
    if (d2 < least) {
      least = d2;
      nearest = d;
    }
    beyond = smaller(beyond, dot(towards, d));
  }
  if (beyond > 0 && beyond * beyond * safe > limit2 * dot(towards, towards)) return false;
  beyond = unbounded;
  for (int k = 0; k < corners; ++k) beyond = smaller(beyond, dot(nearest, c.at[k] - p));
  return !(beyond > 0 && beyond * beyond * safe > limit2 * least);
}

/// The place of an element nearest to a point outside. `type`: no polyhedron.
KOKKOS_INLINE_FUNCTION ElementPlace nearest_in_element(ElementType type, ElementCorners const& c, Vec3 const& p) {
  using compat::math::sqrt;
  ElementPlace best;
  int const corners = n_corners(type);
  double best2 = unbounded;
  for (int k = 0; k < corners; ++k) {
    Vec3 const d = c.at[k] - p;
    double const d2 = dot(d, d);
    if (d2 < best2) {
      best2 = d2;
      best.local = corner_local(type, k);
    }
  }
  bool const surface = is_surface(type);
  int const faces = surface ? 1 : n_faces(type);
  element::FlatFacePlace flat[max_faces];
  double lower[max_faces];
  bool pending[max_faces];
  auto const corner_of = [&](int f, int k) { return surface ? k : face_corner(type, f, k); };
  auto const face_size = [&](int f) { return surface ? corners : n_face_corners(type, f); };
  for (int f = 0; f < faces; ++f) {
    Vec3 x[max_face_corners];
    int const n = face_size(f);
    for (int k = 0; k < n; ++k) x[k] = c.at[corner_of(f, k)] - p;
    flat[f] = element::nearest_on_face(x, n);
    double const warp = n == 4 ? 0.25 * norm((x[0] - x[1]) + (x[2] - x[3])) : 0.0;
    lower[f] = sqrt(flat[f].distance2) - warp;
    pending[f] = true;
  }
  // Faces in order of what they can be at best.
  for (int round = 0; round < faces; ++round) {
    int f = -1;
    for (int g = 0; g < faces; ++g)
      if (pending[g] && (f < 0 || lower[g] < lower[f])) f = g;
    if (f < 0 || !(lower[f] <= 0 || lower[f] * lower[f] < best2)) break;
    pending[f] = false;
    int const n = face_size(f);
    double u = flat[f].u, v = flat[f].v;
    Vec3 const a = corner_local(type, corner_of(f, 0)), b = corner_local(type, corner_of(f, 1)),
               d = corner_local(type, corner_of(f, n - 1));
    if (n == 4) {
      Vec3 const xa = c.at[corner_of(f, 0)] - p, xb = c.at[corner_of(f, 1)] - p, xc = c.at[corner_of(f, 2)] - p,
                 xd = c.at[corner_of(f, 3)] - p;
      element::QuadFace{xa, xb - xa, xd - xa, (xa - xb) + (xc - xd)}.improve(u, v);
    }
    // Faces are affine in local coordinates.
    Vec3 const local = clamp_local(type, a + u * (b - a) + v * (d - a));
    Vec3 const away = element_position(type, c, local) - p;
    double const d2 = dot(away, away);
    if (d2 < best2) {
      best2 = d2;
      best.local = local;
    }
  }
  best.distance = sqrt(best2);
  return best;
}

}  // namespace gridmorph::kernels
