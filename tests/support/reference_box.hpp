// The paper's line sweep and the transfinite correction on one box of nodes, written from the formulas with plain
// loops: the oracle for the library's kernels. Shares no code with them.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace gridmorph::test {

/// n[0] x n[1] x n[2] vectors, first index fastest.
struct BoxField {
  std::array<int, 3> n;
  std::vector<Vec3> v;

  explicit BoxField(std::array<int, 3> extent) : n(extent), v(std::size_t(extent[0]) * extent[1] * extent[2]) {}
  Vec3& operator()(int s, int a, int b) { return v[s + std::size_t(n[0]) * (a + std::size_t(n[1]) * b)]; }
  Vec3 const& operator()(int s, int a, int b) const { return v[s + std::size_t(n[0]) * (a + std::size_t(n[1]) * b)]; }
};

/// Fractions of the length of a polyline; of its node count where it has no length.
inline std::vector<double> fractions(std::vector<Vec3> const& line) {
  std::vector<double> t(line.size(), 0);
  for (std::size_t p = 1; p < line.size(); ++p) {
    Vec3 const d = line[p] - line[p - 1];
    t[p] = t[p - 1] + std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
  double const length = t.back();
  for (std::size_t p = 0; p < line.size(); ++p) t[p] = length > 0 ? t[p] / length : double(p) / (line.size() - 1);
  return t;
}

inline std::vector<double> fractions_along(BoxField const& x, int axis, std::array<int, 3> at) {
  std::vector<Vec3> line;
  for (at[axis] = 0; at[axis] < x.n[axis]; ++at[axis]) line.push_back(x(at[0], at[1], at[2]));
  return fractions(line);
}

/// u between the two faces s = 0 and s = n - 1: u0 + weight(t) (u1 - u0), t by baseline arc length of each line.
template <class Weight>
BoxField reference_sweep(BoxField const& x, BoxField const& known, Weight const& weight) {
  BoxField u(x.n);
  for (int b = 0; b < x.n[2]; ++b)
    for (int a = 0; a < x.n[1]; ++a) {
      std::vector<double> const t = fractions_along(x, 0, {0, a, b});
      Vec3 const u0 = known(0, a, b), u1 = known(x.n[0] - 1, a, b);
      for (int s = 0; s < x.n[0]; ++s) u(s, a, b) = u0 + weight(t[s]) * (u1 - u0);
    }
  return u;
}

/// c along the line (a, b) of a box at fraction t of the line's length, linear between its nodes.
inline Vec3 at_fraction(BoxField const& x, BoxField const& c, int a, int b, double t) {
  std::vector<double> const here = fractions_along(x, 0, {0, a, b});
  std::size_t p = 1;
  while (p + 1 < here.size() && here[p] < t) ++p;
  double const f = (t - here[p - 1]) / (here[p] - here[p - 1]);
  return (1 - f) * c(int(p) - 1, a, b) + f * c(int(p), a, b);
}

/// All six faces known: the sweep plus the residuals on the four sides, blended by the Boolean sum of Gordon and Hall,
/// dimension by dimension: edges, then what the sides have beyond their edges. Fractions A and B across are taken on
/// the two end faces and varied linearly along each line. A side gives its residual at the fraction of its line that
/// the node has of its own.
template <class Weight>
BoxField reference_transfinite(BoxField const& x, BoxField const& known, Weight const& weight) {
  BoxField const u = reference_sweep(x, known, weight);
  BoxField c(x.n);
  for (std::size_t m = 0; m < c.v.size(); ++m) c.v[m] = known.v[m] - u.v[m];
  int const ns = x.n[0], na = x.n[1], nb = x.n[2];
  auto fraction_a = [&](int a, int b, double t) {
    return (1 - t) * fractions_along(x, 1, {0, 0, b})[a] + t * fractions_along(x, 1, {ns - 1, 0, b})[a];
  };
  auto fraction_b = [&](int a, int b, double t) {
    return (1 - t) * fractions_along(x, 2, {0, a, 0})[b] + t * fractions_along(x, 2, {ns - 1, a, 0})[b];
  };
  // Edges: c itself on the four lines along s.
  auto edge = [&](bool upper_a, bool upper_b, double t) {
    return at_fraction(x, c, upper_a ? na - 1 : 0, upper_b ? nb - 1 : 0, t);
  };
  BoxField beyond(x.n);  // on the sides: c less what the side's two edges give
  for (int b = 0; b < nb; ++b)
    for (int a = 0; a < na; ++a) {
      bool const on_a = a == 0 || a == na - 1, on_b = b == 0 || b == nb - 1;
      if (on_a == on_b) continue;
      std::vector<double> const t = fractions_along(x, 0, {0, a, b});
      for (int s = 0; s < ns; ++s) {
        double const f = on_a ? fraction_b(a, b, t[s]) : fraction_a(a, b, t[s]);
        Vec3 const lower = on_a ? edge(a > 0, false, t[s]) : edge(false, b > 0, t[s]);
        Vec3 const upper = on_a ? edge(a > 0, true, t[s]) : edge(true, b > 0, t[s]);
        beyond(s, a, b) = c(s, a, b) - (1 - f) * lower - f * upper;
      }
    }
  BoxField out = u;
  for (int b = 0; b < nb; ++b)
    for (int a = 0; a < na; ++a) {
      std::vector<double> const t = fractions_along(x, 0, {0, a, b});
      for (int s = 0; s < ns; ++s) {
        double const A = fraction_a(a, b, t[s]), B = fraction_b(a, b, t[s]);
        auto side = [&](int at_a, int at_b) { return at_fraction(x, beyond, at_a, at_b, t[s]); };
        out(s, a, b) = u(s, a, b) + (1 - A) * side(0, b) + A * side(na - 1, b) + (1 - B) * side(a, 0) +
                       B * side(a, nb - 1) + (1 - A) * (1 - B) * edge(false, false, t[s]) +
                       A * (1 - B) * edge(true, false, t[s]) + (1 - A) * B * edge(false, true, t[s]) +
                       A * B * edge(true, true, t[s]);
      }
    }
  return out;
}

}  // namespace gridmorph::test
