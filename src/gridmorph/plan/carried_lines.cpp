#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/carried_lines.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace gridmorph {

namespace {

/// What a rank says of a segment to the one rank that puts the line together.
struct SegmentPlace {
  Index line, place, segment;
};

struct SegmentOfRank {
  SegmentPlace at;
  int rank;

  [[nodiscard]] bool continues(SegmentOfRank const& before) const { return at.line == before.at.line; }
};

/// Bytes of n values from the first on.
std::span<std::byte> bytes_of(std::vector<double>& values, std::size_t first, std::size_t n) {
  return std::as_writable_bytes(std::span(values).subspan(first, n));
}

/// Values by rank as a message to, or from, each of the ranks.
std::vector<Message> messages(std::vector<int> const& ranks, std::vector<double>& values) {
  std::vector<Message> out;
  for (std::size_t first = 0, end = 0; first < ranks.size(); first = end) {
    while (end < ranks.size() && ranks[end] == ranks[first]) ++end;
    out.push_back({ranks[first], bytes_of(values, first, end - first)});
  }
  return out;
}

/// The segments that ranks sent, line after line.
std::vector<SegmentOfRank> sorted_lines(std::vector<Packet> const& packets) {
  std::vector<SegmentOfRank> out;
  for (Packet const& p : packets)
    for (SegmentPlace const& at : from_bytes<SegmentPlace>(p.bytes)) out.push_back({at, p.rank});
  std::sort(out.begin(), out.end(), [](SegmentOfRank const& a, SegmentOfRank const& b) {
    return std::tie(a.at.line, a.at.place) < std::tie(b.at.line, b.at.place);
  });
  for (std::size_t n = 1; n < out.size(); ++n)
    if (out[n].continues(out[n - 1]) && out[n].at.place == out[n - 1].at.place)
      throw PlanError("gridmorph::CarriedLines: line " + std::to_string(out[n].at.line) +
                      " has two segments at place " + std::to_string(out[n].at.place) + ", of ranks " +
                      std::to_string(out[n - 1].rank) + " and " + std::to_string(out[n].rank) +
                      "; a sum goes through each part of a line once");
  return out;
}

}  // namespace

CarriedLines::CarriedLines(std::shared_ptr<Ranks const> ranks, std::span<LineSegment const> own)
    : ranks_(std::move(ranks)), n_segments_(Index(own.size())) {
  make_rounds(find_steps(own));
}

/// Each line is put together by one rank, whoever has its segments: nobody needs to know all lines.
std::vector<CarriedLines::Step> CarriedLines::find_steps(std::span<LineSegment const> own) const {
  std::map<int, std::vector<SegmentPlace>> told;
  for (Index s = 0; s < n_segments_; ++s)
    told[int(own[s].line % ranks_->size())].push_back({own[s].line, own[s].place, s});
  std::vector<Packet> const packets = ranks_->send(to_packets(told));
  auto const answers = together(*ranks_, [&] {
    std::vector<SegmentOfRank> const segments = sorted_lines(packets);
    std::map<int, std::vector<Step>> steps;
    Index round = 0;
    for (std::size_t n = 0; n < segments.size(); ++n) {
      Step step;
      step.segment = segments[n].at.segment;
      if (n > 0 && segments[n].continues(segments[n - 1])) {
        step.round = ++round;
        step.rank_before = segments[n - 1].rank;
      } else {
        round = 0;
      }
      if (n + 1 < segments.size() && segments[n + 1].continues(segments[n])) {
        step.rank_next = segments[n + 1].rank;
        step.segment_next = segments[n + 1].at.segment;
      }
      steps[segments[n].rank].push_back(step);
    }
    return to_packets(steps);
  });
  std::vector<Step> out;
  for (Packet const& p : ranks_->send(answers))
    for (Step const& step : from_bytes<Step>(p.bytes)) out.push_back(step);
  return out;
}

void CarriedLines::make_rounds(std::vector<Step> const& steps) {
  double n_rounds = 0;
  for (Step const& step : steps) n_rounds = std::max(n_rounds, double(step.round + 1));
  ranks_->largest({&n_rounds, 1});
  rounds_.resize(std::size_t(n_rounds));

  // Both ends of a message have its values by the numbers that its receiver gives the segments on the way forwards.
  std::vector<Step> arriving = steps, leaving = steps;
  std::sort(arriving.begin(), arriving.end(), [](Step const& a, Step const& b) {
    return std::tie(a.rank_before, a.segment) < std::tie(b.rank_before, b.segment);
  });
  std::sort(leaving.begin(), leaving.end(), [](Step const& a, Step const& b) {
    return std::tie(a.rank_next, a.segment_next) < std::tie(b.rank_next, b.segment_next);
  });
  std::vector<std::vector<int>> ranks_before(rounds_.size()), ranks_next(rounds_.size());
  for (Step const& step : arriving) {
    rounds_[step.round].segments.push_back(step.segment);
    if (step.rank_before >= 0) ranks_before[step.round].push_back(step.rank_before);
  }
  for (Step const& step : leaving)
    if (step.rank_next >= 0) {
      rounds_[step.round].continued.push_back(step.segment);
      ranks_next[step.round].push_back(step.rank_next);
    }

  for (std::size_t n = 0; n < rounds_.size(); ++n) {
    rounds_[n].before.resize(ranks_before[n].size());
    rounds_[n].next.resize(ranks_next[n].size());
    if (n == 0) continue;
    auto const out = messages(ranks_next[n - 1], rounds_[n - 1].next),
               in = messages(ranks_before[n], rounds_[n].before);
    rounds_[n].forwards = ranks_->channel(out, in);
    rounds_[n].backwards = ranks_->channel(in, out);
  }
}

std::vector<double> CarriedLines::totals(Continue const& go_on) {
  std::vector<double> sums(n_segments_, 0.0);
  std::exception_ptr thrown;
  for (Round& round : rounds_) {
    if (round.forwards) {
      round.forwards->exchange();
      for (std::size_t n = 0; n < round.before.size(); ++n) sums[round.segments[n]] = round.before[n];
    }
    try {
      if (!thrown && !round.segments.empty()) go_on(round.segments, sums);
    } catch (...) {
      thrown = std::current_exception();  // the others wait for sums, whatever they are
    }
    for (std::size_t n = 0; n < round.next.size(); ++n) round.next[n] = sums[round.continued[n]];
  }
  for (std::size_t r = rounds_.size(); r-- > 1;) {
    Round& round = rounds_[r];
    Round& earlier = rounds_[r - 1];
    for (std::size_t n = 0; n < round.before.size(); ++n) round.before[n] = sums[round.segments[n]];
    round.backwards->exchange();
    for (std::size_t n = 0; n < earlier.next.size(); ++n) sums[earlier.continued[n]] = earlier.next[n];
  }
  detail::throw_together(*ranks_, thrown);
  return sums;
}

}  // namespace gridmorph
