// Shapes of unstructured elements: corners, edges and faces in the node order of the CGNS SIDS (3.3, unstructured grid
// element numbering conventions). Node numbers are 0-based here.
//
//   triangle       0 1 2 counter-clockwise          quadrilateral  0 1 2 3 counter-clockwise
//   tetrahedron    base 0 1 2, top 3                pyramid        base 0 1 2 3, apex 4
//   prism          bottom 0 1 2, top 3 4 5          hexahedron     bottom 0 1 2 3, top 4 5 6 7
//
// Bases are counter-clockwise when seen from inside the element; faces of volume elements are listed so that their
// normals point outwards, and edges of surface elements so that the element lies on their left. Second-order elements
// list their corners first, so that these tables serve them too.
#pragma once

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace gridmorph::kernels {

enum class ElementType : std::uint8_t {
  triangle,
  quadrilateral,
  tetrahedron,
  pyramid,
  prism,
  hexahedron,
  polyhedron  ///< any other volume element; its faces are in Mesh::polyhedra
};

inline constexpr int n_element_types = 7;
/// The largest counts among the elements that have tables here.
inline constexpr int max_corners = 8, max_edges = 12, max_faces = 6, max_face_corners = 4;

/// Number of corners; 0 for a polyhedron, which has as many as it lists.
KOKKOS_INLINE_FUNCTION constexpr int n_corners(ElementType type) {
  constexpr int n[n_element_types] = {3, 4, 4, 5, 6, 8, 0};
  return n[int(type)];
}

KOKKOS_INLINE_FUNCTION constexpr int n_edges(ElementType type) {
  constexpr int n[n_element_types] = {3, 4, 6, 8, 9, 12, 0};
  return n[int(type)];
}

/// Sides of an element: faces of a volume element, edges of a surface element.
KOKKOS_INLINE_FUNCTION constexpr int n_faces(ElementType type) {
  constexpr int n[n_element_types] = {3, 4, 4, 5, 5, 6, 0};
  return n[int(type)];
}

KOKKOS_INLINE_FUNCTION constexpr bool is_surface(ElementType type) {
  return type == ElementType::triangle || type == ElementType::quadrilateral;
}

/// Corner at end 0 or 1 of an edge.
KOKKOS_FORCEINLINE_FUNCTION constexpr int edge_corner(ElementType type, int edge, int end) {
  constexpr std::int8_t corner[n_element_types - 1][max_edges][2] = {
      {{0, 1}, {1, 2}, {2, 0}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}};
  return corner[int(type)][edge][end];
}

/// Edges of one number run along the same direction of the element, opposite to one another; where an edge has no
/// opposite it has a number of its own. Numbers begin with 0.
KOKKOS_INLINE_FUNCTION constexpr int edge_direction(ElementType type, int edge) {
  constexpr std::int8_t direction[n_element_types - 1][max_edges] = {{0, 1, 2},
                                                                     {0, 1, 0, 1},
                                                                     {0, 1, 2, 3, 4, 5},
                                                                     {0, 1, 0, 1, 2, 3, 4, 5},
                                                                     {0, 1, 2, 3, 3, 3, 0, 1, 2},
                                                                     {0, 1, 0, 1, 2, 2, 2, 2, 0, 1, 0, 1}};
  return direction[int(type)][edge];
}

KOKKOS_FORCEINLINE_FUNCTION constexpr int n_face_corners(ElementType type, int face) {
  constexpr std::int8_t n[n_element_types - 1][max_faces] = {{2, 2, 2},       {2, 2, 2, 2},    {3, 3, 3, 3},
                                                             {4, 3, 3, 3, 3}, {4, 4, 4, 3, 3}, {4, 4, 4, 4, 4, 4}};
  return n[int(type)][face];
}

/// Corner number `at` of a side, in the order that makes its normal point outwards.
KOKKOS_FORCEINLINE_FUNCTION constexpr int face_corner(ElementType type, int face, int at) {
  constexpr std::int8_t corner[n_element_types - 1][max_faces][max_face_corners] = {
      {{0, 1}, {1, 2}, {2, 0}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
      {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
      {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {0, 2, 1}, {3, 4, 5}},
      {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {4, 5, 6, 7}}};
  return corner[int(type)][face][at];
}

/// The corner that a grid line through corner `corner` of side `face` leads to, away from the side; -1 where the
/// element has no such line: only prisms over their triangles, hexahedra, and quadrilaterals form layers.
KOKKOS_INLINE_FUNCTION constexpr int layer_corner(ElementType type, int face, int corner) {
  bool const layers = type == ElementType::quadrilateral || type == ElementType::hexahedron ||
                      (type == ElementType::prism && n_face_corners(type, face) == 3);
  if (!layers) return -1;
  for (int e = 0; e < n_edges(type); ++e)
    for (int end = 0; end < 2; ++end) {
      if (edge_corner(type, e, end) != corner) continue;
      int const other = edge_corner(type, e, 1 - end);
      bool leaves = true;
      for (int c = 0; c < n_face_corners(type, face); ++c) leaves = leaves && face_corner(type, face, c) != other;
      if (leaves) return other;
    }
  return -1;
}

}  // namespace gridmorph::kernels

// The types of elements are words of the library's interface, like the vectors of vec3.hpp.
namespace gridmorph {
using kernels::edge_corner, kernels::n_face_corners, kernels::face_corner;
using kernels::ElementType, kernels::n_element_types;
using kernels::max_corners, kernels::max_faces, kernels::max_face_corners;
using kernels::n_corners, kernels::n_edges, kernels::n_faces, kernels::is_surface;
}  // namespace gridmorph
