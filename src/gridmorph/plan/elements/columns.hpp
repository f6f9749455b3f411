// Columns of nodes through the prisms, hexahedra and prismatic polyhedra that stand on walls: the boundary layer.
#pragma once

#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/options.hpp>

#include <vector>

namespace gridmorph {

struct Columns {
  /// Nodes above walls, layer by layer, each in one column; walls themselves are not listed.
  std::vector<Index32> node;
  std::vector<Index32> root;       ///< the wall node at the foot
  std::vector<Index32> below;      ///< the node beneath: of the wall, or one listed before
  std::vector<double> above_wall;  ///< length of the column up to the node
  std::vector<double> height;      ///< (n_nodes) of the mesh: of the column on a wall node, 0 where there is none
  /// Lengths again, but of edges that lean by more than 60 degrees from the wall's normal only twice what they rise
  /// along it.
  std::vector<double> rise;       ///< up to the node
  std::vector<double> full_rise;  ///< (n_nodes) of the mesh: of the column on a wall node

  [[nodiscard]] Index size() const { return Index(node.size()); }
};

/// How far the columns of a wall go: see BoundaryLayer. Extent::block: as long as cells are thinner than half the
/// shortest edge of the wall face below, so that a mesh of hexahedra throughout has a boundary layer where its cells
/// are flat. Extents given in layers or as a thickness go on through isotropic cells; all end with the elements that
/// have an opposite side.
struct ColumnExtent {
  BoundaryLayer::Extent extent = BoundaryLayer::Extent::block;
  int layers = 0;
  double thickness = 0;
};

/// The columns of walls: from each face of `faces` (numbers in UnstructuredTopology::boundary, any order) through
/// prisms that stand on their triangles, hexahedra and prismatic polyhedra (mesh/opposite_side.hpp), layer by layer; in
/// 2-D through quadrilaterals. A node that several columns reach belongs to the one that reaches it in the lowest
/// layer, then to the first face. Known nodes end a column. Cost O(cells of the columns).
Columns make_columns(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                     std::vector<Index32> const& faces, std::vector<ColumnExtent> const& extents,
                     std::vector<std::uint8_t> const& is_known);

}  // namespace gridmorph
