// The transpose of a morph of blocks against its derivative forwards, on the cases of the invariants.
#include "invariants/cases.hpp"

#include "support/morph_run.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/core/instantiate.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

class Transpose : public ::testing::TestWithParam<Case> {};

template <class Exec>
LinearisedMorph<Exec> linearised(PreparedMorph const& prepared) {
  return {prepared.plan(), prepared.mesh.coordinates, prepared.boundary_displacement()};
}

TEST_P(Transpose, HasTheProductsOfTheDerivativeForwards) {
  for (double const factor : {1.0, 0.0}) {
    PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(factor), GetParam().options);
    EXPECT_LE(product_error(linearised<Kokkos::DefaultHostExecutionSpace>(prepared)), 1e-13) << "factor " << factor;
  }
}

TEST_P(Transpose, IsTheSameToTheBitOnAllHostSpaces) {
  PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  Coordinates const g = random_vectors(7, prepared.mesh.n_nodes());
  Coordinates const reference = linearised<Kokkos::DefaultHostExecutionSpace>(prepared).backwards(g);
  auto const compare = [&]<class Exec>(Exec, char const* name) {
    if constexpr (Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible) {
      EXPECT_EQ(different_bits(linearised<Exec>(prepared).backwards(g), reference), 0) << name;
    }
  };
#define GRIDMORPH_COMPARE(Exec) compare(Exec(), #Exec);
  GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_COMPARE)
#undef GRIDMORPH_COMPARE
}

INSTANTIATE_TEST_SUITE_P(Of, Transpose, ::testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
