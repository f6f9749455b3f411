// The `sections` rule on a surface: what its tables do to the points of a blade or wing.
#pragma once

#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/turbomachinery/section_places.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Keeps the edges of a blade on the slip surfaces that it stands on or touches.
///
/// A motion u takes a point off a surface S by the change of its distance; c_S(u) is the correction that gives the
/// distance back. Every point gets u + sum_S w_S c_S(u) with w_S = (1 / d_S) / sum_T (1 / d_T), d_S the distance of the
/// baseline point from S; ends of the span that touch no surface count in the sum with their distance along the span
/// and have no correction. So w is 1 on the surface itself and, between two ends, falls linearly along the span.
class EdgeTrim {
 public:
  /// The slip surfaces whose patches share nodes with the given ones. Keeps pointers to `surfaces`.
  EdgeTrim(Boundary const& boundary, SectionFrame const& frame, std::vector<int> const& patches,
           SlipSurfaces const& surfaces);

  /// Corrected displacement of a point at a span fraction. Comes back bit for bit when nothing is touched.
  [[nodiscard]] Vec3 operator()(Vec3 const& point, double span, Vec3 const& u) const;

 private:
  std::vector<SlipSurface const*> surfaces_;
  std::vector<double> free_ends_;  ///< span fractions
  double height_ = 0;
};

/// Displacement of the points of one sections rule. A function of the position alone: points that coincide move alike.
class SectionMotion {
 public:
  /// Throws MotionError when the sections cannot be made. Keeps pointers to `surfaces`. Cost O(nodes log nodes).
  SectionMotion(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
                std::vector<int> const& patches, SlipSurfaces const& surfaces, std::vector<std::string>& notes);

  /// The displacement of a point. Cost: O(log sections), times the blades of the rule.
  [[nodiscard]] Vec3 displacement(Vec3 const& point) const;

 private:
  /// The integral of tan(bow) from span 0.
  [[nodiscard]] double bow_integral(double span) const;

  SectionsRule rule_;
  SectionPlaces places_;
  EdgeTrim trim_;
  bool thickens_, bows_;
  std::vector<double> bow_knots_, bow_sums_;  ///< span fractions, and the integral up to there
};

}  // namespace gridmorph
