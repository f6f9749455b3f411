// Surfaces with known targets.
#pragma once

#include <gridmorph/motion/boundary_motion.hpp>

#include "support/mesh_builders.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {

using Map = std::function<Vec3(Vec3 const&)>;

/// A shallow curved shell over [0, 2] x [0, 1], smooth in (a, b).
inline Vec3 shell(double a, double b) {
  return {2 * a + 0.1 * std::sin(3 * b), b + 0.05 * std::sin(4 * a), 0.25 * std::sin(2.5 * a) * std::cos(1.7 * b)};
}

/// The shell as the lower wall of two zones that meet at a = 0.4 or so; nodes are not evenly spaced.
inline Mesh shell_mesh(int ni = 13, int nj = 9) {
  MeshBuilder builder("shell");
  int const middle = 2 * ni / 5;
  auto const position = [=](int first) {
    return [=](Index3 const& p) {
      double const s = double(first + p[0]) / (ni - 1), t = double(p[1]) / (nj - 1);
      Vec3 const x = shell(s + 0.1 * s * (1 - s), t * t * (0.7 + 0.3 * t));
      return Vec3{x.x, x.y, x.z + 0.1 * p[2]};
    };
  };
  int const left = builder.zone("left", {middle + 1, nj, 3}, position(0));
  int const right = builder.zone("right", {ni - middle, nj, 3}, position(middle));
  builder.patch("wall", PatchKind::wall, left, 2, 0);
  builder.patch("wall", PatchKind::wall, right, 2, 0);
  return builder.finish();
}

/// A sharp-edged cambered section: t from 0 at the trailing edge over the upper side, 0.5 at the nose, 1 at the
/// trailing edge. Chord 1.
inline Vec3 airfoil(double t) {
  double const root = std::cos(std::numbers::pi * t), x = root * root, sign = root >= 0 ? 1 : -1;
  double const odd = 0.2969 * root;
  double const even = -0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x;
  return {x, 0.6 * (odd + sign * even) + 0.08 * x * (1 - x), 0};
}

/// A tapered wing along z, closed around i, at span h.
inline Vec3 wing(double t, double h) {
  Vec3 const p = airfoil(t);
  double const chord = 1 - 0.4 * h;
  return {0.5 * h + chord * p.x, chord * p.y, 3 * h};
}

inline Mesh wing_mesh(int ni = 61, int nj = 11) {
  MeshBuilder builder("wing");
  int const zone = builder.zone("wing", {ni, nj, 3}, [=](Index3 const& p) {
    // The last line lies on the first to the bit.
    double const s = double(p[0] % (ni - 1)) / (ni - 1), h = double(p[1]) / (nj - 1);
    Vec3 const x = wing(s, h * (0.8 + 0.2 * h)), middle = wing(0.5, h * (0.8 + 0.2 * h));
    return x + (0.2 * p[2]) * (x - middle);
  });
  builder.patch("wing", PatchKind::wall, zone, 2, 0);
  return builder.finish();
}

/// A surface of n x m points from a map of the unit square, as triangles.
inline TargetGeometry triangles_of(int n, int m, std::function<Vec3(double, double)> const& position) {
  TargetGeometry out;
  for (int b = 0; b < m; ++b)
    for (int a = 0; a < n; ++a) out.points.push_back(position(double(a) / (n - 1), double(b) / (m - 1)));
  for (int b = 0; b + 1 < m; ++b)
    for (int a = 0; a + 1 < n; ++a) {
      int const v = a + n * b;
      out.triangles.push_back({v, v + 1, v + 1 + n});
      out.triangles.push_back({v, v + 1 + n, v + n});
    }
  return out;
}

inline std::vector<Vec3> nodes_of(Mesh const& mesh, int patch) {
  std::vector<Vec3> out;
  Patch const& p = mesh.patches[patch];
  for (int k = p.range.begin[2]; k < p.range.end[2]; ++k)
    for (int j = p.range.begin[1]; j < p.range.end[1]; ++j)
      for (int i = p.range.begin[0]; i < p.range.end[0]; ++i)
        out.push_back(mesh.coordinates[mesh.zones[p.zone].node({i, j, k})]);
  return out;
}

/// The patches of a mesh as grids, moved.
inline TargetGeometry grids_of(Mesh const& mesh, Map const& map) {
  TargetGeometry out;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    TargetGrid grid{mesh.patches[p].name, {1, 1}, {}};
    for (int axis = 0, d = 0; axis < 3; ++axis)
      if (mesh.patches[p].range.extent(axis) > 1) grid.extent[d++] = mesh.patches[p].range.extent(axis);
    for (Vec3 const& x : nodes_of(mesh, p)) grid.points.push_back(map(x));
    out.grids.push_back(std::move(grid));
  }
  return out;
}

/// One rule for all patches of a mesh.
struct TargetRun {
  Mesh mesh;
  ResolvedMotion motion;
  BoundaryMotion surface;

  TargetRun(Mesh m, TargetRule rule)
      : mesh(std::move(m)), motion(resolve(mesh, motion_of(mesh, std::move(rule)))), surface(mesh, motion) {}

  static Motion motion_of(Mesh const& mesh, TargetRule rule) {
    Motion motion;
    motion.rules = {{{mesh.patches.front().families.front()}, std::move(rule), 0, "test"}};
    return motion;
  }
  [[nodiscard]] std::vector<Vec3> displacement(int patch) const {
    auto const points = nodes_of(mesh, patch);
    std::vector<Vec3> out(points.size());
    surface.displacement(0, points, out);
    return out;
  }
  /// Largest distance of the moved nodes from where `map` puts them.
  [[nodiscard]] double error(Map const& map) const {
    double worst = 0;
    for (int p = 0; p < int(mesh.patches.size()); ++p) {
      auto const points = nodes_of(mesh, p);
      auto const u = displacement(p);
      for (std::size_t n = 0; n < points.size(); ++n)
        worst = std::max(worst, distance(points[n] + u[n], map(points[n])));
    }
    return worst;
  }
  /// Whether every displacement is zero to the bit.
  [[nodiscard]] bool stands_still() const {
    for (int p = 0; p < int(mesh.patches.size()); ++p)
      for (Vec3 const& u : displacement(p))
        if (!(u == Vec3{0, 0, 0})) return false;
    return true;
  }
  [[nodiscard]] TargetReach reach() const {
    Coordinates moved(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n]);
    for (int p = 0; p < int(mesh.patches.size()); ++p) {
      Patch const& patch = mesh.patches[p];
      auto const u = displacement(p);
      std::size_t at = 0;
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i, ++at) {
            Index const n = mesh.zones[patch.zone].node({i, j, k});
            moved.set(n, mesh.coordinates[n] + u[at]);
          }
    }
    return surface.target_reach(moved).at(0);
  }
};

inline TargetRule rule_of(TargetGeometry geometry, TargetRule::Mapping mapping = TargetRule::Mapping::automatic) {
  TargetRule rule;
  rule.target = std::make_shared<TargetGeometry const>(std::move(geometry));
  rule.mapping = mapping;
  return rule;
}

inline Vec3 same_place(Vec3 const& x) { return x; }

}  // namespace gridmorph::test
