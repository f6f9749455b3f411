// Finds the closest of many elements: a tree of boxes around them. Internal to casefile.
#pragma once

#include <gridmorph/mapping/detail/facet_shape.hpp>

#include <cstdint>
#include <vector>

namespace gridmorph::casefile {

class FacetTree {
 public:
  /// `facets`: at least one. The tree keeps a copy.
  FacetTree(std::vector<FacetShape> facets, std::vector<std::vector<Vec3>> const& corners);

  struct Hit {
    std::int32_t facet = -1;
    FacetPoint point;
  };
  /// The closest facet; of equally close ones that with the lowest number. Cost O(log n).
  [[nodiscard]] Hit closest(Vec3 const& q) const;
  [[nodiscard]] FacetShape const& facet(std::int32_t f) const { return facets_[f]; }

 private:
  struct Box {
    Vec3 low, high;
    std::int32_t begin = 0, end = 0;     ///< in order_
    std::int32_t left = -1, right = -1;  ///< further boxes; none in a leaf
    [[nodiscard]] double squared_distance(Vec3 const& q) const;
  };
  std::int32_t build(std::vector<Vec3> const& low, std::vector<Vec3> const& high, std::int32_t begin, std::int32_t end);

  std::vector<FacetShape> facets_;
  std::vector<std::int32_t> order_;
  std::vector<Box> boxes_;
};

}  // namespace gridmorph::casefile
