// Where zones are cut so that every block has six whole faces.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// A plane of nodes of one zone, at `index` along `axis`.
struct CutPlane {
  int zone = -1;
  int axis = 0;
  int index = 0;
  auto operator<=>(CutPlane const&) const = default;
};

/// The planes of cuts. Throws PlanError naming every cut in a zone that is not there, or not inside it.
std::vector<CutPlane> planes_of(Mesh const& mesh, std::vector<BlockCut> const& cuts);

/// Sorted node indices of the cut planes along each axis, both zone ends included.
using ZoneCuts = std::array<std::vector<int>, 3>;

/// Cuts every zone at every patch limit, interface limit and at the planes asked for, and carries each cut through the
/// interfaces into the neighbours until nothing changes. Coordinates are not touched.
/// Throws MeshError when the result would exceed max_pieces (interfaces that shift at every turn).
std::vector<ZoneCuts> cut_zones(Mesh const& mesh, Links const& links, std::vector<CutPlane> const& asked,
                                Index max_pieces = 4'000'000);

/// Where a near field of n_layers cells off a range of a zone face ends.
struct LayerLimit {
  std::vector<CutPlane> planes;         ///< outer limits of the near field (may be zone ends)
  std::vector<IndexRange> hit_patches;  ///< ranges where the layers reach a boundary face first
  std::vector<int> hit_zones;           ///< zones of hit_patches
};

/// Follows n_layers cells off a face range through block and zone limits.
LayerLimit layer_limit(Mesh const& mesh, Links const& links, int zone, IndexRange const& wall, int n_layers);

}  // namespace gridmorph
