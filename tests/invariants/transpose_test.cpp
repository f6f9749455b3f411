// The transpose of a morph of blocks against its derivative forwards, on the cases of the invariants.
#include "invariants/cases.hpp"

#include "support/morph_run.hpp"
#include "support/transpose_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

TEST_P(Transpose, AndItsDerivativeAreTheSameOnAllExecutionSpaces) {
  PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  Index const n = prepared.mesh.n_nodes();
  expect_same_derivatives([&]<class Exec>(Exec) { return linearised<Exec>(prepared); },
                          random_vectors(6, Index(prepared.plan().boundary_nodes.size())), random_vectors(7, n));
}

TEST_P(Transpose, DoesNotDependOnWhatWasMorphedBefore) {
  PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  EXPECT_EQ(bits_left_by_others(linearised<Kokkos::DefaultHostExecutionSpace>(prepared)), 0);
}

TEST_P(Transpose, LeavesTheSecondOrderOfATaylorSeries) {
  // J = sum of w . u + |u|^2 / 2 from half the motion on: what J makes beyond its slope falls by four where the step
  // falls by two.
  PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  using Exec = Kokkos::DefaultHostExecutionSpace;
  auto const at = linearised<Exec>(prepared);
  Vec3 const w{1, -2, 0.5};
  auto const displacements = [&](double factor) {
    Coordinates b(at.boundary.size()), u(at.n_nodes);
    for (Index k = 0; k < b.size(); ++k) b.set(k, factor * at.boundary[k]);
    at.morpher.displacements(Exec(), b, u);
    Exec().fence();
    return u;
  };
  auto const J = [&](double factor) {
    Coordinates const u = displacements(factor);
    double sum = 0;
    for (Index n = 0; n < u.size(); ++n) sum += dot(w + 0.5 * u[n], u[n]);
    return sum;
  };
  Coordinates gradient = displacements(0.5), half(at.boundary.size()), b(at.boundary.size());
  for (Index n = 0; n < gradient.size(); ++n) gradient.set(n, gradient[n] + w);
  for (Index k = 0; k < half.size(); ++k) half.set(k, 0.5 * at.boundary[k]);
  at.morpher.transpose(Exec(), half, gradient, b);
  Exec().fence();
  double slope = 0;
  for (Index k = 0; k < b.size(); ++k) slope += dot(b[k], at.boundary[k]);
  double const J0 = J(0.5), h = 0.02;
  double const whole = J(0.5 + h) - J0 - h * slope, part = J(0.5 + h / 2) - J0 - h / 2 * slope;
  EXPECT_NE(slope, 0);
  EXPECT_LE(std::abs(part - whole / 4), 0.1 * std::abs(whole / 4) + 1e-9 * std::abs(J0));
}

TEST_P(Transpose, FollowsADerivativeThatIsTheSlopeInDirectionsOffSlipSurfacesToo) {
  // Nodes whose displacement is given slide where their patch meets a slip surface: what leads off it is taken out of
  // positions, so it has to be out of rates as well.
  PreparedMorph const prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  using Exec = Kokkos::DefaultHostExecutionSpace;
  auto const at = linearised<Exec>(prepared);
  double const size = prepared.plan().mesh_size;
  Coordinates rate(at.boundary.size());
  for (Index k = 0; k < rate.size(); ++k) {
    Vec3 const x = (1 / size) * prepared.mesh.coordinates[prepared.plan().boundary_nodes[k]];
    rate.set(k, {std::sin(3 * x.y + x.z), std::cos(2 * x.z - x.x), std::sin(1 + 2 * x.x + 3 * x.y)});
  }
  auto const displacements = [&](double step) {
    Coordinates b(at.boundary.size()), u(at.n_nodes);
    for (Index k = 0; k < b.size(); ++k) b.set(k, at.boundary[k] + step * rate[k]);
    at.morpher.displacements(Exec(), b, u);
    Exec().fence();
    return u;
  };
  Coordinates const v = at.forwards(rate);
  std::vector<double> off(v.size(), std::numeric_limits<double>::infinity());
  // A long step goes over bends of facets, which are small beside some meshes; a short one is within what given nodes
  // may be off a surface that scatters.
  for (double const h : {1e-6 * size, 1e-8 * size}) {
    Coordinates const ahead = displacements(h), here = displacements(0), behind = displacements(-h);
    for (Index n = 0; n < v.size(); ++n) {
      // Where facets meet at a small angle the slopes on the two sides differ; each is a rate.
      Vec3 const forward = (1 / h) * (ahead[n] - here[n]), backward = (1 / h) * (here[n] - behind[n]);
      for (Vec3 const& slope : {0.5 * (forward + backward), forward, backward})
        off[n] = std::min(off[n], distance(slope, v[n]));
    }
  }
  double const worst = *std::max_element(off.begin(), off.end());
  EXPECT_LE(worst, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Of, Transpose, ::testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
