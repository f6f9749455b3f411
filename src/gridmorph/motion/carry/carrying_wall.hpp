// The nodes of walls around the features that they carry.
#pragma once

#include <gridmorph/motion/carry/carried_features.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

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
