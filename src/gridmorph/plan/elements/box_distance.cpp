#include <gridmorph/plan/elements/wrap_cells.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::detail {
namespace {

using Point = std::array<double, 3>;

/// Whether a triangle about the box's centre and the box of half extents `half` are apart along an axis.
bool apart(std::array<Point, 3> const& t, Point const& half, Point const& axis) {
  double const reach = half[0] * std::abs(axis[0]) + half[1] * std::abs(axis[1]) + half[2] * std::abs(axis[2]);
  if (!(reach > 0)) return false;  // edges of no length, parallel edges
  double low = 1e300, high = -1e300;
  for (Point const& p : t) {
    double const s = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
    low = std::min(low, s);
    high = std::max(high, s);
  }
  return low >= reach || high <= -reach;
}

Point cross(Point const& a, Point const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool triangle_meets_box(std::array<Point, 3> const& t, Point const& half) {
  std::array<Point, 3> const axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (Point const& axis : axes)
    if (apart(t, half, axis)) return false;
  std::array<Point, 3> edge{};
  for (std::size_t n = 0; n < 3; ++n)
    for (std::size_t a = 0; a < 3; ++a) edge[n][a] = t[(n + 1) % 3][a] - t[n][a];
  if (apart(t, half, cross(edge[0], edge[1]))) return false;
  for (Point const& e : edge)
    for (Point const& axis : axes)
      if (apart(t, half, cross(axis, e))) return false;
  return true;
}

}  // namespace

bool polygon_meets_box(std::span<std::array<double, 3> const> corners, LatticeBox const& box,
                       std::array<double, 3> const& offset) {
  Point half{}, centre{};
  for (std::size_t a = 0; a < 3; ++a) {
    centre[a] = 0.5 * (box.low[a] + box.high[a]);
    half[a] = 0.5 * (box.high[a] - box.low[a]) + offset[a];
  }
  auto about_centre = [&](Point const& p) { return Point{p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]}; };
  std::size_t const last = corners.size() - 1;
  for (std::size_t n = 1; n < std::max<std::size_t>(last, 2); ++n)
    if (triangle_meets_box({about_centre(corners[0]), about_centre(corners[std::min(n, last)]),
                            about_centre(corners[std::min(n + 1, last)])},
                           half))
      return true;
  return false;
}

}  // namespace gridmorph::detail
