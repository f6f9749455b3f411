// How parts go along with walls that other rules move.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/motion.hpp>

#include <functional>
#include <span>
#include <vector>

namespace gridmorph {

/// What AttachedRule says, for the walls as they move now.
class AttachedMotion {
 public:
  /// Displacement of points of a patch.
  using Displacement = std::function<void(int patch, std::span<Vec3 const> points, std::span<Vec3> out)>;

  /// Throws MotionError where no node of the patches is near enough, and for AttachedRule::How::nearest without faces in space.
  /// Cost O(nodes of the patches); nearest: O(n log n).
  AttachedMotion(Boundary const& boundary, std::vector<int> const& patches, AttachedRule const& rule,
                 Displacement const& displacement);

  /// Of any point. Exactly zero where the walls rest. Cost O(1); nearest: O(log n).
  [[nodiscard]] Vec3 displacement(Vec3 const& point) const;

 private:
  void follow_faces(Boundary const& boundary, std::vector<int> const& patches, Displacement const& displacement);

  RigidFit fit_;
  TargetTree tree_;  ///< of the nearest
  std::vector<Vec3> of_node_;
};

}  // namespace gridmorph
