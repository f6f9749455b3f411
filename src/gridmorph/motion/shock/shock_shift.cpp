#include <gridmorph/motion/shock/shock_shift.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/shock/fitted_gradient.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

void ShockShift::Sheet::add(Vec3 const& p, double v, double w) {
  place.push_back(p);
  value.push_back(v);
  weight.push_back(w);
}

void ShockShift::Sheet::finish() {
  std::vector<std::array<int, 4>> facets(place.size());
  for (std::size_t n = 0; n < place.size(); ++n) facets[n] = {int(n), int(n), int(n), -1};
  boxes = FacetBoxes(place, facets);
}

namespace {

/// How much a place counts that is within a radius; 0 beyond.
double near_share(Vec3 const& place, Vec3 const& at, double radius) {
  double const s = distance(place, at) / radius;
  return s < 1 ? (1 - s * s) * (1 - s * s) : 0;
}

}  // namespace

ShockShift::Sheet::Mean ShockShift::Sheet::mean(Vec3 const& at, double radius) const {
  Mean out;
  boxes.for_each_nearer(
      at,
      [&](int n) {
        double const w = weight[n] * near_share(place[n], at, radius);
        out.weight += w;
        out.value += w * value[n];
        out.place += w * (place[n] - at);
      },
      [&] { return radius * radius; });
  if (!(out.weight > 0)) return out;
  out.value /= out.weight;
  out.place = at + (1 / out.weight) * out.place;
  return out;
}

double ShockShift::Sheet::linear(Vec3 const& at, double radius, Mean const& mean) const {
  std::vector<Vec3> offset;
  std::vector<double> rise;
  boxes.for_each_nearer(
      at,
      [&](int n) {
        double const w = std::sqrt(weight[n] * near_share(place[n], at, radius));
        if (w == 0) return;
        offset.push_back(w * (place[n] - mean.place));
        rise.push_back(w * (value[n] - mean.value));
      },
      [&] { return radius * radius; });
  constexpr double narrow = 1e-2;  // of squares: a strip ten times as long as wide says nothing about its width
  return mean.value + dot(fitted_gradient(offset, rise, narrow), at - mean.place);
}

std::size_t ShockShift::Sheet::nearest(Vec3 const& at) const {
  std::size_t best = 0;
  double best2 = std::numeric_limits<double>::infinity();
  boxes.for_each_nearer(
      at,
      [&](int n) {
        Vec3 const d = place[n] - at;
        double const d2 = dot(d, d);
        if (d2 > best2 || (d2 == best2 && std::size_t(n) > best)) return;
        best = std::size_t(n);
        best2 = d2;
      },
      [&] { return best2; });
  return best;
}

ShockShift::Sheet ShockShift::heights(std::vector<ShockPoint> const& points) const {
  Sheet out;
  for (ShockPoint const& p : points) out.add(in_plane(p.place), dot(p.place, direction_), p.weight);
  out.finish();
  return out;
}

ShockShift::ShockShift(std::vector<ShockPoint> const& from, std::vector<ShockPoint> const& to, Vec3 const& direction,
                       double radius)
    : direction_(direction), radius_(radius) {
  Sheet const before = heights(from), after = heights(to);
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < before.place.size(); ++n) {
    Vec3 const& t = before.place[n];
    Sheet::Mean const there = after.mean(t, radius);
    // Where the new shock lies to one side alone it ends, and says nothing of the old one there.
    if (!(there.weight > 0) || distance(there.place, t) > radius / 2) {
      closest = std::min(closest, distance(t, after.place[after.nearest(t)]));
      continue;
    }
    shift_.add(t, after.linear(t, radius, there) - before.linear(t, radius, before.mean(t, radius)), before.weight[n]);
  }
  if (shift_.place.empty())
    throw MotionError("seen along the direction " + to_text(direction, 4) +
                      ", the new shock does not cover the old one within " + to_text(radius, 4) + ", and is " +
                      to_text(closest, 4) +
                      " from it at best; give the direction that the shock goes along, or a larger smooth");
  shift_.finish();
  auto const [low, high] = std::minmax_element(shift_.value.begin(), shift_.value.end());
  least_ = *low;
  greatest_ = *high;
}

Vec3 ShockShift::at(Vec3 const& place) const {
  Vec3 const t = in_plane(place);
  Sheet::Mean const here = shift_.mean(t, radius_);
  if (here.weight > 0) return here.value * direction_;
  return shift_.mean(shift_.place[shift_.nearest(t)], radius_).value * direction_;
}

double extent_across(std::vector<ShockPoint> const& points, Vec3 const& direction) {
  Vec3 low, high;
  for (std::size_t n = 0; n < points.size(); ++n) {
    Vec3 const t = points[n].place - dot(points[n].place, direction) * direction;
    low = n == 0 ? t : Vec3{std::min(low.x, t.x), std::min(low.y, t.y), std::min(low.z, t.z)};
    high = n == 0 ? t : Vec3{std::max(high.x, t.x), std::max(high.y, t.y), std::max(high.z, t.z)};
  }
  return norm(high - low);
}

}  // namespace gridmorph
