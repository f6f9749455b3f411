// Blades that are extended or trimmed along themselves to end walls that move: such a wall and where its rule takes it,
// the blades, and the nodes of the wall around them.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The patches of one rule, and the displacement that it gives to their nodes.
class MovedWall {
 public:
  using Displacement = std::function<void(std::span<Vec3 const> points, std::span<Vec3> out)>;

  /// `anywhere`: the displacement is known beside the nodes too. Throws MotionError, beginning with `name`, where there
  /// are no faces.
  MovedWall(Boundary const& boundary, std::vector<int> patches, Displacement displacement, bool anywhere,
            std::string const& name);

  [[nodiscard]] std::vector<int> const& patches() const { return patches_; }
  [[nodiscard]] PatchSurface const& surface() const { return surface_; }
  /// The displacement of each vertex.
  [[nodiscard]] std::vector<Vec3> const& displacement() const { return displacement_; }
  /// Whether any vertex moves.
  [[nodiscard]] bool moves() const;
  /// Whether the baseline has a node of the wall there.
  [[nodiscard]] bool has(Vec3 const& point) const { return surface_.numbers.find(point) >= 0; }
  /// The facets as they are moved, and their copies across the periodic connections that they touch.
  [[nodiscard]] TargetTree const& moved() const { return moved_; }
  /// Where vertex v goes if it is first moved along the wall by `shift`: its own place for no shift.
  [[nodiscard]] Vec3 displaced(int v, Vec3 const& shift) const;
  /// The shift with which vertex v goes by u: displaced(v, shift_to(v, u)) = u, by fixed-point iteration. Throws
  /// MotionError, beginning with `name`, where the wall's displacement changes too fast from place to place for that.
  [[nodiscard]] Vec3 shift_to(int v, Vec3 const& u, std::string const& name) const;

 private:
  [[nodiscard]] Vec3 at(Vec3 const& point) const;

  std::vector<int> patches_;
  Displacement rule_;
  bool anywhere_;
  PatchSurface surface_;
  std::vector<Vec3> displacement_;
  TargetTree moved_;
};

/// The spanwise grid lines of the patches slide along themselves. A line is a C1 cubic over its arc length s through
/// its nodes, with slopes of parabolas through three of them, and goes on straight beyond its ends. An end on a wall
/// that moves goes to s + d, where the line meets the moved facets of the wall (Newton's method); between the ends d is
/// linear in s, so that spacings grow alike all along a line. Ends on no such wall stay, and so do nodes on no line
/// (tip faces).
class ExtensionMotion {
 public:
  /// Throws MotionError, beginning with `name`, where faces of elements do not stand in rows, no line ends on the
  /// walls, a line does not meet its wall, or less than a tenth of one is left. Cost O(nodes log).
  ExtensionMotion(Boundary const& boundary, std::vector<int> const& patches, std::span<MovedWall const* const> walls,
                  std::string const& name, std::vector<std::string>& notes);

  /// Displacement of nodes of the patches, found by their baseline position. Throws MotionError for other points.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;

  [[nodiscard]] PatchSurface const& surface() const { return surface_; }
  /// The displacement of each vertex of surface().
  [[nodiscard]] std::vector<Vec3> const& displacement() const { return displacement_; }

 private:
  std::string name_;
  PatchSurface surface_;
  std::vector<Vec3> displacement_;
};

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
