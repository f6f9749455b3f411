// The same on every execution space that the library is compiled for, those of devices included.
#pragma once

#include "support/morph_run.hpp"

#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/instruction_sets.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph::test {

/// Whether the host reads the memory of Exec as it is.
template <class Exec>
constexpr bool on_host = Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible;

/// Calls work(exec, "name of the space") for each of them, and for the host once more by the narrower instruction set.
template <class Work>
void on_every_space(Work const& work) {
#ifdef GRIDMORPH_TWO_INSTRUCTION_SETS
  struct Narrow {
    bool before = std::exchange(kernels::uses_avx2(), false);
    ~Narrow() { kernels::uses_avx2() = before; }
  };
  if (kernels::uses_avx2()) {
    Narrow const narrow;
    work(Kokkos::DefaultHostExecutionSpace(), "host without AVX2");
  }
#endif
#define GRIDMORPH_CALL(Exec) work(Exec(), Exec::name());
  GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_CALL)
#undef GRIDMORPH_CALL
}

/// Spaces of the host give the same bits. A device contracts products and sums to one rounding and has sines of its
/// own, so there it is a distance: at most `device_error`.
template <class Exec>
void expect_same_on(Exec const& exec, Coordinates const& found, Coordinates const& expected, double device_error) {
  ASSERT_EQ(found.size(), expected.size()) << exec.name();
  if constexpr (on_host<Exec>) {
    EXPECT_EQ(different_bits(found, expected), 0) << exec.name();
  } else {
    double worst = 0;
    for (Index n = 0; n < found.size(); ++n) {
      double const off = distance(found[n], expected[n]);
      worst = std::isfinite(off) ? std::max(worst, off) : std::numeric_limits<double>::infinity();
    }
    EXPECT_LE(worst, device_error) << exec.name();
  }
}

/// The largest component's size.
inline double largest_component(Coordinates const& c) {
  double largest = 0;
  for (Index n = 0; n < c.size(); ++n)
    largest = std::max({largest, std::abs(c[n].x), std::abs(c[n].y), std::abs(c[n].z)});
  return largest;
}

}  // namespace gridmorph::test
