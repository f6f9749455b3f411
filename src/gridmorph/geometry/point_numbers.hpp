// Points that coincide get one number.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace gridmorph {

/// Finds points by position: within a tolerance, or with tolerance 0 the very same ones. Grows with every point that is
/// added; for many points that are known beforehand match_points() and coincident_pairs() of mesh/ take less memory.
///
/// Points join the one that was added before them, so which points are one depends on the order where they lie closer
/// together than the tolerance in chains; take it far below the distances between points that differ. Cost per call:
/// O(1) then.
class PointNumbers {
 public:
  explicit PointNumbers(double tolerance) : tolerance_(tolerance) {}

  /// The number given to the point nearest to p within the tolerance, of equally near ones the first added; -1: none.
  [[nodiscard]] int find(Vec3 const& p) const;
  void add(Vec3 const& p, int number);
  /// find(), or `fresh`, which p then has.
  int find_or_add(Vec3 const& p, int fresh);

  /// Calls visit(point, number) for all points within the tolerance of p, and for some beyond it.
  template <class Visit>
  void for_each_near(Vec3 const& p, Visit const& visit) const {
    // A sphere of the tolerance touches at most two cells along each axis.
    Key const lo{cell(p.x - tolerance_), cell(p.y - tolerance_), cell(p.z - tolerance_)};
    Key const hi{cell(p.x + tolerance_), cell(p.y + tolerance_), cell(p.z + tolerance_)};
    for (std::int64_t i = lo[0]; i <= hi[0]; ++i)
      for (std::int64_t j = lo[1]; j <= hi[1]; ++j)
        for (std::int64_t k = lo[2]; k <= hi[2]; ++k)
          if (auto const found = cells_.find({i, j, k}); found != cells_.end())
            for (Entry const& e : found->second) visit(e.point, e.number);
  }

 private:
  struct Entry {
    Vec3 point;
    int number;
  };
  using Key = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(Key const& key) const;
  };
  /// Four tolerances wide; without one every number has its own.
  [[nodiscard]] std::int64_t cell(double v) const;

  double tolerance_;
  std::unordered_map<Key, std::vector<Entry>, Hash> cells_;
};

}  // namespace gridmorph
