// First cell height and orthogonality over wall faces; internal to the quality part.
#pragma once

#include <gridmorph/quality/quality.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

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

/// WallQuality at the nodes of the wall patches that a column leaves from, all and group by group (first family of a
/// patch, or its BC name). The normal at a node is the sum of the area vectors of its faces in the group.
template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                           BoundaryFacePatches const& face_patches,
                           UnstructuredQualityInput<typename Exec::memory_space> const& input);

}  // namespace gridmorph::detail
