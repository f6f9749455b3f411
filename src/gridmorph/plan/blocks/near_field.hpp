// Stage 0: the near field of moving walls.
#pragma once

#include <gridmorph/plan/blocks/stage_builder.hpp>

#include <vector>

namespace gridmorph {

/// The walls of one [boundary_layer] entry and how many cells its near field has (0: up to the first opposite block
/// face).
struct NearField {
  std::vector<int> walls;  ///< patch numbers
  int layers = 0;
  BoundaryLayer::Mode mode = BoundaryLayer::Mode::rotate;
  bool automatic = false;  ///< Extent::automatic: none where there is no room, see room_limits()
};

/// Whether the near field turns with its walls.
inline bool turns(NearField const& field) { return field.mode != BoundaryLayer::Mode::translate; }

/// Walls and layer counts from the options: an empty wall list takes every patch that ranks as a wall (`kinds`, see
/// ranked_kinds()) and that an explicit rule other than `fixed` moves; walls at gaps (`at_gap`, see gap_walls()) have
/// none. A thickness becomes the median, over all wall nodes, of the layers that reach it. Without any boundary layer
/// in the options there is the default one, if walls move. Throws PlanError for selectors that match no patch and near
/// fields that reach another boundary.
std::vector<NearField> near_fields(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                                   std::vector<PatchKind> const& kinds, std::vector<char> const& at_gap,
                                   PlanOptions const& options);

/// Planes that bound the near fields: to be cut, and kept when blocks are merged.
std::vector<CutPlane> near_field_limits(Mesh const& mesh, Links const& links, std::vector<NearField> const& fields);

/// Planes that bound near fields of Extent::automatic where the block off their walls goes on to a boundary, to a
/// periodic interface included: a third of its cells off the wall. `topology`: without them. Adds to the notes how far
/// such near fields reach.
std::vector<CutPlane> room_limits(Mesh const& mesh, Topology const& topology, std::vector<NearField> const& fields,
                                  std::vector<std::string>& notes);

/// Chains off the walls through the near fields, walls first. Blocks between two walls with near fields have none: what
/// moves both is interpolated between them. Throws PlanError when a near field has no opposite face and is not
/// automatic: such ones are left out there.
std::vector<StageChain> near_field_chains(Mesh const& mesh, Topology const& topology, Known const& known,
                                          std::vector<NearField> const& fields);

}  // namespace gridmorph
