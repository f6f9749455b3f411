// Blades that are extended or trimmed along themselves to end walls that move.
#pragma once

#include <gridmorph/motion/end_walls/moved_wall.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

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

}  // namespace gridmorph
