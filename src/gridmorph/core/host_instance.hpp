// The instance of a host execution space that host code launches on; Kokkos must be running before the library
// allocates or launches.
#pragma once

#include <gridmorph/core/built_for.hpp>

#include <Kokkos_Core.hpp>

#include <type_traits>
#include <utility>
#include <variant>

namespace gridmorph {

/// Throws ConfigError when Kokkos is not initialised, or finalised already: Kokkos' own message speaks of an
/// allocation. `who` is what needs it.
void require_kokkos(char const* who);

/// An instance of any of the host's execution spaces, one type for all of them: planning is compiled once, not for each
/// space. Converts from an instance; a copy launches on the same one.
class HostInstance {
 public:
  /// The default instance of the default host space. Throws ConfigError where Kokkos is not running.
  HostInstance() : instance_(running()) {}
#ifdef GRIDMORPH_WITH_SERIAL
  HostInstance(Kokkos::Serial const& exec) : instance_(exec) {}
#endif
#ifdef GRIDMORPH_WITH_OPENMP
  HostInstance(Kokkos::OpenMP const& exec) : instance_(exec) {}
#endif

  /// use(exec), exec being the instance in the type of its space.
  template <class Use>
  decltype(auto) visit(Use&& use) const {
    return std::visit(std::forward<Use>(use), instance_);
  }
  [[nodiscard]] int concurrency() const {
    return visit([](auto const& exec) { return int(exec.concurrency()); });
  }

 private:
  static Kokkos::DefaultHostExecutionSpace running() {
    require_kokkos("gridmorph::HostInstance");
    return {};
  }

#if defined(GRIDMORPH_WITH_SERIAL) && defined(GRIDMORPH_WITH_OPENMP)
  std::variant<Kokkos::Serial, Kokkos::OpenMP> instance_;
#else
  std::variant<Kokkos::DefaultHostExecutionSpace> instance_;
#endif
};

/// The instance itself where it is one of the host, otherwise the default one of the host.
template <class Exec>
HostInstance host_instance(Exec const& exec) {
  if constexpr (std::is_constructible_v<HostInstance, Exec const&>)
    return exec;
  else
    return {};
}

}  // namespace gridmorph
