// The line kernels on tables written by hand: laws, walking through segments, write masks, frames.
#include <gridmorph/kernels/line_sweep.hpp>
#include <gridmorph/kernels/node_copy.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace gridmorph::test {
namespace {

using Host = Kokkos::HostSpace;
using kernels::Index;

template <class T>
Kokkos::View<T*, Host> view(std::vector<T> const& values) {
  Kokkos::View<T*, Host> v("test::table", values.size());
  for (std::size_t n = 0; n < values.size(); ++n) v(n) = values[n];
  return v;
}

/// Arrays of three components.
struct Arrays {
  std::vector<double> x, y, z;
  explicit Arrays(std::size_t n, double value = 0) : x(n, value), y(n, value), z(n, value) {}
  kernels::Field<double> field() { return {x.data(), y.data(), z.data()}; }
  kernels::Field<double const> read() const { return {x.data(), y.data(), z.data()}; }
};

constexpr std::uint32_t write_all = (1u << 27) - 1;

TEST(LineLaw, StartsAtZeroEndsAtOneAndIsMonotone) {
  using kernels::LineLaw;
  for (LineLaw law : {LineLaw::linear, LineLaw::c1, LineLaw::c2}) {
    EXPECT_EQ(kernels::law_weight(law, 0), 0);
    EXPECT_EQ(kernels::law_weight(law, 1), 1);
    EXPECT_NEAR(kernels::law_weight(law, 0.5), 0.5, 1e-16);
    for (int n = 0; n < 100; ++n)
      EXPECT_LT(kernels::law_weight(law, 0.01 * n), kernels::law_weight(law, 0.01 * (n + 1)));
  }
  EXPECT_EQ(kernels::law_weight(LineLaw::constant, 0.7), 0);
}

TEST(LineLaw, SlopesAndCurvaturesVanishWhereTheySay) {
  using kernels::LineLaw;
  double const h = 1e-4;
  auto const slope = [&](LineLaw law, double s) {
    return (kernels::law_weight(law, s + h) - kernels::law_weight(law, s - h)) / (2 * h);
  };
  auto const curvature = [&](LineLaw law, double s) {
    return (kernels::law_weight(law, s + h) - 2 * kernels::law_weight(law, s) + kernels::law_weight(law, s - h)) /
           (h * h);
  };
  for (double end : {0.0, 1.0}) {
    EXPECT_NEAR(slope(LineLaw::c1, end), 0, 1e-6);
    EXPECT_NEAR(slope(LineLaw::c2, end), 0, 1e-6);
    EXPECT_NEAR(curvature(LineLaw::c2, end), 0, 1e-2);
    EXPECT_GT(std::abs(curvature(LineLaw::c1, end)), 5);
  }
}

/// One line of five nodes in two segments; the second one runs backwards through memory.
///   positions 0 1 2 | 2 3 4   nodes 0 1 2 | 5 4 3,   x = 0 1 3 | 3 6 10
struct TwoSegments {
  kernels::LineTable<Host> table;
  kernels::SideTable<Host> sides;
  Arrays x{6};

  explicit TwoSegments(kernels::LineLaw law, std::uint32_t mask, std::int32_t open = 0, std::int32_t rotation = -1) {
    table.chains = view<kernels::Chain>({{5, 1, 1, law, open, -1, 0, 1, 0, 0}});
    table.tubes = view<kernels::Tube>({{0, 0, 0, 1, 1, 0, 2}});
    table.segments = view<kernels::Segment>({{0, 1, 0, 0, 3, 0, mask, -1}, {5, -1, 0, 0, 3, 2, mask, rotation}});
    table.first_line = view<Index>({0, 1});
    // A quarter turn about z.
    table.rotations = view<Mat3>({Mat3{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}});
    table.n_lines = 1;
    double const along[6] = {0, 1, 3, 10, 6, 3};
    for (int n = 0; n < 6; ++n) x.x[n] = along[n];
  }
  void sweep(Arrays& u) const { kernels::LineSweep<Host>{table, sides, x.read(), u.field()}(0); }
};

TEST(LineSweep, FollowsSegmentsByArcLength) {
  TwoSegments const t(kernels::LineLaw::linear, write_all);
  Arrays u(6, -7);
  u.x[0] = 1;
  u.x[3] = 2;
  t.sweep(u);
  double const expected[6] = {1, 1.1, 1.3, 2, 1.6, 1.3};
  for (int n = 0; n < 6; ++n) EXPECT_NEAR(u.x[n], expected[n], 1e-15) << n;
  for (int n = 0; n < 6; ++n) EXPECT_EQ(u.y[n], -7);
}

TEST(LineSweep, WritesOnlyWhatItsMaskNames) {
  // One node across counts as the lower end: category (cs, 0, 0), bit cs.
  TwoSegments const t(kernels::LineLaw::linear, 1u << 1);
  Arrays u(6, -7);
  u.x[0] = 1;
  u.x[3] = 2;
  t.sweep(u);
  EXPECT_NEAR(u.x[1], 1.1, 1e-15);
  EXPECT_NEAR(u.x[4], 1.6, 1e-15);
  EXPECT_EQ(u.x[2], -7);
  EXPECT_EQ(u.x[5], -7);
}

TEST(LineSweep, AnOpenEndTakesWhatTheKnownEndHas) {
  TwoSegments const t(kernels::LineLaw::constant, write_all, 1);
  Arrays u(6, -7);
  u.x[0] = 0.1;
  t.sweep(u);
  for (int n = 0; n < 6; ++n) EXPECT_EQ(u.x[n], 0.1);
}

TEST(LineSweep, TurnsDisplacementsIntoTheFrameOfEachSegment) {
  TwoSegments const t(kernels::LineLaw::linear, write_all, 0, 0);
  Arrays u(6);
  u.x[0] = 1;  // in the chain's frame
  u.y[3] = 2;  // (2, 0, 0) of the chain, a quarter turn further
  t.sweep(u);
  EXPECT_NEAR(u.x[1], 1.1, 1e-15);
  EXPECT_NEAR(u.x[4], 0, 1e-15);
  EXPECT_NEAR(u.y[4], 1.6, 1e-15);
}

TEST(LineTable, FindsTheTubeOfEveryLine) {
  kernels::LineTable<Host> table;
  table.tubes = view<kernels::Tube>(std::vector<kernels::Tube>(4));
  table.first_line = view<Index>({0, 3, 4, 10, 11});
  int const expected[11] = {0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 3};
  for (int line = 0; line < 11; ++line) EXPECT_EQ(table.tube_of(line), expected[line]);
}

TEST(NodeCopy, CopiesRangesWithStridesAndTurns) {
  Arrays u(20);
  for (int n = 0; n < 6; ++n) u.x[n] = n + 1;
  // A 3 x 2 face to nodes that run backwards, and a turned one.
  kernels::CopyNodes<Host> const kernel{
      view<kernels::NodeCopy>({{0, 1, 3, 15, -1, -3, 3, 2, -1}, {0, 1, 3, 16, 1, 2, 2, 2, 0}}), view<Index>({0, 6, 10}),
      view<Mat3>({Mat3{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}}), u.field()};
  for (Index item = 0; item < 10; ++item) kernel(item);
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 3; ++p) EXPECT_EQ(u.x[15 - p - 3 * q], p + 3 * q + 1);
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      EXPECT_EQ(u.x[16 + p + 2 * q], 0);
      EXPECT_EQ(u.y[16 + p + 2 * q], p + 3 * q + 1);
    }
}

}  // namespace
}  // namespace gridmorph::test
