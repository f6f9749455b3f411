// Parts and regions that go along with walls that other rules move: the rules `attached`, `shock` and `wake`.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/wake/wake_places.hpp>
#include <gridmorph/motion/wall_faces.hpp>

#include <functional>
#include <memory>
#include <string>
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

/// A point x of the wake of a section moves by
///
///     u(x) = v(x) + (1 - smoothstep(|x - x_w| / r)) (u_w - v(x_w)),
///     v(x) = f ( T u_e + (D - 1)(x - x_e) ) + (1 - f) b(x),   f = 1 - smoothstep(behind / fade)
///
/// b: what the field beside the wake does, which the periodic sides of a blade row follow their blade with; nothing
/// beside wings. x_e, u_e: the trailing edge of its section and its displacement; T: what keeps its components along
/// and across the flow path and about the machine axis from there to the point (wings: its direction); D: the turn in
/// the plane of the section by `turn` times the angle by which the last tenth of the camber line turns there; x_w, u_w:
/// the nearest place of the walls, which the second term has the wake agree with; r: a tenth of the chord. A blade that
/// moves as a whole along its row, or about the axis, takes its wake along as a whole; a wing also where it turns in
/// the planes of its sections.
class WakeMotion {
 public:
  using Beside = std::function<Vec3(Vec3 const&)>;

  /// `displacement`: of the walls; `beside`: b, none where the field rests. Throws MotionError when the sections cannot
  /// be made or the walls have no faces. Keeps pointers to `surfaces`. Cost O(n log n).
  WakeMotion(Boundary const& boundary, ResolvedMotion const& motion, WakeRule const& rule,
             std::vector<int> const& patches, SlipSurfaces const& surfaces, WallFaces::Displacement const& displacement,
             std::vector<std::string>& notes, Beside beside = {});

  /// The displacement of a point; exactly zero where the trailing edge and the field beside rest. Cost O(log n), times
  /// blades and periodic copies.
  [[nodiscard]] Vec3 displacement(Vec3 const& point) const;

 private:
  /// The nearest place of the walls and of their periodic copies: in H meshes the two sides of a blade are a pitch
  /// apart.
  [[nodiscard]] WallFaces::Place nearest(Vec3 const& x) const;
  [[nodiscard]] std::optional<WallFaces::Place> nearest_within(Vec3 const& x, double reach) const;
  [[nodiscard]] Vec3 behind_edge(Vec3 const& point, WakePlace const& place) const;

  WakeRule rule_;
  WakePlaces places_;
  WallFaces walls_;
  Beside beside_;
};

}  // namespace gridmorph
