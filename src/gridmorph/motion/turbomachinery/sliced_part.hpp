// A part of a blade's surface that hangs together, and between which span fractions its sections are whole.
#pragma once

#include <gridmorph/motion/turbomachinery/facet_cuts.hpp>

#include <vector>

namespace gridmorph {

class SlicedPart {
 public:
  /// Finds the sections of a part. Keeps pointers to `cuts` and `input`. Cost: some hundred cuts.
  SlicedPart(FacetCuts const& cuts, SliceInput const& input, SurfacePart triangles);

  double middle = 0;  ///< of its span
  double first = 0,
         last = 0;  ///< between these its sections follow one another without being cut off; equal: it has none
  double step = 1;  ///< span of a facet

  [[nodiscard]] SurfacePart const& triangles() const { return triangles_; }
  /// The section of the part at mid span.
  [[nodiscard]] CutLine const& section() const { return reference_; }
  /// The section of the part at a span fraction, run through as that at mid span is.
  [[nodiscard]] CutLine cut(double span) const;
  /// Whether the sections of the part go around the blade: closed, or with ends that lie together (C).
  [[nodiscard]] bool around() const { return around_; }
  /// Whether the other part's section at mid span lies inside this one's.
  [[nodiscard]] bool holds(SlicedPart const& other) const;

 private:
  [[nodiscard]] double limit(double end) const;
  [[nodiscard]] bool gap_opened(CutLine const& line) const;

  FacetCuts const* cuts_;
  SliceInput const* input_;
  SurfacePart triangles_;
  CutLine reference_;
  bool around_ = false;
};

/// Parts with sections, but for those inside another's section and those with less than half of the longest span.
struct OuterParts {
  std::vector<SlicedPart> kept;
  int passed_over = 0;
};
OuterParts outer_parts(FacetCuts const& cuts, SliceInput const& input);

}  // namespace gridmorph
