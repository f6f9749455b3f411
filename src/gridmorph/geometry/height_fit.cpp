#include <gridmorph/geometry/plane_fit.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace gridmorph {
namespace {

constexpr int most_terms = 9;

/// Solves the least-squares problem columns * c = rhs by modified Gram-Schmidt; false when a column depends on others.
bool least_squares(std::vector<std::array<double, most_terms + 1>>& rows, int n, std::array<double, most_terms>& c) {
  std::array<std::array<double, most_terms + 1>, most_terms> r{};
  for (int j = 0; j < n; ++j) {
    double before = 0, after = 0;
    for (auto const& row : rows) after += row[j] * row[j];
    for (int k = 0; k < j; ++k) before += r[k][j] * r[k][j];
    double const length = std::sqrt(after);
    if (!(length > 0.03 * std::sqrt(before + after))) return false;  // as where points lie on three lines
    r[j][j] = length;
    for (auto& row : rows) row[j] /= length;
    for (int k = j + 1; k <= n; ++k) {
      double sum = 0;
      for (auto const& row : rows) sum += row[j] * row[k];
      r[j][k] = sum;
      for (auto& row : rows) row[k] -= sum * row[j];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    double sum = r[j][n];
    for (int k = j + 1; k < n; ++k) sum -= r[j][k] * c[k];
    c[j] = sum / r[j][j];
  }
  return true;
}

std::optional<Vec3> once(Vec3 const& centre, Vec3 const& normal, std::span<Vec3 const> around, int terms) {
  Vec3 const trial = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 e1 = cross(normal, trial);
  e1 = (1 / norm(e1)) * e1;
  Vec3 const e2 = cross(normal, e1);
  // Cholesky factor of the covariance: coordinates (x - l21 ...) / l11 are isotropic however stretched the facets are.
  double xx = 0, xy = 0, yy = 0;
  for (Vec3 const& p : around) {
    double const x = dot(p - centre, e1), y = dot(p - centre, e2);
    xx += x * x / double(around.size());
    xy += x * y / double(around.size());
    yy += y * y / double(around.size());
  }
  double const l11 = std::sqrt(xx), l21 = l11 > 0 ? xy / l11 : 0, rest = yy - l21 * l21;
  if (!(l11 > 0) || !(rest > 1e-18 * yy)) return std::nullopt;
  double const l22 = std::sqrt(rest);

  std::vector<std::array<double, most_terms + 1>> rows;
  for (Vec3 const& p : around) {
    Vec3 const d = p - centre;
    double const a = dot(d, e1) / l11, b = (dot(d, e2) - l21 * a) / l22, far = std::sqrt(a * a + b * b);
    if (far == 0) continue;
    double const w = 1 / far;
    std::array<double, most_terms + 1> row{};
    double const monomials[most_terms] = {a, b, a * a, a * b, b * b, a * a * a, a * a * b, a * b * b, b * b * b};
    for (int k = 0; k < terms; ++k) row[k] = w * monomials[k];
    row[terms] = w * dot(d, normal);
    rows.push_back(row);
  }
  std::array<double, most_terms> c{};
  if (int(rows.size()) < terms || !least_squares(rows, terms, c)) return std::nullopt;
  // Gradient in x, y: the transposed inverse of the factor.
  double const g2 = c[1] / l22, g1 = (c[0] - l21 * g2) / l11;
  Vec3 const n = normal - g1 * e1 - g2 * e2;
  return (1 / norm(n)) * n;
}

}  // namespace

std::optional<Vec3> fit_normal(Vec3 const& centre, Vec3 const& normal, std::span<Vec3 const> around) {
  for (auto const& [terms, least] : {std::array{9, 12}, std::array{5, 6}}) {
    if (int(around.size()) < least) continue;
    auto fitted = once(centre, normal, around, terms);
    if (!fitted) continue;
    // Again over the better plane: heights are smaller there.
    auto const better = once(centre, *fitted, around, terms);
    return better ? better : fitted;
  }
  return std::nullopt;
}

}  // namespace gridmorph
