// Where nodes with numbers of any size and order stand. Internal to io.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/index.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace gridmorph::gmsh {

/// Places of numbers in a list: by a table where they are dense, else by search.
class TagPlaces {
 public:
  /// Returns the first place of a number that is there a second time; -1 where each is there once.
  Index set(std::vector<std::int64_t> const& tags) {
    table_.clear();
    sorted_.clear();
    if (tags.empty()) return -1;
    auto const [low, high] = std::minmax_element(tags.begin(), tags.end());
    constexpr std::uint64_t few = 1024, spread = 4;
    low_ = *low;
    if (std::uint64_t(*high) - std::uint64_t(*low) < spread * tags.size() + few) {
      table_.assign(std::size_t(*high - *low) + 1, -1);
      for (std::size_t n = 0; n < tags.size(); ++n) {
        Index32& place = table_[std::size_t(tags[n] - low_)];
        if (place >= 0) return Index(n);
        place = Index32(n);
      }
      return -1;
    }
    for (std::size_t n = 0; n < tags.size(); ++n) sorted_.emplace_back(tags[n], Index32(n));
    std::sort(sorted_.begin(), sorted_.end());
    Index32 twice = -1;
    for (std::size_t n = 1; n < sorted_.size(); ++n)
      if (sorted_[n].first == sorted_[n - 1].first && (twice < 0 || sorted_[n].second < twice))
        twice = sorted_[n].second;
    return twice;
  }

  /// -1 where there is no such number.
  [[nodiscard]] Index find(std::int64_t tag) const {
    if (!table_.empty()) return tag < low_ || tag - low_ >= Index(table_.size()) ? -1 : table_[std::size_t(tag - low_)];
    auto const at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, Index32(-1)));
    return at == sorted_.end() || at->first != tag ? -1 : at->second;
  }

 private:
  std::int64_t low_ = 0;
  std::vector<Index32> table_;
  std::vector<std::pair<std::int64_t, Index32>> sorted_;
};

}  // namespace gridmorph::gmsh
