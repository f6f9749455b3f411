#include <gridmorph/io/element_orders.hpp>

#include <array>
#include <utility>

namespace gridmorph::io {

namespace {

using Order = std::span<std::uint8_t const>;

// Mid nodes of edges follow the corners in the SIDS in the order of kernels/element_shape.hpp, then those of faces,
// then that of the volume.
constexpr std::array<std::uint8_t, 10> gmsh_tetrahedron{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr std::array<std::uint8_t, 14> gmsh_pyramid{0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13};
constexpr std::array<std::uint8_t, 18> gmsh_prism{0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13, 15, 17, 16};
constexpr std::array<std::uint8_t, 27> gmsh_hexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  10, 12,
                                                       14, 15, 16, 18, 19, 17, 20, 21, 23, 24, 22, 25, 26};
constexpr std::array<std::uint8_t, 18> vtk_prism{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17};
constexpr std::array<std::uint8_t, 27> vtk_hexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                                                      18, 19, 12, 13, 14, 15, 24, 22, 21, 23, 20, 25, 26};
constexpr std::array<std::uint8_t, 8> vtk_voxel{0, 1, 3, 2, 4, 5, 7, 6};

FileShape shape(ElementType type, int nodes, Order order = {}) {
  return {is_surface(type) ? 2 : 3, type, n_corners(type), nodes, order.first(order.empty() ? 0 : std::size_t(nodes))};
}
FileShape edge(int nodes) { return {1, {}, 2, nodes, {}}; }

}  // namespace

FileShape gmsh_shape(std::int64_t type) {
  switch (type) {
    case 1: return edge(2);
    case 2: return shape(ElementType::triangle, 3);
    case 3: return shape(ElementType::quadrilateral, 4);
    case 4: return shape(ElementType::tetrahedron, 4);
    case 5: return shape(ElementType::hexahedron, 8);
    case 6: return shape(ElementType::prism, 6);
    case 7: return shape(ElementType::pyramid, 5);
    case 8: return edge(3);
    case 9: return shape(ElementType::triangle, 6);
    case 10: return shape(ElementType::quadrilateral, 9);
    case 11: return shape(ElementType::tetrahedron, 10, gmsh_tetrahedron);
    case 12: return shape(ElementType::hexahedron, 27, gmsh_hexahedron);
    case 13: return shape(ElementType::prism, 18, gmsh_prism);
    case 14: return shape(ElementType::pyramid, 14, gmsh_pyramid);
    case 15: return {0, {}, 1, 1, {}};
    case 16: return shape(ElementType::quadrilateral, 8);
    case 17: return shape(ElementType::hexahedron, 20, gmsh_hexahedron);
    case 18: return shape(ElementType::prism, 15, gmsh_prism);
    case 19: return shape(ElementType::pyramid, 13, gmsh_pyramid);
    default: return {};
  }
}

FileShape vtk_shape(std::int64_t type) {
  switch (type) {
    case 1: return {0, {}, 1, 1, {}};
    case 3: return edge(2);
    case 5: return shape(ElementType::triangle, 3);
    case 8: return shape(ElementType::quadrilateral, 4, Order(vtk_voxel).first(4));
    case 9: return shape(ElementType::quadrilateral, 4);
    case 10: return shape(ElementType::tetrahedron, 4);
    case 11: return shape(ElementType::hexahedron, 8, vtk_voxel);
    case 12: return shape(ElementType::hexahedron, 8);
    case 13: return shape(ElementType::prism, 6);
    case 14: return shape(ElementType::pyramid, 5);
    case 21: return edge(3);
    case 22: return shape(ElementType::triangle, 6);
    case 23: return shape(ElementType::quadrilateral, 8);
    case 24: return shape(ElementType::tetrahedron, 10);
    case 25: return shape(ElementType::hexahedron, 20, vtk_hexahedron);
    case 26: return shape(ElementType::prism, 15, vtk_prism);
    case 27: return shape(ElementType::pyramid, 13);
    case 28: return shape(ElementType::quadrilateral, 9);
    case 29: return shape(ElementType::hexahedron, 27, vtk_hexahedron);
    case 32: return shape(ElementType::prism, 18, vtk_prism);
    default: return {};
  }
}

void turn_prism(std::span<Index32> nodes) {
  // Corners 1 and 2 change places, and with them the edges and faces that lie on them.
  constexpr std::array<std::array<std::size_t, 2>, 6> swaps{{{1, 2}, {4, 5}, {6, 8}, {10, 11}, {12, 14}, {15, 17}}};
  for (auto const& [a, b] : swaps)
    if (b < nodes.size()) std::swap(nodes[a], nodes[b]);
}

bool orient_prisms(Mesh& mesh) {
  auto const& elements = mesh.elements;
  auto& item = mesh.elements.nodes.item;
  Index balance = 0;
  for (Index e = 0; e < elements.size(); ++e) {
    if (elements.type[e] != ElementType::prism) continue;
    auto const n = elements.nodes[e];
    auto const x = [&](int c) { return mesh.coordinates[n[c]]; };
    balance += dot(cross(x(1) - x(0), x(2) - x(0)), x(3) - x(0)) > 0 ? 1 : -1;
  }
  if (balance >= 0) return false;
  for (Index e = 0; e < elements.size(); ++e)
    if (elements.type[e] == ElementType::prism)
      turn_prism({item.data() + elements.nodes.first[e], elements.nodes[e].size()});
  return true;
}

}  // namespace gridmorph::io
