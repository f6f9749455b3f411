#include <gridmorph/case/case_file.hpp>
#include <gridmorph/command/kokkos_session.hpp>
#include <gridmorph/command/threads.hpp>
#include <gridmorph/core/processors.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>

#include <unistd.h>

namespace gridmorph::cli {

namespace {

/// Bytes of the mesh, 24 bytes per node and as much again for what else is in the file.
constexpr std::uintmax_t bytes_per_thread = 1u << 19;

bool any_set(std::initializer_list<char const*> names) {
  return std::any_of(names.begin(), names.end(), [](char const* name) { return std::getenv(name) != nullptr; });
}

/// Size of the mesh's file, or of what a demo will make.
std::optional<std::uintmax_t> bytes_of_mesh(CommandLine const& options) {
  using Command = CommandLine::Command;
  constexpr std::uintmax_t bytes_per_node = 24, bytes_per_element = 48;
  std::optional<std::filesystem::path> mesh = options.input;
  switch (options.command) {
    case Command::demo:
      return options.demo_name == "ball" ? bytes_per_element * std::uintmax_t(options.demo_elements.value_or(500'000))
                                         : bytes_per_node * std::uintmax_t(options.demo_nodes.value_or(200'000));
    case Command::morph:
    case Command::plan:
    case Command::certify:
    case Command::wheel: mesh = options.case_document ? options.case_document->mesh() : std::nullopt; break;
    case Command::inspect:
    case Command::quality:
    case Command::fillet:
    case Command::blocks:
    case Command::hexahedra:
    case Command::surface:
    case Command::view:
    case Command::keys: break;
  }
  if (!mesh) return std::nullopt;
  std::error_code error;
  auto const size = std::filesystem::file_size(*mesh, error);
  return error ? std::nullopt : std::optional(size);
}

}  // namespace

void wait_passively(char** argv) {
#ifdef KOKKOS_ENABLE_OPENMP
  // The variable that is set here is also what keeps the new program from starting itself once more.
  if (any_set({"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"})) return;
  if (setenv("OMP_WAIT_POLICY", "passive", 1) != 0 || !any_set({"OMP_WAIT_POLICY"})) return;
  execv("/proc/self/exe", argv);  // returns only where it failed: slower, but right
#else
  (void)argv;
#endif
}

namespace {

/// Threads that the environment asks for, as Kokkos and OpenMP read it; 0 where it does not.
int threads_of_environment() {
  for (char const* name : {"KOKKOS_NUM_THREADS", "OMP_NUM_THREADS"})
    if (char const* text = std::getenv(name))
      return int(std::clamp(std::strtol(text, nullptr, 10), 0L, long(std::numeric_limits<int>::max())));
  return 0;
}

}  // namespace

int choose_threads(CommandLine const& options, Terminal& terminal) {
  int const wanted = options.threads > 0 ? options.threads : threads_of_environment();
  if (wanted > most_threads) {
    terminal.warn(fmt::format("{} threads are asked for, and at most {} can be had; goes on with {}", wanted,
                              most_threads, most_threads));
    return most_threads;
  }
  if (options.threads > 0) return options.threads;
#ifndef KOKKOS_ENABLE_OPENMP
  return 0;  // one thread, or backends that know better
#endif
  if (any_set({"OMP_NUM_THREADS", "KOKKOS_NUM_THREADS"})) return 0;
  int const usable = std::min(usable_processors(), most_threads);
  auto const bytes = bytes_of_mesh(options);
  return bytes ? int(std::min(std::uintmax_t(usable), 1 + *bytes / bytes_per_thread)) : usable;
}

}  // namespace gridmorph::cli
