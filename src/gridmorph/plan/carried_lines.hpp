// Sums along grid lines that run through several ranks, with the bits that one rank would give them; internal.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/core/ranks.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

/// A stretch of a line that this rank has.
struct LineSegment {
  Index line = 0;   ///< number of the line, the same on all ranks; they may have gaps
  Index place = 0;  ///< ascending along the line: the number on it of the segment's first node, say
};

/// Floating-point sums depend on their order, and so would coordinates on the number of ranks. So a sum is carried: it
/// goes on in each segment of a line where the one before left off,
///
///   s(n) = s(n - 1) + l(n)   from the first node of the line to its last, whoever has them,
///
/// and the total comes back the same way. The first segments of all lines go on at once, then the second ones, ...
///
/// Cost of a call: two messages of 8 bytes per line where two segments meet, in as many rounds each way as the line
/// with most segments has of them; a rank waits for those alone whose lines it continues. Partial sums and a scan would
/// take fewer rounds, and give other bits in most sums. Memory: 32 bytes per segment.
class CarriedLines {
 public:
  /// Collective; `own`: the segments of this rank, in any order, one after another too. Throws PlanError, on all
  /// ranks: two segments at one place of a line.
  CarriedLines(std::shared_ptr<Ranks const> ranks, std::span<LineSegment const> own);

  /// Called once per round: `segments` (numbers in `own`) are those whose sums go on; sums[s] (n_segments) is the sum
  /// before segment s, and is made that behind it.
  using Continue = std::function<void(std::span<Index const> segments, std::span<double> sums)>;

  /// The sum over the whole line of each own segment. Sums of first segments begin with zero. Collective; what `go_on`
  /// throws on any rank all throw in the end.
  [[nodiscard]] std::vector<double> totals(Continue const& go_on);

  /// Number of rounds: of segments of the line that has most of them.
  [[nodiscard]] Index n_rounds() const { return Index(rounds_.size()); }

 private:
  /// Where a segment stands among those of its line.
  struct Step {
    Index segment = 0, round = 0;  ///< number in `own`, and on the line
    int rank_before = -1, rank_next = -1;
    Index segment_next = 0;
  };
  /// The own segments that are the n-th of their lines.
  struct Round {
    std::vector<Index> segments, continued;  ///< all, and those that another one follows; by rank before, and next
    std::vector<double> before, next;        ///< the values of these in messages; before: none in the first round
    std::unique_ptr<Channel> forwards, backwards;  ///< with the round before: its `next` to `before`, and back
  };

  [[nodiscard]] std::vector<Step> find_steps(std::span<LineSegment const> own) const;
  void make_rounds(std::vector<Step> const& steps);

  std::shared_ptr<Ranks const> ranks_;
  Index n_segments_ = 0;
  std::vector<Round> rounds_;
};

}  // namespace gridmorph
