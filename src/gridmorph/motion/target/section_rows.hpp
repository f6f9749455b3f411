// The sections of a blade or wing mesh: rows of vertices around it, or its facets cut where the nodes stand in no rows.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/target/section_profile.hpp>
#include <gridmorph/motion/target/span_coordinate.hpp>

#include <functional>
#include <string>
#include <utility>
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

/// Vertices and their positions around the section that each lies in.
struct SlicedSections {
  std::vector<std::pair<int, SectionPosition>> places;
  SectionProfile first, last;  ///< at the ends of the span
  int cuts = 0;
  Index facets = 0;
};

/// Cuts the facets at constant shares f of the span between the two ends of the surface,
///
///     f(x) = (w(x) - w_0(x)) / (w_1(x) - w_0(x)),
///
/// w being the span coordinate, w_0 and w_1 that of the lower and upper rim at the place of the rim nearest to x across
/// the span: so that sections beside a curved hub are whole. Rims are edges of one facet, along the span by less than
/// 0.7 of their length, within a quarter of the span of its ends; where there is none (a round tip) w_0 or w_1 is the
/// least or largest w. Facets that gain less span than 0.3 of their length have no sections (facet_cuts.hpp); what is
/// only theirs, and nodes beyond the last whole section, are in no place.
///
/// Where nodes stand in rows (those as many edges from the lower end as one another differ in f by less than a fifth of
/// the gap to the next ones), a cut through each of them; otherwise 17 to 512 evenly spaced ones, two for each facet
/// along the span, and positions linear between the cuts on both sides of a node, where its chord carries it. Nodes
/// amid the sides of second-order faces are taken into the cut beside which they lie.
///
/// Throws MotionError beginning with `name` where the facets make up no section or several. Cost O(facets log), and of
/// each cut the facets beside it.
SlicedSections slice_sections(PatchSurface const& surface, SpanCoordinate const& span, Vec3 const& flow,
                              SectionProfile::Edges edges, std::string const& name);

}  // namespace gridmorph
