// The nodes that chains reach, line by line: what lies on one line together, whatever pieces and zones it runs through.
#pragma once

#include <gridmorph/kernels/transposed_lines.hpp>
#include <gridmorph/kernels/volume_pass.hpp>

#include <array>
#include <map>
#include <vector>

namespace gridmorph::detail {

/// A bundle, and where its lines lie on the chain.
struct PlacedBundle {
  kernels::LineBundle bundle;
  std::array<int, 2> first, n;  ///< a, b
};

PlacedBundle bundle_of(kernels::SkeletonSweep const& sweep);
PlacedBundle bundle_of(kernels::VolumeBox const& box, kernels::VolumeTerm const& term);

/// Per chain of a stage or pass, in the order of its chains.
using BundlesOfChains = std::map<std::int32_t, std::vector<PlacedBundle>>;

struct LineGroups {
  std::vector<kernels::LineGroup> groups;
  std::vector<kernels::LineBundle> bundles;
};
/// Bundles cut so that two of them have the same lines or none in common, and put together by their lines. Cost: linear
/// in bundles, but for sorts.
LineGroups groups_of(BundlesOfChains const& of_chains);

}  // namespace gridmorph::detail
