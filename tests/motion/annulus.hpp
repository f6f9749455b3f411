// Surface meshes of a blade row in a curved annulus, made from formulas that the tests use as their oracle.
//
// Everything is a function of the meridional position (axial x, span fraction h); the blade is twisted, leaned, swept
// and cambered. Surfaces are single faces of zones two nodes thick, oriented and cut as a test asks.
#pragma once

#include <gridmorph/motion/rigid_motion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {

constexpr double pitch = 0.3;

inline double hub(double x) { return 1 + 0.05 * std::sin(2 * x); }
inline double shroud(double x) { return 1.5 - 0.04 * x * x; }
inline double radius(double x, double h) { return hub(x) + h * (shroud(x) - hub(x)); }
inline double span_of(double x, double r) { return (r - hub(x)) / (shroud(x) - hub(x)); }

inline double leading(double h) { return 0.1 * h * (1 - h); }  // sweep
inline double chord(double h) { return 0.5 - 0.1 * h; }
inline double trailing(double h) { return leading(h) + chord(h); }
inline double camber(double c, double h) { return 0.1 * h * h + (0.3 + 0.2 * h) * c * c; }  // lean, twist, camber
inline double inlet(double h) { return -0.6 + 0.05 * h * h; }
constexpr double outlet = 1.1;

inline Vec3 cylindrical(double x, double r, double theta) { return {x, r * std::cos(theta), r * std::sin(theta)}; }
inline double angle_of(Vec3 const& p) { return std::atan2(p.z, p.y); }
inline double radius_of(Vec3 const& p) { return std::hypot(p.y, p.z); }

/// Motion of the mid-camber surface, and what its two sides do differently.
struct BladeMotion {
  std::function<double(double c, double h)> axial = [](double, double) { return 0.0; };
  std::function<double(double c, double h)> angle = [](double, double) { return 0.0; };
  double difference = 0;  ///< of the angle between the sides, zero at both edges
};

/// Position of a point given relative to the blade; phi in [0, 2 pi) goes around, chord fraction (1 - cos phi) / 2.
inline Vec3 blade_point(double phi, double h, double shift = 0) {
  double const c = 0.5 * (1 - std::cos(phi)), x = leading(h) + c * chord(h);
  return cylindrical(x, radius(x, h), camber(c, h) + 0.03 * std::sin(phi) + shift);
}

/// The rule that moves blade nodes by the motion: exact, span fraction kept.
inline FunctionRule blade_rule(BladeMotion const& motion) {
  return {"test blade", [motion](std::span<Vec3 const> points, std::span<Vec3> out) {
            for (std::size_t n = 0; n < points.size(); ++n) {
              Vec3 const p = points[n];
              double const h = span_of(p.x, radius_of(p)), c = (p.x - leading(h)) / chord(h);
              double const off = std::remainder(angle_of(p) - camber(c, h), pitch) / 0.03;  // sin(phi) of its side
              double const x = p.x + motion.axial(c, h);
              double const theta = angle_of(p) + motion.angle(c, h) + motion.difference * off;
              out[n] = cylindrical(x, radius(x, h), theta) - p;
            }
          }};
}

/// A structured surface: n[0] x n[1] points from parameters in [0, 1]^2.
struct Surface {
  std::string name;
  PatchKind kind;
  std::array<int, 2> n;
  std::function<Vec3(double s, double t)> at;
  std::vector<std::string> families;
};

/// How a surface is stored: cut into pieces along s and t, each a zone of its own, indices turned around.
struct Storage {
  std::vector<int> cuts_s, cuts_t;  ///< node numbers where pieces meet
  int orientation = 0;              ///< bit 0: swap, bit 1 and 2: reverse, counted up from piece to piece
  int step = 0;                     ///< added to the orientation from piece to piece
};

class RowMesh {
 public:
  void add(Surface const& surface, Storage const& storage = {}) {
    std::array<std::vector<int>, 2> limits;
    for (int d = 0; d < 2; ++d) {
      limits[d] = {0};
      auto const& cuts = d == 0 ? storage.cuts_s : storage.cuts_t;
      limits[d].insert(limits[d].end(), cuts.begin(), cuts.end());
      limits[d].push_back(surface.n[d] - 1);
    }
    int orientation = storage.orientation;
    for (std::size_t a = 0; a + 1 < limits[0].size(); ++a)
      for (std::size_t b = 0; b + 1 < limits[1].size(); ++b, orientation += storage.step)
        add_piece(surface, {limits[0][a], limits[1][b]}, {limits[0][a + 1], limits[1][b + 1]}, orientation);
  }

  /// All zones belong to one row: joined in a row of plain interfaces (only zone numbers matter to the motion).
  Mesh finish(RigidTransform const& placed = {}) {
    for (std::size_t z = 1; z < mesh_.zones.size(); ++z) {
      Interface1to1 link;
      link.name = "link";
      link.zone = int(z);
      link.donor_zone = int(z) - 1;
      link.range = {{0, 0, 1}, {1, 1, 2}};
      mesh_.interfaces.push_back(link);
    }
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    for (Index n = 0; n < mesh_.n_nodes(); ++n) mesh_.coordinates.set(n, placed(points_[n]));
    return mesh_;
  }

 private:
  void add_piece(Surface const& surface, std::array<int, 2> lo, std::array<int, 2> hi, int orientation) {
    bool const swap = orientation & 1;
    std::array<int, 2> const count{hi[0] - lo[0] + 1, hi[1] - lo[1] + 1};
    std::array<int, 2> const stored = swap ? std::array<int, 2>{count[1], count[0]} : count;
    int const zone = mesh_.add_zone("zone" + std::to_string(mesh_.zones.size()), {stored[0], stored[1], 2});
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < stored[1]; ++j)
        for (int i = 0; i < stored[0]; ++i) {
          int s = swap ? j : i, t = swap ? i : j;
          if (orientation & 2) s = count[0] - 1 - s;
          if (orientation & 4) t = count[1] - 1 - t;
          Vec3 p = surface.at(double(lo[0] + s) / (surface.n[0] - 1), double(lo[1] + t) / (surface.n[1] - 1));
          if (k == 1) p = p + 1e-3 * Vec3{0, p.y, p.z};
          points_.push_back(p);
        }
    mesh_.patches.push_back(
        {surface.name, "", surface.kind, surface.families, zone, {{0, 0, 0}, {stored[0], stored[1], 1}}});
  }

  Mesh mesh_;
  std::vector<Vec3> points_;
};

/// O mesh around the blade: one closed surface whose ends meet at phi = start.
inline Surface o_blade(int around, int spanwise, double start = 0) {
  return {"blade",
          PatchKind::wall,
          {around, spanwise},
          [=](double s, double t) {
            double const turn = s == 1 ? 0 : s;  // the last line is the first, bit for bit
            return blade_point(start + 2 * std::numbers::pi * turn, t);
          },
          {}};
}

/// H mesh: one side only, the other side one pitch away.
inline Surface h_side(bool suction, int along, int spanwise) {
  return {"blade",
          PatchKind::wall,
          {along, spanwise},
          [=](double s, double t) {
            double const phi = std::numbers::pi * s;
            return blade_point(suction ? phi : -phi, t, suction ? 0 : pitch);
          },
          {}};
}

inline Surface end_wall(std::string name, double h, int along, int around) {
  return {std::move(name),
          PatchKind::wall,
          {along, around},
          [=](double s, double t) {
            double const x = inlet(h) + s * (outlet - inlet(h));
            return cylindrical(x, radius(x, h), 0.2 * x + pitch * t);
          },
          {}};
}

inline Surface inlet_plane(int spanwise, int around) {
  return {"inlet",
          PatchKind::inflow,
          {spanwise, around},
          [](double s, double t) { return cylindrical(inlet(s), radius(inlet(s), s), 0.2 * inlet(s) + pitch * t); },
          {}};
}

inline Surface outlet_plane(int spanwise, int around) {
  return {"outlet",
          PatchKind::outflow,
          {spanwise, around},
          [](double s, double t) { return cylindrical(outlet, radius(outlet, s), 0.2 * outlet + pitch * t); },
          {}};
}

}  // namespace gridmorph::test
