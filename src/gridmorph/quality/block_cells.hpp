// Cells of a mesh of blocks, by number and around nodes. Internal.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph::detail {

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
    Zone const& of = mesh_.zones[z];
    Index const n = cell - first_[z], ni = of.extent[0] - 1, nj = of.extent[1] - 1;
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

}  // namespace gridmorph::detail
