#include <gridmorph/mapping/detail/point_clouds.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_set>

namespace gridmorph::mapping {

namespace {

/// Points of each thinned level are this much farther apart than those of the level below.
constexpr double thinning = 4;

/// The first of the points in every cell of a grid of this spacing.
std::vector<std::size_t> thinned(Level const& level, double spacing) {
  struct Hash {
    std::size_t operator()(std::array<std::int64_t, 3> const& c) const {
      std::uint64_t h = 0;
      for (auto const v : c) h = ((h ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15ull) ^ (h >> 29);
      return std::size_t(h);
    }
  };
  std::unordered_set<std::array<std::int64_t, 3>, Hash> seen;
  std::vector<std::size_t> out;
  Vec3 const origin = level.position.front();
  for (std::size_t i = 0; i < level.number.size(); ++i) {
    Vec3 const d = (1 / spacing) * (level.position[i] - origin);
    if (seen.insert({std::int64_t(std::floor(d.x)), std::int64_t(std::floor(d.y)), std::int64_t(std::floor(d.z))})
            .second)
      out.push_back(level.number[i]);
  }
  return out;
}

/// Typical distance of a point to its nearest neighbour: the median over a sample.
double typical_spacing(Level const& level) {
  std::vector<double> nearest;
  std::size_t const step = std::max<std::size_t>(1, level.number.size() / 1000);
  for (std::size_t i = 0; i < level.number.size(); i += step) {
    Vec3 const& p = level.position[i];
    double const q[3] = {p.x, p.y, p.z};
    std::array<std::size_t, 2> number{};
    std::array<double, 2> squared{};
    if (level.tree->knnSearch(q, 2, number.data(), squared.data()) == 2) nearest.push_back(std::sqrt(squared[1]));
  }
  if (nearest.empty()) return 0;
  auto const middle = nearest.begin() + std::ptrdiff_t(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

}  // namespace

std::vector<std::unique_ptr<Level>> make_levels(std::vector<Vec3> const& position, std::size_t fewest) {
  std::vector<std::unique_ptr<Level>> levels;
  std::vector<std::size_t> all(position.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  levels.push_back(std::make_unique<Level>(std::move(all), position));
  double spacing = typical_spacing(*levels.front());
  while (spacing > 0 && levels.back()->number.size() > fewest) {
    spacing *= thinning;
    levels.push_back(std::make_unique<Level>(thinned(*levels.back(), spacing), position));
  }
  return levels;
}

}  // namespace gridmorph::mapping
