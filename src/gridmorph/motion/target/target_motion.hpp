// One target rule, evaluated: where each node of its patches goes.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/target/target_sides.hpp>
#include <gridmorph/motion/target_reach.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class TargetMotion {
 public:
  /// Throws MotionError when the target is not usable for these patches. `name` begins its messages and notes.
  /// A target to project to is cut off at the sides `beside` these patches that they end on (target_sides.hpp).
  TargetMotion(Boundary const& boundary, std::vector<int> const& patches, TargetRule const& rule, Axis const& axis,
               BesideTarget const& beside, std::string const& name, std::vector<std::string>& notes);

  /// The motion of another one to its target, with another share of the way.
  TargetMotion(TargetMotion const& other, double share);

  /// Displacement of nodes of the patches, found by their baseline position. Throws MotionError for other points.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;

  /// Whether nodes go all the way; otherwise how far they end from the target says nothing.
  [[nodiscard]] bool whole() const { return share_ == 1; }

  /// How far the nodes of the patches ended from the target.
  [[nodiscard]] TargetReach reach(Coordinates const& morphed) const;

 private:
  using Mapping = TargetRule::Mapping;

  /// Patches of an unstructured mesh: node for node as listed, by sections, or onto the surface or profile.
  void map_faces(Boundary const& boundary, TargetRule const& rule, Axis const& axis, BesideTarget const& beside,
                 std::vector<std::string>& notes);
  void project(Boundary const& boundary, TargetRule const& rule, Axis const& axis, BesideTarget const& beside,
               std::vector<std::string>& notes);
  void map_onto_sections(Boundary const& boundary, TargetRule const& rule, Axis const& axis,
                         std::vector<std::string>& notes);

  PatchSurface surface_;
  std::string name_;
  double share_ = 1;
  Mapping mapping_ = Mapping::nodes;
  std::vector<Vec3> displacement_;         ///< per vertex
  std::vector<char> reached_;              ///< per vertex: belongs to the target; empty: all do
  TargetTree facets_;                      ///< what distances are measured to, unless node for node
  std::vector<RigidTransform> to_target_;  ///< per grid, before that; empty: as they are
};

/// Grids and triangles of a target as one surface; points that coincide are one. Throws MotionError when the arrays are
/// not consistent, not finite, or hold no facet.
TargetTree target_facets(TargetGeometry const& target, std::string const& name);

}  // namespace gridmorph
