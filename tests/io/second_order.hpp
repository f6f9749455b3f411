// Nodes amid edges and faces of second-order elements: where they are, and where the SIDS has them.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace gridmorph::test {

/// Corners of an element in SIDS order, then the middles of the corners that each list names.
inline std::vector<Vec3> places_amid(ElementType type, std::vector<std::vector<int>> const& amid) {
  std::map<ElementType, std::vector<Vec3>> const corners{
      {ElementType::hexahedron,
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
      {ElementType::prism, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
      {ElementType::tetrahedron, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {ElementType::pyramid, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}}};
  std::vector<Vec3> out = corners.at(type);
  for (auto const& list : amid) {
    Vec3 sum;
    for (int const c : list) sum += corners.at(type)[c];
    out.push_back((1 / double(list.size())) * sum);
  }
  return out;
}

/// Of the one element of a mesh: nodes behind the corners lie amid its edges, then amid its quadrilateral faces, in the
/// order of the SIDS.
inline void expect_nodes_amid(Mesh const& mesh) {
  ElementType const type = mesh.elements.type[0];
  auto const nodes = mesh.elements.nodes[0];
  auto const x = [&](std::size_t k) { return mesh.coordinates[nodes[k]]; };
  auto const corners = std::size_t(n_corners(type));
  for (int e = 0; e < n_edges(type) && corners + std::size_t(e) < nodes.size(); ++e)
    EXPECT_LT(distance(x(corners + std::size_t(e)),
                       0.5 * (x(std::size_t(edge_corner(type, e, 0))) + x(std::size_t(edge_corner(type, e, 1))))),
              1e-15)
        << to_string(type) << " edge " << e;
  std::size_t next = corners + std::size_t(n_edges(type));
  for (int f = 0; f < n_faces(type) && next < nodes.size(); ++f) {
    if (n_face_corners(type, f) != 4) continue;
    Vec3 sum;
    for (int c = 0; c < 4; ++c) sum += x(std::size_t(face_corner(type, f, c)));
    EXPECT_LT(distance(x(next++), 0.25 * sum), 1e-15) << to_string(type) << " face " << f;
  }
}

}  // namespace gridmorph::test
