// First cell height and orthogonality over wall faces; internal to the quality part.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <vector>

namespace gridmorph::detail {

struct WallQualities {
  WallQuality all;
  std::vector<WallGroup> groups;
};

/// WallQuality over the faces, all and group by group; baseline Views may be empty.
template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh,
                           CoordinateViews<typename Exec::memory_space> const& coordinates,
                           CoordinateViews<typename Exec::memory_space> const& baseline,
                           std::vector<WallFace> const& walls);

}  // namespace gridmorph::detail
