// The differences between the Kokkos versions we support, 3.4 to 5.x, in one place.
//
// What is the same everywhere is used directly: Views, policies with their template arguments spelled out (deduction
// guides that take an execution space instance came later), ScopeGuard, Profiling regions.
#pragma once

#include <Kokkos_Core.hpp>

#if KOKKOS_VERSION < 30400
#error "gridmorph needs Kokkos 3.4 or newer"
#endif

#if KOKKOS_VERSION < 30700
#include <Kokkos_MathematicalFunctions.hpp>
#endif

/// Before a loop whose iterations do not wait for one another, though the compiler cannot see it.
#if defined(__CUDACC__) || defined(__HIPCC__)
#define GRIDMORPH_INDEPENDENT_LOOP
#elif defined(__clang__)
#define GRIDMORPH_INDEPENDENT_LOOP _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define GRIDMORPH_INDEPENDENT_LOOP _Pragma("GCC ivdep")
#else
#define GRIDMORPH_INDEPENDENT_LOOP
#endif

/// Functions of kernels that are called and not copied on the host, however much else is (instruction_sets.hpp): those
/// that gain nothing from it, and would make most of what is compiled.
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#define GRIDMORPH_CALLED_ON_HOST [[gnu::noinline]]
#else
#define GRIDMORPH_CALLED_ON_HOST
#endif

namespace gridmorph::kernels::compat {

/// Mathematical functions for host and device.
namespace math {
#if KOKKOS_VERSION >= 30700
namespace kokkos_math = Kokkos;
#else
namespace kokkos_math = Kokkos::Experimental;
#endif
using kokkos_math::acos;
using kokkos_math::atan2;
using kokkos_math::cos;
using kokkos_math::fabs;
using kokkos_math::fmax;
using kokkos_math::fmin;
using kokkos_math::sin;
using kokkos_math::sqrt;
}  // namespace math

/// Waits for the work submitted to `exec`; the label shows in profiles from Kokkos 3.5 on.
template <class ExecutionSpace>
void fence(ExecutionSpace const& exec, [[maybe_unused]] char const* label) {
#if KOKKOS_VERSION >= 30500
  exec.fence(label);
#else
  exec.fence();
#endif
}

#if defined(KOKKOS_ENABLE_HIP) && KOKKOS_VERSION >= 40000
using HIP = Kokkos::HIP;
#elif defined(KOKKOS_ENABLE_HIP)
using HIP = Kokkos::Experimental::HIP;
#endif

}  // namespace gridmorph::kernels::compat

// Host code meets the same differences.
namespace gridmorph {
namespace compat = kernels::compat;
}  // namespace gridmorph
