// Meshes of case files morphed by thin plate splines (thin_plate.hpp), to be put beside what this project makes of
// them: what scripts/methods-study runs.
//
//   bench_splines morph CASE.toml OUTPUT [CENTRES]   the mesh of the case file, its boundary nodes as centres; of
//                                                    more than CENTRES (3000) as many of them, each farthest from
//                                                    those before it. Prints "centres,seconds"
//   bench_splines judge BASELINE MESH ...            prints "smallest scaled Jacobian,inverted elements" of each
//   bench_splines hexahedra BLOCKS OUTPUT            a structured mesh as elements
//
// Centres are the nodes whose displacement rules give; those that slide, are free or periodic follow the splines.
// Scaled Jacobian: the determinant of the edges at a corner over the product of their lengths, the smallest over all
// corners of all elements (scaled_jacobian.hpp).
#include "scaled_jacobian.hpp"
#include "thin_plate.hpp"

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/gridmorph.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

namespace gridmorph::bench {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// `count` of the points, each the farthest from those before it.
std::vector<std::size_t> spread(std::vector<Vec3> const& points, std::size_t count) {
  std::vector<std::size_t> out;
  std::vector<double> nearest(points.size(), HUGE_VAL);
  std::size_t next = 0;
  while (out.size() < std::min(count, points.size())) {
    out.push_back(next);
    Vec3 const p = points[next];
    for (std::size_t n = 0; n < points.size(); ++n)
      nearest[n] = std::min(nearest[n], dot(points[n] - p, points[n] - p));
    next = std::size_t(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
    if (!(nearest[next] > 0)) break;
  }
  return out;
}

void morph(std::string const& case_path, std::string const& output, std::size_t most) {
  CaseFile const c = read_case_file(case_path);
  Mesh const mesh = load_mesh(c.input, c.side_file, c.leave_out);
  auto const topology = make_topology(mesh);
  auto const faces = find_face_patches(mesh, topology);
  auto const graph = make_node_graph(mesh, topology.elements_of_nodes);
  auto const boundary = boundary_conditions(mesh, topology, faces, graph, c.motion, c.plan.elements.walls);
  std::vector<Vec3> const given = evaluate(boundary);
  auto const start = std::chrono::steady_clock::now();
  std::vector<Vec3> places, centres, displacement;
  for (Index32 const n : boundary.known) {
    Vec3 p = mesh.coordinates[n];
    if (mesh.dimension == 2) p.z = 0;
    places.push_back(p);
  }
  for (std::size_t const k : spread(places, most)) {
    centres.push_back(places[k]);
    displacement.push_back(given[k]);
  }
  std::size_t const n_centres = centres.size();
  ThinPlate const spline(std::move(centres), {displacement}, mesh.dimension);
  Coordinates x(mesh.n_nodes());
  Kokkos::parallel_for("gridmorph::bench::thin_plate", Kokkos::RangePolicy<Exec>(0, std::size_t(mesh.n_nodes())),
                       [&](std::size_t n) {
                         Vec3 p = mesh.coordinates[Index(n)];
                         if (mesh.dimension == 2) p.z = 0;
                         x.set(Index(n), mesh.coordinates[Index(n)] + spline(p).front());
                       });
  Exec().fence();
  std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
  write_morphed(c.input.string(), output, mesh, x);
  std::printf("%zu,%.2f\n", n_centres, seconds.count());
}

int run(std::vector<std::string> const& arguments) {
  auto const is = [&](char const* verb, std::size_t least) { return arguments.size() > least && arguments[0] == verb; };
  if (is("morph", 2)) {
    morph(arguments[1], arguments[2], arguments.size() > 3 ? std::stoul(arguments[3]) : 3000);
  } else if (is("judge", 2)) {
    Mesh const baseline = read_mesh(arguments[1]);
    for (std::size_t m = 2; m < arguments.size(); ++m) {
      Verdict const v = judge(baseline, read_mesh(arguments[m]).coordinates);
      std::printf("%.5f,%lld\n", v.smallest, static_cast<long long>(v.inverted));
    }
  } else if (is("hexahedra", 2)) {
    write_mesh(arguments[2], as_hexahedra(read_mesh(arguments[1])));
  } else {
    std::fprintf(
        stderr, "bench_splines morph CASE.toml OUTPUT [CENTRES] | judge BASELINE MESH ... | hexahedra BLOCKS OUTPUT\n");
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace gridmorph::bench

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  try {
    return gridmorph::bench::run({argv + 1, argv + argc});
  } catch (std::exception const& problem) {
    std::fprintf(stderr, "bench_splines: %s\n", problem.what());
    return 2;
  }
}
