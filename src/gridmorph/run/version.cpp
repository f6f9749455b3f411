#include <gridmorph/io/cgns/cgns_version.hpp>
#include <gridmorph/run/version.hpp>

#include <gridmorph_commit.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>

#include <string_view>

namespace gridmorph::cli {

namespace {

/// The device where there is one, then what runs on the host.
std::string backends() {
  std::string_view const device = Kokkos::DefaultExecutionSpace::name(),
                         host = Kokkos::DefaultHostExecutionSpace::name();
  return device == host ? std::string(host) : fmt::format("{}, host {}", device, host);
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#elif defined(__GNUC__)
  return "GNU " __VERSION__;
#else
  return "unknown compiler";
#endif
}

}  // namespace

std::string version_text() {
  std::string_view const commit = GRIDMORPH_COMMIT;
  return fmt::format("gridmorph {}{}\nKokkos {}.{}.{}, backend {}\nCGNS {}\ncompiled with {}\n", GRIDMORPH_VERSION,
                     commit.empty() ? "" : fmt::format(" (commit {})", commit), KOKKOS_VERSION / 10000,
                     KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100, backends(), cgns_version(), compiler());
}

}  // namespace gridmorph::cli
