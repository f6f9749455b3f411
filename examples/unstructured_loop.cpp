// A solver with an unstructured mesh: a body heaves in a box, the mesh follows time step by time step.
//
// Elements, boundary faces and coordinates are handed over as lists, the plan is made once, and every step enqueues
// kernels on the solver's own execution space, a GPU's where Kokkos has one: no allocation, no fence, no host decision.
// Needs the core library (and so Kokkos) alone.
#include <gridmorph/gridmorph.hpp>

#include <Kokkos_Core.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace {

using gridmorph::ElementType;
using gridmorph::Index;
using gridmorph::Index3;
using gridmorph::Index32;
using gridmorph::Vec3;
using Exec = Kokkos::DefaultExecutionSpace;
using Memory = Exec::memory_space;

constexpr int n = 18;  // unit cells along each side of the box; the body takes the middle third
constexpr ElementType hexahedron = ElementType::hexahedron;

enum class Cell { outside, body, fluid };

Cell cell(Index3 const& c) {
  bool inside = true, in_body = true;
  for (int const i : c) {
    inside = inside && i >= 0 && i < n;
    in_body = in_body && i >= n / 3 && i < n - n / 3;
  }
  return !inside ? Cell::outside : in_body ? Cell::body : Cell::fluid;
}

/// Hexahedra between the box and the body, with patches "body" and "box".
gridmorph::Mesh box_around_a_body() {
  constexpr std::array<Index3, 8> corner{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  // What is behind the sides of a hexahedron, in the order of the CGNS standard.
  constexpr std::array<Index3, 6> behind{{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  std::vector<Index32> number((n + 1) * (n + 1) * (n + 1), -1);
  std::vector<Vec3> points;
  std::vector<std::array<Index32, 8>> elements;
  gridmorph::Patch body, box;
  body.name = "body";
  body.kind = gridmorph::PatchKind::wall;
  box.name = "box";
  box.kind = gridmorph::PatchKind::farfield;
  body.zone = box.zone = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (cell({i, j, k}) != Cell::fluid) continue;
        auto& nodes = elements.emplace_back();
        for (std::size_t c = 0; c < 8; ++c) {
          Index3 const at{i + corner[c][0], j + corner[c][1], k + corner[c][2]};
          Index32& own = number[at[0] + (n + 1) * (at[1] + (n + 1) * at[2])];
          if (own < 0) {
            own = Index32(points.size());
            points.push_back({double(at[0]), double(at[1]), double(at[2])});
          }
          nodes[c] = own;
        }
        for (int side = 0; side < 6; ++side) {
          auto const& b = behind[side];
          Cell const there = cell({i + b[0], j + b[1], k + b[2]});
          if (there == Cell::fluid) continue;
          std::array<Index32, 4> face;
          for (int c = 0; c < 4; ++c) face[c] = nodes[gridmorph::face_corner(hexahedron, side, c)];
          (there == Cell::body ? body : box).faces.add(face);
        }
      }
  gridmorph::Mesh mesh;
  mesh.source = "box around a body";
  mesh.add_zone("fluid", Index(points.size()));
  mesh.coordinates = gridmorph::Coordinates(Index(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) mesh.coordinates.set(Index(p), points[p]);
  for (auto const& nodes : elements) mesh.add_element(hexahedron, nodes);
  mesh.patches = {body, box};
  return mesh;
}

/// A list of the host in the memory of Exec.
Kokkos::View<Vec3 const*, Memory> uploaded(std::vector<Vec3> const& values) {
  return Kokkos::create_mirror_view_and_copy(
      Memory(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(values.data(), values.size()));
}

/// Writes amplitude times `mode` into the displacement of the boundary.
void displace(Exec const& exec, double amplitude, Kokkos::View<Vec3 const*, Memory> const& mode,
              Kokkos::View<Vec3*, Memory> const& boundary) {
  Kokkos::parallel_for(
      "displace", Kokkos::RangePolicy<Exec>(exec, 0, Index(mode.extent(0))),
      KOKKOS_LAMBDA(Index k) { boundary(k) = amplitude * mode(k); });
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  Exec const exec;  // the solver's own instance

  // Once: the plan, from which patches move and how far they will.
  gridmorph::Mesh const mesh = box_around_a_body();
  gridmorph::Motion motion;
  motion.rules.push_back({{"body"}, gridmorph::RigidRule{{}, {0, 0, 1}}, 0, "unstructured_loop"});
  gridmorph::PlanOptions options;
  options.elements.motion = 2;  // the largest displacement there will be: the wrap leaves room for it
  gridmorph::MorphPlan const plan(mesh, motion, options);

  // The solver's coordinates where its kernels read them.
  std::vector<Vec3> points;
  for (Index p = 0; p < mesh.n_nodes(); ++p) points.push_back(mesh.coordinates[p]);
  auto const x = uploaded(points);
  Kokkos::View<Vec3*, Memory> const now("positions", points.size());
  gridmorph::Morpher<Exec> const morpher(exec, plan, x);

  // Every step: displacement of the boundary nodes in, positions of all nodes out, always from the reference mesh.
  auto const nodes = plan.boundary_nodes();
  std::vector<Vec3> const heave = plan.boundary_displacement();  // unit heave of the body, none of the box
  auto const mode = uploaded(heave);
  Kokkos::View<Vec3*, Memory> const boundary("boundary displacement", nodes.size());
  double worst = 0;
  for (int step = 0; step <= 8; ++step) {
    double const amplitude = 2 * std::sin(2 * std::numbers::pi * step / 8);
    displace(exec, amplitude, mode, boundary);
    morpher.positions(exec, boundary, now);
    exec.fence();  // the solver would go on with its own kernels instead

    auto const moved = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), now);
    double largest = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      Vec3 const u = amplitude * heave[k], wanted = points[nodes[k]] + u;
      worst = std::max(worst, gridmorph::distance(moved(nodes[k]), wanted));
      largest = std::max(largest, gridmorph::norm(u));
    }
    std::printf("step %d: body moved by %.4f\n", step, largest);
  }
  return worst == 0 ? 0 : 1;
}
