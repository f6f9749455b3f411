#include <gridmorph/plan/elements/columns.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace gridmorph {

namespace {

/// The side of an element opposite to one of its sides, corner by corner along the edges that join them: corners of the element.
struct Opposite {
  int side = -1;  ///< -1 where there is none: tetrahedra, pyramids, the quadrilateral sides of prisms, polyhedra
  int n = 0;
  std::array<std::int8_t, 4> below{}, above{};
};

Opposite find_opposite(ElementType type, int side) {
  Opposite out;
  int const corners = type == ElementType::quadrilateral ? 2 : type == ElementType::prism ? 3 : 4;
  if (n_face_corners(type, side) != corners) return out;
  out.n = corners;
  auto const is_of = [&](std::array<std::int8_t, 4> const& list, int corner) {
    return std::find(list.begin(), list.begin() + corners, std::int8_t(corner)) != list.begin() + corners;
  };
  for (int c = 0; c < corners; ++c) out.below[std::size_t(c)] = std::int8_t(face_corner(type, side, c));
  for (int c = 0; c < corners; ++c)
    // The one edge of this corner that leaves the side.
    for (int k = 0; k < n_edges(type); ++k) {
      int const a = edge_corner(type, k, 0), b = edge_corner(type, k, 1), own = out.below[std::size_t(c)];
      int const other = a == own ? b : b == own ? a : -1;
      if (other >= 0 && !is_of(out.below, other)) out.above[std::size_t(c)] = std::int8_t(other);
    }
  for (int s = 0; s < n_faces(type); ++s) {
    bool same = n_face_corners(type, s) == corners;
    for (int c = 0; same && c < corners; ++c) same = is_of(out.above, face_corner(type, s, c));
    if (same) out.side = s;
  }
  return out;
}

/// From tables that are made once.
Opposite const& opposite_side(ElementType type, int side) {
  constexpr std::array types{ElementType::quadrilateral, ElementType::prism, ElementType::hexahedron};
  constexpr std::size_t most_sides = 6;
  static auto const tables = [&] {
    std::array<std::array<Opposite, most_sides>, types.size()> out{};
    for (std::size_t t = 0; t < types.size(); ++t)
      for (int s = 0; s < n_faces(types[t]); ++s) out[t][std::size_t(s)] = find_opposite(types[t], s);
    return out;
  }();
  static Opposite const none;
  auto const at = std::find(types.begin(), types.end(), type);
  return at == types.end() ? none : tables[std::size_t(at - types.begin())][std::size_t(side)];
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
      Opposite const& opposite = opposite_side(mesh.elements.type[std::size_t(at.element)], at.side);
      if (opposite.side < 0) continue;
      auto const nodes = mesh.elements.corners(at.element);
      std::array<Index32, 4> nodes_below{}, nodes_above{};
      for (std::size_t c = 0; c < std::size_t(opposite.n); ++c) {
        nodes_below[c] = nodes[std::size_t(opposite.below[c])];
        nodes_above[c] = nodes[std::size_t(opposite.above[c])];
      }
      double least = std::numeric_limits<double>::infinity(), reach = least;
      for (int c = 0; c < opposite.n; ++c) {
        double const h =
            distance(mesh.coordinates[nodes_below[std::size_t(c)]], mesh.coordinates[nodes_above[std::size_t(c)]]);
        least = std::min(least, h);
        reach = std::min(reach, above_wall[std::size_t(owner(nodes_below[std::size_t(c)]))] + h);
      }
      if (extent.extent == BoundaryLayer::Extent::block && !(least < 0.5 * (1 - 1e-6) * shortest[at.face])) continue;
      if (extent.extent == BoundaryLayer::Extent::thickness && !(reach <= extent.thickness * (1 + 1e-6))) continue;
      visited[std::size_t(at.element)] = 1;
      for (int c = 0; c < opposite.n; ++c) {
        Index32 const below = owner(nodes_below[std::size_t(c)]), above = owner(nodes_above[std::size_t(c)]);
        if (root[std::size_t(above)] >= 0 || is_known[std::size_t(above)] || root[std::size_t(below)] < 0) continue;
        root[std::size_t(above)] = root[std::size_t(below)];
        double const h = above_wall[std::size_t(below)] + distance(mesh.coordinates[below], mesh.coordinates[above]);
        above_wall[std::size_t(above)] = h;
        double& height = out.height[std::size_t(root[std::size_t(above)])];
        height = std::max(height, h);
        out.node.push_back(above);
        out.root.push_back(root[std::size_t(above)]);
        out.below.push_back(below);
      }
      Index32 const behind = topology.sides.of(at.element)[std::size_t(opposite.side)];
      if (behind < 0) continue;
      std::array<Index32, max_face_corners> room;
      // The side of the next element that is this one's opposite side.
      for (int s = 0; s < n_sides(mesh, behind); ++s) {
        if (topology.sides.of(behind)[std::size_t(s)] != at.element) continue;
        auto const there = side_nodes(mesh, behind, s, room);
        bool const same = int(there.size()) == opposite.n && std::all_of(there.begin(), there.end(), [&](Index32 n) {
                            return std::find(nodes_above.begin(), nodes_above.begin() + opposite.n, n) !=
                                   nodes_above.begin() + opposite.n;
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
