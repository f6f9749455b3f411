// The main of every benchmark program: Google Benchmark inside one Kokkos scope.
#include "bench.hpp"
#include "machine.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  Kokkos::ScopeGuard const kokkos(argc, argv);
  gridmorph::bench::add_machine_context();
  gridmorph::bench::register_all();
  // A filter that matches nothing is an error, or ctest would pass on benchmarks that no longer exist.
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
