#include <gridmorph/core/error.hpp>
#include <gridmorph/core/host_instance.hpp>

#include <Kokkos_Core.hpp>

#include <string>

namespace gridmorph {

void require_kokkos(char const* who) {
  if (Kokkos::is_initialized()) return;
  throw ConfigError(
      std::string(who) +
      ": Kokkos is not running; make a Kokkos::ScopeGuard (or call Kokkos::initialize) before anything of "
      "gridmorph, and end it after everything of gridmorph is gone");
}

}  // namespace gridmorph
