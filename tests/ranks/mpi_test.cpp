// What is of MPI: communicators of a program, and what belongs to whom.
#include <gridmorph/core/error.hpp>
#include <gridmorph/mpi/mpi_ranks.hpp>

#include "ranks/world.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace gridmorph::test {
namespace {

/// Those ranks of the world whose number has the remainder, and for the others no communicator, or what is left.
MPI_Comm every_other(int remainder, bool others_too) {
  int const own = world()->rank();
  bool const is_in = own % 2 == remainder;
  MPI_Comm comm = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, is_in ? 1 : others_too ? 0 : MPI_UNDEFINED, own, &comm);
  return comm;
}

Bytes one_byte(int value) { return {std::byte(value)}; }

/// A message of one byte from each rank to the next one.
struct Ring {
  std::array<std::byte, 1> out{}, in{};
  std::unique_ptr<Channel> channel;

  explicit Ring(Ranks const& ranks) {
    int const n = ranks.size();
    channel = ranks.channel({{(ranks.rank() + 1) % n, out}}, {{(ranks.rank() + n - 1) % n, in}});
  }
};

TEST(MpiRanks, OfAPartOfTheWorldAreItsRanks) {
  MPI_Comm comm = every_other(0, true);
  {
    auto const ranks = mpi_ranks(comm);
    int const n_world = world()->size(), own = world()->rank();
    EXPECT_EQ(ranks->size(), own % 2 == 0 ? (n_world + 1) / 2 : n_world / 2);
    EXPECT_EQ(ranks->rank(), own / 2);
    std::array<double, 1> largest{double(own)};
    ranks->largest(largest);
    EXPECT_EQ(largest[0], (own % 2 == 0 ? 2 * ((n_world + 1) / 2) - 2 : 2 * (n_world / 2) - 1));
    auto const packets = ranks->send({{(ranks->rank() + 1) % ranks->size(), one_byte(own)}});
    ASSERT_EQ(packets.size(), 1u);
    int const before = (ranks->rank() + ranks->size() - 1) % ranks->size();
    EXPECT_EQ(packets[0], (Packet{before, one_byte(2 * before + own % 2)}));
  }
  MPI_Comm_free(&comm);
}

TEST(MpiRanks, AreRefusedToProcessesThatAreNone) {
  MPI_Comm comm = every_other(0, false);
  if (comm == MPI_COMM_NULL)
    expect_all_in(message_of<ConfigError>([&] { (void)mpi_ranks(comm); }), {"MPI_COMM_NULL", "no rank of it"});
  else
    MPI_Comm_free(&comm);
}

TEST(MpiRanks, OfOneCommunicatorMixNoMessages) {
  auto const first = mpi_ranks(MPI_COMM_WORLD), second = mpi_ranks(MPI_COMM_WORLD);
  Ring a(*first), b(*first), c(*second);
  a.out[0] = std::byte(1);
  b.out[0] = std::byte(2);
  c.out[0] = std::byte(3);
  // The program's own messages, of the tag of packets and of the first channel, meet none of ours either.
  int const n = first->size(), next = (first->rank() + 1) % n, before = (first->rank() + n - 1) % n;
  std::array<std::array<char, 1>, 2> sent{{{4}, {5}}}, received{};
  std::array<MPI_Request, 4> requests{};
  for (int tag : {0, 1}) {
    MPI_Isend(sent[tag].data(), 1, MPI_BYTE, next, tag, MPI_COMM_WORLD, &requests[tag]);
    MPI_Irecv(received[tag].data(), 1, MPI_BYTE, before, tag, MPI_COMM_WORLD, &requests[2 + tag]);
  }
  for (Ring* ring : {&c, &b, &a}) ring->channel->exchange();
  auto const packets = second->send({{next, one_byte(6)}});
  MPI_Waitall(4, requests.data(), MPI_STATUSES_IGNORE);
  EXPECT_EQ(a.in, a.out);
  EXPECT_EQ(b.in, b.out);
  EXPECT_EQ(c.in, c.out);
  EXPECT_EQ(received, sent);
  EXPECT_EQ(packets, (std::vector<Packet>{{before, one_byte(6)}}));
}

TEST(MpiRanks, MessagesThatAreNotWaitedForYetStayWithTheirRanks) {
  auto const first = mpi_ranks(MPI_COMM_WORLD), second = mpi_ranks(MPI_COMM_WORLD);
  if (first->size() == 1) GTEST_SKIP() << "needs somebody to send to";
  std::array<std::byte, 3> out{std::byte(1), std::byte(2), std::byte(3)}, in{};
  bool const sends = first->rank() == 0, receives = first->rank() == 1;
  std::vector<std::unique_ptr<Channel>> channels;
  for (int n = 0; n < 3; ++n) {
    std::vector<Message> to, from;
    if (sends) to.push_back({1, std::span(out).subspan(n, 1)});
    if (receives) from.push_back({0, std::span(in).subspan(n, 1)});
    channels.push_back((n < 2 ? first : second)->channel(to, from));
  }
  // One byte leaves before it is waited for, with any MPI that we know. Taken in the other order they would be mixed if
  // tags or communicators were the same.
  if (sends)
    for (int n : {0, 1, 2}) channels[n]->exchange();
  if (receives) {
    for (int n : {2, 1, 0}) channels[n]->exchange();
    EXPECT_EQ(in, out);
  }
}

TEST(MpiRanks, TakeTheDuplicateOfThoseThatAreGone) {
  for (int time = 0; time < 300; ++time) {
    auto const ranks = mpi_ranks(MPI_COMM_WORLD);
    std::array<std::int64_t, 1> n{1};
    ranks->add(n);
    ASSERT_EQ(n[0], ranks->size());
  }
}

TEST(MpiRanks, SaySoWhereTheirCommunicatorWasFreed) {
  MPI_Comm comm = MPI_COMM_NULL;
  MPI_Comm_dup(MPI_COMM_WORLD, &comm);
  auto const ranks = mpi_ranks(comm);
  Ring ring(*ranks);
  MPI_Comm_free(&comm);
  std::array<double, 1> value{};
  expect_all_in(message_of<MachineError>([&] { ranks->largest(value); }), {"was freed"});
  expect_all_in(message_of<MachineError>([&] { ring.channel->exchange(); }), {"was freed"});
}

TEST(MpiRanks, AreMadeOnThreadsThatMpiExpects) {
  int level = 0;
  MPI_Query_thread(&level);
  if (level >= MPI_THREAD_SERIALIZED) GTEST_SKIP() << "any thread may";
  std::thread([] {
    expect_all_in(message_of<ConfigError>([] { (void)mpi_ranks(MPI_COMM_SELF); }), {"MPI_THREAD_SERIALIZED"});
  }).join();
}

TEST(MpiRanks, RefuseOptionsThatMpiCannotHave) {
  for (std::size_t const size : {std::size_t(0), std::size_t(1) << 31})
    expect_all_in(message_of<ConfigError>([&] { (void)mpi_ranks(MPI_COMM_WORLD, {.largest_message = size}); }),
                  {"largest_message", std::to_string(size)});
}

}  // namespace
}  // namespace gridmorph::test
