// Cost of measuring quality, per node of a box of one zone.
//
//   measure_quality   all measures of a morphed mesh against its baseline    56 bytes per node: both meshes read,
//                                                                            volumes written
//   min_determinant   the smallest 3x3x3 determinant alone                   24 bytes per node
//
// About 1000 and 800 flops per cell: both are bound by arithmetic, not by memory.
#include "bench.hpp"

#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace gridmorph::bench {

/// A box of at least n nodes, disturbed by waves of the given amplitude, on the host.
Coordinates wavy_box(Mesh& mesh, std::int64_t n, double amplitude) {
  int const m = std::max(2, int(std::cbrt(double(n))));
  if (mesh.zones.empty()) mesh.add_zone("box", {m, m, int((n + m * m - 1) / (m * m))});
  Zone const& zone = mesh.zones[0];
  Coordinates c(mesh.n_nodes());
  for (Index node = 0; node < mesh.n_nodes(); ++node) {
    auto const p = zone.index(node);
    double const x = double(p[0]) / m, y = double(p[1]) / m, z = double(p[2]) / m;
    c.set(node,
          {x + amplitude * std::sin(5 * y), y + amplitude * std::sin(4 * x + z), z + amplitude * std::cos(3 * x)});
  }
  return c;
}

template <class ExecutionSpace>
CoordinateViews<typename ExecutionSpace::memory_space> on_device(Coordinates const& c) {
  typename ExecutionSpace::memory_space const space;
  return {Kokkos::create_mirror_view_and_copy(space, c.x), Kokkos::create_mirror_view_and_copy(space, c.y),
          Kokkos::create_mirror_view_and_copy(space, c.z)};
}

struct MeasureQuality {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh mesh;
    mesh.coordinates = wavy_box(mesh, state.range(0), 0.05);
    Coordinates const morphed = wavy_box(mesh, state.range(0), 0.06);
    QualityInput<typename ExecutionSpace::memory_space> input;
    input.coordinates = on_device<ExecutionSpace>(morphed);
    input.baseline = on_device<ExecutionSpace>(mesh.coordinates);
    for (auto _ : state)
      state.SetIterationTime(seconds(exec, [&] { benchmark::DoNotOptimize(measure_quality(exec, mesh, input)); }));
    set_rates(state, mesh.n_nodes(), 56);
  }
};

struct MinDeterminant {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Mesh mesh;
    mesh.coordinates = wavy_box(mesh, state.range(0), 0.05);
    auto const coordinates = on_device<ExecutionSpace>(mesh.coordinates);
    std::vector<int> const handedness = zone_handedness(exec, mesh, coordinates);
    auto const& n = mesh.zones[0].extent;
    std::vector<CellBox> const all{{0, {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}}};
    for (auto _ : state)
      state.SetIterationTime(seconds(exec, [&] {
        benchmark::DoNotOptimize(
            min_determinant(exec, mesh, coordinates, std::span<int const>(handedness), std::span<CellBox const>(all)));
      }));
    set_rates(state, mesh.n_nodes(), 24);
  }
};

void register_all() {
  register_benchmark("measure_quality", MeasureQuality());
  register_benchmark("min_determinant", MinDeterminant());
}

}  // namespace gridmorph::bench
