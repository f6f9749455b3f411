// A wall about the x axis that is of revolution nowhere, by formula, and the distance from it by search: an oracle for
// clearances.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph::test {

/// Radius over angle and axial position: waves around the axis, as many as there are blades, that come and go between
/// two ends.
struct ContouredWall {
  double radius = 0.9, amplitude = 0.03;
  int waves = 12;
  double first = 0, last = 1;  ///< axial

  static constexpr double pi = 3.14159265358979323846;

  [[nodiscard]] double at(double axial, double angle) const {
    double const t = (axial - first) / (last - first);
    return radius + amplitude * std::cos(waves * angle + 0.4) * std::sin(pi * t);
  }
  [[nodiscard]] Vec3 place(double axial, double angle) const { return at_radius(axial, angle, at(axial, angle)); }
  [[nodiscard]] static Vec3 at_radius(double axial, double angle, double r) {
    return {axial, r * std::cos(angle), r * std::sin(angle)};
  }
  /// Unit, towards the axis.
  [[nodiscard]] Vec3 normal(double axial, double angle) const {
    double const h = 1e-5;
    Vec3 const n =
        cross(place(axial + h, angle) - place(axial - h, angle), place(axial, angle + h) - place(axial, angle - h));
    return (dot(n, at_radius(0, angle, 1)) < 0 ? 1 / norm(n) : -1 / norm(n)) * n;
  }
  /// Shortest distance, positive towards the axis: the nearest of a grid of places, then of finer grids about it.
  [[nodiscard]] double distance_of(Vec3 const& p) const {
    double a = p.x, theta = std::atan2(p.z, p.y), da = 0.2 * (last - first), dt = 0.5 / waves, best = 1e300;
    for (int level = 0; level < 24; ++level) {
      double const a0 = a, t0 = theta;
      constexpr int n = 8;
      for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j) {
          double const ai = std::fmin(last, std::fmax(first, a0 + i * da / n)), tj = t0 + j * dt / n;
          double const d = distance(p, place(ai, tj));
          if (d >= best) continue;
          best = d;
          a = ai;
          theta = tj;
        }
      da *= 0.5;
      dt *= 0.5;
    }
    return std::hypot(p.y, p.z) > at(p.x, std::atan2(p.z, p.y)) ? -best : best;
  }
};

}  // namespace gridmorph::test
