// The `shock` rule: regions that go along with a shock to where another flow solution has it.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/wall_faces.hpp>

#include <memory>
#include <vector>

namespace gridmorph {

/// A point x of the region moves by
///
///     u(x) = u_w + share smoothstep(|x - x_w| / fade) v(x)
///
/// v: ShockShift; x_w, u_w: the nearest place of the walls and its displacement, which the region takes up, so that
/// both agree where they meet. Without walls u = share v.
class ShockMotion {
 public:
  /// `displacement`: of the walls, which may be none. Throws MotionError where the rule has no shift, and for walls
  /// without faces. Cost O(n log n) of the walls.
  ShockMotion(Boundary const& boundary, ShockRule const& rule, std::vector<int> const& walls,
              WallFaces::Displacement const& displacement);

  /// The displacement of a point. Cost O(log n), and the shock's points within the radius of its shift.
  [[nodiscard]] Vec3 displacement(Vec3 const& point) const;

 private:
  std::shared_ptr<ShockShift const> shift_;
  double fade_, share_;
  WallFaces walls_;
};

}  // namespace gridmorph
