#include <gridmorph/mesh/opposite_side.hpp>
#include <gridmorph/plan/elements/columns.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace gridmorph {

namespace {

/// A face from which a column may go on.
struct Front {
  Index32 element;
  int side;
  std::size_t face;  ///< number in the list of wall faces
};

/// (n_nodes) Sums of the faces' area vectors at wall nodes; in 2-D of their edges. Zero where those of a wall inside a
/// zone cancel.
std::vector<Vec3> wall_directions(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                                  std::vector<Index32> const& faces) {
  std::vector<Vec3> out(mesh.n_nodes());
  std::vector<double> lengths(out.size(), 0);
  Coordinates const& x = mesh.coordinates;
  for (Index32 const f : faces) {
    auto const corners = topology.boundary.nodes[f];
    Vec3 const sum = mesh.dimension == 2 ? x[corners[1]] - x[corners[0]] : face_normal(corners, x);
    double const length = norm(sum);
    for (Index32 const n : corners) {
      auto const o = std::size_t(graph.representative[n]);
      out[o] += sum;
      lengths[o] += length;
    }
  }
  if (topology.boundary.behind.empty()) return out;
  // Both sides of a wall inside a zone cancel, but for rounding, which is no direction.
  constexpr double rounding = 1e-9;
  for (std::size_t n = 0; n < out.size(); ++n)
    if (norm(out[n]) <= rounding * lengths[n]) out[n] = {};
  return out;
}

/// Twice the length of the part of `edge` across a wall that has that direction, its own length at most.
double rise_of(Vec3 const& edge, Vec3 const& wall, bool is_plane) {
  double const size = norm(wall);
  if (!(size > 0)) return norm(edge);
  Vec3 const unit = (1 / size) * wall;
  double const along = dot(edge, unit);
  // Up to 60 degrees of lean are what lines that fan out round an edge do.
  return std::min(norm(edge), 2 * (is_plane ? norm(edge - along * unit) : std::abs(along)));
}

}  // namespace

Columns make_columns(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                     std::vector<Index32> const& faces, std::vector<ColumnExtent> const& extents,
                     std::vector<std::uint8_t> const& is_known) {
  Columns out;
  out.height.assign(mesh.n_nodes(), 0);
  out.full_rise = out.height;
  std::vector<Vec3> const wall = wall_directions(mesh, topology, graph, faces);
  auto const owner = [&](Index32 n) { return graph.representative[n]; };
  std::vector<Index32> root(mesh.n_nodes(), -1);
  std::vector<double> shortest(faces.size(), std::numeric_limits<double>::infinity());
  std::vector<Front> front;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    auto const corners = topology.boundary.nodes[faces[f]];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      root[owner(corners[k])] = owner(corners[k]);
      double const edge = distance(mesh.coordinates[corners[k]], mesh.coordinates[corners[(k + 1) % corners.size()]]);
      if (edge > 0) shortest[f] = std::min(shortest[f], edge);
    }
    front.push_back({topology.boundary.element[faces[f]], topology.boundary.side[faces[f]], f});
  }
  std::vector<double> above_wall(mesh.n_nodes(), 0), risen = above_wall;
  std::vector<std::uint8_t> visited(mesh.n_elements(), 0);
  OppositeSide opposite;
  for (int layer = 0; !front.empty(); ++layer) {
    std::vector<Front> next;
    for (Front const& at : front) {
      ColumnExtent const& extent = extents[at.face];
      if (extent.extent == BoundaryLayer::Extent::layers && layer >= extent.layers) continue;
      if (visited[at.element]) continue;
      find_opposite_side(mesh, at.element, at.side, opposite);
      if (opposite.side < 0) continue;
      auto const& [side_above, nodes_below, nodes_above] = opposite;
      std::size_t const n_corners = nodes_below.size();
      double least = std::numeric_limits<double>::infinity(), reach = least;
      for (std::size_t c = 0; c < n_corners; ++c) {
        double const h = distance(mesh.coordinates[nodes_below[c]], mesh.coordinates[nodes_above[c]]);
        least = std::min(least, h);
        reach = std::min(reach, above_wall[owner(nodes_below[c])] + h);
      }
      if (extent.extent == BoundaryLayer::Extent::block && !(least < 0.5 * (1 - 1e-6) * shortest[at.face])) continue;
      if (extent.extent == BoundaryLayer::Extent::thickness && !(reach <= extent.thickness * (1 + 1e-6))) continue;
      visited[at.element] = 1;
      for (std::size_t c = 0; c < n_corners; ++c) {
        Index32 const below = owner(nodes_below[c]), above = owner(nodes_above[c]);
        if (root[above] >= 0 || is_known[above] || root[below] < 0) continue;
        auto const foot = std::size_t(root[below]);
        Vec3 const edge = mesh.coordinates[above] - mesh.coordinates[below];
        root[above] = Index32(foot);
        double const h = above_wall[below] + norm(edge);
        above_wall[above] = h;
        out.height[foot] = std::max(out.height[foot], h);
        double const rise = risen[below] + rise_of(edge, wall[foot], mesh.dimension == 2);
        risen[above] = rise;
        out.full_rise[foot] = std::max(out.full_rise[foot], rise);
        out.rise.push_back(rise);
        out.node.push_back(above);
        out.root.push_back(root[above]);
        out.below.push_back(below);
      }
      Index32 const behind = topology.sides.of(at.element)[side_above];
      if (behind < 0) continue;
      std::array<Index32, max_face_corners> room;
      // The side of the next element that is this one's opposite side.
      for (int s = 0; s < n_sides(mesh, behind); ++s) {
        if (topology.sides.of(behind)[s] != at.element) continue;
        auto const there = side_nodes(mesh, behind, s, room);
        bool const same = there.size() == n_corners && std::all_of(there.begin(), there.end(), [&](Index32 n) {
                            return std::find(opposite.above.begin(), opposite.above.end(), n) != opposite.above.end();
                          });
        if (same) next.push_back({behind, s, at.face});
      }
    }
    front = std::move(next);
  }
  for (Index32 const n : out.node) out.above_wall.push_back(above_wall[n]);
  return out;
}

}  // namespace gridmorph
