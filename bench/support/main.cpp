// The main of every benchmark program: Google Benchmark inside one Kokkos scope, with what a reader of the figures has
// to know in the context of the report.
#include "bench.hpp"

#include <gridmorph/version.hpp>

#include <cstdlib>
#include <sstream>

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  Kokkos::ScopeGuard const kokkos(argc, argv);

  benchmark::AddCustomContext("gridmorph", gridmorph::version);
  benchmark::AddCustomContext("kokkos", std::to_string(KOKKOS_VERSION));
  benchmark::AddCustomContext("default execution space", Kokkos::DefaultExecutionSpace::name());
  benchmark::AddCustomContext("host threads", std::to_string(Kokkos::DefaultHostExecutionSpace().concurrency()));
  for (char const* variable : {"OMP_NUM_THREADS", "OMP_PROC_BIND", "OMP_PLACES"}) {
    char const* const value = std::getenv(variable);
    benchmark::AddCustomContext(variable, value != nullptr ? value : "(not set)");
  }

  gridmorph::bench::register_all();
  // A filter that matches nothing is an error, or ctest would pass on benchmarks that no longer exist.
  return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
}
