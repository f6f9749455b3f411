// Chains: blocks joined through opposite faces, seen as one cuboid (s, a, b) with s along the chain; and what is known
// of entities while they are found.
#pragma once

#include <gridmorph/plan/topology.hpp>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Kinds that chain ends rank by: the patch kinds, then periodic.
using EndKind = int;
inline constexpr EndKind periodic_end = 100;
inline constexpr EndKind unknown_end = -1;
inline constexpr int no_body = -1;
inline EndKind end_kind(PatchKind kind) { return kind == PatchKind::periodic ? periodic_end : int(kind); }
/// Patches that the priority names have kinds of their own, which hold what they are besides.
inline constexpr EndKind named_ends = 1000;
inline EndKind named_end(int number, EndKind kind) { return named_ends * (number + 1) + kind % named_ends; }
inline std::string_view end_kind_name(EndKind named_or_not) {
  EndKind const kind = named_or_not % named_ends;
  return kind == periodic_end ? "periodic" : (kind == unknown_end ? "open" : to_string(PatchKind(kind)));
}

/// What is known of each entity class of the lattice.
struct Known {
  std::vector<char> known;
  std::vector<EndKind> kind;
  std::vector<std::vector<int>> patches;  ///< whose kind that is, ascending: Mesh::patches, then Mesh::interfaces
  std::vector<char> turns;                ///< whether its displacement comes with a rotation
  std::vector<int> body;  ///< whose rotation that is, where it is one body's; see WallRoots::centre_of_body()

  explicit Known(int n_classes)
      : known(n_classes, 0),
        kind(n_classes, unknown_end),
        patches(n_classes),
        turns(n_classes, 0),
        body(n_classes, no_body) {}
  [[nodiscard]] bool operator()(int entity_class) const { return known[entity_class] != 0; }
};

struct ChainStep {
  int block = -1;
  Orientation to_chain;  ///< block axes -> chain axes (0: s, 1: a, 2: b)
  Mat3 rotation;         ///< chain frame -> frame of this block (not the identity behind a periodic interface)
  Vec3 translation;      ///< and positions: x = rotation * (position in the chain's frame) + translation
  bool rotated = false;  ///< neither is the identity
};

/// The block face at the lower (side 0) or upper (side 1) s end of a step.
BlockFace end_face(ChainStep const& step, int side);

/// How a chain ends: on a known face, or on a boundary face that nothing fixes yet (slip, free).
struct ChainEnd {
  bool known = false;
  EndKind kind = unknown_end;
  int patch = -1;                 ///< boundary patch under the end, -1 when it is an inner face
  std::vector<int> patches = {};  ///< whose kind that is, see Known::patches; the patch where nothing fixes it
};

struct Chain {
  std::vector<ChainStep> steps;
  ChainEnd first, last;
};

/// The chain through a block along one of its axes; nothing when it would pass a block twice.
/// Walks through every face that is neither known nor on the boundary.
std::optional<Chain> find_chain(Mesh const& mesh, Topology const& topology, Known const& known, int block, int axis);

/// What an end lies on, or what made the face known that it lies on: families, or names where there is none, in
/// alphabetical order.
std::vector<std::string> end_names(Mesh const& mesh, ChainEnd const& end);

/// The chain seen from its other end.
Chain reversed(Chain chain);

/// Walks from a face of a block into it and on through its opposite face until enough(chain) says so. `last` stays open
/// when the walk was stopped so; nothing when it came to a boundary or known face, or back to one of its blocks, first.
std::optional<Chain> walk_from(Mesh const& mesh, Topology const& topology, Known const& known, BlockFace const& start,
                               std::function<bool(Chain const&)> const& enough);

/// One piece of a chain.
struct ChainPiece {
  int piece = -1;
  Orientation to_chain;  ///< zone axes -> chain axes
  int step = 0;
};

/// A chain laid out piece by piece: n[0] along s, n[1] x n[2] across.
struct ChainLayout {
  Index3 n{0, 0, 0};
  std::vector<ChainPiece> pieces;              ///< s fastest, then a, then b
  std::vector<int> first_piece;                ///< along s, per step and one past the last
  std::vector<int> s_begin, a_begin, b_begin;  ///< node position of each piece's lower end, per piece along the axis
  Index3 n_nodes{0, 0, 0};                     ///< nodes along s, a, b

  [[nodiscard]] ChainPiece const& at(int s, int a, int b) const {
    return pieces[std::size_t(s) + std::size_t(n[0]) * (a + std::size_t(n[1]) * b)];
  }
};

ChainLayout lay_out(Topology const& topology, Chain const& chain);

/// Lattice entity of a chain piece; which = 0, 1, 2 (lower end, inside, upper end) along s, a, b.
int chain_entity(Lattice const& lattice, ChainPiece const& piece, Index3 const& which);

/// First node and strides (along s, a, b) of a chain piece in the flat arrays, and its node counts.
struct PieceNodes {
  Index first = 0;
  std::array<Index, 3> stride{};
  Index3 count{};
};
PieceNodes piece_nodes(Mesh const& mesh, Lattice const& lattice, ChainPiece const& piece);

}  // namespace gridmorph
