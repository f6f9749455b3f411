// A solver that owns its coordinates lets its mesh follow a moving wall, time step by time step.
//
// Two zones, one above the other, share an interface; the floor of the lower one is a panel that bends, the other faces
// stay. The solver keeps each zone in an array of its own, (i, j, k, 3) with a ghost layer around it. The plan is made
// once. Every step enqueues kernels on the solver's own execution space, a GPU's where Kokkos has one, which read and
// write these arrays: no allocation, no fence, no host decision. Needs the core library (and so Kokkos) alone.
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
using Exec = Kokkos::DefaultExecutionSpace;
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

/// One array per zone, with a layer of ghost nodes around it, in the memory of Exec.
struct Blocks {
  std::vector<Kokkos::View<double****, Kokkos::LayoutRight, Memory>> whole;
  std::vector<Kokkos::View<double****, Kokkos::LayoutStride, Memory>> inner;

  explicit Blocks(gridmorph::Mesh const& mesh) {
    for (auto const& zone : mesh.zones) {
      auto const [ni, nj, nk] = zone.extent;
      whole.emplace_back("coordinates", ni + 2, nj + 2, nk + 2, 3);
      inner.emplace_back(
          Kokkos::subview(whole.back(), std::pair(1, ni + 1), std::pair(1, nj + 1), std::pair(1, nk + 1), Kokkos::ALL));
      auto const host = Kokkos::create_mirror_view(whole.back());
      for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
        auto const [i, j, k] = zone.index(n);
        Vec3 const p = mesh.coordinates[n];
        host(i + 1, j + 1, k + 1, 0) = p.x;
        host(i + 1, j + 1, k + 1, 1) = p.y;
        host(i + 1, j + 1, k + 1, 2) = p.z;
      }
      Kokkos::deep_copy(whole.back(), host);
    }
  }
  /// z of a node, for what is printed.
  [[nodiscard]] double z(std::size_t zone, int i, int j, int k) const {
    auto const host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), whole[zone]);
    return host(i + 1, j + 1, k + 1, 2);
  }
};

/// Writes amplitude times `mode` into the displacement of the boundary.
void deflect(Exec const& exec, double amplitude, Kokkos::View<Vec3 const*, Memory> const& mode,
             Kokkos::View<double* [3], Memory> const& boundary) {
  Kokkos::parallel_for(
      "deflect", Kokkos::RangePolicy<Exec>(exec, 0, Index(mode.extent(0))), KOKKOS_LAMBDA(Index n) {
        boundary(n, 0) = amplitude * mode(n).x;
        boundary(n, 1) = amplitude * mode(n).y;
        boundary(n, 2) = amplitude * mode(n).z;
      });
}

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
  std::vector<Vec3> const& shape = plan.boundary_displacement();
  auto const mode = Kokkos::create_mirror_view_and_copy(
      Memory(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(shape.data(), shape.size()));
  Kokkos::View<double* [3], Memory> const boundary("boundary displacement", shape.size());
  double worst = 0;
  for (int step = 0; step <= 8; ++step) {
    double const amplitude = 0.2 * std::sin(2 * std::numbers::pi * step / 8);
    deflect(exec, amplitude, mode, boundary);
    morpher.positions(exec, boundary, now);
    auto const cells = validity(exec, now);
    exec.fence();  // the solver would go on with its own kernels instead

    int const i = extent[0] / 2, j = extent[1] / 2;
    double const panel = current.z(0, i, j, 0);
    auto const found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), cells)();
    worst = std::max({worst, std::abs(panel - amplitude), double(found.inverted)});
    std::printf("step %d: panel centre at %+.4f, centre of the contact at %+.4f, smallest determinant %.3f\n", step,
                panel, current.z(1, i, j, 0), found.smallest_determinant);
  }
  return worst < 1e-15 ? 0 : 1;
}
