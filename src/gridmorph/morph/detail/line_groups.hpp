// The nodes that chains reach, line by line: what lies on one line together, whatever pieces and zones it runs through.
#pragma once

#include <gridmorph/kernels/transposed_lines.hpp>
#include <gridmorph/kernels/volume_pass.hpp>

#include <array>
#include <map>
#include <vector>

namespace gridmorph::detail {

/// A patch, and where its lines lie on the chain.
struct PlacedPatch {
  kernels::LinePatch patch;
  std::array<int, 2> first, n;  ///< a, b
};

PlacedPatch patch_of(kernels::SkeletonSweep const& sweep);
PlacedPatch patch_of(kernels::VolumeBox const& box, kernels::VolumeTerm const& term);

/// Per chain of a stage or pass, in the order of its chains.
using PatchesOfChains = std::map<std::int32_t, std::vector<PlacedPatch>>;

struct LineGroups {
  std::vector<kernels::LineGroup> groups;
  std::vector<kernels::LinePatch> patches;
};
/// Patches cut so that two of them have the same lines or none in common, and put together by their lines. Cost: linear in patches, but for sorts.
LineGroups groups_of(PatchesOfChains const& of_chains);

}  // namespace gridmorph::detail
