// The sections of a blade or wing mesh: rows of vertices around it.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <functional>
#include <string>
#include <vector>

namespace gridmorph {

/// Rows from the lower to the upper end of the span; each goes once around in the same order, the first vertex again at
/// its end when the contour closes.
struct SectionRows {
  std::vector<std::vector<int>> rows;
  std::vector<int> left_out;  ///< patches whose lines run nowhere along the span (tip faces)
};

/// Joins the spanwise grid lines of the patches, in span and around. `span` is the coordinate along the span. Surfaces
/// of two node planes or more; a surface without extent in span gives one row per grid line. Throws MotionError
/// beginning with `name` when the result is not one contour with lines of equal length.
SectionRows find_section_rows(PatchSurface const& surface, std::function<double(Vec3 const&)> const& span,
                              std::string const& name);

}  // namespace gridmorph
