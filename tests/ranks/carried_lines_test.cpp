// Sums along lines that many ranks have parts of are those of one rank, to the bit.
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/carried_lines.hpp>

#include "ranks/world.hpp"
#include "support/expect_error.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>

namespace gridmorph::test {
namespace {

/// Lines with lengths of very different size, whose sums depend on their order.
std::vector<std::vector<double>> drawn_lines(int n_lines, int longest, Random& random) {
  std::vector<std::vector<double>> out(n_lines);
  for (auto& line : out) {
    line.resize(1 + random.below(longest));
    for (double& length : line) length = std::exp(random.between(-12, 3));
  }
  return out;
}

/// Lines cut at random places, as many segments on average, and each given to a random rank: those of one of them.
struct CutLines {
  std::vector<LineSegment> segments;
  std::vector<std::pair<int, int>> steps;  ///< from and to, of each

  CutLines(std::vector<std::vector<double>> const& lines, double n_cuts, Ranks const& ranks, Random& random) {
    for (int n = 0; n < int(lines.size()); ++n) {
      int const end = int(lines[n].size());
      for (int from = 0, to = 0; from < end; from = to) {
        to = from + 1;
        while (to < end && random.unit() > n_cuts / end) ++to;
        if (random.below(ranks.size()) != ranks.rank()) continue;
        segments.push_back({3 * n, from});  // numbers of lines have gaps
        steps.emplace_back(from, to);
      }
    }
  }
};

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

/// Compares the totals, and the sums on the way, with serial ones.
void expect_serial_sums(std::vector<std::vector<double>> const& lines, CutLines const& cut, CarriedLines& carried) {
  int n_differ = 0;
  auto const totals = carried.totals([&](std::span<Index const> segments, std::span<double> sums) {
    for (Index const s : segments) {
      auto const& line = lines[cut.segments[s].line / 3];
      n_differ += bits(sums[s]) != bits(std::accumulate(line.begin(), line.begin() + cut.steps[s].first, 0.0));
      for (int n = cut.steps[s].first; n < cut.steps[s].second; ++n) sums[s] += line[n];
    }
  });
  ASSERT_EQ(totals.size(), cut.segments.size());
  for (std::size_t s = 0; s < totals.size(); ++s) {
    auto const& line = lines[cut.segments[s].line / 3];
    n_differ += bits(totals[s]) != bits(std::accumulate(line.begin(), line.end(), 0.0));
  }
  EXPECT_EQ(n_differ, 0) << "of " << totals.size();
}

TEST(CarriedLines, HaveTheBitsOfSerialSums) {
  auto const ranks = world();
  Random random(3);
  for (double const n_cuts : {0.0, 1.0, 3.0, 20.0}) {
    auto const lines = drawn_lines(400, 150, random);
    CutLines const cut(lines, n_cuts, *ranks, random);
    CarriedLines carried(ranks, cut.segments);
    for (int time = 0; time < 2; ++time) expect_serial_sums(lines, cut, carried);
  }
}

TEST(CarriedLines, AreInAnyOrderOnTheirRank) {
  auto const ranks = world();
  Random random(4);
  auto const lines = drawn_lines(50, 60, random);
  CutLines cut(lines, 5, *ranks, random);
  std::vector<int> order(cut.segments.size());
  std::iota(order.begin(), order.end(), 0);
  Random(unsigned(10 + ranks->rank())).shuffle(order);  // another order on each rank
  CutLines const before = cut;
  for (std::size_t n = 0; n < order.size(); ++n) {
    cut.segments[n] = before.segments[order[n]];
    cut.steps[n] = before.steps[order[n]];
  }
  CarriedLines carried(ranks, cut.segments);
  expect_serial_sums(lines, cut, carried);
}

TEST(CarriedLines, TakeAsManyRoundsAsTheLongestLineHasSegments) {
  auto const ranks = world();
  std::vector<LineSegment> own{{7, ranks->rank()}};
  if (ranks->rank() == 0) own.push_back({8, 0});
  EXPECT_EQ(CarriedLines(ranks, own).n_rounds(), ranks->size());
  EXPECT_EQ(CarriedLines(ranks, {}).n_rounds(), 0);
  EXPECT_TRUE(CarriedLines(ranks, {}).totals({}).empty());
}

TEST(CarriedLines, RefuseTwoSegmentsAtOnePlace) {
  auto const ranks = world();
  std::vector<LineSegment> own;
  if (ranks->rank() == 0) own = {{5, 20}, {6, 20}};
  if (ranks->rank() == ranks->size() - 1) own.push_back({5, 20});
  expect_all_in(message_of<PlanError>([&] { CarriedLines(ranks, own); }), {"line 5", "place 20"});
}

TEST(CarriedLines, FailOnAllRanksWhereOneFails) {
  auto const ranks = world();
  CarriedLines carried(ranks, std::vector<LineSegment>{{0, ranks->rank()}});
  int const thrower = ranks->size() / 2;
  auto const go_on = [&](std::span<Index const>, std::span<double>) {
    if (ranks->rank() == thrower) throw PlanError("no line");
  };
  expect_all_in(message_of<PlanError>([&] { (void)carried.totals(go_on); }), {"no line"});
  EXPECT_EQ(carried.totals([](std::span<Index const>, std::span<double> sums) { sums[0] += 1; })[0], ranks->size());
}

}  // namespace
}  // namespace gridmorph::test
