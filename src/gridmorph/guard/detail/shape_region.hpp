// The cells around a place of a mesh of blocks whose shape is smoothed, and the points among them that may move.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/relative_shape.hpp>
#include <gridmorph/plan/block_points.hpp>
#include <gridmorph/quality/block_cells.hpp>

#include <array>
#include <span>
#include <vector>

namespace gridmorph::detail {

/// A corner that changes with a point: the point is the corner's own node (bit 0), the end of its edge d (bit 1 + d),
/// or several.
struct PointCorner {
  Index32 cell;  ///< in ShapeRegion::cells
  std::uint8_t corner, roles;
  std::int16_t matrix;  ///< of the point's node there
};

struct ShapeRegion {
  std::vector<CellNodes> cells;                                 ///< that a free point changes
  std::vector<Index> numbers;                                   ///< of these cells in the mesh
  std::vector<std::uint8_t> changing;                           ///< bit c: corner c changes with a free point
  std::vector<Index> others;                                    ///< cells that lost their shape and have no free point
  std::vector<std::array<kernels::BaselineCorner, 8>> corners;  ///< of `cells`
  // Free points:
  std::vector<Index> first_node{0}, first_corner{0};
  std::vector<PointNode> nodes;
  std::vector<PointCorner> point_corners;
  std::vector<Index32> sliding;  ///< per point; -1: free in space
  std::vector<SlidingPoint> slides;
  /// Points no two of which share a cell.
  std::vector<std::vector<Index32>> colours;

  [[nodiscard]] Index n_points() const { return Index(sliding.size()); }
  [[nodiscard]] std::span<PointNode const> nodes_of(Index point) const {
    return {nodes.data() + first_node[point], nodes.data() + first_node[point + 1]};
  }
  [[nodiscard]] std::span<PointCorner const> corners_of(Index point) const {
    return {point_corners.data() + first_corner[point], point_corners.data() + first_corner[point + 1]};
  }
};

/// `rings` of cells around `cells`, through interfaces. `points`: learns which points stay because edges at them are
/// collapsed, or because they are twice in a cell through a rotation. Points are in the order of their smallest nodes;
/// colours are greedy in that order. Cost: O(region) and two numbers per cell and node of the mesh.
ShapeRegion shape_region(HostInstance const& host, BlockCells const& mesh_cells, BlockPoints& points,
                         std::span<Index const> cells, int rings);

}  // namespace gridmorph::detail
