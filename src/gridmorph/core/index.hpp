// Index triples, node ranges and the orientation of one zone's indices in another's.
//
// Inside the library node indices are 0-based and ranges are half-open; the 1-based inclusive ranges of the CGNS
// SIDS are converted in io only. i varies fastest.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace gridmorph {

using Index = std::int64_t;         ///< node number in the flat arrays of a mesh
using Index3 = std::array<int, 3>;  ///< (i, j, k)

[[nodiscard]] inline Index3 plus(Index3 const& a, Index3 const& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
[[nodiscard]] inline Index3 minus(Index3 const& a, Index3 const& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Half-open box of node indices: begin <= (i, j, k) < end.
struct IndexRange {
  Index3 begin{0, 0, 0};
  Index3 end{0, 0, 0};

  [[nodiscard]] int extent(int axis) const { return end[axis] - begin[axis]; }
  [[nodiscard]] Index size() const { return Index(extent(0)) * extent(1) * extent(2); }
  [[nodiscard]] bool contains(Index3 const& p) const {
    for (int a = 0; a < 3; ++a)
      if (p[a] < begin[a] || p[a] >= end[a]) return false;
    return true;
  }
  friend bool operator==(IndexRange const&, IndexRange const&) = default;
};

/// The indices that are in both; empty, of size 0, where none is.
[[nodiscard]] inline IndexRange intersection(IndexRange const& a, IndexRange const& b) {
  IndexRange out;
  for (int d = 0; d < 3; ++d) {
    out.begin[d] = a.begin[d] > b.begin[d] ? a.begin[d] : b.begin[d];
    out.end[d] = a.end[d] < b.end[d] ? a.end[d] : b.end[d];
    if (out.end[d] < out.begin[d]) out.end[d] = out.begin[d];
  }
  return out;
}

/// "[1:33, 1:1, 5:9]", 1-based and inclusive as users see it in their files.
std::string to_string(IndexRange const& range);

/// A signed permutation of the three index axes: step +1 along own axis a is step sign[a] along donor axis axis[a].
/// This is the CGNS SIDS `Transform` with T[a] = sign[a] * (axis[a] + 1).
struct Orientation {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  [[nodiscard]] Index3 apply(Index3 const& step) const {
    Index3 out{0, 0, 0};
    for (int a = 0; a < 3; ++a) out[axis[a]] = sign[a] * step[a];
    return out;
  }
  /// The orientation that applies first this one, then `next`.
  [[nodiscard]] Orientation then(Orientation const& next) const {
    Orientation o;
    for (int a = 0; a < 3; ++a) {
      o.axis[a] = next.axis[axis[a]];
      o.sign[a] = sign[a] * next.sign[axis[a]];
    }
    return o;
  }
  [[nodiscard]] Orientation inverse() const {
    Orientation o;
    for (int a = 0; a < 3; ++a) {
      o.axis[axis[a]] = a;
      o.sign[axis[a]] = sign[a];
    }
    return o;
  }
  /// The sign of the orientation: +1 if it keeps handedness, -1 if it mirrors.
  [[nodiscard]] int determinant() const {
    int swaps = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a + 1; b < 3; ++b) swaps += axis[a] > axis[b] ? 1 : 0;
    return sign[0] * sign[1] * sign[2] * (swaps % 2 == 0 ? 1 : -1);
  }
  friend bool operator==(Orientation const&, Orientation const&) = default;
};

/// donor = orientation(own - own_origin) + donor_origin   (CGNS SIDS: Index2 = T.(Index1 - Begin1) + Begin2)
struct IndexMap {
  Orientation orientation;
  Index3 own_origin{0, 0, 0};
  Index3 donor_origin{0, 0, 0};

  [[nodiscard]] Index3 operator()(Index3 const& own) const {
    Index3 const step = orientation.apply({own[0] - own_origin[0], own[1] - own_origin[1], own[2] - own_origin[2]});
    return {donor_origin[0] + step[0], donor_origin[1] + step[1], donor_origin[2] + step[2]};
  }
  [[nodiscard]] IndexMap inverse() const { return {orientation.inverse(), donor_origin, own_origin}; }
  /// The map that applies first this one, then `next`.
  [[nodiscard]] IndexMap then(IndexMap const& next) const {
    return {orientation.then(next.orientation), own_origin, next(donor_origin)};
  }
  /// The image of a box of nodes, as a normalised half-open range.
  [[nodiscard]] IndexRange operator()(IndexRange const& own) const {
    Index3 const a = (*this)(own.begin);
    Index3 const b = (*this)(Index3{own.end[0] - 1, own.end[1] - 1, own.end[2] - 1});
    IndexRange out;
    for (int d = 0; d < 3; ++d) {
      out.begin[d] = a[d] < b[d] ? a[d] : b[d];
      out.end[d] = (a[d] < b[d] ? b[d] : a[d]) + 1;
    }
    return out;
  }
};

}  // namespace gridmorph
