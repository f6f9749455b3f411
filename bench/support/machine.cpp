#include "machine.hpp"

#include "bench.hpp"
#include "build_info.hpp"

#include <gridmorph/version.hpp>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace gridmorph::bench {
namespace {

/// As Linux names it; "unknown" elsewhere.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0)
      if (auto const colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

/// The widest vectors that this program was compiled for.
char const* vector_instructions() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__SSE2__)
  return "SSE2";
#elif defined(__ARM_FEATURE_SVE)
  return "SVE";
#elif defined(__ARM_NEON)
  return "NEON";
#else
  return "unknown";
#endif
}

/// Kokkos' own description in one line: what is on.
std::string kokkos_configuration() {
  std::ostringstream text;
  Kokkos::print_configuration(text);
  std::istringstream lines(text.str());
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    auto const begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t");
    if (begin == std::string::npos || line[end] == ':' || line.rfind(": no") == end - 3) continue;
    if (!all.empty()) all += "; ";
    all += line.substr(begin, end - begin + 1);
  }
  return all;
}

}  // namespace

void add_machine_context() {
  auto const add = [](char const* what, std::string const& value) { benchmark::AddCustomContext(what, value); };
  add("gridmorph", gridmorph::version);
  add("commit", commit);
  add("processor", processor());
  add("compiler", compiler);
  add("compiler flags", compiler_flags);
  add("vector instructions", vector_instructions());
  add("kokkos", std::to_string(KOKKOS_VERSION));
  add("kokkos configuration", kokkos_configuration());
  add("default execution space", Kokkos::DefaultExecutionSpace::name());
  add("host threads", std::to_string(Kokkos::DefaultHostExecutionSpace().concurrency()));
  for (char const* variable : {"OMP_NUM_THREADS", "OMP_PROC_BIND", "OMP_PLACES"}) {
    char const* const value = std::getenv(variable);
    add(variable, value != nullptr ? value : "(not set)");
  }
}

}  // namespace gridmorph::bench
