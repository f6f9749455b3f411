// The map of an unstructured element from local coordinates (r, s, t) to space, and its inverse.
//
//   x(r, s, t) = sum over corners of weight(r, s, t) * corner                 (SIDS node order, element_shape.hpp)
//
//   triangle       1 - r - s, r, s                             0 <= r, s and r + s <= 1
//   quadrilateral  bilinear                                    0 <= r, s <= 1
//   tetrahedron    1 - r - s - t, r, s, t                      0 <= r, s, t and r + s + t <= 1
//   pyramid        with w = 1 - t: (w - r)(w - s) / w, r (w - s) / w, r s / w, (w - r) s / w, t
//                                                              0 <= r, s <= w and 0 <= t <= 1
//   prism          triangle (r, s) times linear in t           hexahedron  trilinear, 0 <= r, s, t <= 1
//
// The weights sum to one and are never negative inside, and two elements that share a face agree on it. The pyramid is
// the rational one of G. Bedrosian (Int. J. Numer. Meth. Engng 35, 1992): bilinear on its base, linear on its triangles
// and along lines to the apex, where the quotients r / w and s / w stay between 0 and 1 and so all terms and their
// slopes bounded.
//
// Inverse. Corners are taken relative to the point, and the map in normal form: with J the Jacobian at the element's
// centre,
//
//   J^-1 (x(centre + xi) - p) = xi + N(xi) - y,        |N_i| <= bound_i inside the element
//
// so that flat elements look like well-shaped ones. Simplices have N = 0: one step. A point with |y| further outside
// than the bound is not in the element. Else Newton's method with halved steps, at most max_newton_steps of them, from
// the nearest place to y; where that fails from the centre and eight places around it. Surface elements: the point is
// projected on the plane of the element's centre.
//
// Cost: tetrahedron 90 flops; hexahedron 350 and 160 for each step, of which two to four are taken.
#pragma once

#include <gridmorph/kernels/element_quality.hpp>

namespace gridmorph::kernels {

inline constexpr int max_newton_steps = 16;

/// Weights of the corners; those that a type does not have are zero.
struct ElementWeights {
  double of[max_corners] = {};
};

KOKKOS_INLINE_FUNCTION ElementWeights element_weights(ElementType type, Vec3 const& local) {
  double const r = local.x, s = local.y, t = local.z;
  switch (type) {
    case ElementType::triangle: return {{1 - r - s, r, s}};
    case ElementType::quadrilateral: return {{(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s}};
    case ElementType::tetrahedron: return {{1 - r - s - t, r, s, t}};
    case ElementType::pyramid: {
      double const w = 1 - t;
      if (!(w > 0)) return {{0, 0, 0, 0, 1}};
      return {{(w - r) * (w - s) / w, r * (w - s) / w, r * s / w, (w - r) * s / w, t}};
    }
    case ElementType::prism: {
      double const q = 1 - r - s, b = 1 - t;
      return {{q * b, r * b, s * b, q * t, r * t, s * t}};
    }
    case ElementType::hexahedron: {
      double const a = (1 - r) * (1 - s), b = r * (1 - s), c = r * s, d = (1 - r) * s, u = 1 - t;
      return {{a * u, b * u, c * u, d * u, a * t, b * t, c * t, d * t}};
    }
    case ElementType::polyhedron: break;
  }
  return {};
}

/// Local coordinates of a corner.
KOKKOS_INLINE_FUNCTION Vec3 corner_local(ElementType type, int corner) {
  bool const quad_base =
      type == ElementType::quadrilateral || type == ElementType::pyramid || type == ElementType::hexahedron;
  if (type == ElementType::pyramid && corner == 4) return {0, 0, 1};
  if (quad_base) {
    int const at = corner & 3;
    return {at == 1 || at == 2 ? 1.0 : 0.0, at >= 2 ? 1.0 : 0.0, corner >= 4 ? 1.0 : 0.0};
  }
  if (type == ElementType::tetrahedron)
    return {corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0, corner == 3 ? 1.0 : 0.0};
  int const at = corner % 3;
  return {at == 1 ? 1.0 : 0.0, at == 2 ? 1.0 : 0.0, corner >= 3 ? 1.0 : 0.0};
}

KOKKOS_INLINE_FUNCTION Vec3 element_position(ElementType type, ElementCorners const& c, Vec3 const& local) {
  ElementWeights const w = element_weights(type, local);
  // Relative to a corner, so that positions near one are as exact as they can be.
  Vec3 sum;
  int const n = n_corners(type);
  for (int k = 1; k < n; ++k) sum += w.of[k] * (c.at[k] - c.at[0]);
  return c.at[0] + sum;
}

/// Derivatives of the position along r, s and t; that of a surface element along t is zero. At a pyramid's apex its
/// limit along the axis.
struct ElementJacobian {
  Vec3 r, s, t;
};

KOKKOS_INLINE_FUNCTION ElementJacobian element_jacobian(ElementType type, ElementCorners const& c, Vec3 const& local);

namespace element {

/// x(centre + xi) with xi = (r, s, t): value + r r + s s + t t + rs * rs + ...; the pyramid has u v / w in the place of
/// rs, where u = r + t / 2, v = s + t / 2 and w = 3/4 - t.
struct CentredMap {
  Vec3 value, r, s, t;
  Vec3 rs, st, rt, rst;
};

/// Local coordinates of the centre.
KOKKOS_INLINE_FUNCTION Vec3 centre_local(ElementType type) {
  constexpr double third = 1.0 / 3;
  switch (type) {
    case ElementType::triangle: return {third, third, 0};
    case ElementType::quadrilateral: return {0.5, 0.5, 0};
    case ElementType::tetrahedron: return {0.25, 0.25, 0.25};
    case ElementType::pyramid: return {0.375, 0.375, 0.25};
    case ElementType::prism: return {third, third, 0.5};
    case ElementType::hexahedron:
    case ElementType::polyhedron: break;
  }
  return {0.5, 0.5, 0.5};
}

/// A normal of the length of the sides, along which surface elements have no extent.
KOKKOS_INLINE_FUNCTION Vec3 normal_like(Vec3 const& r, Vec3 const& s) {
  Vec3 const n = cross(r, s);
  double const area = norm(n);
  return area > 0 ? (1 / compat::math::sqrt(area)) * n : n;
}

KOKKOS_INLINE_FUNCTION CentredMap triangle_map(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  CentredMap m;
  m.value = (1.0 / 3) * (a + b + c);
  m.r = b - a;
  m.s = c - a;
  return m;
}

KOKKOS_INLINE_FUNCTION CentredMap quad_map(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec3 const& d) {
  CentredMap m;
  m.value = 0.25 * ((a + b) + (c + d));
  m.r = 0.5 * ((b - a) + (c - d));
  m.s = 0.5 * ((d - a) + (c - b));
  m.rs = (a - b) + (c - d);
  return m;
}

/// The map of a layer, linear between a bottom and a top.
KOKKOS_INLINE_FUNCTION CentredMap layer_map(CentredMap const& bottom, CentredMap const& top) {
  CentredMap m;
  m.value = 0.5 * (bottom.value + top.value);
  m.r = 0.5 * (bottom.r + top.r);
  m.s = 0.5 * (bottom.s + top.s);
  m.rs = 0.5 * (bottom.rs + top.rs);
  m.t = top.value - bottom.value;
  m.rt = top.r - bottom.r;
  m.st = top.s - bottom.s;
  m.rst = top.rs - bottom.rs;
  return m;
}

/// The map of an element as x - p: relative to the point, so that the round-off is that of the element's size.
KOKKOS_INLINE_FUNCTION CentredMap centred_map(ElementType type, ElementCorners const& c, Vec3 const& p) {
  CentredMap m;
  Vec3 const* const x = c.at;
  switch (type) {
    case ElementType::triangle:
      m = triangle_map(x[0] - p, x[1] - p, x[2] - p);
      m.t = normal_like(m.r, m.s);
      break;
    case ElementType::quadrilateral:
      m = quad_map(x[0] - p, x[1] - p, x[2] - p, x[3] - p);
      m.t = normal_like(m.r, m.s);
      break;
    case ElementType::tetrahedron:
      m.value = 0.25 * (((x[0] - p) + (x[1] - p)) + ((x[2] - p) + (x[3] - p)));
      m.r = x[1] - x[0];
      m.s = x[2] - x[0];
      m.t = x[3] - x[0];
      break;
    case ElementType::pyramid: {
      CentredMap const base = quad_map(x[0] - p, x[1] - p, x[2] - p, x[3] - p);
      m = base;
      // w * base mean + t * apex, and r = w / 2 + u: the centre of the base follows w.
      m.t = (x[4] - p) - (base.value - 0.5 * (base.r + base.s));
      m.value = 0.75 * base.value + 0.25 * (x[4] - p);
      break;
    }
    case ElementType::prism:
      m = layer_map(triangle_map(x[0] - p, x[1] - p, x[2] - p), triangle_map(x[3] - p, x[4] - p, x[5] - p));
      break;
    case ElementType::hexahedron:
      m = layer_map(quad_map(x[0] - p, x[1] - p, x[2] - p, x[3] - p), quad_map(x[4] - p, x[5] - p, x[6] - p, x[7] - p));
      break;
    case ElementType::polyhedron: break;
  }
  return m;
}

/// The map relative to its Jacobian at the centre.
struct NormalForm {
  Vec3 target;           ///< y
  Vec3 rs, st, rt, rst;  ///< of N
  bool pyramid = false;
  bool sound = false;  ///< the Jacobian at the centre has an inverse

  /// The map N(xi) and its columns of derivatives.
  KOKKOS_INLINE_FUNCTION Vec3 bend(Vec3 const& xi, Vec3& dr, Vec3& ds, Vec3& dt) const {
    double const r = xi.x, s = xi.y, t = xi.z;
    if (!pyramid) {
      dr = s * rs + t * rt + (s * t) * rst;
      ds = r * rs + t * st + (r * t) * rst;
      dt = s * st + r * rt + (r * s) * rst;
      return (r * s) * rs + (s * t) * st + (r * t) * rt + (r * s * t) * rst;
    }
    // u v / w; outside of the cone that is twice as wide as the pyramid a continuation with bounded slopes.
    double const u = r + 0.5 * t, v = s + 0.5 * t, w = 0.75 - t;
    double const size_u = u < 0 ? -u : u, size_v = v < 0 ? -v : v;
    double value = 0, by_u = 0, by_v = 0, by_w = 0;
    if (w >= size_u && w >= size_v) {
      if (w > 0) {
        by_u = v / w;
        by_v = u / w;
        value = u * by_u;
        by_w = -by_u * by_v;
      }
    } else if (size_u >= size_v) {
      by_v = u < 0 ? -1 : 1;
      value = by_v * v;
    } else {
      by_u = v < 0 ? -1 : 1;
      value = by_u * u;
    }
    dr = by_u * rs;
    ds = by_v * rs;
    dt = (0.5 * (by_u + by_v) - by_w) * rs;
    return value * rs;
  }
};

KOKKOS_INLINE_FUNCTION double size_of(double a) { return a < 0 ? -a : a; }

KOKKOS_INLINE_FUNCTION NormalForm normal_form(ElementType type, CentredMap const& m) {
  constexpr double flat = 1e-13;  // sine of the angle between the columns below which nothing can be divided by it
  NormalForm f;
  Vec3 a = cross(m.s, m.t), b = cross(m.t, m.r), c = cross(m.r, m.s);
  double const det = dot(m.r, a);
  double const scale2 = dot(m.r, m.r) * dot(m.s, m.s) * dot(m.t, m.t);
  f.sound = det * det > flat * flat * scale2 && is_finite(1 / det);
  if (!f.sound) return f;
  double const inverse = 1 / det;
  a = inverse * a;
  b = inverse * b;
  c = inverse * c;
  auto const apply = [&](Vec3 const& v) { return Vec3{dot(a, v), dot(b, v), dot(c, v)}; };
  f.target = -apply(m.value);
  if (type == ElementType::triangle || type == ElementType::tetrahedron) return f;
  f.pyramid = type == ElementType::pyramid;
  if (type != ElementType::prism) f.rs = apply(m.rs);
  if (type == ElementType::prism || type == ElementType::hexahedron) {
    f.st = apply(m.st);
    f.rt = apply(m.rt);
  }
  if (type == ElementType::hexahedron) f.rst = apply(m.rst);
  if (is_surface(type)) f.target.z = f.rs.z = 0;
  return f;
}

/// How far local coordinates are outside, 0 inside.
KOKKOS_INLINE_FUNCTION double excess(ElementType type, Vec3 const& l) {
  double const low = -smaller(l.x, smaller(l.y, is_surface(type) ? 0.0 : l.z));
  double high = 0;
  switch (type) {
    case ElementType::triangle: high = l.x + l.y - 1; break;
    case ElementType::quadrilateral: high = larger(l.x, l.y) - 1; break;
    case ElementType::tetrahedron: high = l.x + l.y + l.z - 1; break;
    case ElementType::pyramid: high = larger(l.x, larger(l.y, 0.0)) + l.z - 1; break;
    case ElementType::prism: high = larger(l.x + l.y, l.z) - 1; break;
    case ElementType::hexahedron: high = larger(l.x, larger(l.y, l.z)) - 1; break;
    case ElementType::polyhedron: break;
  }
  return larger(0.0, larger(low, high));
}

/// The bound of N as an excess: a place inside may have a target that lies so far outside.
KOKKOS_INLINE_FUNCTION double bend_bound(ElementType type, NormalForm const& f) {
  auto const sum = [](Vec3 const& v, double w) { return Vec3{w * size_of(v.x), w * size_of(v.y), w * size_of(v.z)}; };
  switch (type) {
    case ElementType::quadrilateral:
    case ElementType::pyramid: {
      Vec3 const b = sum(f.rs, 0.25);
      return larger(b.x, b.y) + b.z;
    }
    case ElementType::prism: {
      Vec3 const b = sum(f.rt, 1.0 / 3) + sum(f.st, 1.0 / 3);
      return larger(b.x + b.y, b.z);
    }
    case ElementType::hexahedron: {
      Vec3 const b = sum(f.rs, 0.25) + sum(f.st, 0.25) + sum(f.rt, 0.25) + sum(f.rst, 0.125);
      return larger(b.x, larger(b.y, b.z));
    }
    default: return 0;
  }
}

}  // namespace element

/// Local coordinates moved into the element; those within round-off of a corner's, edge's or face's become exactly
/// that.
KOKKOS_INLINE_FUNCTION Vec3 clamp_local(ElementType type, Vec3 const& local) {
  auto const clamp = [](double a, double top) {
    constexpr double round_off = 4e-15;
    return a > round_off ? (a < top - round_off ? a : top) : 0.0;
  };
  Vec3 l{clamp(local.x, 1), clamp(local.y, 1), is_surface(type) ? 0.0 : clamp(local.z, 1)};
  double over = 0;
  switch (type) {
    case ElementType::triangle:
    case ElementType::prism:
      over = l.x + l.y;
      if (over > 1) {
        l.x = clamp(l.x - 0.5 * (over - 1), 1);
        l.y = clamp(l.y - 0.5 * (over - 1), 1);
        // Rounding may leave the sum above one.
        l.y = smaller(l.y, 1 - l.x);
      }
      break;
    case ElementType::tetrahedron:
      over = l.x + l.y + l.z;
      if (over > 1) l = (1 / over) * l;
      break;
    case ElementType::pyramid:
      l.x = clamp(l.x, 1 - l.z);
      l.y = clamp(l.y, 1 - l.z);
      break;
    default: break;
  }
  return l;
}

namespace element {

/// Newton's method with halved steps on xi + N(xi) - y = 0. `xi`: start and result. False where it finds no way down or
/// has used up its steps.
KOKKOS_INLINE_FUNCTION bool solve(NormalForm const& f, Vec3& xi) {
  constexpr double small_step = 1e-10;  // from here on only round-off can keep a step from being a good one
  constexpr double small_residual = 2e-15;
  constexpr double singular = 1e-14;
  constexpr int halvings = 5;
  Vec3 dr, ds, dt;
  Vec3 residual = xi + f.bend(xi, dr, ds, dt) - f.target;
  double error = dot(residual, residual);
  for (int step = 0; step < max_newton_steps; ++step) {
    if (error <= small_residual * small_residual) return true;
    dr.x += 1;
    ds.y += 1;
    dt.z += 1;
    Vec3 const a = cross(ds, dt), b = cross(dt, dr), c = cross(dr, ds);
    double const det = dot(dr, a);
    Vec3 d;
    if (size_of(det) > singular) {
      d = (-1 / det) * Vec3{dot(a, residual), dot(b, residual), dot(c, residual)};
    } else {  // steepest descent
      Vec3 const slope{dot(dr, residual), dot(ds, residual), dot(dt, residual)};
      Vec3 const along = slope.x * dr + slope.y * ds + slope.z * dt;
      double const curvature = dot(along, along);
      if (!(curvature > 0)) return false;
      d = (-dot(slope, slope) / curvature) * slope;
    }
    bool const last = dot(d, d) <= small_step * small_step;
    double fraction = 1;
    bool down = false;
    for (int h = 0; h <= halvings && !down; ++h, fraction *= 0.5) {
      Vec3 const trial = xi + fraction * d;
      Vec3 tr, ts, tt;
      Vec3 const there = trial + f.bend(trial, tr, ts, tt) - f.target;
      double const trial_error = dot(there, there);
      down = trial_error < error;
      if (!down && last) return true;  // as near as round-off allows
      if (!down) continue;
      xi = trial;
      residual = there;
      error = trial_error;
      dr = tr;
      ds = ts;
      dt = tt;
    }
    if (!down) return false;
  }
  return false;
}

/// Starts after the nearest place to the target: the centre, then eight places around it.
KOKKOS_INLINE_FUNCTION Vec3 start_around(int n) {
  if (n == 0) return {};
  double const a = 0.3;
  return {(n - 1) & 1 ? a : -a, (n - 1) & 2 ? a : -a, (n - 1) & 4 ? a : -a};
}

}  // namespace element

KOKKOS_INLINE_FUNCTION ElementJacobian element_jacobian(ElementType type, ElementCorners const& c, Vec3 const& local) {
  element::CentredMap const m = element::centred_map(type, c, c.at[0]);
  Vec3 const xi = local - element::centre_local(type);
  element::NormalForm bends;  // in space instead of relative to the centre
  bends.rs = m.rs;
  bends.st = m.st;
  bends.rt = m.rt;
  bends.rst = m.rst;
  bends.pyramid = type == ElementType::pyramid;
  ElementJacobian j;
  bends.bend(xi, j.r, j.s, j.t);
  j.r += m.r;
  j.s += m.s;
  j.t = is_surface(type) ? Vec3{} : j.t + m.t;
  return j;
}

struct ElementInverse {
  Vec3 local;
  /// A place was found, inside or outside. Not when the point is too far outside to look, the element has no volume at
  /// its centre, or Newton's method found no way.
  bool converged = false;
};

/// Local coordinates of point p. Points that are outside by more than `reach` (in local coordinates) may be left
/// without an answer. `local` are numbers within a few elements whatever the element is, as long as its corners are
/// numbers.
KOKKOS_INLINE_FUNCTION ElementInverse invert_element(ElementType type, ElementCorners const& c, Vec3 const& p,
                                                     double reach) {
  ElementInverse out;
  Vec3 const centre = element::centre_local(type);
  out.local = centre;
  element::NormalForm const f = element::normal_form(type, element::centred_map(type, c, p));
  if (!f.sound) return out;
  Vec3 const straight = centre + f.target;
  double const bound = element::bend_bound(type, f);
  if (!(element::excess(type, straight) <= bound + reach)) return out;
  if (bound == 0) {
    out.local = straight;
    out.converged = true;
    return out;
  }
  Vec3 const nearest = clamp_local(type, straight) - centre;
  bool const curved = bound > 0.2;
  int const starts = curved ? 9 : 1;
  for (int n = -1; n < starts; ++n) {
    Vec3 xi = n < 0 ? nearest : element::start_around(n);
    if (is_surface(type)) xi.z = 0;
    if (!element::solve(f, xi)) continue;
    Vec3 const local = centre + xi;
    double const outside = element::excess(type, local);
    if (!is_finite(outside)) continue;
    // A warped map may lead to the point from outside as well as from inside.
    if (!out.converged || outside < element::excess(type, out.local)) out.local = local;
    out.converged = true;
    if (outside <= reach || !curved) return out;
  }
  return out;
}

}  // namespace gridmorph::kernels
