#include <gridmorph/plan/elements/corner_means.hpp>

#include <array>

namespace gridmorph::detail {

InterpolationOperator corner_means(Mesh const& mesh, NodeGraph const& graph) {
  InterpolationOperator rows;
  std::vector<std::uint8_t> done;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[std::size_t(e)];
    auto const all = mesh.elements.nodes[e], corners = mesh.elements.corners(e);
    if (all.size() == corners.size()) continue;
    if (done.empty()) {
      done.assign(std::size_t(mesh.n_nodes()), 0);
      for (Index n = 0; n < mesh.n_nodes(); ++n) done[std::size_t(n)] = graph.neighbours[n].empty() ? 0 : 1;
    }
    // Places of the faces whose middle may be a node.
    std::array<int, max_faces> square{};
    int n_square = 0;
    if (!is_surface(type))
      for (int f = 0; f < n_faces(type); ++f)
        if (n_face_corners(type, f) == 4) square[std::size_t(n_square++)] = f;
    for (std::size_t k = corners.size(); k < all.size(); ++k) {
      Index32 const n = all[k];
      if (done[std::size_t(n)] || !graph.carries(n)) continue;
      done[std::size_t(n)] = 1;
      int const edge = int(k - corners.size()), face = edge - n_edges(type);
      std::vector<Index32> items;
      auto const take = [&](Index32 corner) { items.push_back(graph.representative[std::size_t(corner)]); };
      if (edge < n_edges(type)) {
        for (int end = 0; end < 2; ++end) take(corners[std::size_t(edge_corner(type, edge, end))]);
      } else if (face < n_square) {
        std::array<Index32, max_face_corners> room;
        for (Index32 const c : side_nodes(mesh, e, square[std::size_t(face)], room)) take(c);
      } else {
        for (Index32 const c : corners) take(c);
      }
      std::vector<double> const weights(items.size(), 1.0);
      rows.add(n, items, weights);
    }
  }
  return rows;
}

}  // namespace gridmorph::detail
