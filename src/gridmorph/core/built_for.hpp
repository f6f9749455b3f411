// Which execution spaces the library has code for. Of the host: those that Kokkos has enabled, or of these the default
// one alone (CMake option GRIDMORPH_DEFAULT_SPACES), which takes a third less time to compile.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#include <type_traits>

#ifdef KOKKOS_ENABLE_OPENMP
#define GRIDMORPH_WITH_OPENMP
#endif
#if defined(KOKKOS_ENABLE_SERIAL) && !(defined(GRIDMORPH_DEFAULT_SPACES) && defined(KOKKOS_ENABLE_OPENMP))
#define GRIDMORPH_WITH_SERIAL
#endif

namespace gridmorph {

namespace detail {
template <class Exec>
constexpr bool is_built_for() {
  bool found = false;
#ifdef GRIDMORPH_WITH_SERIAL
  found = found || std::is_same_v<Exec, Kokkos::Serial>;
#endif
#ifdef GRIDMORPH_WITH_OPENMP
  found = found || std::is_same_v<Exec, Kokkos::OpenMP>;
#endif
#ifdef KOKKOS_ENABLE_CUDA
  found = found || std::is_same_v<Exec, Kokkos::Cuda>;
#endif
#ifdef KOKKOS_ENABLE_HIP
  found = found || std::is_same_v<Exec, compat::HIP>;
#endif
  return found;
}
}  // namespace detail

/// Whether gridmorph was built for an execution space: those that its Kokkos has enabled among Serial, OpenMP, Cuda and
/// HIP; with GRIDMORPH_DEFAULT_SPACES the default ones alone. Functions for which this is not fulfilled have no code.
template <class Exec>
concept BuiltFor = detail::is_built_for<Exec>();

}  // namespace gridmorph
