// The bandwidths that a figure is a share of, measured in the same run on arrays of the same size.
#pragma once

#include "bench.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace gridmorph::bench {

/// Seconds of one launch() on n nodes: median of seven readings. Small arrays go several times per reading, so that the
/// clock does not count.
template <class ExecutionSpace, class Launch>
double median_seconds(ExecutionSpace const& exec, std::int64_t n, Launch const& launch) {
  int const repeats = int(std::clamp<std::int64_t>(2'000'000 / n, 1, 1000));
  std::array<double, 7> readings{};
  for (double& reading : readings)
    reading = seconds(exec,
                      [&] {
                        for (int r = 0; r < repeats; ++r) launch();
                      }) /
              repeats;
  std::sort(readings.begin(), readings.end());
  return readings[readings.size() / 2];
}

/// Three arrays of n values, first touched by the threads that use them later.
template <class ExecutionSpace>
struct RoofArrays {
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using Range = Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<std::int64_t>>;
  View x, y, z;

  RoofArrays(ExecutionSpace const& exec, std::int64_t n)
      : x(Kokkos::view_alloc(exec, "gridmorph::bench::roof_x"), n),
        y(Kokkos::view_alloc(exec, "gridmorph::bench::roof_y"), n),
        z(Kokkos::view_alloc(exec, "gridmorph::bench::roof_z"), n) {}
};

/// Seconds that the two roofs take for n nodes.
struct Roof {
  double update = 0;  ///< x += 1, y += 1, z += 1: 48 bytes per node; the roof of a morph that overwrites its mesh
  double triad = 0;   ///< x = y + 3 z: 24 bytes per node; to compare machines
};
inline constexpr double update_bytes = 48, triad_bytes = 24;

/// Measured once per size and execution space.
template <class ExecutionSpace>
Roof roof(ExecutionSpace const& exec, std::int64_t n) {
  static std::map<std::int64_t, Roof> known;
  if (auto const it = known.find(n); it != known.end()) return it->second;
  RoofArrays<ExecutionSpace> const arrays(exec, n);
  typename RoofArrays<ExecutionSpace>::Range const range(exec, 0, n);
  auto const x = arrays.x, y = arrays.y, z = arrays.z;
  auto const update = KOKKOS_LAMBDA(std::int64_t i) {
    x(i) += 1;
    y(i) += 1;
    z(i) += 1;
  };
  auto const triad = KOKKOS_LAMBDA(std::int64_t i) { x(i) = y(i) + 3 * z(i); };
  Roof measured;
  measured.update =
      median_seconds(exec, n, [&] { Kokkos::parallel_for("gridmorph::bench::in_place_update", range, update); });
  measured.triad = median_seconds(exec, n, [&] { Kokkos::parallel_for("gridmorph::bench::triad", range, triad); });
  return known[n] = measured;
}

/// Calls work() once per iteration, timed from idle to idle; returns the mean in seconds. Once before that: the first
/// use of memory costs what the system takes to hand it out, on a virtual machine a second per gigabyte.
template <class ExecutionSpace, class Work>
double time_iterations(benchmark::State& state, ExecutionSpace const& exec, Work const& work) {
  seconds(exec, work);
  double sum = 0;
  for (auto _ : state) {
    double const once = seconds(exec, work);
    state.SetIterationTime(once);
    sum += once;
  }
  return sum / double(state.iterations());
}

/// The rates of set_rates(), "bytes/node", and as plain numbers
///   share        bytes per second over those of the in-place update
///   triad share  bytes per second over those of the triad
///   updates      time in units of one in-place update
/// `mean`: seconds of one iteration.
template <class ExecutionSpace>
void set_shares(benchmark::State& state, ExecutionSpace const& exec, double mean, std::int64_t nodes,
                double bytes_per_node) {
  set_rates(state, nodes, bytes_per_node);
  Roof const best = roof(exec, nodes);
  state.counters["bytes/node"] = bytes_per_node;
  state.counters["share"] = bytes_per_node / mean / (update_bytes / best.update);
  state.counters["triad share"] = bytes_per_node / mean / (triad_bytes / best.triad);
  state.counters["updates"] = mean / best.update;
}

}  // namespace gridmorph::bench
