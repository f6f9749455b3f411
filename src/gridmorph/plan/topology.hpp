// The topology of a mesh: links between zones, the cut lattice with its coincident entities, and the blocks.
//
// Blocks: the pieces of the cut mesh put together again as far as nothing forces them apart.
//
// A sheet is a set of interior faces that continue one another across edges where four pieces meet (the dual surface of
// a hexahedral complex). A sheet that no patch limit, irregular edge, periodic interface or near-field limit needs is
// removed, and the pieces on both sides become one block. Plans are made on blocks, so they do not depend on how the
// user's file happened to be cut into zones.
#pragma once

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/plan/blocks/cuts.hpp>
#include <gridmorph/plan/blocks/lattice.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// A piece's place in its block. `to_block` turns the piece's zone axes into the block's axes.
struct PlacedPiece {
  int piece = -1;
  Orientation to_block;
};

/// A cuboid of pieces with six whole faces.
struct Block {
  Index3 n_pieces{0, 0, 0};
  std::vector<PlacedPiece> pieces;  ///< i fastest, n_pieces[0] * n_pieces[1] * n_pieces[2] of them

  [[nodiscard]] PlacedPiece const& at(int i, int j, int k) const {
    return pieces[std::size_t(i) + std::size_t(n_pieces[0]) * (j + std::size_t(n_pieces[1]) * k)];
  }
};

/// What keeps pieces apart beyond the topology itself.
struct MergeLimits {
  /// Labels of Mesh::patches and of Mesh::interfaces: faces with different labels stay on different blocks.
  std::vector<int> patch_label, interface_label;
  std::vector<CutPlane> kept_planes;  ///< near-field limits and the like
};

struct BlockFace {
  int block = -1;
  int axis = 0, side = 0;
  auto operator<=>(BlockFace const&) const = default;
};

class Blocks {
 public:
  Blocks(Mesh const& mesh, Links const& links, Lattice const& lattice, MergeLimits const& limits);

  [[nodiscard]] std::vector<Block> const& all() const { return blocks_; }
  [[nodiscard]] int size() const { return int(blocks_.size()); }
  [[nodiscard]] Block const& operator[](int b) const { return blocks_[b]; }
  [[nodiscard]] int block_of(int piece) const { return block_of_[piece]; }
  [[nodiscard]] Orientation const& to_block(int piece) const { return to_block_[piece]; }

  /// The block face that a side of a face entity is part of.
  [[nodiscard]] BlockFace face_of(FaceSide const& side) const;
  /// The face entities (in their pieces' zones) of a block face.
  [[nodiscard]] std::vector<int> face_entities(Lattice const& lattice, BlockFace const& face) const;
  /// Patch number of each face class that lies on the boundary or around a region, -1 elsewhere.
  [[nodiscard]] std::vector<int> const& patch_of_face() const { return patch_of_face_; }
  /// Number of a patch of kind `region` that holds the piece; -1: none does.
  [[nodiscard]] int region_of(int piece) const { return region_of_piece_[piece]; }
  /// Interface number of each face class that lies on a 1-to-1 interface, -1 elsewhere.
  [[nodiscard]] std::vector<int> const& interface_of_face() const { return interface_of_face_; }

 private:
  void label_faces(Mesh const& mesh, Links const& links, Lattice const& lattice);
  void label_regions(Mesh const& mesh, Lattice const& lattice);
  [[nodiscard]] std::vector<char> removable_faces(Mesh const& mesh, Links const& links, Lattice const& lattice,
                                                  MergeLimits const& limits);
  bool assemble(Lattice const& lattice, std::vector<char>& removable);

  std::vector<Block> blocks_;
  std::vector<int> block_of_;
  std::vector<Orientation> to_block_;
  std::vector<int> patch_of_face_, interface_of_face_;
  std::vector<int> region_of_piece_;
  std::vector<int> sheet_of_face_;
};

/// Orientation that turns the zone axes of the piece on `from`'s side of a face into those of the piece on `to`'s side.
Orientation across(Lattice const& lattice, FaceSide const& from, FaceSide const& to);

struct Topology {
  Links links;
  Lattice lattice;
  Blocks blocks;
};

/// Cuts, identifies and merges. `links` come from connect(); coverage must have been checked. `limits.kept_planes` are
/// cut as well. Cost: O(blocks), plus what connect() costs; coordinates are not read.
inline Topology build_topology(Mesh const& mesh, Links links, MergeLimits const& limits) {
  Lattice lattice(mesh, links, cut_zones(mesh, links, limits.kept_planes));
  Blocks blocks(mesh, links, lattice, limits);
  return {std::move(links), std::move(lattice), std::move(blocks)};
}

}  // namespace gridmorph
