// Faces of finite elements, in the numbering of the CGNS standard (SIDS, "Unstructured Grid Element Numbering
// Conventions"). Internal to io.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gridmorph::cgns {

/// A triangle or quadrilateral with, in elements of higher order, a node amid each side and one in the middle.
struct ElementFace {
  std::array<std::int32_t, 4> corner{-1, -1, -1, -1};  ///< the last one is -1 in a triangle
  std::array<std::int32_t, 4> amid{-1, -1, -1, -1};    ///< between corner s and the next one
  std::int32_t middle = -1;

  [[nodiscard]] int sides() const { return corner[3] < 0 ? 3 : 4; }
};

struct ElementShape {
  int number;  ///< ElementType_t
  std::string_view name;
  int dimension;                               ///< 0 node, 1 line, 2 shell, 3 solid
  int nodes;                                   ///< per element
  std::vector<std::vector<int>> faces;         ///< corners, 0-based
  std::vector<std::array<int, 2>> mid_points;  ///< ends of the edges that the nodes after the corners lie on
  int corners;
};

/// The shape with an ElementType_t number; nullptr for shapes that are not read.
ElementShape const* element_shape(std::int64_t number);

/// Appends the faces of one element; `nodes` are its numbers in the mesh.
void add_faces(ElementShape const& shape, std::span<std::int32_t const> nodes, std::vector<ElementFace>& faces);

/// The faces that belong to one element alone, in their order. Cost O(n log n).
std::vector<ElementFace> outer_faces(std::vector<ElementFace> const& faces);

/// Appends the face as linear triangles and quadrilaterals that use each of its nodes.
void add_facets(ElementFace const& face, std::vector<std::array<std::int32_t, 4>>& facets);

}  // namespace gridmorph::cgns
