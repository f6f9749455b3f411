// Elements around a place of a mesh whose shape is smoothed, and the nodes among them that may move.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/kernels/relative_shape.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// A corner of an element with three edges: its node and those at the other ends of the edges. Tetrahedra have one
/// (their F is the same everywhere), prisms 6, hexahedra 8, pyramids the 4 of the base, polyhedra those where three
/// faces meet.
struct ElementCorner {
  Index32 element;
  std::array<Index32, 4> node;
};

/// Free nodes with all corners that change with them; the baseline of these. Built in the order of the nodes; colours
/// are greedy in that order.
class ElementShapes {
 public:
  /// nodes: ascending representatives. copies: pairs (representative, node that coincides with it), ascending.
  ElementShapes(Mesh const& mesh, UnstructuredTopology const& topology, std::span<Index32 const> nodes,
                std::span<std::pair<Index32, Index32> const> copies);

  /// Sweeps as smooth_region() of blocks does; x: the coordinates of the mesh.
  void smooth(int sweeps, double relaxation, Coordinates& x) const;

 private:
  struct Change {
    Index32 corner;      ///< in corners_
    std::uint8_t roles;  ///< bit 0: the corner's own node; bit 1 + d: the end of its edge d
  };

  void add_corners(Index32 element);
  void add_corners_of_polyhedron(Index32 element);
  void find_corners(UnstructuredTopology const& topology);
  void colour();
  [[nodiscard]] double smallest_volume(Coordinates const& x) const;
  void move(Index32 point, double delta, double relaxation, Coordinates& x,
            std::vector<kernels::CornerChange>& changes) const;

  Mesh const& mesh_;
  std::vector<Index> first_node_{0}, first_change_{0};
  std::vector<Index32> nodes_;  ///< per point: itself and what coincides with it
  std::vector<Change> changes_;
  std::vector<ElementCorner> corners_;
  std::vector<Index32> element_of_corner_;  ///< counted from 0 in the order of corners_
  std::vector<kernels::BaselineCorner> baseline_;
  std::vector<std::vector<Index32>> colours_;
};

}  // namespace gridmorph::detail
