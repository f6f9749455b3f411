// How many cells a morph turned inside out.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <algorithm>

namespace gridmorph {

/// Cells turned inside out that were sound in the baseline: at their corners or, where there is a certificate, anywhere
/// in them.
inline Index newly_inverted(QualityReport const& quality) {
  Index const at_corners = quality.near_field.newly_inverted + quality.far_field.newly_inverted;
  return quality.certificate ? std::max(at_corners, quality.certificate->broken.cells) : at_corners;
}

}  // namespace gridmorph
