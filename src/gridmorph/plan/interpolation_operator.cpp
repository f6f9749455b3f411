#include <gridmorph/plan/interpolation_operator.hpp>

namespace gridmorph {

void InterpolationOperator::add(Index32 row_target, std::span<Index32 const> items, std::span<double const> weights) {
  double sum = 0;
  for (double const w : weights) sum += w;
  target.push_back(row_target);
  item.insert(item.end(), items.begin(), items.end());
  for (double const w : weights) weight.push_back(float(w / sum));
  first.push_back(Index(item.size()));
}

}  // namespace gridmorph
