// Cost of measuring quality, on one block and on blocks of 9 x 9 x 9 nodes.
//
//   measure_quality   all measures of a morphed mesh against its baseline    56 bytes per node: both meshes read,
//                                                                            volumes written
//   min_determinant   the smallest 3x3x3 determinant alone                   24 bytes per node
//   certify           the sign of the Jacobian everywhere in each cell         24 bytes per node
//
// About 960, 530 and 260 flops per cell (kernels/gridmorph/kernels/regular_cell.hpp, jacobian_bounds.hpp), 20 per byte:
// arithmetic sets the time, not memory. "read share": bytes per second over those of reading three arrays of this size,
// measured in the same run.
#include "bench.hpp"
#include "roof.hpp"

#include <gridmorph/quality/quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::bench {

/// One box of at least n nodes, or as many cubes of `block` nodes a side as make n nodes.
Mesh boxes(std::int64_t n, int block) {
  Mesh mesh;
  if (block == 0) {
    int const m = std::max(2, int(std::cbrt(double(n))));
    mesh.add_zone("box", {m, m, int((n + m * m - 1) / (m * m))});
  } else {
    for (std::int64_t nodes = 0; nodes < n; nodes += block * block * block)
      mesh.add_zone("box " + std::to_string(mesh.zones.size()), {block, block, block});
  }
  return mesh;
}

/// Unit boxes disturbed by waves of the given amplitude, on the host.
Coordinates wavy(Mesh const& mesh, double amplitude) {
  Coordinates c(mesh.n_nodes());
  for (Zone const& zone : mesh.zones) {
    double const m = zone.extent[0];
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          double const x = i / m, y = j / m, z = k / m;
          c.set(zone.node({i, j, k}), {x + amplitude * std::sin(5 * y), y + amplitude * std::sin(4 * x + z),
                                       z + amplitude * std::cos(3 * x)});
        }
  }
  return c;
}

template <class ExecutionSpace>
CoordinateViews<typename ExecutionSpace::memory_space> on_device(Coordinates const& c) {
  typename ExecutionSpace::memory_space const space;
  return {Kokkos::create_mirror_view_and_copy(space, c.x), Kokkos::create_mirror_view_and_copy(space, c.y),
          Kokkos::create_mirror_view_and_copy(space, c.z)};
}

/// Seconds to read three arrays of n nodes (24 bytes per node). Integers, because compilers may add them in any order
/// and so with all lanes. Median of seven, once per size and execution space.
template <class ExecutionSpace>
double read_seconds(ExecutionSpace const& exec, std::int64_t n) {
  static std::map<std::int64_t, double> known;
  if (auto const it = known.find(n); it != known.end()) return it->second;
  using View = Kokkos::View<std::int64_t*, typename ExecutionSpace::memory_space>;
  View const x(Kokkos::view_alloc(exec, "gridmorph::bench::roof_x"), n),
      y(Kokkos::view_alloc(exec, "gridmorph::bench::roof_y"), n),
      z(Kokkos::view_alloc(exec, "gridmorph::bench::roof_z"), n);
  typename RoofArrays<ExecutionSpace>::Range const range(exec, 0, n);
  auto const add = KOKKOS_LAMBDA(std::int64_t i, std::int64_t & sum) { sum += x(i) + y(i) + z(i); };
  return known[n] = median_seconds(exec, n, [&] {
           std::int64_t sum = 0;
           Kokkos::parallel_reduce("gridmorph::bench::read", range, add, sum);
           benchmark::DoNotOptimize(sum);
         });
}

/// set_rates() and "cells/s", "bytes/cell" and, as a share of 1, "read share".
template <class ExecutionSpace>
void set_cell_rates(benchmark::State& state, ExecutionSpace const& exec, double mean, Mesh const& mesh,
                    double bytes_per_node) {
  auto const rate = benchmark::Counter::kIsIterationInvariantRate;
  auto const nodes = std::int64_t(mesh.n_nodes());
  auto const cells = double(first_cells(mesh).back());
  set_rates(state, nodes, bytes_per_node);
  state.counters["cells/s"] = benchmark::Counter(cells, rate);
  state.counters["bytes/cell"] = double(nodes) * bytes_per_node / cells;
  state.counters["read share"] = bytes_per_node / mean / (24 / read_seconds(exec, nodes));
}

struct MeasureQuality {
  int block = 0;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh mesh = boxes(state.range(0), block);
    mesh.coordinates = wavy(mesh, 0.05);
    Coordinates const morphed = wavy(mesh, 0.06);
    QualityInput<typename ExecutionSpace::memory_space> input;
    input.coordinates = on_device<ExecutionSpace>(morphed);
    input.baseline = on_device<ExecutionSpace>(mesh.coordinates);
    double const mean =
        time_iterations(state, exec, [&] { benchmark::DoNotOptimize(measure_quality(exec, mesh, input)); });
    set_cell_rates(state, exec, mean, mesh, 56);
  }
};

struct MinDeterminant {
  int block = 0;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh mesh = boxes(state.range(0), block);
    mesh.coordinates = wavy(mesh, 0.05);
    auto const coordinates = on_device<ExecutionSpace>(mesh.coordinates);
    std::vector<int> const handedness = zone_handedness(exec, mesh, coordinates);
    std::vector<CellBox> all;
    for (int z = 0; z < int(mesh.zones.size()); ++z) {
      auto const& n = mesh.zones[z].extent;
      all.push_back({z, {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}});
    }
    double const mean = time_iterations(state, exec, [&] {
      benchmark::DoNotOptimize(
          min_determinant(exec, mesh, coordinates, std::span<int const>(handedness), std::span<CellBox const>(all)));
    });
    set_cell_rates(state, exec, mean, mesh, 24);
  }
};

struct Certify {
  int block = 0;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh mesh = boxes(state.range(0), block);
    mesh.coordinates = wavy(mesh, 0.05);
    CertificateInput<typename ExecutionSpace::memory_space> input;
    input.coordinates = on_device<ExecutionSpace>(wavy(mesh, 0.06));
    input.baseline = on_device<ExecutionSpace>(mesh.coordinates);
    input.handedness = zone_handedness(exec, mesh, input.baseline);
    double const mean = time_iterations(state, exec, [&] { benchmark::DoNotOptimize(certify(exec, mesh, input)); });
    set_cell_rates(state, exec, mean, mesh, 24);
  }
};

void register_all() {
  register_benchmark("measure_quality", MeasureQuality());
  register_benchmark("measure_quality_small_blocks", MeasureQuality{9});
  register_benchmark("min_determinant", MinDeterminant());
  register_benchmark("min_determinant_small_blocks", MinDeterminant{9});
  register_benchmark("certify", Certify());
  register_benchmark("certify_small_blocks", Certify{9});
}

}  // namespace gridmorph::bench
