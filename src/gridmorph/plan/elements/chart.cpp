#include <gridmorph/core/for_all.hpp>
#include <gridmorph/plan/elements/chart.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph {
namespace {

using Point = std::array<double, 3>;

/// Low and high end of a coordinate at the chart coordinates before it.
std::pair<double, double> ends_at(Chart::Limits const& limits, Point const& q) {
  std::array<int, 2> knot{};
  std::array<double, 2> t{};
  for (std::size_t a = 0; a < 2; ++a) {
    if (limits.over[a] < 0 || limits.knots[a] < 2) continue;
    double const s = (q[limits.over[a]] - limits.first[a]) / limits.step[a];
    knot[a] = std::clamp(int(std::floor(s)), 0, limits.knots[a] - 2);
    t[a] = std::clamp(s - knot[a], 0.0, 1.0);
  }
  auto value = [&](std::vector<double> const& table) {
    auto at = [&](int i, int j) {
      return table[std::min(knot[0] + i, limits.knots[0] - 1) +
                   limits.knots[0] * std::min(knot[1] + j, limits.knots[1] - 1)];
    };
    return (1 - t[1]) * ((1 - t[0]) * at(0, 0) + t[0] * at(1, 0)) + t[1] * ((1 - t[0]) * at(0, 1) + t[0] * at(1, 1));
  };
  return {value(limits.low), value(limits.high)};
}

/// u of the square for (x, y) in the unit disc; beyond the rim the place on it counts.
double square(double x, double y) {
  double const s = 2 + x * x - y * y, t = 2 * std::numbers::sqrt2 * x;
  return std::clamp(0.5 * (std::sqrt(std::max(0.0, s + t)) - std::sqrt(std::max(0.0, s - t))), -1.0, 1.0);
}

}  // namespace

bool Chart::is_identity() const {
  return frame == Frame::straight && std::none_of(limits.begin(), limits.end(), [](auto const& l) { return bool(l); });
}

Vec3 Chart::operator()(Vec3 const& place) const {
  Point q{place.x, place.y, place.z};
  if (frame != Frame::straight) {
    Vec3 const d = place - origin;
    double const x = dot(d, zero), y = dot(d, quarter), along = dot(d, axis);
    if (frame == Frame::cylindrical)
      q = {along, std::hypot(x, y), radius * std::atan2(y, x)};
    else
      q = {radius * square(x / radius, y / radius), radius * square(y / radius, x / radius), along};
  }
  for (int const c : order)
    if (auto const& l = limits[c]) {
      auto const [low, high] = ends_at(*l, q);
      q[c] = l->width * (q[c] - low) / (high - low);
    }
  return {q[0], q[1], q[2]};
}

Vec3 Chart::place(Vec3 const& coordinates) const {
  Point const chart{coordinates.x, coordinates.y, coordinates.z};
  Point q = chart;
  for (int const c : order)
    if (auto const& l = limits[c]) {
      auto const [low, high] = ends_at(*l, chart);
      q[c] = low + (high - low) * (chart[c] / l->width);
    }
  if (frame == Frame::straight) return {q[0], q[1], q[2]};
  if (frame == Frame::disc) {
    double const u = std::clamp(q[0] / radius, -1.0, 1.0), v = std::clamp(q[1] / radius, -1.0, 1.0);
    return origin + (radius * u * std::sqrt(1 - v * v / 2)) * zero + (radius * v * std::sqrt(1 - u * u / 2)) * quarter +
           q[2] * axis;
  }
  double const angle = q[2] / radius;
  return origin + q[0] * axis + (q[1] * std::cos(angle)) * zero + (q[1] * std::sin(angle)) * quarter;
}

Coordinates Chart::mapped(HostInstance const& host, Coordinates const& coordinates) const {
  if (is_identity()) return coordinates;
  Coordinates out(coordinates.size());
  detail::for_all(host, "gridmorph::chart", coordinates.size(), [&](Index n) { out.set(n, (*this)(coordinates[n])); });
  return out;
}

std::string Chart::name() const {
  bool const fitted = std::any_of(limits.begin(), limits.end(), [](auto const& l) { return bool(l); });
  if (frame == Frame::disc) return "disc";
  if (frame == Frame::cylindrical) return fitted ? "annular sector between surfaces" : "annular sector";
  return fitted ? "box between surfaces" : "box";
}

}  // namespace gridmorph
