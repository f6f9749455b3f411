// A blade put together from its patches: spanwise lines, stitched into contours around the sections.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/turbomachinery/facet_cuts.hpp>
#include <gridmorph/motion/turbomachinery/wall_curve.hpp>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// One contour along the span: lines of places from its lower to its upper end, in their order around the sections.
struct SlicedContour {
  std::vector<std::vector<SlicePlace>> lines;
  bool closed = false;
};

/// Cuts the facets of blades at evenly spaced span fractions (17 to 129, two for each facet along the span) and gives
/// every section points in the same places: at the ends of an open section, at the corners of its edges (an edge that
/// turns by more than 50 degrees within a tenth of the chord of the end of the section), or at the end itself where it
/// is round, and 65 between two of these, by arc length, denser towards the edges. Points that follow one another along
/// the span make the lines that grid lines of blocks are. They lie on the facets, so that sections are off a smooth
/// surface by O(h^2), h the length of a facet.
///
/// What gains less span than 0.3 of its length (tip faces, rims of squealers) is no part of a section. Every part that
/// hangs together gives one contour, the one that reaches farthest in each section: what else is cut, as walls of
/// holes, lies inside and goes along; pieces of a contour with gaps of less than a tenth of the chord between them
/// (holes in the surface) are one. So do parts that lie inside another's contour, or have less than half of its span
/// (inner walls of a squealer). The span fractions are those where all parts have whole sections. `notes` says how many
/// parts were passed over. Throws MotionError when no part has sections. Cost O(facets log), and of each section the
/// facets beside it.
std::vector<SlicedContour> slice_surface(SliceInput const& input, std::vector<std::string>& notes);

struct BladeNode {
  double m = 0;     ///< position along the flow path: the axial position where that is axial
  double span = 0;  ///< span fraction: 0 at the hub, 1 at the case
  int number = -1;  ///< among the nodes of the patches, in the order of Boundary::points(); -1 on cut facets
  Vec3 point;
};

/// Spanwise lines that follow one another around the sections.
struct BladeContour {
  std::vector<int> lines;
  bool closed = false;  ///< the last line is followed by the first (O mesh); otherwise one side of an H mesh, or a C
};

struct BladeSurface {
  std::vector<BladeNode> nodes;
  std::vector<std::vector<int>> lines;  ///< nodes from hub to case
  std::vector<BladeContour> contours;
  bool sliced = false;  ///< lines were made by cutting facets (slice_surface()): they are no lines of nodes
  /// The nodes of the patches, by their numbers, that those of cut facets are weighted means of; otherwise empty.
  std::vector<std::vector<std::pair<int, double>>> means;
};

/// What stitch_blade needs to know about places.
struct BladeInput {
  CylindricalFrame frame;
  std::function<FlowPosition(MeridionalPoint const&)> position;
  /// Distance from hub to case through a point.
  std::function<double(MeridionalPoint const&)> height;
  /// A measure that increases along the flow.
  std::function<double(Vec3 const&)> along;
};

/// What the nodes of a blade do.
struct BladeDisplacement {
  /// What the displacement of a point means for those that follow it: the components that are tabulated.
  std::function<CylindricalMotion(Vec3 const& point, Vec3 const& displacement)> motion;
  /// Displacements of the nodes of one patch, in patch_points order.
  std::function<void(int patch, std::span<Vec3 const> points, std::span<Vec3> displacement)> displacement;
};

/// Stitches the grids of the patches: finds which direction of each runs spanwise, joins pieces that
/// were split in span or around the section by their coincident nodes (1e-7 of the blade's size). Pieces that run
/// nowhere spanwise (tip faces) are left out with a note. Faces of elements are put together into grids first
/// (find_face_grids()), the lines of a plane mesh with their copies across it; where that leaves faces over, or lines
/// that do not run along the span together, the facets are cut instead (slice_surface()). Throws MotionError when
/// nothing is left or more than two surfaces meet in one line. Cost O(nodes log nodes), of cuts as slice_surface().
BladeSurface stitch_blade(Boundary const& boundary, std::vector<int> const& patches, BladeInput const& input,
                          std::vector<std::string>& notes);

/// The motions of the nodes of a stitched blade; of cut facets those of their corners, linear between. Cost O(nodes of
/// the patches).
std::vector<CylindricalMotion> motions_of(BladeSurface const& blade, Boundary const& boundary,
                                          std::vector<int> const& patches, BladeDisplacement const& given);

/// Leaves out the contours of splitter blades: those that begin or end elsewhere along the flow than the longest one
/// does, by more than 15 % of its chord. What is left are the sides of one blade, or copies of it. Returns how many
/// were left out. Throws MotionError when a contour lies wholly before or behind the longest: that is another row.
int leave_out_splitters(BladeSurface& blade);

}  // namespace gridmorph
