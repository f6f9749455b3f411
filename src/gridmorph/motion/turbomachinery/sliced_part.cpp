#include <gridmorph/motion/turbomachinery/sliced_part.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace gridmorph {

namespace {

constexpr double near_ends = 0.3;  ///< of the extent: open contours whose ends are nearer go around the blade (C)

/// Whether a section follows another one closely along the span, or one of them is cut off.
bool alike(CutLine const& line, CutLine const& other) {
  double const size = line.extent(), before = other.extent();
  return line.size() >= 3 && line.closed == other.closed && size > 0.9 * before && size < 1.1 * before;
}

}  // namespace

SlicedPart::SlicedPart(FacetCuts const& cuts, SliceInput const& input, SurfacePart triangles)
    : cuts_(&cuts), input_(&input), triangles_(std::move(triangles)) {
  auto const [lo, hi] = cuts.range(triangles_);
  middle = first = last = 0.5 * (lo + hi);
  reference_ = cuts.cut(triangles_, middle, false);
  if (reference_.size() < 3 || !(reference_.extent() > 0)) return;
  around_ = reference_.closed ||
            distance(reference_.points.front(), reference_.points.back()) < near_ends * reference_.extent();
  if (!around_ && input.along(reference_.points.front()) > input.along(reference_.points.back())) reference_.reverse();
  first = limit(lo);
  last = limit(hi);
  step = cuts.step(triangles_);
}

bool SlicedPart::holds(SlicedPart const& other) const {
  if (!around_ || other.reference_.size() == 0) return false;
  Vec3 const area = reference_.area();
  Vec3 const n = (1 / norm(area)) * area;
  Vec3 const axis = reference_.points[1] - reference_.points[0];
  Vec3 const x = (1 / norm(axis)) * axis;
  Vec3 const y = cross(n, x);
  Vec3 const p = other.reference_.points.front();
  bool inside = false;
  for (int k = 0, j = reference_.size() - 1; k < reference_.size(); j = k++) {
    Vec3 const a = reference_.points[k] - p, b = reference_.points[j] - p;
    double const ay = dot(a, y), by = dot(b, y);
    if ((ay > 0) == (by > 0)) continue;
    if (dot(a, x) + (dot(b, x) - dot(a, x)) * ay / (ay - by) > 0) inside = !inside;
  }
  return inside;
}

/// How far towards the end of its range a part has sections like its middle one.
double SlicedPart::limit(double end) const {
  constexpr int steps = 64, halvings = 24;
  double good = middle;
  CutLine line = reference_;
  auto const try_at = [&](double h) {
    CutLine next = cuts_->cut(triangles_, h, h > middle);
    if (!alike(next, line) || gap_opened(next)) return false;
    line = std::move(next);
    good = h;
    return true;
  };
  for (int n = 1; n <= steps; ++n) {
    double bad = n == steps ? end : middle + (end - middle) * n / steps;
    if (try_at(bad)) continue;
    for (int k = 0; k < halvings; ++k) {
      double const h = 0.5 * (good + bad);
      if (!try_at(h)) bad = h;
    }
    // Not where the nodes at the end scatter.
    return good + 1e-4 * (middle - end);
  }
  return good;
}

/// The ends of a section that goes around have come apart.
bool SlicedPart::gap_opened(CutLine const& line) const {
  return around_ && !line.closed && distance(line.points.front(), line.points.back()) >= near_ends * line.extent();
}

CutLine SlicedPart::cut(double span) const {
  CutLine line = cuts_->cut(triangles_, span, span > middle);
  if (line.size() < 2) return line;
  bool const against = around_ ? dot(line.area(), reference_.area()) < 0
                               : input_->along(line.points.front()) > input_->along(line.points.back());
  if (against) line.reverse();
  return line;
}

OuterParts outer_parts(FacetCuts const& cuts, SliceInput const& input) {
  OuterParts out;
  std::vector<SlicedPart> parts;
  for (SurfacePart& triangles : cuts.parts()) {
    SlicedPart part(cuts, input, std::move(triangles));
    if (part.last > part.first)
      parts.push_back(std::move(part));
    else
      ++out.passed_over;
  }
  double longest = 0;
  for (SlicedPart const& p : parts) longest = std::max(longest, p.last - p.first);
  std::vector<char> keep;
  for (SlicedPart const& p : parts)
    keep.push_back(p.last - p.first >= 0.5 * longest &&
                   std::none_of(parts.begin(), parts.end(), [&](SlicedPart const& other) {
                     return &other != &p && other.section().extent() > p.section().extent() && other.holds(p);
                   }));
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (keep[n] != 0)
      out.kept.push_back(std::move(parts[n]));
    else
      ++out.passed_over;
  }
  return out;
}

}  // namespace gridmorph
