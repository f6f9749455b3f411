// A target that goes on beyond the sides of the mesh, cut off there.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <utility>
#include <vector>

namespace gridmorph {

/// What a surface that goes to a target may end on.
struct BesideTarget {
  std::vector<SlipSurface> const& slides;  ///< what nodes of other patches slide on
  std::vector<int> fixed;                  ///< patches whose nodes stay
  std::vector<int> free;                   ///< patches whose nodes go along
};

/// A plane or a surface of revolution that the mesh ends on, beside a surface that moves.
class TargetSide {
 public:
  /// sense: 1 where the surface that moves is at positive heights over `surface`, -1 where it is at negative ones.
  /// within: what is no farther from it counts as on it.
  TargetSide(SlipSurface surface, double sense, double within)
      : surface_(std::move(surface)), sense_(sense), within_(within) {}

  [[nodiscard]] double within() const { return within_; }

  /// How far p is from the side: positive on the side of the surface that moves.
  [[nodiscard]] double height(Vec3 const& p) const { return sense_ * surface_.view().offset(p); }
  /// The point of the side between p and q, whose heights have different signs; to rounding. The same for (q, p).
  [[nodiscard]] Vec3 crossing(Vec3 const& p, Vec3 const& q) const;
  /// Points of the side from p to q, two points of it on a facet with that normal, in the plane of the facet: so many
  /// that straight lines between them, p and q are within `tolerance` of it, at most 255. None where the side is a
  /// plane.
  [[nodiscard]] std::vector<Vec3> way(Vec3 const& p, Vec3 const& q, Vec3 const& normal, double tolerance) const;

 private:
  SlipSurface surface_;
  double sense_, within_;
};

/// The sides that a surface ends on: planes and surfaces of revolution that nodes of it lie on and none crosses, to
/// 1e-6 of its size. They are what nodes of other patches slide on, and patches that stay or go along without a surface
/// of their own, as far as these are flat, or surfaces of revolution about the axis, to 1e-6 of their size, and the
/// surface meets them at more than 45 degrees. Cost O(n log n) in the nodes of these patches.
std::vector<TargetSide> sides_beside(Boundary const& boundary, PatchSurface const& surface, BesideTarget const& beside,
                                     Axis const& axis);

/// (vertices of the surface) Whether a patch that stays has the vertex as well.
std::vector<char> vertices_on(Boundary const& boundary, PatchSurface const& surface, std::vector<int> const& patches);

/// The part of a target that is above all sides. Nodes on a side stay on it, so that a target which goes on beyond
/// (terrain, a body whose half is meshed, a blade that goes through hub and case) is one that ends there. Edges are cut
/// once, to rounding: what ends on a plane lies on it; facets that a surface of revolution cuts end on it within 1e-8
/// of the target's size. A target that ends before, or lies beyond altogether, comes back as it is. Cost O(points +
/// triangles) for each side that cuts.
TargetTree cut_at_sides(TargetTree target, std::vector<TargetSide> const& sides);
/// The same of lines in a plane, from end to end.
std::vector<std::pair<Vec3, Vec3>> cut_at_sides(std::vector<std::pair<Vec3, Vec3>> lines,
                                                std::vector<TargetSide> const& sides);

}  // namespace gridmorph
