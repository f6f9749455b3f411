#include <gridmorph/motion/along_walls.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/motion/shock/shock_shift.hpp>

namespace gridmorph {

ShockMotion::ShockMotion(Boundary const& boundary, ShockRule const& rule, std::vector<int> const& walls,
                         WallFaces::Displacement const& displacement)
    : shift_(rule.shift), fade_(rule.fade), share_(rule.share) {
  if (shift_ == nullptr) throw MotionError("where the shock goes to has not been found; give ShockRule::shift");
  if (!walls.empty()) walls_ = WallFaces(boundary, walls, displacement);
}

Vec3 ShockMotion::displacement(Vec3 const& point) const {
  if (walls_.empty()) return share_ * shift_->at(point);
  WallFaces::Place const wall = walls_.nearest(point);
  double const away = distance(point, wall.point);
  double const free = away > 0 ? (fade_ > 0 ? smoothstep(away / fade_) : 1.0) : 0.0;
  return free > 0 ? wall.displacement + (free * share_) * shift_->at(point) : wall.displacement;
}

}  // namespace gridmorph
