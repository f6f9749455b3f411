#include <gridmorph/plan/elements/background.hpp>

namespace gridmorph::detail {

std::vector<double> growing(double length, double first, double growth) {
  constexpr int most = 64;
  std::vector<double> at{0};
  for (double step = first; at.back() < length && int(at.size()) <= most; step *= growth)
    at.push_back(at.back() + step);
  if (at.size() < 2) at.push_back(length);
  double const scale = length / at.back();
  for (double& place : at) place *= scale;
  at.back() = length;
  return at;
}

}  // namespace gridmorph::detail
