// Loops of host code over all threads.
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/index_buckets.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <vector>

namespace gridmorph::test {
namespace {

// An exception that leaves a thread ends the program.
TEST(ForAll, WhatABodyThrowsComesOutOfTheLoop) {
  for (auto const loop : {0, 1}) {
    std::atomic<Index> calls{0};
    auto const run = [&] {
      auto const body = [&](Index n) {
        ++calls;
        if (n % 7 == 3) throw MeshError("at " + std::to_string(n));
      };
      if (loop == 0)
        detail::for_all({}, "test", 100, body);
      else
        detail::for_all_parts({}, "test", 100, body);
    };
    EXPECT_EQ(message_of<MeshError>(run), "at 3") << "what the first number threw, whatever the number of threads";
    EXPECT_EQ(calls, 100);
  }
}

TEST(ForAll, MemoryThatRunsOutInALoopIsAnErrorOfWhoAskedForIt) {
  EXPECT_THROW(detail::for_all({}, "test", 8, [](Index) { throw std::bad_alloc(); }), std::bad_alloc);
  detail::IndexBuckets<int> const buckets({}, "test", 5000, 3000,
                                          [](Index item, auto const& put) { put(Index32(item % 3000), int(item)); });
  EXPECT_THROW(buckets.for_each_key([](Index32, Index, std::span<int>) { throw std::bad_alloc(); }), std::bad_alloc);
}

}  // namespace
}  // namespace gridmorph::test
