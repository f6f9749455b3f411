// Where a target takes the nodes of a surface: onto grids or listed nodes of its own, onto a profile in a plane, onto
// sections.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/motion/target/target_sides.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// Displacement of every vertex when every patch has a grid of its size; nothing if some patch has none. Each grid
/// serves one patch. Directions may be swapped or reversed, and a direction in which patch and grid close on themselves
/// may start anywhere: of all these the one is taken that agrees with the neighbours already placed and moves nodes
/// least (squares), unless another changes the shape far less (a tenth of the squares that the best rigid motion
/// leaves).
///
/// Throws MotionError where patches meet and their grids do not. Cost O(nodes), times the places where a closed grid
/// may start (on at most 2000 of its nodes).
std::optional<std::vector<Vec3>> match_grids(PatchSurface const& surface, std::vector<TargetGrid> const& grids,
                                             Boundary const& boundary, std::string const& name,
                                             std::vector<std::string>& notes);

/// Displacement of every vertex from positions listed patch after patch, i fastest. Throws MotionError when their
/// number is not that of the nodes, or coincident nodes have different targets.
std::vector<Vec3> match_nodes(PatchSurface const& surface, std::vector<Vec3> const& nodes, Boundary const& boundary,
                              std::string const& name);

/// Displacement of every vertex of lines in a plane z = constant onto the profile of the target: its sections where it
/// has some, laid into that plane, otherwise the cut of its facets with it. Corners go to corners and the lines between
/// them to the way between their images, with equal shares of arc length; a closed line without corners is turned so
/// that its nodes move least, an open one goes to an open one from end to end (edge_images.hpp). What has no
/// counterpart goes to the closest point. A profile of points around a closed line is closed. It is cut off at `sides`.
/// A vertex of `held` (one per vertex) that lies on the profile to 1e-6 of the size of the surface stays.
///
/// Throws MotionError when sections do not lie across z and when the plane meets no facet. Cost O(vertices log points).
std::vector<Vec3> project_to_profile(PatchSurface const& surface, TargetGeometry const& target,
                                     std::vector<TargetSide> const& sides, std::vector<char> const& held,
                                     std::string const& name, std::vector<std::string>& notes);

struct SectionMapping {
  std::vector<Vec3> displacement;  ///< per vertex of the surface
  std::vector<char> mapped;  ///< per vertex: on a section; the others (tip faces) are carried along by their edges
  TargetTree facets;         ///< flat facets between the points of the sections
  std::vector<RigidTransform> to_target;  ///< per grid: onto the copy of the blade that the target is
};

/// Sides that lie a pitch apart (H mesh) are brought together by the periodic transforms of the mesh, at the copy of
/// the blade that is nearest to the target. Stitches the spanwise grid lines of the patches into one closed contour;
/// its rows are the sections of the mesh. Of patches without grid lines they are cuts through the facets
/// (section_rows.hpp). A node at SectionPosition p and span coordinate w goes to the target's surface at p and the
/// same share of the span between the ends of the column p, or the same w (TargetRule::SpanMatch). Between target
/// sections: cubic Hermite pieces over w with slopes from parabolas; positions that agree with a section to 1e-9 take
/// its point exactly. One target section alone shapes all nodes of a mesh and leaves their w as it is.
///
/// Throws MotionError when the patches are not one blade or wing, or sections are not usable. Cost O(nodes log points).
SectionMapping map_sections(Boundary const& boundary, PatchSurface const& surface, TargetRule const& rule,
                            Axis const& axis, std::string const& name, std::vector<std::string>& notes);

}  // namespace gridmorph
