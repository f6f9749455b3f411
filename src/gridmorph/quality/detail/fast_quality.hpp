// A verdict on a structured mesh in one pass over its cells; internal to the quality part.
#pragma once

#include <gridmorph/quality/quality.hpp>

namespace gridmorph::detail {

/// measure_quality() for QualityInput::fast: numbers of cells, what fell, smallest determinant and angle. `input` has
/// been checked and knows the handedness.
template <class Exec>
QualityReport fast_quality(Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input);

/// Takes from a report what a verdict has not gathered: means, and largest values of determinant and angle.
void keep_verdict(QualityReport& report);

}  // namespace gridmorph::detail
