// Features that go along with the walls they sit on and keep their shape, and the nodes of walls around them.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/wall_faces.hpp>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// What CarryRule says. Faces of its patches that share nodes are one feature; its rim are the nodes that it has in
/// common with the walls. It moves rigidly,
///
///     x' = t + R (x - s),   s = sum a_k x_k / sum a_k,   t = sum a_k y_k / sum a_k,
///     R: sum a_k |R (x_k - s) - (y_k - t)|^2 least,
///
/// x_k the corners of the walls' faces that touch the rim, y_k where the walls' rules put them, a_k what they have of
/// the area of these faces (length in plane meshes): R as Horn (JOSA A 4, 1987) has it. A constraint keeps what lies
/// along a direction d (the axis, the normal of flat patches): t loses its part along d, and R turns about d by
///
///     atan2(sum a_k d . (b_k x c_k), sum a_k (b_k . c_k - (b_k . d)(c_k . d))),   b_k = x_k - s,   c_k = y_k - t.
///
/// A rigid motion of the walls is taken over to rounding, no motion exactly. R makes it no linear function of the
/// walls' displacement.
class CarriedFeatures {
 public:
  using Displacement = WallFaces::Displacement;
  struct Feature {
    std::vector<Vec3> rim;
    RigidFit motion;
    double fade = 0;  ///< how far from the rim the walls have their own motion again [length]
  };

  /// `displacement`: that the rules of the walls give their nodes. Throws MotionError, beginning with `name`, for a
  /// feature that meets none of the walls or walls of different motion, and for a plane that there is not. Cost O(n log
  /// n) in the nodes of features and walls.
  CarriedFeatures(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& patches,
                  CarryRule const& rule, std::vector<int> const& walls, Displacement const& displacement,
                  std::string const& name);

  /// Displacement of nodes of the features, found by their baseline position. Throws MotionError for other points. Cost
  /// O(1) each.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;

  [[nodiscard]] std::vector<Feature> const& features() const { return features_; }

 private:
  [[nodiscard]] int feature_at(Vec3 const& point) const;  ///< -1: none
  [[nodiscard]] Feature made(std::set<int> const& rim, RigidFit const& motion, std::optional<double> const& fade) const;
  [[nodiscard]] std::string described(Boundary const& boundary, int feature) const;

  std::string name_;
  PatchSurface surface_;
  std::vector<int> feature_of_;  ///< per vertex
  std::vector<Feature> features_;
};

/// Nodes of walls that features have too go with the features; those around go along by
///
///     u(p) = u_w(p) + (1 - c1(d / D)) (u_f(p) - u_w(p)),   c1(t) = t^2 (3 - 2 t),
///
/// u_w what the rule of the wall says, u_f the rigid motion of the nearest feature, d the distance of p from its rim
/// along the edges of the wall. D is CarryRule::fade, half the way to the next feature at most, and no farther than the
/// nearest node that patches with another displacement of their own have too, or a periodic copy on the wall. Beyond D
/// the wall keeps its displacement to the bit.
class CarryingWall {
 public:
  /// `patches`: the walls, of one rule or of several; `own`: their displacement. `limits`: per patch of the mesh,
  /// whether it has a displacement of its own that the nodes share which the walls have on it. Cost O(n log n).
  CarryingWall(Boundary const& boundary, std::vector<int> const& patches,
               std::vector<CarriedFeatures::Feature const*> const& features, std::vector<char> const& limits,
               CarriedFeatures::Displacement const& own);

  /// Changes the displacement that the rule of the wall gives to points into what they get; points that are no nodes of
  /// the wall keep it.
  void change(std::span<Vec3 const> points, std::span<Vec3> displacement) const;

 private:
  PatchSurface surface_;
  std::vector<char> changes_;  ///< per vertex
  std::vector<Vec3> displacement_;
};

}  // namespace gridmorph
