#include <gridmorph/plan/elements/columns.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace gridmorph {

namespace {

/// The side of an element opposite to one of its sides, corner by corner along the edges that join them.
struct Opposite {
  int side = -1;
  int n = 0;
  std::array<Index32, 4> below{}, above{};
};

/// side -1 where there is none: tetrahedra, pyramids, the quadrilateral sides of prisms, polyhedra.
Opposite opposite_side(Mesh const& mesh, Index e, int side) {
  Opposite out;
  ElementType const type = mesh.elements.type[std::size_t(e)];
  bool const prism = type == ElementType::prism, hexahedron = type == ElementType::hexahedron;
  if (!prism && !hexahedron && type != ElementType::quadrilateral) return out;
  auto const nodes = mesh.elements.corners(e);
  std::array<Index32, max_face_corners> room;
  auto const own = side_nodes(mesh, e, side, room);
  int const corners = type == ElementType::quadrilateral ? 2 : prism ? 3 : 4;
  if (int(own.size()) != corners) return out;
  for (int c = 0; c < corners; ++c) {
    out.below[std::size_t(c)] = own[std::size_t(c)];
    // The one edge of this corner that leaves the side.
    for (int k = 0; k < n_edges(type); ++k) {
      Index32 const a = nodes[std::size_t(edge_corner(type, k, 0))], b = nodes[std::size_t(edge_corner(type, k, 1))];
      Index32 const other = a == own[std::size_t(c)] ? b : b == own[std::size_t(c)] ? a : -1;
      if (other >= 0 && std::find(own.begin(), own.end(), other) == own.end()) out.above[std::size_t(c)] = other;
    }
  }
  for (int s = 0; s < n_sides(mesh, e); ++s) {
    auto const there = side_nodes(mesh, e, s, room);
    if (int(there.size()) == corners && std::all_of(there.begin(), there.end(), [&](Index32 n) {
          return std::find(out.above.begin(), out.above.begin() + corners, n) != out.above.begin() + corners;
        }))
      out.side = s;
  }
  out.n = corners;
  return out;
}

/// A face from which a column may go on.
struct Front {
  Index32 element;
  int side;
  std::size_t face;  ///< number in the list of wall faces
};

}  // namespace

Columns make_columns(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                     std::vector<Index32> const& faces, std::vector<ColumnExtent> const& extents,
                     std::vector<std::uint8_t> const& is_known) {
  Columns out;
  out.height.assign(std::size_t(mesh.n_nodes()), 0);
  auto const owner = [&](Index32 n) { return graph.representative[std::size_t(n)]; };
  std::vector<Index32> root(std::size_t(mesh.n_nodes()), -1);
  std::vector<double> shortest(faces.size(), std::numeric_limits<double>::infinity());
  std::vector<Front> front;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    auto const corners = topology.boundary.nodes[faces[f]];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      root[std::size_t(owner(corners[k]))] = owner(corners[k]);
      double const edge = distance(mesh.coordinates[corners[k]], mesh.coordinates[corners[(k + 1) % corners.size()]]);
      if (edge > 0) shortest[f] = std::min(shortest[f], edge);
    }
    front.push_back(
        {topology.boundary.element[std::size_t(faces[f])], topology.boundary.side[std::size_t(faces[f])], f});
  }
  std::vector<double> above_wall(std::size_t(mesh.n_nodes()), 0);
  std::vector<std::uint8_t> visited(std::size_t(mesh.n_elements()), 0);
  for (int layer = 0; !front.empty(); ++layer) {
    std::vector<Front> next;
    for (Front const& at : front) {
      ColumnExtent const& extent = extents[at.face];
      if (extent.extent == BoundaryLayer::Extent::layers && layer >= extent.layers) continue;
      if (visited[std::size_t(at.element)]) continue;
      Opposite const opposite = opposite_side(mesh, at.element, at.side);
      if (opposite.side < 0) continue;
      double least = std::numeric_limits<double>::infinity(), reach = least;
      for (int c = 0; c < opposite.n; ++c) {
        double const h = distance(mesh.coordinates[opposite.below[std::size_t(c)]],
                                  mesh.coordinates[opposite.above[std::size_t(c)]]);
        least = std::min(least, h);
        reach = std::min(reach, above_wall[std::size_t(owner(opposite.below[std::size_t(c)]))] + h);
      }
      if (extent.extent == BoundaryLayer::Extent::block && !(least < 0.5 * (1 - 1e-6) * shortest[at.face])) continue;
      if (extent.extent == BoundaryLayer::Extent::thickness && !(reach <= extent.thickness * (1 + 1e-6))) continue;
      visited[std::size_t(at.element)] = 1;
      for (int c = 0; c < opposite.n; ++c) {
        Index32 const below = owner(opposite.below[std::size_t(c)]), above = owner(opposite.above[std::size_t(c)]);
        if (root[std::size_t(above)] >= 0 || is_known[std::size_t(above)] || root[std::size_t(below)] < 0) continue;
        root[std::size_t(above)] = root[std::size_t(below)];
        double const h = above_wall[std::size_t(below)] + distance(mesh.coordinates[below], mesh.coordinates[above]);
        above_wall[std::size_t(above)] = h;
        double& height = out.height[std::size_t(root[std::size_t(above)])];
        height = std::max(height, h);
        out.node.push_back(above);
        out.root.push_back(root[std::size_t(above)]);
      }
      Index32 const behind = topology.sides.of(at.element)[std::size_t(opposite.side)];
      if (behind < 0) continue;
      std::array<Index32, max_face_corners> room;
      // The side of the next element that is this one's opposite side.
      for (int s = 0; s < n_sides(mesh, behind); ++s) {
        if (topology.sides.of(behind)[std::size_t(s)] != at.element) continue;
        auto const there = side_nodes(mesh, behind, s, room);
        bool const same = int(there.size()) == opposite.n && std::all_of(there.begin(), there.end(), [&](Index32 n) {
                            return std::find(opposite.above.begin(), opposite.above.begin() + opposite.n, n) !=
                                   opposite.above.begin() + opposite.n;
                          });
        if (same) next.push_back({behind, s, at.face});
      }
    }
    front = std::move(next);
  }
  for (Index32 const n : out.node) out.above_wall.push_back(above_wall[std::size_t(n)]);
  return out;
}

}  // namespace gridmorph
