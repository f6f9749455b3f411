// The processes that share out a mesh among themselves, and what they tell one another. No MPI here: gridmorph::mpi
// makes Ranks of a communicator (mpi/mpi_ranks.hpp), a program of one process has Ranks::alone().
//
// These calls are for planning and for files: they block, work on memory of the host and, but for rank(), size() and
// give_up(), are collective: every rank makes them, in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gridmorph {

using Bytes = std::vector<std::byte>;

/// The items as they lie in memory: ranks are machines of one kind.
template <class T>
Bytes to_bytes(std::vector<T> const& items) {
  static_assert(std::is_trivially_copyable_v<T>);
  auto const bytes = std::as_bytes(std::span(items));
  return {bytes.begin(), bytes.end()};
}
/// The items that to_bytes() was given.
template <class T>
std::vector<T> from_bytes(std::span<std::byte const> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!items.empty()) std::memcpy(items.data(), bytes.data(), items.size() * sizeof(T));
  return items;
}

/// Bytes on their way to a rank, or from it.
struct Packet {
  int rank = -1;
  Bytes bytes{};

  friend bool operator==(Packet const&, Packet const&) = default;
};

/// A packet for each rank of what there is for it.
template <class T>
std::vector<Packet> to_packets(std::map<int, std::vector<T>> const& items_by_rank) {
  std::vector<Packet> out;
  out.reserve(items_by_rank.size());
  for (auto const& [rank, items] : items_by_rank) out.push_back({rank, to_bytes(items)});
  return out;
}

/// Where a message of fixed size lies, to a rank or from it. The memory is the caller's and outlives the Channel.
struct Message {
  int rank = -1;
  std::span<std::byte> bytes;
};

/// Messages of fixed sizes between fixed ranks, again and again. Made by Ranks::channel(), which is collective; its end
/// is not.
class Channel {
 public:
  Channel() = default;
  Channel(Channel const&) = delete;
  Channel& operator=(Channel const&) = delete;
  virtual ~Channel() = default;

  /// Sends what lies in the messages out and returns when those in are there and those out may be written again. Called
  /// by the ranks that have messages, as often by each as by those it has them with; waits for no others.
  virtual void exchange() = 0;
};

/// All ranks of a program, seen from one of them.
class Ranks {
 public:
  /// One process without others.
  [[nodiscard]] static std::shared_ptr<Ranks const> alone();

  Ranks() = default;
  Ranks(Ranks const&) = delete;
  Ranks& operator=(Ranks const&) = delete;
  virtual ~Ranks() = default;

  [[nodiscard]] virtual int rank() const = 0;  ///< of this process, from 0
  [[nodiscard]] virtual int size() const = 0;  ///< number of ranks

  /// Makes each entry the largest that a rank has there. As many entries on all ranks, none of them NaN.
  virtual void largest(std::span<double> values) const = 0;
  /// Makes each entry the sum of those that the ranks have there. As many entries on all ranks.
  virtual void add(std::span<std::int64_t> values) const = 0;
  /// What each rank handed over, by rank, on all of them.
  [[nodiscard]] virtual std::vector<Bytes> gather(std::span<std::byte const> own) const = 0;

  /// Hands packets over to ranks, at most one to each, and returns those that ranks had for this one, by rank. Packets
  /// may be empty, and arrive. Throws ConfigError, on all ranks, where one names a rank twice or one that is not there.
  /// Cost: beside the packets 8 bytes per rank, on each.
  [[nodiscard]] std::vector<Packet> send(std::vector<Packet> packets) const;

  /// Joins the n-th message out to a rank with the n-th in that this rank has from here. Throws ConfigError, on all
  /// ranks, where numbers or sizes differ, or a rank is not there.
  [[nodiscard]] std::unique_ptr<Channel> channel(std::vector<Message> const& out, std::vector<Message> const& in) const;

  /// Ends all processes, after a line on the standard error: for what one rank alone knows while the others wait for
  /// it. Not collective.
  [[noreturn]] virtual void give_up(std::string_view why) const = 0;

 private:
  virtual std::vector<Packet> deliver(std::vector<Packet> packets) const = 0;
  virtual std::unique_ptr<Channel> connect(std::vector<Message> const& out, std::vector<Message> const& in) const = 0;
};

namespace detail {

/// Throws on all ranks what the lowest of those that have thrown something threw; nothing where none has.
void throw_together(Ranks const& ranks, std::exception_ptr const& thrown);

}  // namespace detail

/// Runs work that is no other rank's matter: it makes no collective calls. Where it throws on any rank, all throw what
/// it threw on the lowest of them: an error of the same class with the same words after "rank 17: ", memory that has
/// run out as a MachineError, exceptions that are not the library's as std::runtime_error. Where there is one rank
/// alone, its exception itself. Elsewhere errors stay on their rank while the others wait, so each phase that reads,
/// checks or allocates stands in such a call. Cost: one largest().
template <class Work>
auto together(Ranks const& ranks, Work&& work) {
  using Result = std::invoke_result_t<Work>;
  std::exception_ptr thrown;
  if constexpr (std::is_void_v<Result>) {
    try {
      std::forward<Work>(work)();
    } catch (...) {
      thrown = std::current_exception();
    }
    detail::throw_together(ranks, thrown);
  } else {
    std::optional<Result> result;
    try {
      result.emplace(std::forward<Work>(work)());
    } catch (...) {
      thrown = std::current_exception();
    }
    detail::throw_together(ranks, thrown);
    return *std::move(result);
  }
}

}  // namespace gridmorph
