// The second node plane that readers give to blocks of 2-D meshes.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <optional>

namespace gridmorph {

/// Leads from the second plane of flat blocks back to the first, where what a file says of a 2-D mesh holds: points of
/// a table, formulas. Of other meshes, and of surfaces that are not flat, all points stay.
class SecondPlane {
 public:
  /// Cost: O(nodes of the patches of the planes).
  explicit SecondPlane(BoundaryMesh const& mesh);

  [[nodiscard]] bool is_there() const { return shift_.has_value(); }
  /// A point of the second plane as the one of the first that it is a copy of; others as they are.
  [[nodiscard]] Vec3 first(Vec3 const& p) const;

 private:
  Vec3 origin_;                ///< in the first plane
  std::optional<Vec3> shift_;  ///< from the first plane to the second, across both
};

}  // namespace gridmorph
