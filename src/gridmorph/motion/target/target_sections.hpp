// Mapping onto section profiles: the same place around the section, the same place along the span.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/motion.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct SectionMapping {
  std::vector<Vec3> displacement;  ///< per vertex of the surface
  std::vector<char> mapped;  ///< per vertex: on a section; the others (tip faces) are carried along by their edges
  TargetTree facets;         ///< flat facets between the points of the sections
  std::vector<RigidTransform> to_target;  ///< per grid: onto the copy of the blade that the target is
};

/// Sides that lie a pitch apart (H mesh) are brought together by the periodic transforms of the mesh, at the copy of
/// the blade that is nearest to the target. Stitches the spanwise grid lines of the patches into one closed contour;
/// its rows are the sections of the mesh. Of patches without grid lines they are cuts through the facets
/// (sliced_sections.hpp). A node at SectionPosition p and span coordinate w goes to the target's surface at p and the
/// same share of the span between the ends of the column p, or the same w (TargetRule::SpanMatch). Between target
/// sections: cubic Hermite pieces over w with slopes from parabolas; positions that agree with a section to 1e-9 take
/// its point exactly. One target section alone shapes all nodes of a mesh and leaves their w as it is.
///
/// Throws MotionError when the patches are not one blade or wing, or sections are not usable. Cost O(nodes log points).
SectionMapping map_sections(Boundary const& boundary, PatchSurface const& surface, TargetRule const& rule,
                            Axis const& axis, std::string const& name, std::vector<std::string>& notes);

}  // namespace gridmorph
