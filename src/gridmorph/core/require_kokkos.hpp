// Kokkos must be running before the library allocates or launches.
#pragma once

namespace gridmorph {

/// Throws ConfigError when Kokkos is not initialised, or finalised already: Kokkos' own message speaks of an
/// allocation. `who` is what needs it.
void require_kokkos(char const* who);

}  // namespace gridmorph
