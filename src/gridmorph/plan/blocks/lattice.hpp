// The entities of the cut mesh (corners, edges, faces, volumes of its pieces) and which of them coincide.
//
// Along each axis of a zone, lattice position 2c is cut plane c and position 2c+1 the open interval between cut planes
// c and c+1. An entity is a lattice triple; its dimension is the number of odd positions. The nodes of a zone are split
// among its entities without overlap, so "one displacement per entity" is "one displacement per node".
#pragma once

#include <gridmorph/plan/blocks/cuts.hpp>

#include <optional>
#include <span>
#include <vector>

namespace gridmorph {

/// One occurrence of an entity class in a zone.
struct EntityCopy {
  int entity = -1;
  IndexMap from_owner;       ///< node index in the owner's zone -> node index in this zone
  RigidTransform transform;  ///< owner position -> this position
  bool moved = false;        ///< transform is not the identity (reached through a periodic interface)
};

/// One side of a face: the piece it bounds and where.
struct FaceSide {
  int piece = -1;
  int axis = 0, side = 0;  ///< i_min ... k_max of the piece, in its zone's axes
  int entity = -1;         ///< the face entity in that piece's zone
};

/// A piece of a zone between neighbouring cut planes (a volume entity).
struct Piece {
  int zone = -1;
  Index3 lattice{0, 0, 0};  ///< cut interval along each axis
  IndexRange nodes;         ///< closed box of nodes, both bounding planes included
};

class Lattice {
 public:
  Lattice(Mesh const& mesh, Links const& links, std::vector<ZoneCuts> cuts);

  [[nodiscard]] std::vector<Piece> const& pieces() const { return pieces_; }
  [[nodiscard]] int n_entities() const { return offset_.back(); }
  [[nodiscard]] int n_classes() const { return int(class_begin_.size()) - 1; }
  [[nodiscard]] std::vector<ZoneCuts> const& cuts() const { return cuts_; }

  [[nodiscard]] int zone_of(int entity) const;
  [[nodiscard]] Index3 position(int entity) const;
  [[nodiscard]] int entity(int zone, Index3 const& position) const;
  /// Entity of a piece: 0, 1, 2 = lower plane, interior, upper plane along each axis; (1,1,1) is the piece itself.
  [[nodiscard]] int entity_of_piece(int piece, Index3 const& which) const;
  [[nodiscard]] int piece_of_volume(int entity) const { return piece_of_volume_[entity]; }
  [[nodiscard]] int dimension(int entity) const;
  /// Nodes of an entity; may be empty (a piece of one cell has no interior).
  [[nodiscard]] IndexRange nodes(int entity) const;

  [[nodiscard]] int class_of(int entity) const { return class_of_[entity]; }
  /// All coincident copies; the first is the owner (identity map and transform).
  [[nodiscard]] std::span<EntityCopy const> copies(int entity_class) const {
    return {copies_.data() + class_begin_[entity_class], copies_.data() + class_begin_[entity_class + 1]};
  }
  [[nodiscard]] EntityCopy const& copy_of(int entity) const { return copies_[copy_of_[entity]]; }
  /// Direction of the rotation that maps an entity onto itself (nodes on the axis of a sector), in the owner's frame:
  /// displacements there have this component only.
  [[nodiscard]] std::optional<Vec3> axis_of(int entity_class) const { return axis_[entity_class]; }
  /// The pieces on both sides of a face class: two inside the domain, one on a boundary.
  [[nodiscard]] std::vector<FaceSide> face_sides(int entity_class) const;

 private:
  void identify(Mesh const& mesh, Links const& links);
  [[nodiscard]] int image(Link const& link, int entity) const;

  std::vector<ZoneCuts> cuts_;
  std::vector<int> offset_;  ///< first entity of each zone
  std::vector<Piece> pieces_;
  std::vector<int> piece_of_volume_;
  std::vector<int> class_of_, copy_of_, class_begin_;
  std::vector<EntityCopy> copies_;
  std::vector<std::optional<Vec3>> axis_;
};

/// Whether a patch of kind `region` holds a piece.
inline bool is_within(Piece const& piece, Patch const& region) {
  if (piece.zone != region.zone) return false;
  for (int a = 0; a < 3; ++a)
    if (piece.nodes.begin[a] < region.range.begin[a] || piece.nodes.end[a] > region.range.end[a]) return false;
  return true;
}

/// Calls visit(entity) for a face or volume and its faces, edges and corners (entities of the same zone).
template <class Visit>
void for_closure(Lattice const& lattice, int closed, Visit&& visit) {
  int const zone = lattice.zone_of(closed);
  Index3 const p = lattice.position(closed);
  Index3 d{};
  for (d[2] = -(p[2] % 2); d[2] <= p[2] % 2; ++d[2])
    for (d[1] = -(p[1] % 2); d[1] <= p[1] % 2; ++d[1])
      for (d[0] = -(p[0] % 2); d[0] <= p[0] % 2; ++d[0])
        visit(lattice.entity(zone, {p[0] + d[0], p[1] + d[1], p[2] + d[2]}));
}

/// The nodes of a face with its border.
IndexRange closed_nodes(Lattice const& lattice, int face_entity);

}  // namespace gridmorph
