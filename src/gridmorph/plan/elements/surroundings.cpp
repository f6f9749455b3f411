#include <gridmorph/core/for_all.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace gridmorph {

namespace {

/// Even beside the body, then growing: places from the centre, one side of it and mirrored on the other.
std::vector<double> planes_around(double size) {
  constexpr double even_step = 0.05, even = 2.5, growth = 1.5;  // in sizes of the body
  std::vector<double> side{0};
  for (double place = 0, step = even_step; place < Surroundings::reach;) {
    place += step;
    side.push_back(place * size);
    if (place > even) step *= growth;
  }
  std::vector<double> out;
  for (std::size_t n = side.size() - 1; n > 0; --n) out.push_back(-side[n]);
  out.insert(out.end(), side.begin(), side.end());
  return out;
}

/// The interval of ascending places that holds x, and where in it, 0 to 1.
std::pair<std::size_t, double> interval(std::vector<double> const& at, double x) {
  auto const above = std::upper_bound(at.begin() + 1, at.end() - 1, x);
  auto const k = std::size_t(above - at.begin()) - 1;
  return {k, std::clamp((x - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0)};
}

}  // namespace

std::vector<Surroundings::Source> Surroundings::sources(std::vector<SeenPiece> const& wall) const {
  constexpr double finest = 0.05, share_of_way = 0.15;    // of the body's size, of the distance from its centre
  std::map<std::array<std::int64_t, 3>, double> lengths;  // level, place: the same order however edges are numbered
  for (auto const& [centre, length] : wall) {
    Vec3 const d = centre - plane_.centre;
    double const du = dot(d, plane_.u), dv = dot(d, plane_.v);
    double const steps = std::max(0.0, std::log2(share_of_way * std::hypot(du, dv) / (finest * size_)));
    auto const level = std::int64_t(std::floor(steps));
    for (std::int64_t const upper : {0, 1}) {
      double const spacing = finest * size_ * std::ldexp(1.0, int(level + upper)), t = steps - double(level);
      double const u = du / spacing, v = dv / spacing;
      auto const i = std::int64_t(std::floor(u)), j = std::int64_t(std::floor(v));
      for (int corner = 0; corner < 4; ++corner) {
        int const p = corner & 1, q = corner >> 1;
        double const of_u = p == 1 ? u - double(i) : 1 - (u - double(i)),
                     of_v = q == 1 ? v - double(j) : 1 - (v - double(j));
        double const part = (upper == 1 ? t : 1 - t) * of_u * of_v;
        if (part > 0) lengths[{level + upper, i + p, j + q}] += part * length;
      }
    }
  }
  std::vector<Source> out;
  for (auto const& [key, length] : lengths) {
    double const spacing = finest * size_ * std::ldexp(1.0, int(key[0]));
    Vec3 const at = spacing * double(key[1]) * plane_.u + spacing * double(key[2]) * plane_.v;
    out.push_back({plane_.centre + at, length, spacing});
  }
  return out;
}

Surroundings::Surroundings(HostInstance const& host, SightPlane const& plane,
                           std::span<std::vector<SeenPiece> const> walls, std::span<FacetDistance const> from,
                           double size)
    : plane_(plane), size_(size), planes_(planes_around(size)), n_walls_(walls.size()) {
  std::vector<std::vector<Source>> all;
  for (auto const& wall : walls) all.push_back(sources(wall));
  std::size_t const n = planes_.size();
  seen_.assign(n * n * n_walls_, 0);
  detail::for_all_parts(host, "gridmorph::surroundings", Index(n), [&](Index j) {
    std::vector<int> start(n_walls_, 0);
    for (std::size_t i = 0; i < n; ++i) {
      Vec3 const p = plane_.centre + (planes_[i] * plane_.u + planes_[j] * plane_.v);
      for (std::size_t s = 0; s < n_walls_; ++s) {
        double closeness = 0, softened = 0;
        for (Source const& source : all[s]) {
          Vec3 const d = source.at - p;
          double const c = source.length / (dot(d, d) + source.softening * source.softening);
          closeness += c;
          softened += c * source.softening;
        }
        if (!(closeness > 0)) continue;
        double const way = std::hypot(from[s](p, start[s]), softened / closeness);
        seen_[(std::size_t(j) * n + i) * n_walls_ + s] = closeness * way / std::numbers::pi;
      }
    }
  });
}

void Surroundings::add(Vec3 const& p, double factor, std::span<double> seen) const {
  Vec3 const d = p - plane_.centre;
  std::size_t const n = planes_.size();
  auto const [i, u] = interval(planes_, dot(d, plane_.u));
  auto const [j, v] = interval(planes_, dot(d, plane_.v));
  for (std::size_t corner = 0; corner < 4; ++corner) {
    std::size_t const a = corner & 1, b = corner >> 1;
    double const weight = factor * (a == 1 ? u : 1 - u) * (b == 1 ? v : 1 - v);
    double const* const at = seen_.data() + ((i + a) + n * (j + b)) * n_walls_;
    for (std::size_t s = 0; s < n_walls_; ++s) seen[s] += weight * at[s];
  }
}

}  // namespace gridmorph
