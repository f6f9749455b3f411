#include <gridmorph/core/error.hpp>
#include <gridmorph/core/ranks.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <new>
#include <stdexcept>
#include <string>

namespace gridmorph {

namespace {

/// Copies what a process has for itself.
class ChannelToItself final : public Channel {
 public:
  ChannelToItself(std::vector<Message> out, std::vector<Message> in) : out_(std::move(out)), in_(std::move(in)) {}
  void exchange() override {
    for (std::size_t n = 0; n < out_.size(); ++n)
      std::copy(out_[n].bytes.begin(), out_[n].bytes.end(), in_[n].bytes.begin());
  }

 private:
  std::vector<Message> out_, in_;
};

class OneProcess final : public Ranks {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 1; }
  void largest(std::span<double>) const override {}
  void add(std::span<std::int64_t>) const override {}
  [[nodiscard]] std::vector<Bytes> gather(std::span<std::byte const> own) const override {
    return {Bytes(own.begin(), own.end())};
  }
  [[noreturn]] void give_up(std::string_view why) const override {
    std::fprintf(stderr, "gridmorph: %.*s\n", int(why.size()), why.data());
    std::_Exit(EXIT_FAILURE);
  }

 private:
  std::vector<Packet> deliver(std::vector<Packet> packets) const override { return packets; }
  std::unique_ptr<Channel> connect(std::vector<Message> const& out, std::vector<Message> const& in) const override {
    return std::make_unique<ChannelToItself>(out, in);
  }
};

void check_rank(Ranks const& ranks, int rank, char const* who) {
  if (rank < 0 || rank >= ranks.size())
    throw ConfigError(std::string(who) + ": there is no rank " + std::to_string(rank) + ", they go from 0 to " +
                      std::to_string(ranks.size() - 1));
}

/// For each rank that messages have to do with their sizes, in the order of the messages.
std::vector<Packet> sizes_by_rank(std::vector<Message> const& messages) {
  std::map<int, std::vector<std::uint64_t>> sizes;
  for (Message const& m : messages) sizes[m.rank].push_back(m.bytes.size());
  return to_packets(sizes);
}

// An error travels as the number of its class, a character, and its words.

template <class E>
[[noreturn]] void throw_as(std::string const& what) {
  throw E(what);
}
struct ErrorClass {
  bool (*holds)(std::exception const&);
  void (*throw_as)(std::string const&);
};
template <class E>
constexpr ErrorClass class_of{[](std::exception const& e) { return dynamic_cast<E const*>(&e) != nullptr; },
                              &throw_as<E>};
/// The first that an error is of is its class.
constexpr ErrorClass error_classes[] = {class_of<MeshError>,   class_of<MotionError>,       class_of<PlanError>,
                                        class_of<ConfigError>, class_of<IoError>,           class_of<MachineError>,
                                        class_of<Error>,       class_of<std::runtime_error>};

std::string in_words(std::exception const& e) {
  std::size_t number = 0;
  while (number + 1 < std::size(error_classes) && !error_classes[number].holds(e)) ++number;
  return char(number) + std::string(e.what());
}

std::string in_words(std::exception_ptr const& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (std::bad_alloc const&) {
    return in_words(MachineError("out of memory; use more machines, or a smaller mesh"));
  } catch (std::exception const& e) {
    return in_words(e);
  } catch (...) {
    return in_words(std::runtime_error("something that is no exception was thrown"));
  }
}

}  // namespace

std::shared_ptr<Ranks const> Ranks::alone() {
  static auto const one = std::make_shared<OneProcess const>();
  return one;
}

std::vector<Packet> Ranks::send(std::vector<Packet> packets) const {
  std::sort(packets.begin(), packets.end(), [](Packet const& a, Packet const& b) { return a.rank < b.rank; });
  together(*this, [&] {
    for (std::size_t n = 0; n < packets.size(); ++n) {
      check_rank(*this, packets[n].rank, "gridmorph::Ranks::send");
      if (n > 0 && packets[n].rank == packets[n - 1].rank)
        throw ConfigError("gridmorph::Ranks::send: two packets to rank " + std::to_string(packets[n].rank) +
                          "; put into one what a rank is to get");
    }
  });
  return deliver(std::move(packets));
}

std::unique_ptr<Channel> Ranks::channel(std::vector<Message> const& out, std::vector<Message> const& in) const {
  together(*this, [&] {
    for (auto const* messages : {&out, &in})
      for (Message const& m : *messages) check_rank(*this, m.rank, "gridmorph::Ranks::channel");
  });
  std::vector<Packet> const sent = send(sizes_by_rank(out));
  together(*this, [&] {
    if (sent != sizes_by_rank(in))
      throw ConfigError(
          "gridmorph::Ranks::channel: the messages that others send here are not those that are waited for; both ends "
          "name them in the same order, with the same numbers of bytes");
  });
  return connect(out, in);
}

namespace detail {

void throw_together(Ranks const& ranks, std::exception_ptr const& thrown) {
  if (ranks.size() == 1) {
    if (thrown) std::rethrow_exception(thrown);
    return;
  }
  double lowest = -(thrown ? ranks.rank() : ranks.size());
  ranks.largest({&lowest, 1});
  int const thrower = int(-lowest);
  if (thrower == ranks.size()) return;
  std::string const own = thrower == ranks.rank() ? in_words(thrown) : std::string();
  Bytes const told = ranks.gather(std::as_bytes(std::span(own)))[std::size_t(thrower)];
  std::string const words(reinterpret_cast<char const*>(told.data()), told.size());
  error_classes[std::to_integer<std::size_t>(told.front())].throw_as("rank " + std::to_string(thrower) + ": " +
                                                                     words.substr(1));
}

}  // namespace detail

}  // namespace gridmorph
