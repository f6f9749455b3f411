// The correction of a row of nodes against the Boolean sum written out node by node.
#include "kernels/tables.hpp"

#include <gridmorph/kernels/row_correction.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace gridmorph::test {
namespace {

using kernels::Chain;

/// A chain of n_s x n_a x n_b nodes with residuals at random on its sides, whose lines are spaced at random too.
struct RandomChain {
  Chain chain{};
  std::array<std::vector<std::vector<double>>, 4> t;       ///< per side and line
  std::array<std::vector<std::vector<Vec3>>, 4> residual;  ///< per side and line
  std::array<std::vector<double>, 4> section;              ///< A at s = 0, A at s = 1, B, B
  std::mt19937 random;

  RandomChain(std::array<int, 3> n, unsigned known_sides, double unevenness, unsigned seed) : random(seed) {
    chain.n_s = n[0];
    chain.n_a = n[1];
    chain.n_b = n[2];
    chain.known_sides = known_sides;
    for (int side = 0; side < 4; ++side)
      for (int w = 0; w < (side < 2 ? n[2] : n[1]); ++w) {
        t[side].push_back(spacing(unevenness));
        residual[side].emplace_back();
        for (int s = 0; s < n[0]; ++s) residual[side].back().push_back({value(), value(), value()});
      }
    for (auto& fractions : section)
      for (int m = 0; m < n[1] * n[2]; ++m) fractions.push_back(0.5 + 0.5 * value());
  }
  double value() { return std::uniform_real_distribution<>(-1, 1)(random); }

  /// Fractions of a line, 0 and 1 at its ends: even ones, moved by a part of their spacing.
  std::vector<double> spacing(double unevenness) {
    std::vector<double> f;
    int const last = chain.n_s - 1;
    for (int s = 0; s <= last; ++s) f.push_back((s + (s == 0 || s == last ? 0 : 0.49 * unevenness * value())) / last);
    return f;
  }

  Vec3 at(int side, int w, double fraction) const {
    auto const& f = t[side][w];
    auto const upper = std::min(std::size_t(std::upper_bound(f.begin(), f.end(), fraction) - f.begin()), f.size() - 1);
    double const g = (fraction - f[upper - 1]) / (f[upper] - f[upper - 1]);
    return (1 - g) * residual[side][w][upper - 1] + g * residual[side][w][upper];
  }
  Vec3 boolean_sum(int a, int b, double fraction) const {
    std::size_t const m = std::size_t(a) + std::size_t(chain.n_a) * std::size_t(b);
    double const A = (1 - fraction) * section[0][m] + fraction * section[1][m];
    double const B = (1 - fraction) * section[2][m] + fraction * section[3][m];
    double const of_side[4] = {1 - A, A, 1 - B, B};
    bool const two = chain.blends_along(0) || chain.blends_along(1);
    Vec3 sum;
    for (int side = 0; side < 4; ++side) {
      bool const counts =
          two ? chain.blends_along(side / 2) && chain.side_matters(side) : ((chain.known_sides >> side) & 1u) != 0;
      if (counts) sum += of_side[side] * at(side, side < 2 ? b : a, fraction);
    }
    for (int e = 0; e < 4 && !two; ++e)
      if ((chain.known_sides >> (4 + e)) & 1u)
        sum += (of_side[e % 2] * of_side[2 + e / 2]) * at(e % 2, e < 2 ? 0 : chain.n_b - 1, fraction);
    return sum;
  }
};

/// The same chain as kernels see it.
struct Tables {
  kernels::SideTable<Host> table;
  Arrays residuals{0};

  /// across: with second copies of all sides, line by line.
  Tables(RandomChain& r, bool across) {
    std::vector<kernels::Side> sides;
    std::vector<double> t, per_t, section;
    auto const add = [&](int side, std::size_t w, int s) {
      auto const& f = r.t[side][w];
      t.push_back(f[s]);
      per_t.push_back(s + 1 < r.chain.n_s ? 1 / (f[s + 1] - f[s]) : 0);
      Vec3 const c = r.residual[side][w][s];
      residuals.x.push_back(c.x);
      residuals.y.push_back(c.y);
      residuals.z.push_back(c.z);
    };
    for (int side = 0; side < 4; ++side) {
      sides.push_back({0, int(r.t[side].size()), kernels::Index(t.size())});
      for (std::size_t w = 0; w < r.t[side].size(); ++w)
        for (int s = 0; s < r.chain.n_s; ++s) add(side, w, s);
    }
    for (int side = 0; side < 4 && across; ++side) {
      sides[side].across = kernels::Index(t.size());
      for (int s = 0; s < r.chain.n_s; ++s)
        for (std::size_t w = 0; w < r.t[side].size(); ++w) add(side, w, s);
    }
    for (auto const& fractions : r.section) section.insert(section.end(), fractions.begin(), fractions.end());
    table = {view(sides), {}, view(t), view(per_t), view(section), residuals.read()};
  }
};

/// All rows inside a chain in one direction (0: along s, 1: a, 2: b), up or down, of at most `width` nodes.
template <int width>
void expect_boolean_sum(RandomChain& r, int direction, int step, double unevenness, bool across) {
  Tables const tables(r, across);
  int const n[3] = {r.chain.n_s, r.chain.n_a, r.chain.n_b};
  for (int p = 1; p < n[(direction + 1) % 3] - 1; ++p)
    for (int q = 1; q < n[(direction + 2) % 3] - 1; ++q) {
      int at[3], d[3] = {0, 0, 0};
      d[direction] = step;
      at[(direction + 1) % 3] = p;
      at[(direction + 2) % 3] = q;
      int const inside = n[direction] - 2;
      at[direction] = step > 0 ? 1 : inside;
      int const length = std::min(inside, width);
      std::vector<double> t;
      auto const along = r.spacing(unevenness);
      for (int w = 0; w < length; ++w)
        t.push_back(direction == 0 ? along[at[0] + w * step] : r.spacing(unevenness)[at[0]]);
      kernels::VectorRow<width> v{};
      kernels::RowCorrection<Host, width>{tables.table, r.chain, at[0], d[0],     at[1],
                                          d[1],         at[2],   d[2],  t.data(), length}
          .add_to(v);
      for (int w = 0; w < length; ++w) {
        Vec3 const expected = r.boolean_sum(at[1] + w * d[1], at[2] + w * d[2], t[w]);
        EXPECT_NEAR(v.x[w], expected.x, 1e-13);
        EXPECT_NEAR(v.y[w], expected.y, 1e-13);
        EXPECT_NEAR(v.z[w], expected.z, 1e-13);
      }
    }
}

TEST(RowCorrection, IsTheBooleanSumInEveryDirection) {
  constexpr unsigned all = 255, two_a = 3 | 240, two_b = 12 | 240, one_side = 4, edges_only = 240, mixed = 1 | 8 | 64;
  unsigned seed = 0;
  for (unsigned const known : {all, two_a, two_b, one_side, edges_only, mixed})
    // Rows on the knots, around them by rounding and by more, all over.
    for (double const unevenness : {0.0, 1e-15, 0.01, 1.0})
      for (int direction = 0; direction < 3; ++direction)
        for (int const step : {1, -1}) {
          RandomChain chain({17, 23, 15}, known, unevenness, ++seed);  // groups of 8 and 4 nodes, and some left
          expect_boolean_sum<32>(chain, direction, step, unevenness, true);
          expect_boolean_sum<32>(chain, direction, step, unevenness, false);
          expect_boolean_sum<1>(chain, direction, step, unevenness, false);
        }
}

/// A row in which t rises by a known part of an interval from node to node, so that groups lie in one pair of
/// intervals, come to the next, or to the one after.
TEST(RowCorrection, FollowsRowsThatRunThroughIntervals) {
  for (double const part : {0.01, 0.06, 0.2, 0.7, -0.06, -0.2}) {
    RandomChain chain({33, 40, 5}, 255, 0.3, 11);
    Tables const tables(chain, true);
    std::vector<double> t;
    for (int w = 0; w < 38; ++w) t.push_back(((part > 0 ? 2.3 : 30.4) + part * w) / 32);
    kernels::VectorRow<64> v{};
    kernels::RowCorrection<Host, 64>{tables.table, chain.chain, 16, 0, 1, 1, 2, 0, t.data(), 38}.add_to(v);
    for (int w = 0; w < 38; ++w) EXPECT_NEAR(v.z[w], chain.boolean_sum(1 + w, 2, t[w]).z, 1e-13) << part << ' ' << w;
  }
}

TEST(RowCorrection, ReadsLinesOfTwoNodes) {
  RandomChain chain({2, 5, 4}, 255, 0, 3);
  Tables const tables(chain, true);
  double const t[3] = {0.25, 0.5, 0.75};
  kernels::VectorRow<4> v{};
  kernels::RowCorrection<Host, 4>{tables.table, chain.chain, 0, 0, 1, 1, 2, 0, t, 3}.add_to(v);
  for (int w = 0; w < 3; ++w) EXPECT_NEAR(v.y[w], chain.boolean_sum(1 + w, 2, t[w]).y, 1e-13);
}

}  // namespace
}  // namespace gridmorph::test
