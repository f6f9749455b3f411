// What every benchmark shares: sizes, honest clocks, one registration per execution space.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>

#include <benchmark/benchmark.h>

#include <Kokkos_Core.hpp>

#include <chrono>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph::bench {

inline constexpr std::int64_t smoke_nodes = 4096;         ///< the only size that ctest runs
inline constexpr std::int64_t cache_nodes = 100'000;      ///< stays in the caches of a CPU
inline constexpr std::int64_t memory_nodes = 25'000'000;  ///< far out of cache; the size of the paper's timings

/// Seconds that `work` takes on `exec`, from idle to idle.
template <class ExecutionSpace, class Work>
double seconds(ExecutionSpace const& exec, Work const& work) {
  using clock = std::chrono::steady_clock;
  compat::fence(exec, "gridmorph::bench (before the clock starts)");
  auto const start = clock::now();
  work();
  compat::fence(exec, "gridmorph::bench (before the clock stops)");
  return std::chrono::duration<double>(clock::now() - start).count();
}

/// Adds the counters "nodes", which need not be the number in the benchmark's name, "nodes/s" and "bytes/s".
inline void set_rates(benchmark::State& state, std::int64_t nodes, double bytes_per_node) {
  auto const per_iteration = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["nodes"] = double(nodes);
  state.counters["nodes/s"] = benchmark::Counter(double(nodes), per_iteration);
  state.counters["bytes/s"] = benchmark::Counter(double(nodes) * bytes_per_node, per_iteration);
}

/// From cache to memory: a million nodes and more take the same time per node, or something is wrong.
inline std::vector<std::int64_t> const passage_sizes{smoke_nodes, cache_nodes, 400'000,      1'000'000,
                                                     4'000'000,   10'000'000,  memory_nodes, 40'000'000};

/// Registers run(exec, state) as "<name>/<execution space>/nodes:<n>" for Serial, where it is enabled, and the default
/// spaces of host and device. `run` takes any execution space; times are the ones it sets.
template <class Run>
void register_benchmark(std::string const& name, Run const& run,
                        std::vector<std::int64_t> const& sizes = {smoke_nodes, cache_nodes, memory_nodes}) {
  auto const add = [&](auto exec) {
    using ExecutionSpace = decltype(exec);
    auto* const registered =
        benchmark::RegisterBenchmark((name + "/" + ExecutionSpace::name()).c_str(),
                                     [run](benchmark::State& state) { run(ExecutionSpace(), state); })
            ->ArgName("nodes")
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    for (std::int64_t const n : sizes) registered->Arg(n);
  };
#ifdef KOKKOS_ENABLE_SERIAL
  add(Kokkos::Serial());
  constexpr bool host_is_new = !std::is_same_v<Kokkos::DefaultHostExecutionSpace, Kokkos::Serial>;
#else
  constexpr bool host_is_new = true;
#endif
  if constexpr (host_is_new) add(Kokkos::DefaultHostExecutionSpace());
  if constexpr (!std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>)
    add(Kokkos::DefaultExecutionSpace());
}

/// Each benchmark program registers its benchmarks here; main calls it once Kokkos is up.
void register_all();

}  // namespace gridmorph::bench
