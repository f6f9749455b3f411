#include <gridmorph/fillet/wall_path.hpp>

#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

double angle_between(Vec3 const& a, Vec3 const& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// A normal with the sign that points into the mesh.
Vec3 inward(Vec3 const& normal, Vec3 const& into_mesh) { return dot(normal, into_mesh) < 0 ? -normal : normal; }

}  // namespace

Vec3 Ball::to_arc(int wall, double share) const {
  double const whole = half_angle_rad, angle = share * whole;
  if (whole < 1e-9) return to_middle;
  return (1 / std::sin(whole)) * (std::sin(whole - angle) * to_middle + std::sin(angle) * to_contact[wall]);
}

double nearest_arc(ArcCurve const& line, Vec3 const& p) {
  double s = std::min(distance(p, line.point(0)), line.length());
  for (int step = 0; step < 40; ++step) {
    Vec3 const tangent = line.tangent(s);
    double const way = dot(p - line.at(s), tangent) / dot(tangent, tangent);
    s = std::max(0.0, s + way);
    if (std::abs(way) <= 1e-14 * line.length()) break;
  }
  return s;
}

std::optional<Ball> rolling_ball(CornerWalls const& walls, double radius) {
  ArcCurve const& blade = *walls.blade_line;
  auto const centre = [&](double s) {
    Vec3 const on_blade = blade.at(s);
    Vec3 const normal = walls.surface[0]->closest_point(on_blade).normal;
    return on_blade + radius * inward(normal, walls.into_mesh[0]);
  };
  auto const gap = [&](double s) {
    Vec3 const c = centre(s);
    kernels::FacetFoot const foot = walls.surface[1]->closest_point(c);
    return dot(c - foot.point, inward(foot.normal, walls.into_mesh[1])) - radius;
  };
  double low = 0, high = 0;
  for (double const step = radius / 16; gap(high) < 0; high += step) {
    if (high > blade.length()) return {};
    low = high;
  }
  for (int step = 0; step < 60 && high - low > 1e-15 * blade.length(); ++step) {
    double const middle = (low + high) / 2;
    (gap(middle) < 0 ? low : high) = middle;
  }

  Ball ball;
  ball.radius = radius;
  ball.centre = centre(high);
  kernels::FacetFoot const foot = walls.surface[1]->closest_point(ball.centre);
  ball.to_contact = {unit(blade.at(high) - ball.centre), unit(foot.point - ball.centre)};
  ball.to_middle = unit(ball.to_contact[0] + ball.to_contact[1]);
  ball.half_angle_rad = angle_between(ball.to_contact[0], ball.to_contact[1]) / 2;
  ball.blade_arc = high;
  return ball;
}

}  // namespace gridmorph
