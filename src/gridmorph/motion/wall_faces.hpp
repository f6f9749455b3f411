// Walls as faces that know their displacement, wherever on them.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace gridmorph {

class WallFaces {
 public:
  /// Evaluates the displacement of points of a patch.
  using Displacement = std::function<void(int patch, std::span<Vec3 const> points, std::span<Vec3> out)>;
  struct Place {
    Vec3 point;
    Vec3 displacement;  ///< linear between the corners of the face, of equal corners exactly theirs
  };

  WallFaces() = default;
  /// The faces of patches; lines where they are lines in the boundary of a plane mesh. Throws MotionError where the
  /// patches have neither. Cost O(n log n).
  WallFaces(Boundary const& boundary, std::vector<int> const& patches, Displacement const& displacement);

  [[nodiscard]] bool empty() const { return tree_.empty(); }
  /// The nearest place of the walls. Cost O(log n) near them.
  [[nodiscard]] Place nearest(Vec3 const& point) const { return place(tree_.closest(point)); }
  /// The nearest place of the walls where one is nearer than a distance. Cost O(log n), far away O(1).
  [[nodiscard]] std::optional<Place> nearest_within(Vec3 const& point, double distance) const;

 private:
  [[nodiscard]] Place place(TargetTree::Hit const& hit) const;

  TargetTree tree_;
  std::vector<Vec3> of_node_;
};

}  // namespace gridmorph
