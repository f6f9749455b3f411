// Hybrid unstructured meshes from hexahedral cells: layers stay hexahedra or become prisms, the rest becomes
// tetrahedra, with pyramids where a hexahedron meets them. Internal to the demo meshes.
//
// Every node has a rank, and a quadrilateral that must be split is split from its node of smallest rank, so that two
// cells cut their common face alike whatever else they are (J. Dompierre et al., "How to subdivide pyramids, prisms,
// and hexahedra into tetrahedra", 8th International Meshing Roundtable, 1999). Ranks are scattered over the nodes, so
// that diagonals have no preferred direction.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph {

/// What becomes of the layers at the walls.
enum class LayerElements {
  prisms,
  hexahedra,
  mixed  ///< hexahedra on the rope, prisms on the ball (a sphere alone: in turn over its six faces)
};

namespace demo {

using Quad = std::array<Index32, 4>;
using Hex = std::array<Index32, 8>;  ///< SIDS order: bottom 0 1 2 3, top 4 5 6 7

/// Scatters 32-bit numbers one to one (the finaliser of MurmurHash3, A. Appleby).
constexpr std::uint32_t scatter(std::uint32_t n) {
  n ^= n >> 16;
  n *= 0x85ebca6bU;
  n ^= n >> 13;
  n *= 0xc2b2ae35U;
  return n ^ (n >> 16);
}

using Rank = std::uint64_t;

/// Rank of a node. Nodes with the same `key` are ordered by `level`; different keys stand in a random order.
constexpr Rank rank_of(Index32 key, int level = 0) { return Rank(scatter(std::uint32_t(key))) << 32U | Rank(level); }

class HybridMesh {
 public:
  /// ranks: of the nodes, no two alike in a quadrilateral that is split.
  HybridMesh(std::vector<Vec3> nodes, std::vector<Rank> ranks) : nodes_(std::move(nodes)), rank_(std::move(ranks)) {}

  void add_hexahedron(Hex const& hex) { hexahedra_.push_back(hex); }
  /// Two prisms; both triangles of the split bottom stay below the split top.
  void add_prisms(Hex const& hex);
  /// Six tetrahedra that share the corner of smallest rank.
  void add_tetrahedra(Hex const& hex);
  /// Bottom left whole: a pyramid on it, and ten tetrahedra over the other faces, all around a node added in the
  /// middle.
  void add_pyramid(Hex const& hex);

  /// Names, families and kind of a patch; returns its number.
  int add_patch(std::string const& name, PatchKind kind, std::string const& bc_type);
  void add_quadrilateral(int patch, Quad const& quad) { faces_[std::size_t(patch)].push_back(quad); }
  void add_triangles(int patch, Quad const& quad);

  /// Moves each node that only tetrahedra and pyramids' apexes have, off the boundary, by up to `amount` of its
  /// shortest edge in each direction; less where an element would lose more than 40 % of its volume. Depends on node
  /// numbers alone.
  void jitter(double amount);
  /// Numbers nodes, and elements of each type, at random; the same for the same mesh.
  void shuffle();

  /// Tetrahedra first, then pyramids, prisms, hexahedra; one zone. Leaves this object empty.
  Mesh finish(std::string const& zone, std::string const& source);

 private:
  [[nodiscard]] bool cut_02(Index32 a, Index32 b, Index32 c, Index32 d) const;
  /// The two triangles of a quadrilateral, in its sense of rotation.
  [[nodiscard]] std::array<std::array<Index32, 3>, 2> triangles(Quad const& q) const;
  [[nodiscard]] std::vector<std::uint8_t> free_nodes() const;

  std::vector<Vec3> nodes_;
  std::vector<Rank> rank_;
  std::vector<std::array<Index32, 4>> tetrahedra_;
  std::vector<std::array<Index32, 5>> pyramids_;
  std::vector<std::array<Index32, 6>> prisms_;
  std::vector<Hex> hexahedra_;
  std::vector<Patch> patches_;
  std::vector<std::vector<Quad>> faces_;  ///< of each patch; the fourth node is -1 in triangles
};

}  // namespace demo
}  // namespace gridmorph
