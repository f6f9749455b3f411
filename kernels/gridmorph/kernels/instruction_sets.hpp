// Kernels of the host compiled twice, for x86-64 as it began and for AVX2 (vectors of four doubles); which copy runs is
// found out when a program starts. Contraction of products and sums is switched off in both, so that they give the same
// bits.
//
// Only kernels that gain ask for it, each by a member `two_instruction_sets`: rows that are computed in long loops; or
// by computing runs of vectors (vector_runs.hpp). Those that wait for memory do not. AVX-512 gives at most a tenth
// more, which is not worth a third copy.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>

// A build for a machine that has the wider set needs no second copy, and other processors have none. Sanitizers, which
// take long to compile, go without by GRIDMORPH_ONE_INSTRUCTION_SET.
#if defined(__GNUC__) && defined(__x86_64__) && !defined(__AVX2__) && !defined(__CUDACC__) && !defined(__HIPCC__) && \
    !defined(GRIDMORPH_ONE_INSTRUCTION_SET)
#define GRIDMORPH_TWO_INSTRUCTION_SETS 1
#include <cstdlib>
#endif

namespace gridmorph::kernels {

template <class Kernel>
concept HasTwoInstructionSets = requires {
  requires Kernel::two_instruction_sets;
};

#ifdef GRIDMORPH_TWO_INSTRUCTION_SETS
inline constexpr bool has_two_instruction_sets = true;

/// Whether kernels run by AVX2: where the machine has it, unless the environment variable GRIDMORPH_NO_AVX2 is set. Not
/// to be changed while kernels run.
inline bool& uses_avx2() {
  static bool uses = __builtin_cpu_supports("avx2") != 0 && std::getenv("GRIDMORPH_NO_AVX2") == nullptr;
  return uses;
}

/// A kernel with all that it calls, by AVX2.
template <class Kernel>
struct ByAvx2 {
  Kernel kernel;
  [[gnu::flatten, gnu::target("avx2")]] void operator()(Index item) const { kernel(item); }
};

/// Calls run(kernel), in the copy for the instruction set of this machine.
template <class Kernel, class Run>
void with_instruction_set(Kernel const& kernel, Run const& run) {
  if constexpr (HasTwoInstructionSets<Kernel>)
    if (uses_avx2()) return run(ByAvx2<Kernel>{kernel});
  run(kernel);
}
#else
inline constexpr bool has_two_instruction_sets = false;

template <class Kernel, class Run>
void with_instruction_set(Kernel const& kernel, Run const& run) {
  run(kernel);
}
#endif

}  // namespace gridmorph::kernels
