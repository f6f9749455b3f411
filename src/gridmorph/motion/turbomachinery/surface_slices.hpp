// Sections of a blade whose surface has no grid lines: its facets cut at constant span fractions.
#pragma once

#include <gridmorph/motion/turbomachinery/facet_cuts.hpp>

#include <string>
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

}  // namespace gridmorph
