// The kernels on tables written by hand: laws, line parameters through segments, sweeps, frames, copies.
#include "kernels/tables.hpp"

#include <gridmorph/kernels/line_parameter.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/skeleton_sweep.hpp>
#include <gridmorph/kernels/volume_pass.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace gridmorph::test {
namespace {

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

TEST(LineLaw, CubicsHaveTheSlopesThatTheyAreGiven) {
  double const h = 1e-5;
  for (double const a : {0.0, 0.85, 1.0, 1.5})
    for (double const b : {0.0, 0.3, 1.0, 1.5}) {
      auto const w = [&](double s) { return kernels::cubic_weight(a, b, s); };
      EXPECT_EQ(w(0), 0);
      EXPECT_EQ(w(1), 1);
      EXPECT_NEAR((w(h) - w(-h)) / (2 * h), a, 1e-9);
      EXPECT_NEAR((w(1 + h) - w(1 - h)) / (2 * h), b, 1e-9);
      // Third derivatives of cubics are constant: fourth differences vanish.
      EXPECT_NEAR(w(0) - 4 * w(0.25) + 6 * w(0.5) - 4 * w(0.75) + w(1), 0, 1e-14);
    }
  kernels::Chain mixed{};
  mixed.law = kernels::LineLaw::cubic;
  mixed.slope[0] = mixed.slope[1] = 0.7;
  for (double const s : {0.0, 0.1, 0.4, 0.9, 1.0})
    EXPECT_NEAR(kernels::law_weight(mixed, nullptr, s), 0.7 * s + 0.3 * kernels::law_weight(kernels::LineLaw::c1, s),
                1e-15);
}

TEST(LineLaw, TablesAreTheCubicsThroughTheirKnots) {
  // Any cubic with w(0) = 0 is its own table, however many knots it has; a second table in front moves the first one
  // along.
  auto const w = [](double s) { return s * (0.25 + s * (2.5 - 1.75 * s)); };
  auto const slope = [](double s) { return 0.25 + s * (5 - 5.25 * s); };
  for (int const n : {1, 3, 8}) {
    std::vector<double> knots{9, 9, 9, 9};
    for (int m = 0; m <= n; ++m) knots.insert(knots.end(), {w(double(m) / n), slope(double(m) / n) / n});
    kernels::Chain chain{};
    chain.law = kernels::LineLaw::table;
    chain.first_knot = 4;
    chain.n_intervals = n;
    for (int k = 0; k <= 100; ++k)
      EXPECT_NEAR(kernels::law_weight(chain, knots.data(), 0.01 * k), w(0.01 * k), 2e-15) << n << ' ' << k;
    EXPECT_EQ(kernels::law_weight(chain, knots.data(), 0), 0);
  }
}

/// One line of five nodes in two segments; the second one runs backwards through memory.
///   positions 0 1 2 | 2 3 4   nodes 0 1 2 | 5 4 3,   x = 0 1 3 | 3 6 10
struct TwoSegments {
  kernels::LineTable<Host> table;
  std::vector<kernels::ParameterTarget> targets{{0, 1, 0, 0},  {0, 1, 0, 0},  {0, 1, 0, 0},
                                                {5, -1, 0, 0}, {5, -1, 0, 0}, {5, -1, 0, 0}};
  std::vector<kernels::Segment> segments;
  Arrays x{6};

  TwoSegments() {
    table.chains = view<kernels::Chain>({{5, 1, 1, kernels::LineLaw::linear, 0, -1, 0, 1, 0, 0, 0}});
    table.tubes = view<kernels::Tube>({{0, 0, 0, 1, 1, 0, 2}});
    segments = {{0, 1, 0, 0, 3, 0, {}}, {5, -1, 0, 0, 3, 2, {}}};
    for (int m = 0; m < 2; ++m)
      for (int c = 0; c < 27; ++c) segments[m].target[c] = c < 3 ? 3 * m + c : -1;
    double const along[6] = {0, 1, 3, 10, 6, 3};
    for (int n = 0; n < 6; ++n) x.x[n] = along[n];
  }
  template <int Width>
  std::vector<double> parameters() {
    table.segments = view(segments);
    std::vector<double> t(6, -7);
    kernels::LineParameters<Host, Width>{table, view(targets), view<Index>({0, 1}), x.read(), t.data()}(0);
    return t;
  }
};

TEST(LineParameters, FollowSegmentsByArcLength) {
  TwoSegments lines;
  double const expected[6] = {0, 0.1, 0.3, 1, 0.6, 0.3};
  auto const one = lines.parameters<1>(), many = lines.parameters<64>();
  for (int n = 0; n < 6; ++n) {
    EXPECT_NEAR(one[n], expected[n], 1e-15) << n;
    EXPECT_EQ(many[n], one[n]) << n;
  }
}

TEST(LineParameters, AreKeptOnlyWhereTheyAreWanted) {
  TwoSegments lines;
  for (auto& segment : lines.segments) segment.target[0] = segment.target[2] = -1;
  auto const t = lines.parameters<64>();
  for (int n : {0, 2, 3, 5}) EXPECT_EQ(t[n], -7);
  EXPECT_NEAR(t[1], 0.1, 1e-15);
  EXPECT_NEAR(t[4], 0.6, 1e-15);
}

/// A box of nodes as one chain along a given axis of memory.
struct OneBox {
  int n[3];
  Arrays x;

  OneBox(int ni, int nj, int nk) : n{ni, nj, nk}, x(std::size_t(ni) * nj * nk) {
    for (std::size_t m = 0; m < x.x.size(); ++m) {
      double const i = double(m % ni), j = double((m / ni) % nj), k = double(m / ni / nj);
      x.x[m] = i + 0.3 * std::sin(1.7 * j + k);
      x.y[m] = j * j * 0.1 + 0.2 * std::cos(i + 2 * k);
      x.z[m] = k + 0.1 * i * j;
    }
  }
  /// Parameters of all nodes in memory order; lines start at the far end where `backward`.
  template <int Width>
  std::vector<double> parameters(int axis, bool backward) const {
    int const a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    Index const stride[3] = {1, n[0], Index(n[0]) * n[1]};
    kernels::LineTable<Host> table;
    table.chains = view<kernels::Chain>({{n[axis], n[a], n[b], kernels::LineLaw::linear, 0, -1, 0, 1, 0, 0, 0}});
    table.tubes = view<kernels::Tube>({{0, 0, 0, n[a], n[b], 0, 1}});
    Index const first = backward ? (n[axis] - 1) * stride[axis] : 0, along = backward ? -stride[axis] : stride[axis];
    kernels::Segment segment{first, along, stride[a], stride[b], n[axis], 0, {}};
    table.segments = view<kernels::Segment>({segment});  // every category goes to target 0: the node itself
    std::vector<double> t(x.x.size(), -7);
    kernels::LineParameters<Host, Width> const kernel{
        table, view<kernels::ParameterTarget>({{first, along, stride[a], stride[b]}}),
        view<Index>({0, kernels::LineParameters<Host, Width>::items(table.tubes(0))}), x.read(), t.data()};
    for (Index item = 0; item < kernel.first_item(1); ++item) kernel(item);
    return t;
  }
};

TEST(LineParameters, AreTheSameBitsWithAnyTileAndMatchAPlainSum) {
  for (auto const& box : {OneBox(200, 5, 3), OneBox(7, 90, 4), OneBox(70, 3, 9), OneBox(2, 2, 2), OneBox(131, 66, 2)})
    for (int axis = 0; axis < 3; ++axis)
      for (bool const backward : {false, true}) {
        auto const one = box.parameters<1>(axis, backward), some = box.parameters<4>(axis, backward),
                   many = box.parameters<64>(axis, backward);
        EXPECT_EQ(one, some);
        EXPECT_EQ(one, many);
        Index const stride[3] = {1, box.n[0], Index(box.n[0]) * box.n[1]};
        for (Index m = 0; m < Index(one.size()); ++m) {
          // Arc length up to the node, and of the whole line, edge by edge.
          int const at = int(m / stride[axis]) % box.n[axis];
          Index const start = m - at * stride[axis];
          double before = 0, total = 0;
          for (int p = 1; p < box.n[axis]; ++p) {
            Index const to = start + p * stride[axis], from = to - stride[axis];
            double const edge =
                std::hypot(box.x.x[to] - box.x.x[from], box.x.y[to] - box.x.y[from], box.x.z[to] - box.x.z[from]);
            total += edge;
            if (p <= at) before += edge;
          }
          EXPECT_NEAR(one[m], backward ? 1 - before / total : before / total, 1e-14);
        }
      }
}

TEST(LineParameters, CountNodesOnLinesOfNoLength) {
  OneBox box(5, 3, 4);
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 5; ++i) {
      int const m = i + 5 * (1 + 3 * k);  // the lines j = 1
      box.x.x[m] = box.x.y[m] = 2;
      box.x.z[m] = k;
    }
  auto const t = box.parameters<64>(0, false);
  EXPECT_EQ(t, box.parameters<1>(0, false));
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(t[5 + i], i / 4.0, 1e-15);
}

TEST(SkeletonSweep, InterpolatesTurnsAndAdds) {
  // A chain of 2 x 1 lines with three nodes: the middle nodes go to slots 4 and 5.
  kernels::SkeletonSweep sweep{};
  sweep.matrix = 0;
  sweep.n_p = 2;
  sweep.n_q = 1;
  sweep.slot = 4;
  sweep.t_p = 1;
  sweep.a[1] = 1;
  sweep.s[0] = 1;
  auto const chains = view<kernels::Chain>({{3, 2, 1, kernels::LineLaw::linear, 0, -1, 0, 1, 0, 0, 0}});
  Arrays ends(4), u(6, 1);
  ends.x = {1, 2, 3, 6};
  std::vector<double> const t{0.5, 0.25};
  Kokkos::View<Mat3*, Host> const quarter_turn = view<Mat3>({Mat3{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}});
  auto const run = [&](auto kernel) {
    for (Index item = 0; item < kernel.first_item(1); ++item) kernel(item);
  };
  run(kernels::SweepSkeleton<Host, 1, false>{view<kernels::SkeletonSweep>({sweep}),
                                             view<Index>({0, 2}),
                                             chains,
                                             quarter_turn,
                                             {},
                                             t.data(),
                                             ends.read(),
                                             u.field()});
  EXPECT_EQ(u.x, (std::vector<double>{1, 1, 1, 1, 0, 0}));
  EXPECT_EQ(u.y, (std::vector<double>{1, 1, 1, 1, 2, 3}));
  run(kernels::SweepSkeleton<Host, 64, true>{view<kernels::SkeletonSweep>({sweep}),
                                             view<Index>({0, 1}),
                                             chains,
                                             quarter_turn,
                                             {},
                                             t.data(),
                                             ends.read(),
                                             u.field()});
  EXPECT_EQ(u.y, (std::vector<double>{1, 1, 1, 1, 4, 6}));
}

TEST(Tiles, FindTheEntryOfEveryItem) {
  auto const first = view<Index>({0, 3, 4, 10, 11});
  int const expected[11] = {0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 3};
  for (int item = 0; item < 11; ++item) EXPECT_EQ(kernels::entry_of(first, item), expected[item]);
}

template <int Width>
void expect_copies() {
  Arrays u(20);
  for (int n = 0; n < 6; ++n) u.x[n] = n + 1;
  // A 3 x 2 face to nodes that run backwards, and a turned one.
  std::vector<kernels::NodeCopy> const list{{0, 1, 3, 15, -1, -3, 3, 2, -1}, {0, 1, 3, 16, 1, 2, 2, 2, 0}};
  using Copy = kernels::CopyNodes<Host, Width>;
  std::vector<Index> const first{0, Copy::items(list[0]), Copy::items(list[0]) + Copy::items(list[1])};
  Copy const kernel{view(list), view(first), view<Mat3>({Mat3{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}}), u.read(),
                    u.field()};
  for (Index item = 0; item < first.back(); ++item) kernel(item);
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 3; ++p) EXPECT_EQ(u.x[15 - p - 3 * q], p + 3 * q + 1);
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p) {
      EXPECT_EQ(u.x[16 + p + 2 * q], 0);
      EXPECT_EQ(u.y[16 + p + 2 * q], p + 3 * q + 1);
    }
}

TEST(NodeCopy, CopiesRangesWithStridesAndTurns) {
  expect_copies<1>();
  expect_copies<2>();
  expect_copies<128>();
}

TEST(NodeCopy, MovesKeepEveryBitOfANodeThatStays) {
  for (double const zero : {0.0, -0.0}) {
    EXPECT_TRUE(std::signbit(kernels::moved(-0.0, zero)));
    EXPECT_FALSE(std::signbit(kernels::moved(0.0, zero)));
    EXPECT_EQ(kernels::moved(1e-310, zero), 1e-310);
  }
  EXPECT_EQ(kernels::moved(1.5, 0.25), 1.75);
}

}  // namespace
}  // namespace gridmorph::test
