// How far a cell is from turning inside out when its corners are x(t) = x0 + sum of t_i d_i, for all |t_i| <= s at
// once: a lower bound of that s from its Bezier coefficients (jacobian_bounds.hpp), which are polynomials in t.
//
// J is made of products a_p . (b_q x c_r) of three kinds of vectors between corners, its factors: edges along i, j, k
// of a hexahedron; columns and triangle edges of a prism; edges to the apex and base edges of a pyramid; three edges of
// a tetrahedron; in the plane its normal and edges. Every Bezier coefficient is a mean of such products:
//
//   hexahedron     b_IJK: a at (j, k), b at (i, k), c at (i, j), all with i + i' = I, j + j' = J, k + k' = K
//   prism          b_kT: column k, r at t, s at t', t + t' = T
//   pyramid        b_IJ: axis at (i, j), r at j', s at i', i + i' = I, j + j' = J; (1 - t)^2 left out
//   tetrahedron, triangle: one; quadrilateral: its corners
//
// With E the factors at the centre and F_i those of d_i, a factor is E + sum of t_i F_i, so that
//
//   b(t) >= b0 - s L - s^2 Q - s^3 T,    |t_i| <= s
//
// where L is the sum of |db/dt_i|, exact, or bounded as Q and T are: by permanents of the sizes of components, |det(u,
// v, w)| <= perm(|u|, |v|, |w|), of E and of R = sum of |F_i|. Sizes are taken by the cell's own measure, after E and
// F_i have been multiplied by the inverse of A, the means of the three kinds of factors; det A is J in the middle of
// the cell. So a cell a million times longer than high, or sheared, is measured like a cube: norms of its edges would
// say nothing of it.
//
// What is positive is so by more than arithmetic can be wrong: 2^-44 a b c (sign_share) and, for the rounding of the
// coordinates of a design, 64 eps x (a b + b c + c a), with the longest factors a, b, c and the largest coordinate x
// that the box has at the largest s that is asked for. Factors that are zero in all designs (poles, wedges) leave no
// trace: coefficients of which every product has one are zero in all designs, which the certificate takes for sound.
//
// Cost per hexahedron: 1100 flops and 300 for each mode by norms, 1300 more for each mode with exact slopes.
#pragma once

#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>

#include <cstdint>

namespace gridmorph::kernels {

inline constexpr int max_coefficients = 27, max_factors = 4;

/// Which corners factors lead between, and the coefficient that each product counts in.
struct ProductTable {
  int count[3] = {1, 1, 1};                  ///< factors of each kind
  std::int8_t ends[3][max_factors][2] = {};  ///< from, to; both 0: the normal of the plane
  int n_coefficients = 1;
  std::int8_t coefficient[max_factors][max_factors][max_factors] = {};  ///< of product (p, q, r)
  std::int8_t products[max_coefficients] = {};                          ///< that a coefficient is the mean of
  bool is_value[max_coefficients] = {};  ///< whether a coefficient is a value of J, at a corner
  /// Which directions of the cell a coefficient lies amid, bits of 1, 2, 4: halving it along them brings it closer to
  /// J.
  std::uint8_t amid[max_coefficients] = {};
};

KOKKOS_INLINE_FUNCTION constexpr ProductTable product_table(ElementType type) {
  constexpr std::int8_t ends[n_element_types - 1][3][max_factors][2] = {
      {{{0, 0}}, {{0, 1}}, {{0, 2}}},
      {{{0, 0}}, {{0, 1}, {3, 2}}, {{0, 3}, {1, 2}}},
      {{{0, 3}}, {{0, 1}}, {{0, 2}}},
      {{{0, 4}, {1, 4}, {3, 4}, {2, 4}}, {{0, 1}, {3, 2}}, {{0, 3}, {1, 2}}},
      {{{0, 3}, {1, 4}, {2, 5}}, {{0, 1}, {3, 4}}, {{0, 2}, {3, 5}}},
      {{{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {3, 7}, {2, 6}}}};
  constexpr std::int8_t count[n_element_types - 1][3] = {{1, 1, 1}, {1, 2, 2}, {1, 1, 1},
                                                         {4, 2, 2}, {3, 2, 2}, {4, 4, 4}};
  ProductTable t;
  t.n_coefficients = type == ElementType::hexahedron                              ? 27
                     : type == ElementType::prism || type == ElementType::pyramid ? 9
                     : type == ElementType::quadrilateral                         ? 4
                                                                                  : 1;
  for (int kind = 0; kind < 3; ++kind) {
    t.count[kind] = count[int(type)][kind];
    for (int n = 0; n < t.count[kind]; ++n)
      for (int end = 0; end < 2; ++end) t.ends[kind][n][end] = ends[int(type)][kind][n][end];
  }
  for (int p = 0; p < t.count[0]; ++p)
    for (int q = 0; q < t.count[1]; ++q)
      for (int r = 0; r < t.count[2]; ++r) {
        int at[3] = {0, 0, 0};
        if (type == ElementType::hexahedron) {
          at[0] = q % 2 + r % 2;
          at[1] = p % 2 + r / 2;
          at[2] = p / 2 + q / 2;
        } else if (type == ElementType::pyramid) {
          at[0] = p % 2 + r;
          at[1] = p / 2 + q;
        } else if (type == ElementType::prism) {
          at[0] = 2 * p;  // J is linear in the triangle: what it has at the columns are values
          at[2] = q + r;
        } else {
          at[0] = 2 * r;
          at[1] = 2 * q;
        }
        int const c = type == ElementType::hexahedron ? at[0] + 3 * at[1] + 9 * at[2]
                      : type == ElementType::pyramid  ? at[0] + 3 * at[1]
                      : type == ElementType::prism    ? p + 3 * at[2]
                                                      : q + 2 * r;
        t.coefficient[p][q][r] = std::int8_t(c);
        ++t.products[c];
        for (int axis = 0; axis < 3; ++axis)
          if (at[axis] == 1) t.amid[c] = std::uint8_t(t.amid[c] | 1u << axis);
        t.is_value[c] = t.amid[c] == 0;
      }
  return t;
}

/// The factors of J of one cell, or what a mode adds to them: of[kind][number].
struct JacobianFactors {
  Vec3 of[3][max_factors];
};

template <ElementType type>
KOKKOS_INLINE_FUNCTION JacobianFactors jacobian_factors(ElementCorners const& c, Vec3 const& plane_normal) {
  constexpr ProductTable t = product_table(type);
  JacobianFactors f;
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < t.count[kind]; ++n)
      f.of[kind][n] =
          is_surface(type) && kind == 0 ? plane_normal : c.at[t.ends[kind][n][1]] - c.at[t.ends[kind][n][0]];
  return f;
}

/// Bezier coefficients of J, or of their changes.
struct Coefficients {
  double of[max_coefficients];
};

namespace design {

template <ElementType type, class Product>
KOKKOS_INLINE_FUNCTION Coefficients means_of(Product const& of_normals) {
  constexpr ProductTable t = product_table(type);
  Coefficients b{};
  for (int q = 0; q < t.count[1]; ++q)
    for (int r = 0; r < t.count[2]; ++r)
      of_normals(q, r, [&](int p, double value) { b.of[t.coefficient[p][q][r]] += value; });
  for (int c = 0; c < t.n_coefficients; ++c) b.of[c] *= 1.0 / t.products[c];
  return b;
}

}  // namespace design

template <ElementType type>
KOKKOS_INLINE_FUNCTION Coefficients jacobian_coefficients(JacobianFactors const& e) {
  return design::means_of<type>([&](int q, int r, auto const& add) {
    Vec3 const n = cross(e.of[1][q], e.of[2][r]);
    for (int p = 0; p < product_table(type).count[0]; ++p) add(p, dot(e.of[0][p], n));
  });
}

/// The terms of first order in f of the coefficients of e + f.
template <ElementType type>
KOKKOS_INLINE_FUNCTION Coefficients coefficient_slopes(JacobianFactors const& e, JacobianFactors const& f) {
  return design::means_of<type>([&](int q, int r, auto const& add) {
    Vec3 const n = cross(e.of[1][q], e.of[2][r]), m = cross(f.of[1][q], e.of[2][r]) + cross(e.of[1][q], f.of[2][r]);
    for (int p = 0; p < product_table(type).count[0]; ++p) add(p, dot(f.of[0][p], n) + dot(e.of[0][p], m));
  });
}

/// The terms of second order in f of the coefficients of e + f.
template <ElementType type>
KOKKOS_INLINE_FUNCTION Coefficients coefficient_bends(JacobianFactors const& e, JacobianFactors const& f) {
  return design::means_of<type>([&](int q, int r, auto const& add) {
    Vec3 const n = cross(f.of[1][q], e.of[2][r]) + cross(e.of[1][q], f.of[2][r]), m = cross(f.of[1][q], f.of[2][r]);
    for (int p = 0; p < product_table(type).count[0]; ++p) add(p, dot(f.of[0][p], n) + dot(e.of[0][p], m));
  });
}

/// Sizes of the components of the factors of each kind, the largest of the kind.
struct FactorSizes {
  Vec3 of[3];
};

/// The permanent of three vectors without negative components: no less than |det| of any vectors of these sizes.
KOKKOS_INLINE_FUNCTION double permanent(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  return a.x * (b.y * c.z + b.z * c.y) + a.y * (b.x * c.z + b.z * c.x) + a.z * (b.x * c.y + b.y * c.x);
}
/// One factor of f, two of e; two of f, one of e, ...: what a coefficient may change by where its factors are of these
/// sizes.
KOKKOS_INLINE_FUNCTION double first_order(FactorSizes const& e, FactorSizes const& f) {
  return permanent(f.of[0], e.of[1], e.of[2]) + permanent(e.of[0], f.of[1], e.of[2]) +
         permanent(e.of[0], e.of[1], f.of[2]);
}
KOKKOS_INLINE_FUNCTION double third_order(FactorSizes const& f) { return permanent(f.of[0], f.of[1], f.of[2]); }

/// A cell's own measure: the inverse of the means of its factors.
struct CellFrame {
  Vec3 row[3];
  double size = 0;  ///< J in the middle of the cell; 1 by its own measure

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 operator()(Vec3 const& v) const {
    return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
  }
};

template <ElementType type>
KOKKOS_INLINE_FUNCTION CellFrame cell_frame(JacobianFactors const& e, double sign) {
  constexpr ProductTable t = product_table(type);
  Vec3 mean[3];
  for (int kind = 0; kind < 3; ++kind) {
    for (int n = 0; n < t.count[kind]; ++n) mean[kind] += e.of[kind][n];
    mean[kind] = (1.0 / t.count[kind]) * mean[kind];
  }
  Vec3 const n[3] = {cross(mean[1], mean[2]), cross(mean[2], mean[0]), cross(mean[0], mean[1])};
  double const det = dot(mean[0], n[0]);
  return {{(1 / det) * n[0], (1 / det) * n[1], (1 / det) * n[2]}, sign * det};
}

template <ElementType type>
KOKKOS_INLINE_FUNCTION JacobianFactors in_frame(CellFrame const& frame, JacobianFactors const& f) {
  constexpr ProductTable t = product_table(type);
  JacobianFactors out;
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < t.count[kind]; ++n) out.of[kind][n] = frame(f.of[kind][n]);
  return out;
}

/// Adds the sizes of the components of f, factor by factor.
template <ElementType type>
KOKKOS_INLINE_FUNCTION void add_sizes(JacobianFactors const& f, JacobianFactors& sizes) {
  constexpr ProductTable t = product_table(type);
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < t.count[kind]; ++n) {
      Vec3 const& v = f.of[kind][n];
      sizes.of[kind][n] += {absolute(v.x), absolute(v.y), absolute(v.z)};
    }
}
/// The largest of each kind; no numbers where one of them is none, which comparisons would pass over.
template <ElementType type>
KOKKOS_INLINE_FUNCTION FactorSizes largest_sizes(JacobianFactors const& sizes) {
  constexpr ProductTable t = product_table(type);
  FactorSizes out;
  double sum = 0;
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < t.count[kind]; ++n) {
      Vec3 const& v = sizes.of[kind][n];
      out.of[kind] = {larger(out.of[kind].x, v.x), larger(out.of[kind].y, v.y), larger(out.of[kind].z, v.z)};
      sum += v.x + v.y + v.z;
    }
  for (Vec3& v : out.of) v = v + Vec3{sum - sum, sum - sum, sum - sum};
  return out;
}

/// The longest factor of each kind, and the largest coordinate.
struct CellLengths {
  double longest[3] = {0, 0, 0}, coordinate = 0;

  /// Adds those of other corners, `times` over.
  template <ElementType type>
  KOKKOS_INLINE_FUNCTION void add(JacobianFactors const& f, ElementCorners const& c, double times) {
    constexpr ProductTable t = product_table(type);
    for (int kind = 0; kind < 3; ++kind) {
      double square = 0;
      for (int n = 0; n < t.count[kind]; ++n) square = larger(square, dot(f.of[kind][n], f.of[kind][n]));
      longest[kind] += times * compat::math::sqrt(square);
    }
    coordinate += times * largest_component(c.at, n_corners(type));
  }
  /// What arithmetic may do to J; deviation: what coordinates may be wrong by besides.
  template <ElementType type>
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double margin(double deviation) const {
    double const a = is_surface(type) ? 1 : longest[0], b = longest[1], c = longest[2];
    double const of_nodes = 0x1p-46 * coordinate + 4 * deviation;
    return sign_share * a * b * c + of_nodes * ((is_surface(type) ? 0 : b * c) + a * (b + c));
  }
};

/// Which coefficients are not zero in all designs, bit by bit: those that have a product without a collapsed factor.
/// sizes, change: of the factors and of all that is added to them, by the cell's own measure.
template <ElementType type>
KOKKOS_INLINE_FUNCTION std::uint32_t live_coefficients(JacobianFactors const& sizes, JacobianFactors const& change,
                                                       double limit) {
  constexpr ProductTable t = product_table(type);
  unsigned collapsed[3] = {0, 0, 0};
  for (int kind = 0; kind < 3; ++kind)
    for (int n = 0; n < t.count[kind]; ++n) {
      Vec3 const v = sizes.of[kind][n] + limit * change.of[kind][n];
      if (v.x + v.y + v.z <= collapsed_fraction) collapsed[kind] |= 1u << n;
    }
  if ((collapsed[0] | collapsed[1] | collapsed[2]) == 0) return ~std::uint32_t(0);
  std::uint32_t live = 0;
  for (int p = 0; p < t.count[0]; ++p)
    for (int q = 0; q < t.count[1]; ++q)
      for (int r = 0; r < t.count[2]; ++r)
        if (((collapsed[0] >> p | collapsed[1] >> q | collapsed[2] >> r) & 1u) == 0)
          live |= std::uint32_t(1) << t.coefficient[p][q][r];
  return live;
}

/// The largest s <= limit with c - l s - q s^2 - t s^3 >= 0 (l, q, t >= 0), to 1e-12 and from below. Newton's method
/// from above, which cannot overshoot, as the function is concave; 0 where c is not positive or something is no number.
KOKKOS_INLINE_FUNCTION double positive_up_to(double c, double l, double q, double t, double limit) {
  if (!(c > 0)) return 0;
  auto const value = [&](double s) { return c - s * (l + s * (q + s * t)); };
  if (value(limit) >= 0) return limit;
  double s = l * limit > c ? c / l : limit;
  for (int n = 0; n < 50; ++n) {
    double const step = value(s) / (l + s * (2 * q + s * 3 * t));
    if (!(step < -1e-14 * s)) break;
    s += step;
  }
  s *= 1 - 1e-12;
  return s > 0 && value(s) >= 0 ? s : 0;
}

/// What is asked of one cell.
struct DesignQuestion {
  int n_modes = 0;
  double sign = 1;  ///< -1: numbered inside out, or of a left-handed zone
  Vec3 plane_normal;
  double limit = 1;      ///< the largest s that is of interest
  double enough = 0;     ///< a cell that norms show to be valid so far needs no more
  double deviation = 0;  ///< what coordinates may be wrong by
};

/// A lower bound of the s up to which a cell is valid, and whether it took exact slopes.
struct ScreenedCell {
  double scale = 0;
  bool exact = false;
};

/// The bound for a cell with corners x at the centre of the box; mode(i): what parameter i adds to them per unit of t.
template <ElementType type, class Mode>
KOKKOS_INLINE_FUNCTION ScreenedCell screen_design_cell(ElementCorners const& x, Mode const& mode,
                                                       DesignQuestion const& ask) {
  constexpr ProductTable t = product_table(type);
  JacobianFactors const at_centre = jacobian_factors<type>(x, ask.plane_normal);
  CellFrame const frame = cell_frame<type>(at_centre, ask.sign);
  if (!(frame.size > 0)) return {};
  JacobianFactors const e = in_frame<type>(frame, at_centre);
  CellLengths lengths;
  lengths.add<type>(at_centre, x, 1);
  JacobianFactors change;
  for (int i = 0; i < ask.n_modes; ++i) {
    ElementCorners const d = mode(i);
    JacobianFactors const f = jacobian_factors<type>(d, Vec3{});
    lengths.add<type>(f, d, ask.limit);
    add_sizes<type>(in_frame<type>(frame, f), change);
  }
  JacobianFactors own;
  add_sizes<type>(e, own);
  std::uint32_t const live = live_coefficients<type>(own, change, ask.limit);
  FactorSizes const size = largest_sizes<type>(own), most = largest_sizes<type>(change);
  double const margin = lengths.margin<type>(ask.deviation) / frame.size;
  double const second = first_order(most, size), third = third_order(most);
  Coefficients const b = jacobian_coefficients<type>(e);
  double least = unbounded;
  for (int c = 0; c < t.n_coefficients; ++c)
    if ((live >> c & 1u) != 0) least = b.of[c] >= least ? least : b.of[c];  // what is no number stays
  double const by_norms = positive_up_to(least - margin, first_order(size, most), second, third, ask.limit);
  if (by_norms >= ask.enough || !(least > margin)) return {by_norms, false};
  Coefficients slopes{};
  for (int i = 0; i < ask.n_modes; ++i) {
    JacobianFactors const f = in_frame<type>(frame, jacobian_factors<type>(mode(i), Vec3{}));
    Coefficients const g = coefficient_slopes<type>(e, f);
    for (int c = 0; c < t.n_coefficients; ++c) slopes.of[c] += absolute(g.of[c]);
  }
  double scale = ask.limit;
  for (int c = 0; c < t.n_coefficients; ++c)
    if ((live >> c & 1u) != 0) scale = positive_up_to(b.of[c] - margin, slopes.of[c], second, third, scale);
  return {larger(scale, by_norms), true};
}

/// f.operator()<type>() for a type that has a J of its own.
template <class Function>
KOKKOS_INLINE_FUNCTION auto with_element_type(ElementType type, Function const& f) {
  switch (type) {
    case ElementType::triangle: return f.template operator()<ElementType::triangle>();
    case ElementType::quadrilateral: return f.template operator()<ElementType::quadrilateral>();
    case ElementType::tetrahedron: return f.template operator()<ElementType::tetrahedron>();
    case ElementType::pyramid: return f.template operator()<ElementType::pyramid>();
    case ElementType::prism: return f.template operator()<ElementType::prism>();
    default: return f.template operator()<ElementType::hexahedron>();
  }
}

}  // namespace gridmorph::kernels
