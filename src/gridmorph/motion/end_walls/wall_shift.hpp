// The nodes of an end wall around blades that are extended to it.
#pragma once

#include <gridmorph/motion/end_walls/extension.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Where a blade ends on the wall its nodes go where the blade goes; those around go along by
///
///     shift(p) = (1 - c1(d / D)) sum_j r_j^-4 e_j / sum_j r_j^-4,   c1(t) = t^2 (3 - 2 t),
///
/// e_j the shift with which node j of the blades' rims goes where its blade says (MovedWall::shift_to), r_j its
/// distance from p, its periodic copies among them; d the distance of p from the rims along the edges of the wall, D
/// that of the nearest node that other patches have too (inlet, outlet; the farthest node where there is none). Then
/// the wall's rule at p + shift takes the node onto the moved wall.
class WallShift {
 public:
  /// Throws what shift_to() does. Cost O(nodes of the wall x nodes of the rims).
  WallShift(Boundary const& boundary, MovedWall const& wall, std::span<ExtensionMotion const* const> blades,
            std::string const& name);

  /// Displacement of nodes of the wall, found by their baseline position. Throws MotionError for other points.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;

 private:
  std::string name_;
  PatchSurface const* surface_;
  std::vector<Vec3> displacement_;
};

}  // namespace gridmorph
