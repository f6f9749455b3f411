#include <gridmorph/fillet/mitre_path.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph {

namespace {

constexpr ElementType hexahedron = ElementType::hexahedron;

/// Nodes of a hexahedron at the other ends of the three edges that leave one of its corners.
std::array<Index32, 3> beside(std::span<Index32 const> corners, Index32 node) {
  std::array<Index32, 3> out{-1, -1, -1};
  std::size_t found = 0;
  for (int e = 0; e < n_edges(hexahedron); ++e)
    for (int end = 0; end < 2; ++end)
      if (corners[edge_corner(hexahedron, e, end)] == node && found < 3)
        out[found++] = corners[edge_corner(hexahedron, e, 1 - end)];
  return out;
}

/// The corner of a hexahedron that leads away from a face of it.
Index32 away(std::span<Index32 const> corners, Index32 node, std::array<Index32, 4> const& face) {
  for (Index32 const n : beside(corners, node))
    if (std::find(face.begin(), face.end(), n) == face.end()) return n;
  return -1;
}

/// The corner that edges join to both `a` and `b`, other than `not_this`.
Index32 common_neighbour(std::span<Index32 const> corners, Index32 a, Index32 b, Index32 not_this) {
  for (Index32 const n : beside(corners, a))
    if (n != not_this && std::ranges::count(beside(corners, b), n) > 0) return n;
  return -1;
}

/// Whether it has eight nodes in their places: collapsed hexahedra have not.
bool is_whole(CornerCell const& cell) {
  std::vector<Index32> nodes;
  for (auto const& end : cell.node)
    for (auto const& row : end) nodes.insert(nodes.end(), row.begin(), row.end());
  std::sort(nodes.begin(), nodes.end());
  return nodes.front() >= 0 && std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end();
}

}  // namespace

CornerCell CornerLattice::first(std::array<Index32, 2> const& root_edge) const {
  Index32 const e = elements_.with(root_edge).front();
  auto const corners = elements_.mesh().elements.corners(e);
  CornerCell cell;
  cell.element = e;
  std::array<Index32, 2> const root{elements_.node_at(e, root_edge[0]), elements_.node_at(e, root_edge[1])};
  for (std::size_t end = 0; end < 2; ++end) {
    auto& at = cell.node[end];
    at[0][0] = root[end];
    for (Index32 const n : beside(corners, root[end])) {
      if (n == root[1 - end]) continue;
      Index32 const m = common_neighbour(corners, n, root[1 - end], root[end]);
      // The face along the corner says which wall the edge is on: where a blade ends edges may be on both.
      Index32 const face = find_boundary_face(elements_.topology(), std::array<Index32, 4>{root[0], root[1], m, n});
      (edges_.wall_of_face(face) == 0 ? at[0][1] : at[1][0]) = n;
    }
    at[1][1] = common_neighbour(corners, at[0][1], at[1][0], at[0][0]);
  }
  if (!is_whole(cell))
    throw MeshError(
        elements_.mesh().source + ": " + describe_element(elements_.mesh(), e) +
        " in the corner is collapsed, or has both of its faces there on one wall; it cannot be cut along a mitre");
  return cell;
}

Index32 CornerLattice::across(Index32 element, std::array<Index32, 4> const& nodes) const {
  std::array<Index32, 4> places;
  std::transform(nodes.begin(), nodes.end(), places.begin(), [&](Index32 n) { return elements_.place(n); });
  for (Index32 const e : elements_.with(places))
    if (e != element) return e;
  return -1;
}

std::optional<CornerCell> CornerLattice::off(CornerCell const& cell, int wall) const {
  CornerCell out;
  std::array<Index32, 4> nodes{};
  std::size_t count = 0;
  auto const far = [&](std::size_t end, std::size_t k) {
    return wall == 0 ? cell.node[end][1][k] : cell.node[end][k][1];
  };
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 2; ++k) nodes[count++] = far(end, k);
  Index32 const e = out.element = across(cell.element, nodes);
  if (e < 0 || elements_.mesh().elements.type[e] != hexahedron) return {};
  auto const corners = elements_.mesh().elements.corners(e);
  for (Index32& n : nodes) n = elements_.node_at(e, elements_.place(n));
  count = 0;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 2; ++k) {
      Index32 const near = nodes[count++], next = away(corners, near, nodes);
      (wall == 0 ? out.node[end][0][k] : out.node[end][k][0]) = near;
      (wall == 0 ? out.node[end][1][k] : out.node[end][k][1]) = next;
    }
  if (!is_whole(out)) return {};
  return out;
}

std::array<Index32, 4> CornerLattice::end_face(CornerCell const& cell, int end) {
  auto const& at = cell.node[end];
  return {at[0][0], at[1][0], at[1][1], at[0][1]};
}

std::optional<CornerCell> CornerLattice::behind(CornerCell const& cell, int end) const {
  std::array<Index32, 4> face = end_face(cell, end);
  CornerCell out;
  if (out.element = across(cell.element, face); out.element >= 0) {
    for (Index32& n : face) n = elements_.node_at(out.element, elements_.place(n));
  } else {
    BoundaryFaces const& faces = elements_.topology().boundary;
    Index32 const f = find_boundary_face(elements_.topology(), face);
    if (f < 0 || faces.across[f] < 0) return {};
    out.element = faces.element[faces.across[f]];
    for (Index32& n : face) n = partner(n, faces.connection[f]);
  }
  if (elements_.mesh().elements.type[out.element] != hexahedron)
    throw MeshError(elements_.mesh().source + ": the corner goes on behind the blade into " +
                    describe_element(elements_.mesh(), out.element) +
                    ", and has to be cut there as along the blade; that takes hexahedra all the way to the boundary");
  auto const corners = elements_.mesh().elements.corners(out.element);
  auto& near = out.node[1 - end];
  near[0][0] = face[0];
  near[1][0] = face[1];
  near[1][1] = face[2];
  near[0][1] = face[3];
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) out.node[end][i][j] = away(corners, near[i][j], face);
  if (!is_whole(out))
    throw MeshError(elements_.mesh().source + ": " + describe_element(elements_.mesh(), out.element) +
                    " is collapsed; the corner goes on through it and has to be cut there");
  return out;
}

Index32 CornerLattice::partner(Index32 node, Index32 connection_side) const {
  auto& pairs = partners_[connection_side];
  if (pairs.empty()) {
    Connection const& c = elements_.mesh().connections[connection_side / 2];
    auto const& own = connection_side % 2 == 0 ? c.nodes : c.donor_nodes;
    auto const& donor = connection_side % 2 == 0 ? c.donor_nodes : c.nodes;
    for (std::size_t n = 0; n < own.size(); ++n) pairs[own[n]] = donor[n];
  }
  return pairs.at(node);
}

}  // namespace gridmorph
