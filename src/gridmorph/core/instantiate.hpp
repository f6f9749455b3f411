// The list of execution spaces that library functions are compiled for.
//
// A function that launches kernels is declared in a header as a template on the execution space, defined in one .cpp,
// and instantiated at the end of that .cpp for every space that this Kokkos has enabled:
//
//   // line_sweep.hpp
//   template <class Exec>
//   void sweep(Exec const& exec, Lines<typename Exec::memory_space> const& lines);
//
//   // line_sweep.cpp
//   #include <gridmorph/core/instantiate.hpp>
//   ...
//   #define GRIDMORPH_INSTANTIATE(Exec) template void sweep(Exec const&, Lines<Exec::memory_space> const&);
//   GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
//   #undef GRIDMORPH_INSTANTIATE
//
// Code that calls such a function with another space fails at link time; it can include gridmorph/kernels/ instead.
// With GRIDMORPH_DEFAULT_SPACES the list is that of core/built_for.hpp and the device's.
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#ifdef GRIDMORPH_WITH_SERIAL
#define GRIDMORPH_DETAIL_SERIAL(APPLY) APPLY(Kokkos::Serial)
#else
#define GRIDMORPH_DETAIL_SERIAL(APPLY)
#endif

#ifdef GRIDMORPH_WITH_OPENMP
#define GRIDMORPH_DETAIL_OPENMP(APPLY) APPLY(Kokkos::OpenMP)
#else
#define GRIDMORPH_DETAIL_OPENMP(APPLY)
#endif

#ifdef KOKKOS_ENABLE_CUDA
#define GRIDMORPH_DETAIL_CUDA(APPLY) APPLY(Kokkos::Cuda)
#else
#define GRIDMORPH_DETAIL_CUDA(APPLY)
#endif

#ifdef KOKKOS_ENABLE_HIP
#define GRIDMORPH_DETAIL_HIP(APPLY) APPLY(::gridmorph::compat::HIP)
#else
#define GRIDMORPH_DETAIL_HIP(APPLY)
#endif

/// Expands APPLY(ExecutionSpace) for every enabled execution space the library supports.
#define GRIDMORPH_FOR_EACH_EXEC(APPLY) \
  GRIDMORPH_DETAIL_SERIAL(APPLY)       \
  GRIDMORPH_DETAIL_OPENMP(APPLY)       \
  GRIDMORPH_DETAIL_CUDA(APPLY)         \
  GRIDMORPH_DETAIL_HIP(APPLY)
