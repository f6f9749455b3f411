#include <gridmorph/core/error.hpp>
#include <gridmorph/mpi/mpi_ranks.hpp>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace gridmorph {

namespace {

/// Throws what MPI says of a call that failed; only communicators whose errors the program wants returned come so far.
void require(int code, char const* call) {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  throw MachineError(std::string("gridmorph::mpi: ") + call + " failed: " + std::string(text.data(), length));
}

/// A duplicate of the program's communicator, for one Ranks and its Channels at a time; they hold a pointer to it.
struct Duplicate {
  MPI_Comm comm = MPI_COMM_NULL;

  [[nodiscard]] MPI_Comm get() const {
    if (comm == MPI_COMM_NULL)
      throw MachineError(
          "gridmorph::mpi: the communicator that these ranks were made of was freed; free it after them");
    return comm;
  }
};

/// All duplicates of a communicator, in the order in which they were made, which is that of every rank.
using Duplicates = std::vector<std::shared_ptr<Duplicate>>;

/// Called by MPI_Comm_free() of the program's communicator, on all its ranks.
extern "C" int gridmorph_free_duplicates(MPI_Comm, int, void* attribute, void*) {
  std::unique_ptr<Duplicates> const all(static_cast<Duplicates*>(attribute));
  int code = MPI_SUCCESS;
  for (auto const& one : *all)
    if (int const result = MPI_Comm_free(&one->comm); result != MPI_SUCCESS) code = result;
  return code;
}

Duplicates& duplicates_of(MPI_Comm comm) {
  static int const key = [] {
    int made = MPI_KEYVAL_INVALID;
    require(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, gridmorph_free_duplicates, &made, nullptr),
            "MPI_Comm_create_keyval");
    return made;
  }();
  void* attribute = nullptr;
  int is_there = 0;
  require(MPI_Comm_get_attr(comm, key, static_cast<void*>(&attribute), &is_there), "MPI_Comm_get_attr");
  if (is_there != 0) return *static_cast<Duplicates*>(attribute);
  auto made = std::make_unique<Duplicates>();
  require(MPI_Comm_set_attr(comm, key, made.get()), "MPI_Comm_set_attr");
  return *made.release();
}

/// A duplicate that nobody uses on any rank: the first such, or a new one.
std::shared_ptr<Duplicate> free_duplicate(MPI_Comm comm) {
  Duplicates& all = duplicates_of(comm);
  std::vector<int> used;
  for (auto const& one : all) used.push_back(one.use_count() > 1 ? 1 : 0);
  require(MPI_Allreduce(MPI_IN_PLACE, used.data(), int(used.size()), MPI_INT, MPI_MAX, comm), "MPI_Allreduce");
  auto const unused = std::size_t(std::find(used.begin(), used.end(), 0) - used.begin());
  if (unused < all.size()) return all[unused];
  auto made = std::make_shared<Duplicate>();
  require(MPI_Comm_dup(comm, &made->comm), "MPI_Comm_dup");
  all.push_back(made);
  return made;
}

/// Calls f(first, count) for pieces of at most `largest` of `total`: counts of MPI are of type int.
template <class Function>
void in_pieces(std::size_t total, std::size_t largest, Function const& f) {
  for (std::size_t first = 0; first < total; first += largest) f(first, int(std::min(largest, total - first)));
}

/// Tags: that of packets, then one for each Channel.
constexpr int packet_tag = 0;

int largest_tag(MPI_Comm comm) {
  int* tag = nullptr;
  int is_there = 0;
  require(MPI_Comm_get_attr(comm, MPI_TAG_UB, static_cast<void*>(&tag), &is_there), "MPI_Comm_get_attr");
  return is_there != 0 ? *tag : 32767;  // MPI promises that much
}

class MpiChannel final : public Channel {
 public:
  MpiChannel(std::shared_ptr<Duplicate> duplicate, int tag, std::size_t largest, std::vector<Message> const& out,
             std::vector<Message> const& in)
      : duplicate_(std::move(duplicate)) {
    MPI_Comm const comm = duplicate_->get();
    for (Message const& m : in)
      in_pieces(m.bytes.size(), largest, [&](std::size_t first, int count) {
        require(MPI_Recv_init(m.bytes.data() + first, count, MPI_BYTE, m.rank, tag, comm, add()), "MPI_Recv_init");
      });
    for (Message const& m : out)
      in_pieces(m.bytes.size(), largest, [&](std::size_t first, int count) {
        require(MPI_Send_init(m.bytes.data() + first, count, MPI_BYTE, m.rank, tag, comm, add()), "MPI_Send_init");
      });
  }
  ~MpiChannel() override {
    int is_finalized = 0;
    MPI_Finalized(&is_finalized);
    if (is_finalized != 0) return;
    for (MPI_Request& r : requests_)
      if (r != MPI_REQUEST_NULL) MPI_Request_free(&r);
  }
  MpiChannel(MpiChannel const&) = delete;
  MpiChannel& operator=(MpiChannel const&) = delete;

  void exchange() override {
    (void)duplicate_->get();  // says where it was freed
    // One by one, since MPI_Startall() may start them in any order, and messages of one tag arrive in that of their
    // starts.
    for (MPI_Request& r : requests_) require(MPI_Start(&r), "MPI_Start");
    require(MPI_Waitall(int(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
  }

 private:
  MPI_Request* add() { return &requests_.emplace_back(MPI_REQUEST_NULL); }

  std::shared_ptr<Duplicate> duplicate_;
  std::vector<MPI_Request> requests_;
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks(std::shared_ptr<Duplicate> duplicate, MpiOptions const& options)
      : duplicate_(std::move(duplicate)), options_(options), n_tags_(largest_tag(duplicate_->get())) {
    require(MPI_Comm_rank(duplicate_->get(), &rank_), "MPI_Comm_rank");
    require(MPI_Comm_size(duplicate_->get(), &size_), "MPI_Comm_size");
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  void largest(std::span<double> values) const override { reduce(values, MPI_DOUBLE, MPI_MAX); }
  void add(std::span<std::int64_t> values) const override { reduce(values, MPI_INT64_T, MPI_SUM); }

  [[nodiscard]] std::vector<Bytes> gather(std::span<std::byte const> own) const override {
    MPI_Comm const comm = duplicate_->get();
    std::vector<std::int64_t> sizes(size_);
    auto const own_size = std::int64_t(own.size());
    require(MPI_Allgather(&own_size, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, comm), "MPI_Allgather");
    std::vector<Bytes> all(size_);
    for (int r = 0; r < size_; ++r) all[r].resize(sizes[r]);

    // In rounds of which each fits a message: places in it are of type int as well.
    auto const share = std::max<std::int64_t>(1, std::int64_t(options_.largest_message) / size_);
    std::int64_t const longest = *std::max_element(sizes.begin(), sizes.end());
    std::vector<int> counts(size_), places(size_);
    Bytes round;
    for (std::int64_t first = 0; first < longest; first += share) {
      int end = 0;
      for (int r = 0; r < size_; ++r) {
        counts[r] = int(std::clamp<std::int64_t>(sizes[r] - first, 0, share));
        places[r] = end;
        end += counts[r];
      }
      round.resize(end);
      std::byte const* const from = own.data() + std::min(first, own_size);
      require(MPI_Allgatherv(from, counts[rank_], MPI_BYTE, round.data(), counts.data(), places.data(), MPI_BYTE, comm),
              "MPI_Allgatherv");
      for (int r = 0; r < size_; ++r)
        std::copy_n(round.begin() + places[r], counts[r], all[r].begin() + std::min(first, sizes[r]));
    }
    return all;
  }

  [[noreturn]] void give_up(std::string_view why) const override {
    std::fprintf(stderr, "gridmorph: rank %d: %.*s\n", rank_, int(why.size()), why.data());
    std::fflush(stderr);
    int is_finalized = 0;
    MPI_Finalized(&is_finalized);
    if (is_finalized == 0)
      MPI_Abort(duplicate_->comm == MPI_COMM_NULL ? MPI_COMM_WORLD : duplicate_->comm, EXIT_FAILURE);
    std::_Exit(EXIT_FAILURE);
  }

 private:
  template <class T>
  void reduce(std::span<T> values, MPI_Datatype type, MPI_Op op) const {
    MPI_Comm const comm = duplicate_->get();
    in_pieces(values.size(), std::max<std::size_t>(1, options_.largest_message / sizeof(T)),
              [&](std::size_t first, int count) {
                require(MPI_Allreduce(MPI_IN_PLACE, values.data() + first, count, type, op, comm), "MPI_Allreduce");
              });
  }

  /// Sizes first, from all to all: eight bytes per rank are less to get wrong than looking for messages until nobody
  /// can have sent one any more. Then the packets, in pieces that arrive in order, where there is something in them.
  std::vector<Packet> deliver(std::vector<Packet> packets) const override {
    MPI_Comm const comm = duplicate_->get();
    constexpr std::int64_t nothing = -1;
    std::vector<std::int64_t> sizes(size_, nothing), arriving(size_);
    for (Packet const& p : packets) sizes[p.rank] = std::int64_t(p.bytes.size());
    require(MPI_Alltoall(sizes.data(), 1, MPI_INT64_T, arriving.data(), 1, MPI_INT64_T, comm), "MPI_Alltoall");

    std::vector<Packet> arrived;
    for (int r = 0; r < size_; ++r)
      if (arriving[r] != nothing) arrived.push_back({r, r == rank_ ? Bytes() : Bytes(arriving[r])});
    std::vector<MPI_Request> requests;
    for (Packet& p : arrived)
      in_pieces(p.bytes.size(), options_.largest_message, [&](std::size_t first, int count) {
        require(MPI_Irecv(p.bytes.data() + first, count, MPI_BYTE, p.rank, packet_tag, comm, &requests.emplace_back()),
                "MPI_Irecv");
      });
    for (Packet& p : packets) {
      if (p.rank == rank_) {
        std::find_if(arrived.begin(), arrived.end(), [&](Packet const& a) { return a.rank == rank_; })->bytes =
            std::move(p.bytes);
        continue;
      }
      in_pieces(p.bytes.size(), options_.largest_message, [&](std::size_t first, int count) {
        require(MPI_Isend(p.bytes.data() + first, count, MPI_BYTE, p.rank, packet_tag, comm, &requests.emplace_back()),
                "MPI_Isend");
      });
    }
    require(MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
    return arrived;
  }

  std::unique_ptr<Channel> connect(std::vector<Message> const& out, std::vector<Message> const& in) const override {
    // The same on all ranks, since all make their channels in the same order. Begun again where MPI has no more.
    int const tag = packet_tag + 1 + int(n_channels_++ % n_tags_);
    return std::make_unique<MpiChannel>(duplicate_, tag, options_.largest_message, out, in);
  }

  std::shared_ptr<Duplicate> duplicate_;
  MpiOptions options_;
  int rank_ = 0, size_ = 1;
  std::int64_t n_tags_;                  ///< for Channels
  mutable std::int64_t n_channels_ = 0;  ///< made so far
};

/// Whether MPI may be called at all, and here.
void check_state() {
  int is_initialized = 0, is_finalized = 0;
  MPI_Initialized(&is_initialized);
  MPI_Finalized(&is_finalized);
  if (is_initialized == 0)
    throw ConfigError("gridmorph::mpi_ranks: MPI is not initialised; call MPI_Init_thread() before it");
  if (is_finalized != 0)
    throw ConfigError(
        "gridmorph::mpi_ranks: MPI is finalised already; call MPI_Finalize() after everything of gridmorph");
  int level = MPI_THREAD_SINGLE, is_main = 0;
  require(MPI_Query_thread(&level), "MPI_Query_thread");
  require(MPI_Is_thread_main(&is_main), "MPI_Is_thread_main");
  if (level < MPI_THREAD_SERIALIZED && is_main == 0)
    throw ConfigError(
        "gridmorph::mpi_ranks: this thread may not call MPI, which was initialised for the thread that did so alone; "
        "ask "
        "MPI_Init_thread() for MPI_THREAD_SERIALIZED, or make the ranks there");
}

}  // namespace

std::shared_ptr<Ranks const> mpi_ranks(MPI_Comm comm, MpiOptions const& options) {
  check_state();
  if (comm == MPI_COMM_NULL)
    throw ConfigError("gridmorph::mpi_ranks: the communicator is MPI_COMM_NULL: this process is no rank of it");
  int has_two_groups = 0;
  require(MPI_Comm_test_inter(comm, &has_two_groups), "MPI_Comm_test_inter");
  if (has_two_groups != 0)
    throw ConfigError("gridmorph::mpi_ranks: an intercommunicator has two groups; merge them by MPI_Intercomm_merge()");
  if (options.largest_message < 1 || options.largest_message > INT_MAX)
    throw ConfigError("gridmorph::mpi_ranks: largest_message is " + std::to_string(options.largest_message) +
                      " bytes; it goes from 1 to 2^31 - 1");
  return std::make_shared<MpiRanks>(free_duplicate(comm), options);
}

}  // namespace gridmorph
