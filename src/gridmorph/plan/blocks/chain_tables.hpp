// The skeleton: all nodes on faces, edges and corners of pieces, and all in regions that rules move. It carries the
// displacement from stage to stage; the nodes inside other pieces depend on nothing but the skeleton.
//
// Every entity class has its slots, in the order of its owner's nodes and in its owner's frame, so that nodes that
// coincide share one displacement.
//
// The pieces of a chain are compiled into the flat tables that kernels walk and sweep.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/plan/blocks/chain.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>
#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/topology.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// Rotations used by the tables of a plan, without repeats.
class RotationTable {
 public:
  explicit RotationTable(std::vector<Mat3>& table) : table_(table) {}
  std::int32_t number(Mat3 const& m);
  [[nodiscard]] Mat3 const& operator[](std::int32_t number) const { return table_[number]; }

 private:
  std::vector<Mat3>& table_;
};

bool same_rotation(Mat3 const& a, Mat3 const& b);

/// The nodes of one entity as rows, of a volume those of one of its layers: node (p, q) has slot + p + slot_q * q and
/// zone index at + p * step_p + q * step_q.
struct SkeletonRows {
  int n_p = 1, n_q = 1;
  Index slot = 0, slot_q = 0;
  Index3 at{0, 0, 0}, step_p{0, 0, 0}, step_q{0, 0, 0};
};

/// The index of node (p, q) in the zone that the rows lie in.
inline Index3 node_at(SkeletonRows const& rows, int p, int q) {
  Index3 at{};
  for (int d = 0; d < 3; ++d) at[d] = rows.at[d] + p * rows.step_p[d] + q * rows.step_q[d];
  return at;
}
inline Vec3 node_position(Mesh const& mesh, int zone, SkeletonRows const& rows, int p, int q) {
  return mesh.coordinates[mesh.zones[zone].node(node_at(rows, p, q))];
}

/// Layers of an entity's nodes: 1, but of a volume as many as nodes along its last axis.
int n_layers(IndexRange const& nodes);

class Skeleton {
 public:
  /// The volumes of blocks.region_of() belong to it: what a region moves is known node by node.
  Skeleton(Mesh const& mesh, Lattice const& lattice, Blocks const& blocks);

  [[nodiscard]] Index size() const { return n_slots_; }
  /// Rows of one occurrence of an entity; nothing when it has no nodes. Slots of a volume's layers follow one another.
  [[nodiscard]] std::optional<SkeletonRows> rows(int entity, int layer = 0) const;
  /// The copies from slots to all nodes of the mesh that belong to the skeleton, each in its zone's frame.
  [[nodiscard]] std::vector<kernels::NodeCopy> to_nodes(RotationTable& rotations) const;

 private:
  Mesh const& mesh_;
  Lattice const& lattice_;
  std::vector<Index> first_slot_;
  Index n_slots_ = 0;
};

/// The matrix that leaves of a displacement its part along a unit vector.
Mat3 onto(Vec3 const& axis);

class WallRoots;

/// What every part of a plan refers to.
struct PlanContext {
  HostInstance host;  ///< that loops over nodes and lines run on
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

/// A line of a side whose parameters are still to be found.
struct SideWalk {
  std::size_t tube = 0;
  int a = 0, b = 0;
  Index at = 0;  ///< of its first one in SideTables::t
};

/// Appends the side tables of chain number `number` (the last in stage.lines) when any of its sides, or an edge or
/// corner on them, is known; leaves the chain a plain sweep otherwise. `walks`: gets the lines of its sides. Cost:
/// O(nodes on the chain's surface).
void add_side_tables(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                     int number, Stage& stage, std::vector<SideWalk>& walks);
/// Finds the line parameters of sides once the lines of all chains are there.
void find_side_parameters(PlanContext const& context, std::vector<SideWalk> const& walks, Stage& stage);

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
