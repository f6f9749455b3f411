#include <gridmorph/geometry/point_numbers.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace gridmorph {

std::size_t PointNumbers::Hash::operator()(Key const& key) const {
  std::uint64_t h = 0;
  for (std::int64_t const v : key) h = ((h ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15ull) ^ (h >> 29);
  return std::size_t(h);
}

std::int64_t PointNumbers::cell(double v) const {
  if (!(tolerance_ > 0)) return std::bit_cast<std::int64_t>(v + 0.0);  // 0 and -0 are one
  // Beyond this cells are wider than they say, which costs time only.
  constexpr double most = 9e18;
  return std::int64_t(std::clamp(std::floor(v / (4 * tolerance_)), -most, most));
}

int PointNumbers::find(Vec3 const& p) const {
  int best = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for_each_near(p, [&](Vec3 const& point, int number) {
    if (double const d = distance(p, point); d <= tolerance_ && d < nearest) {
      nearest = d;
      best = number;
    }
  });
  return best;
}

void PointNumbers::add(Vec3 const& p, int number) { cells_[{cell(p.x), cell(p.y), cell(p.z)}].push_back({p, number}); }

int PointNumbers::find_or_add(Vec3 const& p, int fresh) {
  int const known = find(p);
  if (known < 0) add(p, fresh);
  return known < 0 ? fresh : known;
}

}  // namespace gridmorph
