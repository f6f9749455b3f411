// A solver that owns its coordinates lets its mesh follow a moving wall, time step by time step.
//
// Two zones, one above the other, share an interface; the floor of the lower one is a panel that bends, the other faces
// stay. The solver keeps each zone in an array of its own, (i, j, k, 3) with a ghost layer around it. The plan is made
// once. Every step enqueues kernels on the solver's own execution space, which read and write these arrays: no
// allocation, no fence, no host decision. Needs the core library (and so Kokkos) alone.
#include <gridmorph/gridmorph.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using gridmorph::Index;
using gridmorph::Index3;
using gridmorph::Vec3;
using Exec = Kokkos::DefaultHostExecutionSpace;
using Memory = Exec::memory_space;

constexpr Index3 extent{33, 17, 25};

gridmorph::Patch face(int zone, std::string name, int axis, int side) {
  gridmorph::Patch patch{std::move(name), "BCWall", gridmorph::PatchKind::wall, {}, zone, {{0, 0, 0}, extent}};
  patch.range.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
  patch.range.end[axis] = patch.range.begin[axis] + 1;
  return patch;
}

/// Two unit boxes: zone "lower" from z = 0 to 1, zone "upper" from 1 to 2.
gridmorph::Mesh two_boxes() {
  gridmorph::Mesh mesh;
  mesh.source = "two boxes";
  for (char const* name : {"lower", "upper"}) mesh.add_zone(name, extent);
  mesh.coordinates = gridmorph::Coordinates(mesh.n_nodes());
  for (int zone = 0; zone < 2; ++zone) {
    for (int k = 0; k < extent[2]; ++k)
      for (int j = 0; j < extent[1]; ++j)
        for (int i = 0; i < extent[0]; ++i)
          mesh.coordinates.set(mesh.zones[zone].node({i, j, k}),
                               {i / (extent[0] - 1.0), j / (extent[1] - 1.0), zone + k / (extent[2] - 1.0)});
    for (int axis = 0; axis < 2; ++axis)
      for (int side = 0; side < 2; ++side) mesh.patches.push_back(face(zone, "sides", axis, side));
  }
  mesh.patches.push_back(face(0, "panel", 2, 0));
  mesh.patches.push_back(face(1, "roof", 2, 1));
  // The last k of the lower zone is the first of the upper one; i and j run alike.
  auto const [ni, nj, nk] = extent;
  mesh.interfaces.push_back(gridmorph::interface_from_ranges(mesh, "contact", 0, {{1, 1, nk}, {ni, nj, nk}}, 1,
                                                             {{1, 1, 1}, {ni, nj, 1}}, {1, 2, 3}));
  return mesh;
}

/// First bending shape of a panel that is held at its edges.
double panel_shape(Vec3 const& p) {
  double const a = std::sin(std::numbers::pi * p.x) * std::sin(std::numbers::pi * p.y);
  return a * a;
}

/// One array per zone, with a layer of ghost nodes around it.
struct Blocks {
  std::vector<Kokkos::View<double****, Kokkos::LayoutRight, Memory>> whole;
  std::vector<Kokkos::View<double****, Kokkos::LayoutStride, Memory>> inner;

  explicit Blocks(gridmorph::Mesh const& mesh) {
    for (auto const& zone : mesh.zones) {
      auto const [ni, nj, nk] = zone.extent;
      whole.emplace_back("coordinates", ni + 2, nj + 2, nk + 2, 3);
      inner.emplace_back(
          Kokkos::subview(whole.back(), std::pair(1, ni + 1), std::pair(1, nj + 1), std::pair(1, nk + 1), Kokkos::ALL));
      for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
        auto const [i, j, k] = zone.index(n);
        Vec3 const p = mesh.coordinates[n];
        inner.back()(i, j, k, 0) = p.x;
        inner.back()(i, j, k, 1) = p.y;
        inner.back()(i, j, k, 2) = p.z;
      }
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  Exec const exec;  // the solver's own instance

  // Once: topology and plan, from the mesh and from which patches move.
  gridmorph::Mesh mesh = two_boxes();
  gridmorph::Motion motion;
  motion.rules.push_back({{"panel"},
                          gridmorph::FunctionRule{"bending panel",
                                                  [](std::span<Vec3 const> points, std::span<Vec3> u) {
                                                    for (std::size_t n = 0; n < points.size(); ++n)
                                                      u[n] = {0, 0, panel_shape(points[n])};
                                                  }},
                          0,
                          "solver_loop"});
  gridmorph::PlanOptions options;
  gridmorph::BoundaryLayer near;
  near.walls = {"panel"};
  near.extent = gridmorph::BoundaryLayer::Extent::layers;
  near.layers = 4;
  options.boundary_layers = {near};
  gridmorph::MorphPlan const plan(mesh, motion, options);

  // The solver's arrays, and what the library reads and writes of them.
  Blocks const reference(mesh), current(mesh);
  gridmorph::VectorView<Memory> const x(exec, mesh, reference.inner), now(exec, mesh, current.inner);
  gridmorph::Morpher<Exec> const morpher(exec, plan, x);
  gridmorph::ValidityCheck<Exec> const validity(exec, mesh);

  // Every step: displacement of the boundary nodes in, positions of all nodes out, always from the reference mesh.
  std::vector<Vec3> const& mode = plan.boundary_displacement();
  Kokkos::View<double* [3], Memory> const boundary("boundary displacement", mode.size());
  double worst = 0;
  for (int step = 0; step <= 8; ++step) {
    double const amplitude = 0.2 * std::sin(2 * std::numbers::pi * step / 8);
    for (std::size_t n = 0; n < mode.size(); ++n) {
      boundary(n, 0) = amplitude * mode[n].x;
      boundary(n, 1) = amplitude * mode[n].y;
      boundary(n, 2) = amplitude * mode[n].z;
    }
    morpher.positions(exec, boundary, now);
    auto const cells = validity(exec, now);
    exec.fence();  // the solver would go on with its own kernels instead

    int const i = extent[0] / 2, j = extent[1] / 2;
    double const panel = current.inner[0](i, j, 0, 2);
    worst = std::max({worst, std::abs(panel - amplitude), double(cells().inverted)});
    std::printf("step %d: panel centre at %+.4f, centre of the contact at %+.4f, smallest determinant %.3f\n", step,
                panel, current.inner[1](i, j, 0, 2), cells().smallest_determinant);
  }
  return worst < 1e-15 ? 0 : 1;
}
