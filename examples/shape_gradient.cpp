// The shape of a channel's floor by gradients: sections of given areas.
//
// The floor of a channel, a box of cells, is the sum of waves whose heights p are sought, so that each section across
// the channel has a wanted area, a tenth less half way than at the ends. The sum of squares J of what is missing is a
// function of the nodes of the mesh, as a drag or a loss that a flow solver finds. Its gradient dJ/dx goes through the
// mesh to the floor by one transpose and from there to the heights, however many these are:
//
//   dJ/dp = (db/dp)^T (dx/db)^T dJ/dx      b: displacement of the boundary, x: positions of all nodes
//
// Prints this gradient beside centred differences, then the steps of a descent. Needs the core library (and so Kokkos)
// alone.
#include <gridmorph/gridmorph.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using gridmorph::Coordinates;
using gridmorph::Index;
using gridmorph::Index3;
using gridmorph::Vec3;
using Exec = Kokkos::DefaultHostExecutionSpace;

constexpr Index3 extent{41, 17, 21};
constexpr int n_waves = 8;
using Heights = std::array<double, n_waves>;

/// From (0, 0, 0) to (3, 1, 1), the floor at z = 0, cells finer towards it.
gridmorph::Mesh channel() {
  gridmorph::Mesh mesh;
  mesh.source = "channel";
  mesh.add_zone("channel", extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    auto const [i, j, k] = mesh.zones[0].index(n);
    double const up = k / (extent[2] - 1.0);
    mesh.coordinates.set(n, {3 * i / (extent[0] - 1.0), j / (extent[1] - 1.0), 0.3 * up + 0.7 * up * up});
  }
  auto const add_face = [&](char const* name, int axis, int side) {
    gridmorph::Patch patch{name, "BCWall", gridmorph::PatchKind::wall, {}, 0, {{0, 0, 0}, extent}};
    patch.range.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
    patch.range.end[axis] = patch.range.begin[axis] + 1;
    mesh.patches.push_back(patch);
  };
  add_face("inlet", 0, 0);
  add_face("outlet", 0, 1);
  add_face("sides", 1, 0);
  add_face("sides", 1, 1);
  add_face("floor", 2, 0);
  add_face("roof", 2, 1);
  return mesh;
}

/// How much wave m raises the floor at p, for a height of one: nothing at inlet, outlet and sides.
double wave(int m, Vec3 const& p) {
  double const across = std::sin(std::numbers::pi * p.y);
  return std::sin((m + 1) * std::numbers::pi * p.x / 3) * across * across;
}

/// The areas of all sections, and their wanted ones.
class Sections {
 public:
  explicit Sections(gridmorph::Zone const& zone) : zone_(zone) {}

  [[nodiscard]] static double wanted(int i) {
    double const throat = std::sin(std::numbers::pi * i / (extent[0] - 1));
    return 1 - 0.1 * throat * throat;
  }
  [[nodiscard]] double missing(Coordinates const& x, int i) const {
    double area = 0;
    for_quads(i, [&](auto const& at) { area += quad_area(x, at); });
    return area - wanted(i);
  }
  /// J, half the sum of squares of what is missing; its gradient at every node.
  double functional(Coordinates const& x, Coordinates& gradient) const {
    double J = 0;
    for (Index n = 0; n < gradient.size(); ++n) gradient.set(n, {});
    for (int i = 0; i < extent[0]; ++i) {
      double const m = missing(x, i);
      J += 0.5 * m * m;
      for_quads(i, [&](auto const& at) {
        for (int c = 0; c < 4; ++c) {  // of the area in the plane (y, z): half of what lies across, turned
          Vec3 const d = x[at[(c + 1) % 4]] - x[at[(c + 3) % 4]];
          gradient.set(at[c], gradient[at[c]] + m * Vec3{0, 0.5 * d.z, -0.5 * d.y});
        }
      });
    }
    return J;
  }

 private:
  template <class Visit>
  void for_quads(int i, Visit const& visit) const {
    for (int k = 0; k + 1 < extent[2]; ++k)
      for (int j = 0; j + 1 < extent[1]; ++j)
        visit(std::array{zone_.node({i, j, k}), zone_.node({i, j + 1, k}), zone_.node({i, j + 1, k + 1}),
                         zone_.node({i, j, k + 1})});
  }
  static double quad_area(Coordinates const& x, std::array<Index, 4> const& at) {
    Vec3 const a = x[at[2]] - x[at[0]], b = x[at[3]] - x[at[1]];
    return 0.5 * (a.y * b.z - a.z * b.y);
  }

  gridmorph::Zone const& zone_;
};

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  Exec const exec;

  gridmorph::Mesh const mesh = channel();
  gridmorph::Motion motion;
  motion.rules = {{{"floor"}, gridmorph::PrescribedRule{}, 0, "shape_gradient"}};  // the others stand
  gridmorph::PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"floor"}, .extent = gridmorph::BoundaryLayer::Extent::layers, .layers = 4});
  gridmorph::MorphPlan const plan(mesh, motion, options);
  gridmorph::Morpher<Exec> const morpher(exec, plan, mesh.coordinates, {.transpose = true});
  gridmorph::ValidityCheck<Exec> const validity(exec, mesh);
  Sections const sections(mesh.zones[0]);

  std::vector<Index> const nodes = plan.boundary_nodes();
  auto const on_floor = [&](Index n) { return mesh.coordinates[n].z == 0; };
  Coordinates b(Index(nodes.size())), x(mesh.n_nodes()), dJ_dx(mesh.n_nodes()), dJ_db(b.size());

  auto const morph = [&](Heights const& p) {
    for (Index m = 0; m < b.size(); ++m) {
      Vec3 const at = mesh.coordinates[nodes[m]];
      double z = 0;
      for (int w = 0; w < n_waves && on_floor(nodes[m]); ++w) z += p[w] * wave(w, at);
      b.set(m, {0, 0, z});
    }
    morpher.positions(exec, b, x);
    exec.fence();
    return sections.functional(x, dJ_dx);
  };
  // J and dJ/dp: one transpose, and sums over the floor.
  auto const evaluate = [&](Heights const& p, Heights& slope) {
    double const J = morph(p);
    morpher.transpose(exec, b, dJ_dx, dJ_db);
    exec.fence();
    slope = {};
    for (Index m = 0; m < b.size(); ++m)
      for (int w = 0; w < n_waves && on_floor(nodes[m]); ++w)
        slope[w] += wave(w, mesh.coordinates[nodes[m]]) * dJ_db[m].z;
    return J;
  };

  Heights p{0.03, -0.02, 0.01}, slope, ignored;
  (void)evaluate(p, slope);
  std::printf("gradient of %d heights at 0.03, -0.02, 0.01, 0, ...\n  wave   by one transpose     by differences\n",
              n_waves);
  double largest = 0, error = 0;
  for (std::size_t w = 0; w < n_waves; ++w) {
    double const h = 1e-5;
    Heights up = p, down = p;
    up[w] += h;
    down[w] -= h;
    double const difference = (evaluate(up, ignored) - evaluate(down, ignored)) / (2 * h);
    std::printf("  %4zu  %17.12f  %17.12f\n", w + 1, slope[w], difference);
    largest = std::max(largest, std::abs(slope[w]));
    error = std::max(error, std::abs(slope[w] - difference));
  }

  // Steepest descent with the step lengths of Barzilai and Borwein (IMA J. Numer. Anal. 8 (1988) 141).
  std::printf("\ndescent\n  step  J              largest slope   largest area missing\n");
  double J = evaluate(p, slope), length = 0.05, off = 0, steepest = 0;
  for (int step = 0; step < 30; ++step) {
    off = steepest = 0;
    for (int i = 0; i < extent[0]; ++i) off = std::max(off, std::abs(sections.missing(x, i)));
    for (double const s : slope) steepest = std::max(steepest, std::abs(s));
    std::printf("  %4d  %.6e   %.3e       %.6f\n", step, J, steepest, off);
    if (steepest < 1e-8 * largest) break;
    Heights next = p, next_slope;
    for (std::size_t w = 0; w < n_waves; ++w) next[w] -= length * slope[w];
    J = evaluate(next, next_slope);
    double moved = 0, along = 0;
    for (std::size_t w = 0; w < n_waves; ++w) {
      double const dp = next[w] - p[w];
      moved += dp * dp;
      along += dp * (next_slope[w] - slope[w]);
    }
    length = moved / along;
    p = next;
    slope = next_slope;
  }
  auto const cells = validity(exec, x);
  exec.fence();
  std::printf("\nheights:");
  for (double const height : p) std::printf(" %.4f", height);
  std::printf("\ninverted cells: %ld\n", long(cells().inverted));
  return error < 1e-6 * largest && steepest < 1e-8 * largest && off < 1e-3 && cells().inverted == 0 ? 0 : 1;
}
