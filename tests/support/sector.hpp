// Sectors about an axis that may lie anywhere, of elements, with periodic sides.
#pragma once

#include "support/unstructured_case.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>

#include <cmath>
#include <functional>
#include <numbers>

namespace gridmorph::test {

/// Cells (r, theta, axial) of a sector: hexahedra, and prisms on the axis where it begins there, whose sides then meet
/// in it.
struct Sector {
  double inner = 0, outer = 1, length = 1, angle = std::numbers::pi / 6;
  Index3 cells{4, 3, 6};
  RigidTransform frame{};  ///< of (r cos theta, r sin theta, axial)
  double cone = 0;         ///< growth of the outer radius along the axis

  [[nodiscard]] Axis axis() const { return {frame(Vec3{}), frame.rotation * Vec3{0, 0, 1}}; }
  [[nodiscard]] bool meets() const { return inner == 0; }
  [[nodiscard]] double outer_at(double axial) const { return outer + cone * axial; }
  /// (r cos theta, r sin theta, axial) of a place.
  [[nodiscard]] Vec3 local(Vec3 const& x) const { return transpose(frame.rotation) * (x - frame.translation); }

  /// Patches "hub" (unless it begins on the axis), "shroud", "inlet", "outlet", "per1", "per2", the latter joined by a
  /// connection "pair".
  [[nodiscard]] Mesh mesh() const {
    Mesh mesh;
    mesh.source = "sector";
    auto const [nr, nt, nz] = cells;
    auto const node = [&](int i, int j, int k) {
      if (!meets()) return Index32((k * (nt + 1) + j) * (nr + 1) + i);
      return Index32(k * (1 + nr * (nt + 1)) + (i == 0 ? 0 : 1 + j * nr + i - 1));
    };
    mesh.add_zone("sector", Index(node(meets() ? 0 : 0, 0, nz + 1)));
    mesh.coordinates = Coordinates(mesh.n_nodes());
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= nt; ++j)
        for (int i = 0; i <= nr; ++i) {
          double const z = length * k / nz, t = angle * j / nt, r = inner + (outer_at(z) - inner) * i / nr;
          mesh.coordinates.set(node(i, j, k), frame(Vec3{r * std::cos(t), r * std::sin(t), z}));
        }
    auto const add = [&](ElementType type, std::vector<Index32> const& nodes) { mesh.add_element(type, nodes); };
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < nt; ++j)
        for (int i = 0; i < nr; ++i)
          if (i == 0 && meets())
            add(ElementType::prism, {node(0, j, k), node(1, j, k), node(1, j + 1, k), node(0, j, k + 1),
                                     node(1, j, k + 1), node(1, j + 1, k + 1)});
          else
            add(ElementType::hexahedron,
                {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1),
                 node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)});
    auto const patch = [&](char const* name, PatchKind kind) -> Patch& {
      Patch p;
      p.name = name;
      p.kind = kind;
      p.zone = 0;
      mesh.patches.push_back(std::move(p));
      return mesh.patches.back();
    };
    for (int side = 0; side < 2; ++side) {
      Patch& wall = patch(side == 0 ? "hub" : "shroud", PatchKind::wall);
      int const i = side == 0 ? 0 : nr;
      for (int k = 0; k < nz && (side == 1 || !meets()); ++k)
        for (int j = 0; j < nt; ++j)
          wall.faces.add(
              std::vector<Index32>{node(i, j, k), node(i, j + 1, k), node(i, j + 1, k + 1), node(i, j, k + 1)});
      if (side == 0 && meets()) mesh.patches.pop_back();
    }
    for (int side = 0; side < 2; ++side) {
      Patch& end = patch(side == 0 ? "inlet" : "outlet", side == 0 ? PatchKind::inflow : PatchKind::outflow);
      int const k = side == 0 ? 0 : nz;
      for (int j = 0; j < nt; ++j)
        for (int i = 0; i < nr; ++i)
          end.faces.add(i == 0 && meets() ? std::vector<Index32>{node(0, j, k), node(1, j, k), node(1, j + 1, k)}
                                          : std::vector<Index32>{node(i, j, k), node(i + 1, j, k),
                                                                 node(i + 1, j + 1, k), node(i, j + 1, k)});
    }
    for (int side = 0; side < 2; ++side) {
      Patch& periodic = patch(side == 0 ? "per1" : "per2", PatchKind::other);
      int const j = side == 0 ? 0 : nt;
      for (int k = 0; k < nz; ++k)
        for (int i = 0; i < nr; ++i)
          periodic.faces.add(
              std::vector<Index32>{node(i, j, k), node(i + 1, j, k), node(i + 1, j, k + 1), node(i, j, k + 1)});
    }
    Connection pair;
    pair.name = "pair";
    pair.zone = pair.donor_zone = 0;
    pair.periodic = periodic_rotation(axis().origin, axis().direction, angle);
    for (int k = 0; k <= nz; ++k)
      for (int i = 0; i <= nr; ++i) {
        pair.nodes.push_back(node(i, 0, k));
        pair.donor_nodes.push_back(node(i, nt, k));
      }
    mesh.connections.push_back(std::move(pair));
    return mesh;
  }

  /// A rule by a displacement in cylindrical components (r, theta, axial) of (r, theta, axial).
  [[nodiscard]] Rule by(std::function<Vec3(Vec3 const&)> const& of) const {
    return FunctionRule{"by cylindrical components", [*this, of](std::span<Vec3 const> x, std::span<Vec3> u) {
                          for (std::size_t n = 0; n < x.size(); ++n) {
                            Vec3 const p = local(x[n]);
                            double const r = std::hypot(p.x, p.y), t = std::atan2(p.y, p.x);
                            Vec3 const d = of({r, t, p.z});
                            Vec3 const to{(r + d.x) * std::cos(t + d.y), (r + d.x) * std::sin(t + d.y), p.z + d.z};
                            u[n] = frame.rotation * (to - p);
                          }
                        }};
  }

  /// Largest distance of the copies of nodes from where the connection takes them.
  [[nodiscard]] double largest_gap(Mesh const& mesh, Coordinates const& x) const {
    RigidTransform const turn = rotation_about(axis().origin, axis().direction, angle);
    double gap = 0;
    Connection const& c = mesh.connections.front();
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      gap = std::max(gap, distance(turn(x[c.nodes[n]]), x[c.donor_nodes[n]]));
    return gap;
  }
};

/// About an axis that lies askew, far from the origin.
inline RigidTransform askew() {
  RigidTransform out = rotation_about({1, 2, -3}, {0.3, -0.5, 0.8}, 0.7);
  out.translation += Vec3{2, -1, 3};
  return out;
}

}  // namespace gridmorph::test
