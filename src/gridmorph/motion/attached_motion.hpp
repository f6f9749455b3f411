// How parts go along with walls that other rules move.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/wall_faces.hpp>

#include <vector>

namespace gridmorph {

/// What AttachedRule says, for the walls as they move now.
class AttachedMotion {
 public:
  using Displacement = WallFaces::Displacement;

  /// Throws MotionError where no node of the patches is near enough, and for AttachedRule::How::nearest without faces.
  /// Cost O(nodes of the patches); nearest: O(n log n).
  AttachedMotion(Boundary const& boundary, std::vector<int> const& patches, AttachedRule const& rule,
                 Displacement const& displacement);

  /// The displacement of any point. Exactly zero where the walls rest. Cost O(1); nearest: O(log n).
  [[nodiscard]] Vec3 displacement(Vec3 const& point) const;

 private:
  RigidFit fit_;
  WallFaces faces_;  ///< of the nearest
};

}  // namespace gridmorph
