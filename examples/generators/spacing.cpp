#include <generators/spacing.hpp>

#include <cmath>

namespace gridmorph::demo {

namespace {

std::vector<double> uniform(int n) {
  std::vector<double> s(n + 1);
  for (int i = 0; i <= n; ++i) s[i] = double(i) / n;
  return s;
}

/// Root of a decreasing function between lo and hi.
template <class F>
double bisect(double lo, double hi, F f) {
  for (int step = 0; step < 100; ++step) {
    double const mid = 0.5 * (lo + hi);
    (f(mid) > 0 ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

double first_of_geometric(int n, double growth) {
  // (g - 1) / (g^n - 1), written so that it holds for growth ratios next to one.
  double const log_growth = std::log(growth);
  return log_growth == 0 ? 1.0 / n : std::expm1(log_growth) / std::expm1(n * log_growth);
}

std::vector<double> geometric_spacing(int n, double first) {
  if (first * n >= 1) return uniform(n);
  double const log_growth =
      bisect(0, std::log(1 / first), [&](double g) { return first_of_geometric(n, std::exp(g)) - first; });
  std::vector<double> s(n + 1);
  for (int i = 0; i <= n; ++i) s[i] = std::expm1(i * log_growth) / std::expm1(n * log_growth);
  return s;
}

std::vector<double> tanh_spacing(int n, double first) {
  if (first * n >= 1) return uniform(n);
  auto const at = [n](double b, int i) { return 0.5 * (1 + std::tanh(b * (2.0 * i / n - 1)) / std::tanh(b)); };
  double const b = bisect(1e-6, 18, [&](double trial) { return at(trial, 1) - first; });
  std::vector<double> s(n + 1);
  for (int i = 0; i <= n; ++i) s[i] = at(b, i);
  s.front() = 0;
  s.back() = 1;
  return s;
}

std::vector<double> two_sided_spacing(int n, double first, double last) {
  double const ratio = std::sqrt(last / first), wanted = 1 / (n * std::sqrt(first * last));
  double const d = wanted <= 1 ? 0 : bisect(1e-9, 100, [&](double trial) { return wanted - std::sinh(trial) / trial; });
  std::vector<double> s(n + 1);
  for (int i = 0; i <= n; ++i) {
    double const t = double(i) / n;
    double const u = d < 1e-6 ? t : 0.5 * (1 + std::tanh(d * (t - 0.5)) / std::tanh(0.5 * d));
    s[i] = u / (ratio + (1 - ratio) * u);
  }
  s.front() = 0;
  s.back() = 1;
  return s;
}

}  // namespace gridmorph::demo
