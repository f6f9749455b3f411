// The smooth field between boundary values: constants, and the same field however the nodes are numbered.
#include "support/random.hpp"

#include <gridmorph/morph/detail/inverse_distance_views.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// The lattice points on the surface of a cube of side n: full of equal distances.
std::vector<Vec3> cube_surface(int n) {
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        if (i == 0 || i == n || j == 0 || j == n || k == 0 || k == n)
          points.push_back({double(i), double(j), double(k)});
  return points;
}

/// Values on the lattice over twice the cube; node number k is points[order[k]].
std::vector<Vec3> field(std::vector<Vec3> const& points, std::vector<int> const& order, Vec3 (*value)(Vec3 const&)) {
  Coordinates x(Index(points.size()));
  std::vector<Index32> nodes;
  std::vector<double> area;
  Kokkos::View<Vec3*, Kokkos::HostSpace> const given("given", points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    Vec3 const p = points[std::size_t(order[k])];
    x.set(Index(k), p);
    nodes.push_back(Index32(k));
    area.push_back(1 + 0.1 * std::sin(p.x + 2 * p.y + 3 * p.z));
    given(k) = value(p);
  }
  InverseDistanceField const lattice = make_scatter_lattice(x, nodes, area, 3, {-4, -4, -4}, {12, 12, 12}, 4000);
  detail::InverseDistanceViews<Kokkos::HostSpace, Vec3> const views(lattice);
  Exec const exec;
  views.run(exec, given);
  exec.fence();
  return {views.value.data(), views.value.data() + views.value.extent(0)};
}

std::vector<int> in_order(std::size_t n) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

TEST(InverseDistanceField, ConstantsStayConstant) {
  auto const points = cube_surface(8);
  for (Vec3 const& v : field(points, in_order(points.size()), [](Vec3 const&) { return Vec3{1, -2, 0.5}; })) {
    EXPECT_LT(norm(v - Vec3{1, -2, 0.5}), 1e-12);
  }
}

TEST(InverseDistanceField, NumberingOfTheNodesDoesNotMatter) {
  auto const points = cube_surface(8);
  auto const value = [](Vec3 const& p) { return Vec3{std::sin(p.x), p.y * p.z / 10, std::cos(p.x + p.y)}; };
  auto const expected = field(points, in_order(points.size()), value);
  Random random(7);
  for (int trial = 0; trial < 3; ++trial) {
    auto order = in_order(points.size());
    random.shuffle(order);
    auto const found = field(points, order, value);
    ASSERT_EQ(found.size(), expected.size());
    // Weights are kept in single precision.
    for (std::size_t n = 0; n < found.size(); ++n) EXPECT_LT(norm(found[n] - expected[n]), 1e-6);
  }
}

TEST(InverseDistanceField, ValuesLieBetweenThoseGiven) {
  auto const points = cube_surface(6);
  for (Vec3 const& v : field(points, in_order(points.size()), [](Vec3 const& p) { return Vec3{p.x, 0, 1}; })) {
    EXPECT_GE(v.x, 0);
    EXPECT_LE(v.x, 6);
    EXPECT_LT(std::abs(v.y), 1e-14);
  }
}

}  // namespace
}  // namespace gridmorph::test
