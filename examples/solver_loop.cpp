// A solver that owns its coordinates lets its mesh follow a moving wall, time step by time step.
//
// Two zones, one above the other, share an interface; the floor of the lower one is a panel that bends, the other faces
// stay. The plan is made once. Every step enqueues kernels on the solver's own execution space: no allocation, no fence,
// no host decision. Needs the core library (and so Kokkos) alone.
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

using gridmorph::Index;
using gridmorph::Index3;
using gridmorph::Vec3;

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
  gridmorph::Interface1to1 contact;
  contact.name = "contact";
  contact.zone = 0;
  contact.donor_zone = 1;
  contact.range = face(0, "", 2, 1).range;
  contact.to_donor = {{}, contact.range.begin, {0, 0, 0}};
  mesh.interfaces.push_back(contact);
  return mesh;
}

/// First bending shape of a panel that is held at its edges.
double panel_shape(Vec3 const& p) {
  double const a = std::sin(std::numbers::pi * p.x) * std::sin(std::numbers::pi * p.y);
  return a * a;
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  using Exec = Kokkos::DefaultHostExecutionSpace;
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
  gridmorph::PreparedMorph const prepared = gridmorph::prepare(mesh, motion, options);

  // Every step: displacement of the boundary nodes in, positions of all nodes out, always from the reference mesh.
  auto const& nodes = prepared.plan().boundary_nodes;
  Kokkos::View<Vec3*, Exec::memory_space> const boundary("boundary displacement", nodes.size());
  gridmorph::Coordinates const& x = mesh.coordinates;
  gridmorph::Coordinates const now(mesh.n_nodes());
  gridmorph::Morpher<Exec> const morpher(exec, prepared.plan(), x);
  std::vector<Vec3> const mode = prepared.boundary_displacement(mesh);
  double worst = 0;
  for (int step = 0; step <= 8; ++step) {
    double const amplitude = 0.2 * std::sin(2 * std::numbers::pi * step / 8);
    for (std::size_t n = 0; n < nodes.size(); ++n) boundary(n) = amplitude * mode[n];
    morpher.positions(exec, boundary, now);
    exec.fence();  // the solver would go on with its own kernels instead

    Index const middle = mesh.zones[0].node({extent[0] / 2, extent[1] / 2, 0});
    worst = std::max(worst, std::abs(now.z(middle) - amplitude));
    std::printf("step %d: panel centre at %+.4f, centre of the contact at %+.4f\n", step, now.z(middle),
                now.z(mesh.zones[1].node({extent[0] / 2, extent[1] / 2, 0})));
  }
  return worst < 1e-15 ? 0 : 1;
}
