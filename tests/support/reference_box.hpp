// The paper's line sweep and the transfinite correction on one box of nodes, written from the formulas with plain loops:
// the oracle for the library's kernels. Shares no code with them.
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

/// All six faces known: the sweep plus the residuals on the four sides, blended by the Boolean sum of Gordon and Hall with
/// the arc-length fractions A and B across, taken on the two end faces and varied linearly along each line. A side gives
/// its residual at the fraction of its line that the node has of its own.
template <class Weight>
BoxField reference_transfinite(BoxField const& x, BoxField const& known, Weight const& weight) {
  BoxField u = reference_sweep(x, known, weight);
  BoxField c(x.n);
  for (std::size_t m = 0; m < c.v.size(); ++m) c.v[m] = known.v[m] - u.v[m];
  int const ns = x.n[0], na = x.n[1], nb = x.n[2];
  BoxField out = u;
  for (int b = 0; b < nb; ++b)
    for (int a = 0; a < na; ++a) {
      std::vector<double> const t = fractions_along(x, 0, {0, a, b});
      double const A0 = fractions_along(x, 1, {0, 0, b})[a], A1 = fractions_along(x, 1, {ns - 1, 0, b})[a];
      double const B0 = fractions_along(x, 2, {0, a, 0})[b], B1 = fractions_along(x, 2, {ns - 1, a, 0})[b];
      for (int s = 0; s < ns; ++s) {
        double const A = (1 - t[s]) * A0 + t[s] * A1, B = (1 - t[s]) * B0 + t[s] * B1;
        auto side = [&](int at_a, int at_b) { return at_fraction(x, c, at_a, at_b, t[s]); };
        Vec3 const along_a = (1 - A) * side(0, b) + A * side(na - 1, b);
        Vec3 const along_b = (1 - B) * side(a, 0) + B * side(a, nb - 1);
        Vec3 const both = (1 - A) * (1 - B) * side(0, 0) + A * (1 - B) * side(na - 1, 0) +
                          (1 - A) * B * side(0, nb - 1) + A * B * side(na - 1, nb - 1);
        out(s, a, b) = u(s, a, b) + along_a + along_b - both;
      }
    }
  return out;
}

}  // namespace gridmorph::test
