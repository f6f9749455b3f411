// First cell height and orthogonality over wall faces; internal to the quality part.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <vector>

namespace gridmorph::detail {

/// WallQuality over the faces; baseline Views may be empty.
template <class Exec>
WallQuality wall_quality(Exec const& exec, Mesh const& mesh,
                         CoordinateViews<typename Exec::memory_space> const& coordinates,
                         CoordinateViews<typename Exec::memory_space> const& baseline,
                         std::vector<WallFace> const& walls);

}  // namespace gridmorph::detail
