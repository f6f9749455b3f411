// Cost of finding points in an unstructured mesh: a lattice of hexahedra, or of tetrahedra (six to a cell), whose cells
// grow along one axis; "nodes" counts the elements, and the points, of which there are as many.
//
//   build_locator        sorting the elements and boxes over them
//   locate_inside        points of a lattice that fits nowhere, in no order
//   locate_outside       points around the mesh, up to a fifth of its size away from it
//   interpolation_rows   weights of the corner nodes, on the host
//
// Model, bytes per element or point. Build: keys and numbers written, then read twice and written once in each of eight
// passes (12 + 8 * 32), corners twice (2 * (n (4 + 24) + 9)), boxes written (27) and read (27); n: corners. Locate: the
// same sort (12 + 8 * 32), the point (24, four times: its key, put in order, searched), its place (44), and, as
// neighbours share them, boxes, corners and coordinates once per point (27 + n (4 + 24)). Flops: about 12 for each of
// 130 boxes that a point is compared with, four at a time, and 60 (tetrahedra) or 800 (hexahedra) for each of two to
// eight elements: arithmetic and waiting for caches set the time.
#include "bench.hpp"
#include "last_made.hpp"

#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gridmorph::bench {

struct Lattice {
  std::int64_t elements = 0;
  bool tetrahedra = false;
  bool operator==(Lattice const&) const = default;
};

/// Cells of a unit cube, wavy, 1000 times flatter at z = 0 than at z = 1.
inline Vec3 place(double u, double v, double w) {
  double const grown = (std::pow(1000.0, w) - 1) / 999;
  return {u + 0.03 * std::sin(5 * v + w), v + 0.03 * std::sin(4 * u), grown + 0.03 * std::sin(3 * u + 2 * v)};
}

inline Mesh make_lattice(Lattice const& lattice) {
  std::int64_t const cells = lattice.tetrahedra ? lattice.elements / 6 : lattice.elements;
  int const m = std::max(2, int(std::cbrt(double(cells)) + 0.5));
  Mesh box;
  box.source = "lattice";
  box.add_zone("lattice", {m + 1, m + 1, m + 1});
  box.coordinates = Coordinates(box.n_nodes());
  for (int k = 0; k <= m; ++k)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= m; ++i)
        box.coordinates.set(box.zones[0].node({i, j, k}), place(double(i) / m, double(j) / m, double(k) / m));
  Mesh hexahedra = as_hexahedra(box);
  if (!lattice.tetrahedra) return hexahedra;
  // H. Kuhn's subdivision: paths from corner 0 to corner 6, in SIDS numbers, all positive.
  constexpr std::array<std::array<int, 4>, 6> tetrahedra{
      {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
  Mesh out;
  out.source = hexahedra.source;
  out.add_zone("lattice", hexahedra.n_nodes());
  out.coordinates = hexahedra.coordinates;
  for (Index e = 0; e < hexahedra.n_elements(); ++e) {
    auto const c = hexahedra.elements.corners(e);
    for (auto const& t : tetrahedra)
      out.add_element(ElementType::tetrahedron, std::array{c[t[0]], c[t[1]], c[t[2]], c[t[3]]});
  }
  return out;
}

inline Mesh const& lattice_of(Lattice const& lattice) {
  static LastMade<Lattice, Mesh> last;
  return last.get(lattice, [&] { return make_lattice(lattice); });
}

/// As many points as elements: inside, the places of an additive recurrence with three irrational steps (the second
/// half of them in reverse order); outside, beside the face z = 0.
inline std::vector<Vec3> make_points(Index n, bool outside) {
  std::vector<Vec3> points(static_cast<std::size_t>(n));
  auto const part = [](double a) { return a - std::floor(a); };
  for (Index k = 0; k < n; ++k) {
    double const u = part(0.8191725133961645 * double(k)), v = part(0.6710436067037893 * double(k)),
                 w = part(0.5497004779019703 * double(k));
    Vec3 p = place(0.001 + 0.998 * u, 0.001 + 0.998 * v, 0.001 + 0.998 * w);
    if (outside) p = place(u, v, 0) - Vec3{0, 0, 0.2 * w + 0.001};
    points[k] = p;
  }
  return points;
}

inline void set_locate_rates(benchmark::State& state, Index n, double bytes) {
  auto const rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["points"] = double(n);
  state.counters["points/s"] = benchmark::Counter(double(n), rate);
  state.counters["bytes/point"] = bytes;
  state.counters["bytes/s"] = benchmark::Counter(double(n) * bytes, rate);
}

inline constexpr double sort_bytes = 12 + 8 * 32;

/// Calls work() once per iteration, timed from idle to idle.
template <class ExecutionSpace, class Work>
void iterate(benchmark::State& state, ExecutionSpace const& exec, Work const& work) {
  for (auto _ : state) state.SetIterationTime(seconds(exec, work));
}

struct BuildLocator {
  bool tetrahedra = false;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh const& mesh = lattice_of({state.range(0), tetrahedra});
    iterate(state, exec, [&] {
      ElementLocator<ExecutionSpace> const locator(exec, mesh);
      benchmark::DoNotOptimize(locator.n_candidates());
    });
    double const n = tetrahedra ? 4 : 8;
    set_locate_rates(state, mesh.n_elements(), sort_bytes + 2 * (n * 28 + 9) + 54);
  }
};

struct Locate {
  bool tetrahedra = false;
  bool outside = false;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using MemorySpace = typename ExecutionSpace::memory_space;
    Mesh const& mesh = lattice_of({state.range(0), tetrahedra});
    std::vector<Vec3> const points_h = make_points(mesh.n_elements(), outside);
    auto const points = Kokkos::create_mirror_view_and_copy(
        MemorySpace(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(points_h.data(), points_h.size()));
    Kokkos::View<Location*, MemorySpace> const places("gridmorph::bench::places", points_h.size());
    ElementLocator<ExecutionSpace> const locator(exec, mesh);
    iterate(state, exec, [&] { locator.locate(exec, points, places); });
    auto const found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), places);
    auto const report = summarise({found.data(), found.extent(0)});
    state.counters["inside"] = double(report.inside) / double(found.extent(0));
    double const n = tetrahedra ? 4 : 8;
    set_locate_rates(state, mesh.n_elements(), sort_bytes + 96 + 44 + 27 + n * 28);
  }
};

struct Rows {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    if constexpr (std::is_same_v<typename ExecutionSpace::memory_space, Kokkos::HostSpace>) {
      Mesh const& mesh = lattice_of({state.range(0), false});
      std::vector<Vec3> const points = make_points(mesh.n_elements(), false);
      std::vector<Location> places(points.size());
      ElementLocator<ExecutionSpace> const locator(exec, mesh);
      locator.locate(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(points.data(), points.size()),
                     Kokkos::View<Location*, Kokkos::HostSpace>(places.data(), places.size()));
      compat::fence(exec, "gridmorph::bench (located)");
      std::vector<Index32> targets(points.size());
      for (std::size_t n = 0; n < targets.size(); ++n) targets[n] = Index32(n);
      iterate(state, exec, [&] { benchmark::DoNotOptimize(interpolation_rows({}, mesh, places, targets).size()); });
      // A location, a type, corner nodes read; target, first, items and weights written.
      set_locate_rates(state, mesh.n_elements(), 44 + 9 + 32 + 12 + 64);
    } else {
      state.SkipWithError("rows are made on the host");
    }
  }
};

void register_all() {
  std::vector<std::int64_t> const sizes{smoke_nodes, cache_nodes, 1'000'000, 10'000'000};
  register_benchmark("build_locator", BuildLocator(), sizes);
  register_benchmark("build_locator_tetrahedra", BuildLocator{true}, sizes);
  register_benchmark("locate_inside", Locate(), sizes);
  register_benchmark("locate_inside_tetrahedra", Locate{true}, sizes);
  register_benchmark("locate_outside", Locate{false, true}, sizes);
  register_benchmark("locate_outside_tetrahedra", Locate{true, true}, sizes);
  register_benchmark("interpolation_rows", Rows(), sizes);
}

}  // namespace gridmorph::bench
