// The near field by layers: what walls and ends of columns do, node by node outward.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/kernels/layer_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;

PlanOptions by_layers(LayerWeight weight = LayerWeight::inverse_distance) {
  PlanOptions options;
  options.elements.method = NearFieldMethod::layers;
  options.elements.weight = weight;
  options.elements.offset = 2.2;
  return options;
}

/// A body on a plane that stands: it does not move as a whole.
Case rooted() {
  Mesh mesh = box_around(
      {14, 14, 12},
      [](Vec3 const& p) {
        return norm(p - Vec3{7, 7, 0}) < 3.2 && p.x < 8.5;
      },
      true);
  // Elements of many shapes.
  std::vector<std::uint8_t> inside(mesh.n_nodes(), 1);
  for (Patch const& patch : mesh.patches)
    for (Index32 const n : patch_nodes(patch)) inside[n] = 0;
  Random random(3);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (inside[n]) mesh.coordinates.set(n, mesh.coordinates[n] + random.vector(0.12));
  return Case(std::move(mesh));
}
Motion moves(Vec3 const& axis, double per_length) {
  FunctionRule const bends{"bends", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                             for (std::size_t n = 0; n < x.size(); ++n)
                               u[n] = rotation_about({7, 7, 0}, axis, per_length * x[n].z)(x[n]) - x[n];
                           }};
  return motion_of({rule_for({"body"}, bends), rule_for({"k_min"}, FixedRule{})});
}

constexpr std::array all_weights{LayerWeight::uniform, LayerWeight::inverse_distance, LayerWeight::quality,
                                 LayerWeight::curvature};

TEST(NearLayers, WithoutMotionNothingChangesBitForBit) {
  Case const c = rooted();
  for (auto const weight : all_weights) {
    auto const m = c.morph(moves({0, 0, 1}, 0), by_layers(weight));
    for (Index n = 0; n < m.x.size(); ++n) ASSERT_EQ(m.x[n], c.mesh.coordinates[n]) << n;
  }
}

TEST(NearLayers, PrescribedDisplacementsHoldExactlyAndEachWeightIsAnother) {
  Case const c = rooted();
  std::vector<Coordinates> moved;
  for (auto const weight : all_weights) {
    auto const m = c.morph(moves({1, 0, 1}, 0.08), by_layers(weight));
    EXPECT_TRUE(m.prepared.plan.walls.empty());
    EXPECT_EQ(c.largest_miss(m), 0);
    EXPECT_EQ(c.inverted(m.x), 0) << int(weight);
    moved.push_back(m.x);
  }
  for (std::size_t a = 0; a < moved.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      double largest = 0;
      for (Index n = 0; n < moved[a].size(); ++n) largest = std::max(largest, distance(moved[a][n], moved[b][n]));
      EXPECT_GT(largest, 1e-3) << a << ' ' << b;
    }
}

TEST(NearLayers, RowsPassRigidMotionsOnExactlyAndMeansOfOthers) {
  // Two walls at the ends of a line of nodes that turn alike, then differently.
  using Host = Kokkos::HostSpace;
  std::vector<Index32> const node{0, 4, 1, 2}, target{2, 3}, item{0, 1, 2, 1};
  std::vector<Index> const first{0, 2, 4};
  std::vector<float> const weight{0.75F, 0.25F, 0.5F, 0.5F}, kept{1, 0};
  auto const view = [](auto const& list) {
    using T = typename std::decay_t<decltype(list)>::value_type;
    return Kokkos::View<T const*, Host>(list.data(), list.size());
  };
  Coordinates x(5);
  for (Index n = 0; n < 5; ++n) x.set(n, {double(n), 0.1 * double(n * n), 0.3});
  std::vector<Vec3> u(5);
  RigidTransform const r = rotation_about({1, 2, 3}, {0.6, 0, 0.8}, 0.7);
  Mat3 gradient = r.rotation;
  for (int i = 0; i < 3; ++i) gradient.m[i][i] -= 1;
  std::vector<kernels::AffineMotion> motion(4);
  for (std::size_t p : {0, 1}) motion[p] = {r(x[node[p]]) - x[node[p]], gradient};
  kernels::PassMotions<Host> const pass{{view(target), view(first), view(item), view(weight)},
                                        view(node),
                                        view(kept),
                                        {x.x.data(), x.y.data(), x.z.data()},
                                        motion.data(),
                                        u.data()};
  for (Index row : {0, 1}) pass(row);
  for (Index32 const n : {1, 2}) EXPECT_LT(distance(x[n] + u[n], r(x[n])), 1e-14);
  EXPECT_NEAR(motion[2].gradient.m[1][0], gradient.m[1][0], 1e-15);
  EXPECT_EQ(motion[3].gradient.m[1][0], 0);
  motion[1] = {};
  for (Index row : {0, 1}) pass(row);
  EXPECT_LT(distance(u[1], 0.75 * (r(x[1]) - x[1])), 1e-7);
  EXPECT_LT(distance(u[2], 0.375 * (r(x[2]) - x[2])), 1e-7);
}

TEST(NearLayers, HaveTheVelocityOfTheirDifferences) {
  Case const c = rooted();
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, moves({1, 0, 1}, 0.05), by_layers());
  auto const [error, largest] = rate_error(c, prepared.plan, [&](double t) {
    return prepare(c.mesh, c.topology, c.face_patches, moves({1, 0, 1}, 0.05 + t), by_layers()).boundary_displacement();
  });
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(error, 1e-7 * largest);
}

#ifdef GRIDMORPH_WITH_SERIAL
TEST(NearLayers, GiveTheSameBitsWithAnyThreads) {
  Case const c = rooted();
  auto const with = [&](auto const& exec) { return positions_on(exec, c, moves({1, 0, 1}, 0.08), by_layers()); };
  Coordinates const serial = with(Kokkos::Serial()), host = with(Case::Host());
  for (Index n = 0; n < serial.size(); ++n) ASSERT_EQ(serial[n], host[n]) << n;
}
#endif

}  // namespace
}  // namespace gridmorph::test
