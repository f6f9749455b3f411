// A corner between two plane walls, and what is asked for in it.
#pragma once

#include "support/mesh_builders.hpp"

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/fillet/fillet.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {

/// Cells that grow from a wall on.
inline double grown(int n, int cells, double growth) {
  return (std::pow(growth, n) - 1) / (std::pow(growth, cells) - 1);
}

struct Wedge {
  double angle_rad = std::numbers::pi / 2;
  double lean = 0;  ///< of the grid lines on the hub, along the corner
  Index3 extent{7, 25, 25};
  std::array<double, 2> growth{1.15, 1.15};  ///< off the blade, off the hub
};

/// Two plane walls, "blade" and "hub", that meet along z: 1.2 along the corner, 1 along either wall.
inline Mesh wedge(Wedge const& w) {
  MeshBuilder builder("wedge");
  builder.zone("wedge", w.extent, [&](Index3 const& p) {
    double const along = 1.2 * p[0] / (w.extent[0] - 1), off_blade = grown(p[1], w.extent[1] - 1, w.growth[0]),
                 off_hub = grown(p[2], w.extent[2] - 1, w.growth[1]);
    return Vec3{off_blade + off_hub * std::cos(w.angle_rad), off_hub * std::sin(w.angle_rad),
                along + w.lean * off_blade};
  });
  builder.patch("blade", PatchKind::wall, 0, 1, 0);
  builder.patch("hub", PatchKind::wall, 0, 2, 0);
  builder.patch("far", PatchKind::farfield, 0, 1, 1);
  builder.patch("far", PatchKind::farfield, 0, 2, 1);
  builder.patch("side", PatchKind::symmetry, 0, 0, 0);
  builder.patch("side", PatchKind::symmetry, 0, 0, 1);
  return builder.finish();
}

inline FilletOptions between(Mesh const& mesh, std::vector<std::string> const& blade,
                             std::vector<std::string> const& wall, double radius) {
  FilletOptions options;
  options.blade = select_patches(mesh, blade);
  options.end_wall = select_patches(mesh, wall);
  options.radius = [radius](Vec3 const&) { return radius; };
  return options;
}

/// Whether p is on one of the walls of a wedge, or on the circle that touches both.
inline bool on_filled_wedge(Vec3 const& p, double angle_rad, double radius, double tolerance) {
  double const contact = radius / std::tan(angle_rad / 2);
  Vec3 const blade{std::cos(angle_rad), std::sin(angle_rad), 0}, q{p.x, p.y, 0};
  Vec3 const centre = radius / std::sin(angle_rad / 2) * Vec3{std::cos(angle_rad / 2), std::sin(angle_rad / 2), 0};
  double const on_blade = dot(q, blade), off_blade = norm(q - on_blade * blade);
  return (p.x >= contact - tolerance && std::abs(p.y) < 1e-9) ||
         (on_blade >= contact - tolerance && off_blade < 1e-9) ||
         std::abs(distance(q, centre) - radius) < tolerance * radius;
}

}  // namespace gridmorph::test
