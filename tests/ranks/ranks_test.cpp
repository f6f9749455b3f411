// What ranks tell one another arrives, and errors of one are errors of all.
#include <gridmorph/core/error.hpp>

#include "ranks/world.hpp"
#include "support/expect_error.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <new>
#include <string>

namespace gridmorph::test {
namespace {

/// What rank `from` tells rank `to`: other bytes for every pair and every time.
Bytes words(int from, int to, std::size_t size, int time = 0) {
  Bytes out(size);
  for (std::size_t n = 0; n < size; ++n) out[n] = std::byte((n * 31 + n / 256 + 7 * from + 11 * to + 13 * time) & 255);
  return out;
}

TEST(Ranks, LargestIsTakenEntryByEntry) {
  auto const ranks = world();
  std::array<double, 3> values{double(ranks->rank()), -double(ranks->rank()), 0.1};
  ranks->largest(values);
  EXPECT_EQ(values, (std::array<double, 3>{ranks->size() - 1.0, 0.0, 0.1}));
}

TEST(Ranks, CountsAreAddedEntryByEntryBeyondThirtyTwoBits) {
  auto const ranks = world();
  std::vector<std::int64_t> values(1000, std::int64_t(1) << 40);
  values[17] = ranks->rank();
  ranks->add(values);
  std::int64_t const n = ranks->size();
  EXPECT_EQ(values[16], n << 40);
  EXPECT_EQ(values[17], n * (n - 1) / 2);
}

TEST(Ranks, GatherWhatEachOfThemHas) {
  auto const ranks = world();
  auto const size_of = [](int rank) { return std::size_t(rank % 3 == 1 ? 0 : 1000 * rank + 5); };
  auto const all = ranks->gather(words(ranks->rank(), 0, size_of(ranks->rank())));
  ASSERT_EQ(int(all.size()), ranks->size());
  for (int r = 0; r < ranks->size(); ++r) EXPECT_EQ(all[r], words(r, 0, size_of(r))) << r;
}

/// Sizes of packets from each rank to each: none, empty, small and large ones.
std::vector<std::vector<int>> drawn_sizes(int n_ranks, Random& random) {
  std::vector<std::vector<int>> out(n_ranks, std::vector<int>(n_ranks));
  for (auto& row : out)
    for (int& size : row) {
      std::array<int, 5> const sizes{-1, -1, 0, random.below(100), random.below(200000)};
      size = sizes[random.below(5)];
    }
  return out;
}

TEST(Ranks, SendPacketsToSomeOfThem) {
  auto const ranks = world();
  int const own = ranks->rank(), n = ranks->size();
  Random random(1);                        // the same numbers on all ranks
  for (int time = 0; time < 20; ++time) {  // nothing waits between them: none may arrive in the next one
    auto const sizes = drawn_sizes(n, random);
    std::vector<Packet> out, expected;
    for (int r = n; r-- > 0;)
      if (sizes[own][r] >= 0) out.push_back({r, words(own, r, sizes[own][r], time)});
    for (int r = 0; r < n; ++r)
      if (sizes[r][own] >= 0) expected.push_back({r, words(r, own, sizes[r][own], time)});
    EXPECT_EQ(ranks->send(out), expected) << "time " << time;
  }
}

TEST(Ranks, SendNothingAtAll) { EXPECT_TRUE(world()->send({}).empty()); }

TEST(Ranks, RefusePacketsThatCannotBeSent) {
  auto const ranks = world();
  std::vector<Packet> twice{{0, {}}, {0, {}}}, nowhere{{ranks->size(), {}}};
  if (ranks->rank() != ranks->size() - 1) twice = nowhere = {};
  expect_all_in(message_of<ConfigError>([&] { (void)ranks->send(twice); }), {"two packets to rank 0"});
  expect_all_in(message_of<ConfigError>([&] { (void)ranks->send(nowhere); }),
                {"no rank " + std::to_string(ranks->size())});
}

/// Buffers of the messages between all pairs, two each way of which one may be empty.
struct Buffers {
  std::vector<Bytes> out, in;
  std::vector<Message> out_messages, in_messages;

  explicit Buffers(Ranks const& ranks) : out(2 * ranks.size()), in(2 * ranks.size()) {
    for (int r = 0; r < ranks.size(); ++r)
      for (int n : {2 * r, 2 * r + 1}) {
        out[n].resize(size(ranks.rank(), r, n % 2));
        in[n].resize(size(r, ranks.rank(), n % 2));
        out_messages.push_back({r, out[n]});
        in_messages.push_back({r, in[n]});
      }
  }
  static std::size_t size(int from, int to, int n) { return std::size_t(n == 0 ? 1000 + from : 10000 * (to % 2)); }
  void write(Ranks const& ranks, int time) {
    for (int n = 0; n < int(out.size()); ++n)
      std::ranges::copy(words(ranks.rank(), n / 2, out[n].size(), time + n % 2), out[n].begin());
  }
  void expect(Ranks const& ranks, int time) const {
    for (int n = 0; n < int(in.size()); ++n)
      EXPECT_EQ(in[n], words(n / 2, ranks.rank(), in[n].size(), time + n % 2)) << "rank " << n / 2 << " time " << time;
  }
};

TEST(Channel, BringsMessagesAgainAndAgain) {
  auto const ranks = world();
  Buffers buffers(*ranks);
  auto const channel = ranks->channel(buffers.out_messages, buffers.in_messages);
  for (int time = 0; time < 50; ++time) {
    buffers.write(*ranks, time);
    channel->exchange();
    buffers.expect(*ranks, time);
  }
}

TEST(Channel, BringsItsOwnMessagesOnly) {
  auto const ranks = world();
  Buffers first(*ranks), second(*ranks);
  auto const a = ranks->channel(first.out_messages, first.in_messages);
  auto const b = ranks->channel(second.out_messages, second.in_messages);
  first.write(*ranks, 100);
  second.write(*ranks, 200);
  b->exchange();
  (void)ranks->send({{0, words(0, 0, 10)}});
  a->exchange();
  first.expect(*ranks, 100);
  second.expect(*ranks, 200);
}

TEST(Channel, OfRanksWithoutMessagesWaitsForNobody) {
  auto const ranks = world();
  auto const channel = ranks->channel({}, {});
  for (int time = 0; time <= ranks->rank(); ++time) channel->exchange();
}

TEST(Channel, RefusesMessagesThatDoNotFit) {
  auto const ranks = world();
  Buffers buffers(*ranks);
  if (ranks->rank() == 0) buffers.in_messages.back().bytes = std::span(buffers.in[0]).first(3);
  expect_all_in(message_of<ConfigError>([&] { (void)ranks->channel(buffers.out_messages, buffers.in_messages); }),
                {"not those that are waited for"});
  if (ranks->rank() == 0) buffers.in_messages.back().rank = -1;
  expect_all_in(message_of<ConfigError>([&] { (void)ranks->channel(buffers.out_messages, buffers.in_messages); }),
                {"no rank -1"});
}

/// The words after "rank N: " where there are several ranks; those of one are its own.
std::string said_by(Ranks const& ranks, int rank, std::string const& what) {
  return ranks.size() == 1 ? what : "rank " + std::to_string(rank) + ": " + what;
}

template <class E>
void expect_thrown_by_each() {
  auto const ranks = world();
  for (int thrower = 0; thrower < ranks->size(); ++thrower) {
    auto const work = [&] {
      if (ranks->rank() == thrower) throw E("zone 'A' is\nno zone");
      return 1;
    };
    EXPECT_EQ(message_of<E>([&] { together(*ranks, work); }), said_by(*ranks, thrower, "zone 'A' is\nno zone"));
  }
}

TEST(Together, AllThrowWhatOneThrows) {
  expect_thrown_by_each<MeshError>();
  expect_thrown_by_each<ConfigError>();
  expect_thrown_by_each<IoError>();
  expect_thrown_by_each<MachineError>();
  expect_thrown_by_each<Error>();
  expect_thrown_by_each<std::runtime_error>();
}

TEST(Together, TheLowestRankIsTheOneThatIsHeard) {
  auto const ranks = world();
  int const lowest = ranks->size() / 3;
  auto const work = [&] {
    if (ranks->rank() >= lowest) throw PlanError("chain " + std::to_string(ranks->rank()));
  };
  EXPECT_EQ(message_of<PlanError>([&] { together(*ranks, work); }),
            said_by(*ranks, lowest, "chain " + std::to_string(lowest)));
}

TEST(Together, MemoryThatRunsOutOnARankIsAFailureOfTheMachine) {
  auto const ranks = world();
  if (ranks->size() == 1) GTEST_SKIP() << "one process has its exception itself";
  auto const work = [&] {
    if (ranks->rank() == 1) throw std::bad_alloc();
  };
  expect_all_in(message_of<MachineError>([&] { together(*ranks, work); }), {"rank 1: out of memory"});
}

TEST(Together, ReturnsWhatTheWorkOfEachReturns) {
  auto const ranks = world();
  EXPECT_EQ(together(*ranks, [&] { return std::to_string(ranks->rank()); }), std::to_string(ranks->rank()));
  together(*ranks, [] {});
}

}  // namespace
}  // namespace gridmorph::test
