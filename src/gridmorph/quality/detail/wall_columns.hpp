// First cell height and orthogonality at the walls of unstructured meshes; internal to the quality part.
#pragma once

#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

namespace gridmorph::detail {

/// WallQuality at the nodes of the wall patches that a column leaves from, all and group by group (first family of a
/// patch, or its BC name). The normal at a node is the sum of the area vectors of its faces in the group.
template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                           BoundaryFacePatches const& face_patches,
                           UnstructuredQualityInput<typename Exec::memory_space> const& input);

}  // namespace gridmorph::detail
