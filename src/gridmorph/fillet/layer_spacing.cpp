#include <gridmorph/fillet/layer_spacing.hpp>

#include <cmath>

namespace gridmorph {

std::vector<double> grown_spacing(int n, double first, double length) {
  auto const total = [&](double growth) {
    double sum = 0, cell = first;
    for (int k = 0; k < n; ++k, cell *= growth) sum += cell;
    return sum;
  };
  std::vector<double> out{0.0};
  if (total(1) >= length || n < 2) {
    for (int k = 1; k <= n; ++k) out.push_back(length * k / n);
    return out;
  }
  double low = 1, high = 2;
  while (total(high) < length) high *= 2;
  for (int step = 0; step < 80; ++step) {
    double const middle = (low + high) / 2;
    (total(middle) < length ? low : high) = middle;
  }
  double cell = first;
  for (int k = 1; k < n; ++k, cell *= low) out.push_back(out.back() + cell);
  out.push_back(length);
  return out;
}

std::vector<double> mean_shares(std::vector<double> const& a, std::vector<double> const& b, double w) {
  std::vector<double> out{0.0};
  for (std::size_t n = 1; n < a.size(); ++n) out.push_back(std::pow(a[n], 1 - w) * std::pow(b[n], w));
  return out;
}

std::vector<double> stretched(std::vector<double> const& shares, double first, double length) {
  std::vector<double> out;
  double const t1 = shares[1];
  bool const fits = shares.size() > 2 && first < length;
  double const k = fits ? (first - length * t1) / (t1 * (length - first)) : 0;
  for (double t : shares) out.push_back(length * (1 + k) * t / (1 + k * t));
  return out;
}

}  // namespace gridmorph
