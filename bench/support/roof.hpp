// The bandwidth that a figure is a share of, measured in the same run on arrays of the same size.
#pragma once

#include "bench.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace gridmorph::bench {

/// Seconds of one in-place update of three arrays of n nodes (x += 1, y += 1, z += 1; 48 bytes per node): the roof of a
/// morph that overwrites its mesh. Median of seven, once per size and execution space.
template <class ExecutionSpace>
double in_place_update_seconds(ExecutionSpace const& exec, std::int64_t n) {
  static std::map<std::int64_t, double> known;
  if (auto const it = known.find(n); it != known.end()) return it->second;
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  View const x(Kokkos::view_alloc(exec, "gridmorph::bench::roof_x"), n),
      y(Kokkos::view_alloc(exec, "gridmorph::bench::roof_y"), n),
      z(Kokkos::view_alloc(exec, "gridmorph::bench::roof_z"), n);
  // Small arrays are updated several times per reading, so that the clock does not count.
  int const repeats = int(std::clamp<std::int64_t>(2'000'000 / n, 1, 1000));
  std::vector<double> readings;
  for (int reading = 0; reading < 7; ++reading)
    readings.push_back(seconds(exec,
                               [&] {
                                 for (int r = 0; r < repeats; ++r)
                                   Kokkos::parallel_for(
                                       "gridmorph::bench::in_place_update",
                                       Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<std::int64_t>>(exec, 0, n),
                                       KOKKOS_LAMBDA(std::int64_t i) {
                                         x(i) += 1;
                                         y(i) += 1;
                                         z(i) += 1;
                                       });
                               }) /
                       repeats);
  std::sort(readings.begin(), readings.end());
  return known[n] = readings[readings.size() / 2];
}

/// The rates of set_rates() and, as shares of 1: "share", bytes per second over those of the in-place update, and
/// "updates", time in units of one in-place update.
template <class ExecutionSpace>
void set_shares(benchmark::State& state, ExecutionSpace const& exec, std::int64_t nodes, double bytes_per_node) {
  set_rates(state, nodes, bytes_per_node);
  state.counters["bytes/node"] = bytes_per_node;
  double const roof = in_place_update_seconds(exec, nodes);
  auto const rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["share"] = benchmark::Counter(roof * bytes_per_node / 48, rate);
  state.counters["updates"] = benchmark::Counter(roof, benchmark::Counter::Flags(rate | benchmark::Counter::kInvert));
}

}  // namespace gridmorph::bench
