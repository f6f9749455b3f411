// One curved facet of a discrete surface: a quadrilateral or triangle with a tangent plane at every corner.
//
// Every edge is a cubic from corner A to corner B,
//
//   c(t) = (1 - t) A + t B + 3 t (1 - t) ((1 - t) a + t b),
//
// whose two bends a, b make it tangent to the surface at its ends. Facets that share an edge share the curve.
//   quadrilateral  Coons patch of its four edges (Coons 1967): the bilinear patch plus the bends of each edge faded
//                  linearly to the opposite one
//   triangle       cubic Bezier triangle through its three edges whose middle control point reproduces quadratics (the
//                  PN triangle of Vlachos, Peters, Boyd and Mitchell 2001)
// The normals at the corners are interpolated, (bi)linearly, to a normal field that is continuous across edges.
//
// Order. The distance of the facet from a smooth surface whose points and tangent planes it has at its corners is, as a
// function of the local coordinates, zero with its gradient at the corners. On a square no polynomial of degree three
// is: quadrilaterals are off by O(h^4). On a triangle one is, the bubble: triangles are off by O(h^3). Tangent planes
// that are off by an angle e add O(h e). A planar facet is exactly planar.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// Numbers into the tables of a FacetSurfaceView. Edge q runs from corner q to the next one.
struct Facet {
  std::int32_t corner[4] = {-1, -1, -1, -1};  ///< points; a triangle has none at [3]
  std::int32_t normal[4] = {-1, -1, -1, -1};  ///< normals at the corners
  std::int32_t bend[4] = {-1, -1, -1, -1};    ///< bends of edge q: [bend[q]] beside corner q, [bend[q] ^ 1] at its end
  std::int32_t neighbour[4] = {-1, -1, -1, -1};  ///< 4 * facet + edge across edge q; -1 at a rim
  std::int32_t creases = 0;                      ///< bit q: the surface has a crease along edge q

  KOKKOS_INLINE_FUNCTION int n_corners() const { return corner[3] < 0 ? 3 : 4; }
  KOKKOS_INLINE_FUNCTION bool is_crease(int q) const { return ((creases >> q) & 1) != 0; }
};

/// A facet at one place: point, unscaled normal, and their derivatives along the local coordinates.
struct FacetPlace {
  Vec3 s, s_u, s_v;
  Vec3 n, n_u, n_v;
};

/// A facet with its numbers looked up. Local coordinates: quadrilateral 0 <= u, v <= 1 with corners (0,0), (1,0),
/// (1,1), (0,1); triangle 0 <= u, v and u + v <= 1 with corners (0,0), (1,0), (0,1). Defined, smoothly, beyond that
/// too.
struct FacetPatch {
  Vec3 p[4], n[4];
  Vec3 a[4], b[4];  ///< bends of edge q beside its first and second corner
  int size = 4;     ///< corners

  KOKKOS_INLINE_FUNCTION FacetPatch(Facet const& facet, Vec3 const* points, Vec3 const* normals, Vec3 const* bends)
      : size(facet.n_corners()) {
    for (int q = 0; q < size; ++q) {
      p[q] = points[facet.corner[q]];
      n[q] = normals[facet.normal[q]];
      a[q] = bends[facet.bend[q]];
      b[q] = bends[facet.bend[q] ^ 1];
    }
  }

  KOKKOS_INLINE_FUNCTION FacetPlace at(double u, double v) const {
    return size == 4 ? on_square(u, v) : on_triangle(u, v);
  }

  /// The curve of edge q and its derivative; t = 0 at corner q.
  KOKKOS_INLINE_FUNCTION Vec3 edge(int q, double t) const {
    int const e = q + 1 < size ? q + 1 : 0;
    return p[q] + t * (p[e] - p[q]) + bump(q, t);
  }
  KOKKOS_INLINE_FUNCTION Vec3 edge_derivative(int q, double t) const {
    int const e = q + 1 < size ? q + 1 : 0;
    return (p[e] - p[q]) + bump_derivative(q, t);
  }
  KOKKOS_INLINE_FUNCTION Vec3 edge_normal(int q, double t) const {
    int const e = q + 1 < size ? q + 1 : 0;
    return n[q] + t * (n[e] - n[q]);
  }

  /// Local coordinates of a place on edge q, and back: the nearest place on the edge in local coordinates.
  KOKKOS_INLINE_FUNCTION void on_edge(int q, double t, double& u, double& v) const {
    if (size == 4) {
      u = q == 0 ? t : q == 1 ? 1 : q == 2 ? 1 - t : 0;
      v = q == 0 ? 0 : q == 1 ? t : q == 2 ? 1 : 1 - t;
    } else {
      u = q == 0 ? t : q == 1 ? 1 - t : 0;
      v = q == 0 ? 0 : q == 1 ? t : 1 - t;
    }
  }
  KOKKOS_INLINE_FUNCTION double along_edge(int q, double u, double v) const {
    double const t = size == 4 ? (q == 0   ? u
                                  : q == 1 ? v
                                  : q == 2 ? 1 - u
                                           : 1 - v)
                               : (q == 0   ? u
                                  : q == 1 ? 0.5 * (v + 1 - u)
                                           : 1 - v);
    return t < 0 ? 0 : t > 1 ? 1 : t;
  }

  /// The edge that (u, v) lies farthest beyond, and how far; -1 inside.
  KOKKOS_INLINE_FUNCTION int beyond(double u, double v, double tolerance) const {
    double const out[4] = {-v, size == 4 ? u - 1 : u + v - 1, size == 4 ? v - 1 : -u, size == 4 ? -u : -1.0};
    int most = -1;
    for (int q = 0; q < size; ++q)
      if (out[q] > tolerance && (most < 0 || out[q] > out[most])) most = q;
    return most;
  }

  /// (u, v) taken back inside.
  KOKKOS_INLINE_FUNCTION void clamp(double& u, double& v) const {
    u = u < 0 ? 0 : u > 1 ? 1 : u;
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    if (size == 4 || u + v <= 1) return;
    double const excess = 0.5 * (u + v - 1);
    u = u - excess < 0 ? 0 : u - excess > 1 ? 1 : u - excess;
    v = 1 - u;
  }

 private:
  KOKKOS_INLINE_FUNCTION Vec3 bump(int q, double t) const { return 3 * t * (1 - t) * ((1 - t) * a[q] + t * b[q]); }
  KOKKOS_INLINE_FUNCTION Vec3 bump_derivative(int q, double t) const {
    return 3 * (1 - t) * (1 - 3 * t) * a[q] + 3 * t * (2 - 3 * t) * b[q];
  }

  KOKKOS_INLINE_FUNCTION FacetPlace on_square(double u, double v) const {
    // Edges 2 and 3 run against u and v.
    Vec3 const low = bump(0, u), high = bump(2, 1 - u), left = bump(3, 1 - v), right = bump(1, v);
    Vec3 const p_u = p[1] - p[0], p_v = p[3] - p[0], p_uv = (p[2] - p[1]) - p_v;
    Vec3 const n_u = n[1] - n[0], n_v = n[3] - n[0], n_uv = (n[2] - n[1]) - n_v;
    FacetPlace f;
    f.s = p[0] + (u * p_u + v * p_v + u * v * p_uv) + ((1 - v) * low + v * high + (1 - u) * left + u * right);
    f.s_u = (p_u + v * p_uv) + ((1 - v) * bump_derivative(0, u) - v * bump_derivative(2, 1 - u)) + (right - left);
    f.s_v = (p_v + u * p_uv) + (u * bump_derivative(1, v) - (1 - u) * bump_derivative(3, 1 - v)) + (high - low);
    f.n = n[0] + (u * n_u + v * n_v + u * v * n_uv);
    f.n_u = n_u + v * n_uv;
    f.n_v = n_v + u * n_uv;
    return f;
  }

  KOKKOS_INLINE_FUNCTION FacetPlace on_triangle(double u, double v) const {
    double const w[3] = {1 - u - v, u, v};
    Vec3 const p_u = p[1] - p[0], p_v = p[2] - p[0];
    Vec3 const middle = 0.25 * ((a[0] + b[0]) + (a[1] + b[1]) + (a[2] + b[2]));
    FacetPlace f;
    f.n_u = n[1] - n[0];
    f.n_v = n[2] - n[0];
    f.n = n[0] + (u * f.n_u + v * f.n_v);
    Vec3 bumps = 6 * w[0] * w[1] * w[2] * middle, slope[3];
    for (int q = 0; q < 3; ++q) slope[q] = 6 * w[q == 0 ? 1 : 0] * w[q == 2 ? 1 : 2] * middle;
    for (int q = 0; q < 3; ++q) {
      int const e = q < 2 ? q + 1 : 0;
      bumps += 3 * w[q] * w[e] * (w[q] * a[q] + w[e] * b[q]);
      slope[q] += 3 * w[e] * (2 * w[q] * a[q] + w[e] * b[q]);
      slope[e] += 3 * w[q] * (w[q] * a[q] + 2 * w[e] * b[q]);
    }
    f.s = p[0] + (u * p_u + v * p_v) + bumps;
    f.s_u = p_u + (slope[1] - slope[0]);
    f.s_v = p_v + (slope[2] - slope[0]);
    return f;
  }
};

}  // namespace gridmorph::kernels
