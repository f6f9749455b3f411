// Compiles the pieces of a chain into the flat tables that kernels walk and sweep.
#pragma once

#include <gridmorph/plan/blocks/chain.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>
#include <gridmorph/plan/blocks/skeleton.hpp>
#include <gridmorph/plan/plan.hpp>

namespace gridmorph {

class WallRoots;

/// What every part of a plan refers to.
struct PlanContext {
  Mesh const& mesh;
  Topology const& topology;
  Skeleton const& skeleton;
  RotationTable& rotations;
  std::vector<int> const& box_of_piece;  ///< in Plan::boxes, -1 for pieces without inner nodes
  std::vector<PatchKind> const& kinds;   ///< what patches rank as, see ranked_kinds()
  std::vector<EndKind> const& ends;      ///< the same, but those that the priority names apart
  GridLengths const& lengths;            ///< between nodes of `mesh`
  WallRoots* roots = nullptr;            ///< of near fields that turn
};

/// A box of zone nodes and where it lies on a chain.
struct PlacedBox {
  int zone = -1;
  IndexRange nodes;       ///< borders included
  Orientation to_chain;   ///< zone axes -> chain axes
  Index3 begin{0, 0, 0};  ///< position (s, a, b) on the chain of its lower corner
  Mat3 rotation;          ///< chain frame -> frame of the zone
  Vec3 translation;       ///< and positions, see ChainStep
  bool rotated = false;

  /// A place of the zone in the chain's frame.
  [[nodiscard]] Vec3 in_chain_frame(Vec3 const& x) const {
    return rotated ? transpose(rotation) * (x - translation) : x;
  }

  [[nodiscard]] Index3 position(Index3 const& node) const {
    Index3 at{};
    for (int d = 0; d < 3; ++d) {
      int const c = to_chain.axis[d];
      at[c] = begin[c] + (to_chain.sign[d] > 0 ? node[d] - nodes.begin[d] : nodes.end[d] - 1 - node[d]);
    }
    return at;
  }
};

PlacedBox placed_box(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int ps, int pa, int pb);

/// The segment of a box, without parameter targets.
kernels::Segment make_segment(Mesh const& mesh, PlacedBox const& box);

/// Slots of an entity -> values that the chain keeps at `first` + value_index(position on the chain), chain frame.
/// value_index must be affine. Adds nothing for an entity without nodes.
template <class ValueIndex>
void add_gather(PlanContext const& context, PlacedBox const& box, int entity, Index first,
                ValueIndex const& value_index, std::vector<kernels::NodeCopy>& out);

/// Makes chain number `number` write an entity of a box (category: cs + 3 (ca + 3 cb)): a skeleton sweep, or a term of
/// the volume pass where it is the inside of piece `piece`; line parameters go where the segment then says.
void add_writer(PlanContext const& context, LineTables& lines, std::vector<kernels::SkeletonSweep>& sweeps,
                std::vector<VolumePart>& volume, int number, PlacedBox const& box, int piece, int entity, int category,
                kernels::Segment& segment);

/// Appends the side tables of chain number `number` (the last in stage.lines) when any of its sides, or an edge or
/// corner on them, is known; leaves the chain a plain sweep otherwise. Cost: O(nodes on the chain's surface).
void add_side_tables(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                     int number, Stage& stage);

// --- implementation of the template ---

/// Owner's frame of an entity -> the chain's frame, in the rotation table; -1: the same.
std::int32_t to_chain_frame(PlanContext const& context, PlacedBox const& box, int entity);

template <class ValueIndex>
void add_gather(PlanContext const& context, PlacedBox const& box, int entity, Index first,
                ValueIndex const& value_index, std::vector<kernels::NodeCopy>& out) {
  auto const rows = context.skeleton.rows(entity);
  if (!rows) return;
  auto at = [&](Index3 const& step) {
    return value_index(box.position({rows->at[0] + step[0], rows->at[1] + step[1], rows->at[2] + step[2]}));
  };
  Index const origin = at({0, 0, 0});
  out.push_back({rows->slot, 1, rows->slot_q, first + origin, at(rows->step_p) - origin, at(rows->step_q) - origin,
                 rows->n_p, rows->n_q, to_chain_frame(context, box, entity)});
}

}  // namespace gridmorph
