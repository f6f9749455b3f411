// The memory bandwidth that every other figure is a share of, with the bytes that the code asks for; a store that first
// reads the line it writes moves half as much again in `copy`, a third in `triad`.
//
//   in_place_update   x += 1, y += 1, z += 1       48 bytes per node; the roof of a morph that overwrites its mesh
//   copy              u = x + 1, v = y + 1, ...    48 bytes per node; the roof of a morph that keeps its baseline
//   triad             x = y + 3 z                  24 bytes per node; to compare machines
#include "bench.hpp"

namespace gridmorph::bench {

/// Three arrays of values, first touched by the threads that use them later.
template <class ExecutionSpace>
struct Arrays {
  using View = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using Range = Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<std::int64_t>>;
  View x, y, z;

  Arrays(ExecutionSpace const& exec, std::int64_t n)
      : x(Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::bench::x"), n),
        y(Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::bench::y"), n),
        z(Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::bench::z"), n) {
    fill(exec);
  }
  void fill(ExecutionSpace const& exec) const {
    auto const vx = x, vy = y, vz = z;
    Kokkos::parallel_for(
        "gridmorph::bench::fill", Range(exec, 0, std::int64_t(vx.extent(0))), KOKKOS_LAMBDA(std::int64_t i) {
          vx(i) = 1e-3 * double(i);
          vy(i) = 1;
          vz(i) = 2;
        });
  }
};

struct InPlaceUpdate {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Arrays<ExecutionSpace> const arrays(exec, state.range(0));
    auto const x = arrays.x, y = arrays.y, z = arrays.z;
    for (auto _ : state)
      state.SetIterationTime(seconds(exec, [&] {
        Kokkos::parallel_for(
            "gridmorph::bench::in_place_update", typename Arrays<ExecutionSpace>::Range(exec, 0, state.range(0)),
            KOKKOS_LAMBDA(std::int64_t i) {
              x(i) += 1;
              y(i) += 1;
              z(i) += 1;
            });
      }));
    set_rates(state, state.range(0), 48);
  }
};

struct Copy {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Arrays<ExecutionSpace> const from(exec, state.range(0)), to(exec, state.range(0));
    auto const x = from.x, y = from.y, z = from.z, u = to.x, v = to.y, w = to.z;
    for (auto _ : state)
      state.SetIterationTime(seconds(exec, [&] {
        Kokkos::parallel_for(
            "gridmorph::bench::copy", typename Arrays<ExecutionSpace>::Range(exec, 0, state.range(0)),
            KOKKOS_LAMBDA(std::int64_t i) {
              u(i) = x(i) + 1;
              v(i) = y(i) + 1;
              w(i) = z(i) + 1;
            });
      }));
    set_rates(state, state.range(0), 48);
  }
};

struct Triad {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Arrays<ExecutionSpace> const arrays(exec, state.range(0));
    auto const x = arrays.x, y = arrays.y, z = arrays.z;
    for (auto _ : state)
      state.SetIterationTime(seconds(exec, [&] {
        Kokkos::parallel_for(
            "gridmorph::bench::triad", typename Arrays<ExecutionSpace>::Range(exec, 0, state.range(0)),
            KOKKOS_LAMBDA(std::int64_t i) { x(i) = y(i) + 3 * z(i); });
      }));
    set_rates(state, state.range(0), 24);
  }
};

void register_all() {
  register_benchmark("in_place_update", InPlaceUpdate());
  register_benchmark("copy", Copy());
  register_benchmark("triad", Triad());
}

}  // namespace gridmorph::bench
