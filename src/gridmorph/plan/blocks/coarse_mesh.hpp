// Some of the grid lines of a mesh as a mesh of their own, with the same zones, patches, interfaces and pieces.
#pragma once

#include <gridmorph/plan/blocks/cuts.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>

#include <vector>

namespace gridmorph {

/// Planes of nodes to keep per zone and axis, ascending: all cuts, and pairs of neighbours, so that what lies between
/// them are whole cells of the mesh: the first and the last cell of every piece, and of those between one in `every`,
/// spread evenly. The same at both sides of interfaces. planes: asked for when the mesh is cut.
std::vector<ZoneCuts> sampled_planes(Mesh const& mesh, Links const& links, std::vector<CutPlane> const& planes,
                                     int every);

/// The number of nodes that such planes have.
Index count_nodes(std::vector<ZoneCuts> const& planes);

struct CoarseMesh {
  Mesh mesh;
  Links links;
  std::vector<ZoneCuts> planes;                ///< of the fine mesh, in the order of the indices of this one
  std::array<std::vector<double>, 3> lengths;  ///< GridLengths: along the lines of the fine mesh

  /// The index that a node has in the fine mesh.
  [[nodiscard]] Index3 fine_index(int zone, Index3 const& p) const;
  /// Whether a cell is one of the fine mesh; false where it stands for several.
  [[nodiscard]] bool is_cell(int zone, Index3 const& cell) const;
  /// The place of a plane of the fine mesh that was kept.
  [[nodiscard]] int place(int zone, int axis, int fine_index) const;
};

/// The mesh of the lines kept. Cost: one visit to each node of the lines kept, a share of about 12 / every^2 of the
/// mesh.
CoarseMesh coarsen(Mesh const& mesh, Links const& links, std::vector<ZoneCuts> planes);

}  // namespace gridmorph
