// The execution spaces of the host that the library is compiled for: those that Kokkos has enabled, or of these the
// default one alone (CMake option GRIDMORPH_DEFAULT_SPACES), which takes a third less time to compile.
#pragma once

#include <Kokkos_Core.hpp>

#ifdef KOKKOS_ENABLE_OPENMP
#define GRIDMORPH_WITH_OPENMP
#endif
#if defined(KOKKOS_ENABLE_SERIAL) && !(defined(GRIDMORPH_DEFAULT_SPACES) && defined(KOKKOS_ENABLE_OPENMP))
#define GRIDMORPH_WITH_SERIAL
#endif
