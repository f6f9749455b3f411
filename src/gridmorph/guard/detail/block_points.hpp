// Points of a mesh of blocks: nodes that coincide, and periodic copies of them, are one; which of them may move.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// A node of a point; the node's displacement is that of the point, turned by the plan's rotation `matrix` (-1: as it
/// is).
struct PointNode {
  Index node;
  std::int32_t matrix;
};

/// A cell by its node with the smallest i, j, k and the strides of its zone.
struct CellNodes {
  Index first, stride_j, stride_k;

  /// Corner i + 2 j + 4 k.
  [[nodiscard]] Index node(int corner) const {
    return first + (corner & 1) + (corner >> 1 & 1) * stride_j + (corner >> 2) * stride_k;
  }
};

/// The edges that leave a corner.
inline void corner_edges(Coordinates const& x, CellNodes const& cell, int corner, Vec3 (&edge)[3]) {
  Vec3 const own = x[cell.node(corner)];
  for (int d = 0; d < 3; ++d) edge[d] = x[cell.node(corner ^ (1 << d))] - own;
}

/// Cells by their number in the mesh: first_cells().
class BlockCells {
 public:
  explicit BlockCells(Mesh const& mesh) : mesh_(mesh), first_(first_cells(mesh)) {}

  [[nodiscard]] Index size() const { return first_.back(); }
  [[nodiscard]] int zone(Index cell) const {
    return int(std::upper_bound(first_.begin(), first_.end(), cell) - first_.begin()) - 1;
  }
  [[nodiscard]] CellNodes nodes(Index cell) const {
    int const z = zone(cell);
    Zone const& of = mesh_.zones[std::size_t(z)];
    Index const n = cell - first_[std::size_t(z)], ni = of.extent[0] - 1, nj = of.extent[1] - 1;
    auto const strides = of.strides();
    return {of.node({int(n % ni), int(n / ni % nj), int(n / (ni * nj))}), strides[1], strides[2]};
  }
  /// visit(cell, which of its corners the node is).
  template <class Visit>
  void around(Index node, Visit&& visit) const {
    auto const above = std::upper_bound(mesh_.zones.begin(), mesh_.zones.end(), node,
                                        [](Index n, Zone const& zone) { return n < zone.first_node; });
    std::size_t const z = std::size_t(above - mesh_.zones.begin()) - 1;
    Zone const& zone = mesh_.zones[z];
    Index3 const p = zone.index(node);
    for (int corner = 7; corner >= 0; --corner) {
      Index3 const c{p[0] - (corner & 1), p[1] - (corner >> 1 & 1), p[2] - (corner >> 2)};
      bool inside = true;
      for (int a = 0; a < 3; ++a) inside = inside && c[a] >= 0 && c[a] < zone.extent[a] - 1;
      if (inside)
        visit(first_[z] + c[0] + Index(zone.extent[0] - 1) * (c[1] + Index(zone.extent[1] - 1) * c[2]), corner);
    }
  }

 private:
  Mesh const& mesh_;
  std::vector<Index> first_;
};

/// The surfaces that a point slides on, in the frame of one of its nodes.
struct SlidingPoint {
  PointNode node{-1, -1};
  int count = 0;
  std::array<int, 3> surface{};
  std::array<double, 3> own_offset{};
};

class BlockPoints {
 public:
  /// Throws nothing; cost: O(nodes), two numbers per node of the skeleton and five bytes per node of the mesh.
  explicit BlockPoints(PreparedMorph const& prepared);

  /// Whether a node, and with it all of its point, keeps its place.
  [[nodiscard]] bool stays(Index node) const { return stays_[std::size_t(node)] != 0; }
  void keep(Index node) {
    for_each_node(node, [this](PointNode const& n) { stays_[std::size_t(n.node)] = 1; });
  }
  /// All nodes of a node's point.
  template <class Visit>
  void for_each_node(Index node, Visit&& visit) const {
    Index32 const slot = slot_[std::size_t(node)];
    if (slot < 0) {
      visit(PointNode{node, -1});
      return;
    }
    for (Index n = first_[std::size_t(slot)]; n < first_[std::size_t(slot) + 1]; ++n) visit(nodes_[std::size_t(n)]);
  }
  /// Where the plan keeps a node's displacement; -1 inside pieces.
  [[nodiscard]] Index slot(Index node) const { return slot_[std::size_t(node)]; }
  /// Slip surfaces (BoundaryMotion::slip_surfaces()) that the patches of a node lie on.
  [[nodiscard]] std::vector<int> surfaces(Index node) const;

 private:
  void gather(Plan const& plan);
  void keep_given(PreparedMorph const& prepared);
  void keep_near_field(PreparedMorph const& prepared);
  void keep_axes(PreparedMorph const& prepared);
  void find_slip(PreparedMorph const& prepared);

  std::vector<Index32> slot_;  ///< per node; -1 inside pieces
  std::vector<Index> first_;   ///< per slot
  std::vector<PointNode> nodes_;
  std::vector<std::uint8_t> stays_;
  std::vector<std::pair<Index, int>> slips_;  ///< (node, surface), ascending, each once
};

/// nodes: all those of a point. In the frame of the node with most surfaces; nothing where another node of the point
/// adds one in another frame.
std::optional<SlidingPoint> sliding_point(PreparedMorph const& prepared, BlockPoints const& points,
                                          std::vector<PointNode> const& nodes);

}  // namespace gridmorph::detail
