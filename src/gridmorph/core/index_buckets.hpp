// Records grouped by the number they belong to; internal. The way from lists "which nodes has an element" to lists
// "what is around a node" when the numbers of neighbours are far apart: no list is written in the order of the file.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/for_all.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// Records with keys 0 <= key < n_keys, first by ranges of keys (buckets), then, range after range in cache, by key.
/// Records of a key keep the order of the items they come from, so nothing depends on the number of threads.
///
/// Cost per record: written and read twice, in streams; two calls of `emit` per item. Memory: 8 bytes and a record,
/// each.
template <class Record>
class IndexBuckets {
 public:
  /// `emit(item, put)` calls put(key, record) any number of times, the same both times that it is called for an item.
  template <class Emit>
  IndexBuckets(HostInstance const& host, std::string const& label, Index n_items, Index n_keys, Emit const& emit)
      : host_(host),
        label_(label),
        n_keys_(n_keys),
        keys_per_bucket_(std::max<Index>(smallest_bucket, (n_keys + most_buckets - 1) / most_buckets)),
        n_buckets_((n_keys + keys_per_bucket_ - 1) / keys_per_bucket_),
        begin_(std::size_t(n_buckets_) + 1, 0) {
    Index const n_chunks = std::clamp<Index>(n_items / smallest_chunk, 1, host_.concurrency());
    auto const first_item = [&](Index chunk) { return chunk * n_items / n_chunks; };
    // Bucket after bucket, chunk after chunk in each: the running sum is where the records of a chunk go.
    std::vector<Index> place(n_buckets_ * n_chunks, 0);
    for_all_parts(host_, label_ + "::count", n_chunks, [&](Index c) {
      std::vector<Index> count(n_buckets_, 0);
      for (Index i = first_item(c); i < first_item(c + 1); ++i)
        emit(i, [&](Index32 key, Record const&) { ++count[key / keys_per_bucket_]; });
      for (Index b = 0; b < n_buckets_; ++b) place[b * n_chunks + c] = count[b];
    });
    Index sum = 0;
    for (Index b = 0; b < n_buckets_; ++b) {
      begin_[b] = sum;
      for (Index c = 0; c < n_chunks; ++c) sum += std::exchange(place[b * n_chunks + c], sum);
    }
    begin_[n_buckets_] = sum;
    entry_ = std::make_unique_for_overwrite<Entry[]>(std::size_t(sum));
    for_all_parts(host_, label_ + "::place", n_chunks, [&](Index c) {
      std::vector<Index> at(n_buckets_, 0);
      for (Index b = 0; b < n_buckets_; ++b) at[b] = place[b * n_chunks + c];
      for (Index i = first_item(c); i < first_item(c + 1); ++i)
        emit(i, [&](Index32 key, Record const& record) { entry_[at[key / keys_per_bucket_]++] = {key, record}; });
    });
  }

  /// Number of records.
  [[nodiscard]] Index size() const { return begin_.back(); }

  /// Calls visit(key, at, records) once for every key, on the instance: `at` counts the records of smaller keys;
  /// `records` may be changed and is gone after the call.
  template <class Visit>
  void for_each_key(Visit const& visit) const {
    for_all_parts(host_, label_ + "::group", n_buckets_, [&](Index b) {
      Index const first_key = b * keys_per_bucket_, end_key = std::min(first_key + keys_per_bucket_, n_keys_);
      Index const begin = begin_[b], end = begin_[b + 1];
      std::vector<Index> first(std::size_t(end_key - first_key) + 1, 0);
      for (Index e = begin; e < end; ++e) ++first[std::size_t(entry_[e].key - first_key) + 1];
      for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
      std::vector<Index> next(first.begin(), first.end() - 1);
      auto const record = std::make_unique_for_overwrite<Record[]>(std::size_t(end - begin));
      for (Index e = begin; e < end; ++e) {
        Entry const& entry = entry_[e];
        record[next[entry.key - first_key]++] = entry.record;
      }
      for (Index key = first_key; key < end_key; ++key) {
        Index const from = first[key - first_key], to = first[std::size_t(key - first_key) + 1];
        visit(Index32(key), begin + from, std::span<Record>(record.get() + from, std::size_t(to - from)));
      }
    });
  }

 private:
  // A bucket's records stay in the second-level cache, and there are fewer buckets than entries in the second-level
  // TLB.
  static constexpr Index smallest_bucket = 1024, most_buckets = 1024, smallest_chunk = 4096;

  struct Entry {
    Index32 key;
    Record record;
  };

  HostInstance host_;
  std::string label_;
  Index n_keys_, keys_per_bucket_, n_buckets_;
  std::vector<Index> begin_;
  std::unique_ptr<Entry[]> entry_;
};

}  // namespace gridmorph::detail
