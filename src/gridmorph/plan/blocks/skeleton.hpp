// The skeleton: all nodes on faces, edges and corners of pieces, and all in regions that rules move. It carries the
// displacement from stage to stage; the nodes inside other pieces depend on nothing but the skeleton.
//
// Every entity class has its slots, in the order of its owner's nodes and in its owner's frame, so that nodes that
// coincide share one displacement.
#pragma once

#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/plan/topology.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// Rotations used by the tables of a plan, without repeats.
class RotationTable {
 public:
  explicit RotationTable(std::vector<Mat3>& table) : table_(table) {}
  std::int32_t number(Mat3 const& m);
  [[nodiscard]] Mat3 const& operator[](std::int32_t number) const { return table_[std::size_t(number)]; }

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

}  // namespace gridmorph
