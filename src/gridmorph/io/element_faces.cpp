#include <gridmorph/io/element_faces.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace gridmorph::cgns {

namespace {

using Faces = std::vector<std::vector<int>>;
using Edges = std::vector<std::array<int, 2>>;

ElementShape shape(int number, std::string_view name, int dimension, int corners, Faces faces, Edges edges = {},
                   int further = 0) {
  int const nodes = corners + int(edges.size()) + further;
  return {number, name, dimension, nodes, std::move(faces), std::move(edges), corners};
}

std::vector<ElementShape> all_shapes() {
  Faces const triangle{{0, 1, 2}}, square{{0, 1, 2, 3}};
  Edges const around3{{0, 1}, {1, 2}, {2, 0}}, around4{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Faces const tetra{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  Faces const pyramid{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  Faces const prism{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {0, 2, 1}, {3, 4, 5}};
  Faces const hexa{{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {4, 5, 6, 7}};
  return {shape(2, "NODE", 0, 1, {}),
          shape(3, "BAR_2", 1, 2, {}),
          shape(4, "BAR_3", 1, 2, {}, {{0, 1}}),
          shape(5, "TRI_3", 2, 3, triangle),
          shape(6, "TRI_6", 2, 3, triangle, around3),
          shape(7, "QUAD_4", 2, 4, square),
          shape(8, "QUAD_8", 2, 4, square, around4),
          shape(9, "QUAD_9", 2, 4, square, around4, 1),
          shape(10, "TETRA_4", 3, 4, tetra),
          shape(11, "TETRA_10", 3, 4, tetra, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}),
          shape(12, "PYRA_5", 3, 5, pyramid),
          shape(14, "PENTA_6", 3, 6, prism),
          shape(15, "PENTA_15", 3, 6, prism, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}}),
          shape(17, "HEXA_8", 3, 8, hexa),
          shape(18, "HEXA_20", 3, 8, hexa,
                {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}})};
}

/// Sorted corners: the same for the two elements that share a face, however each of them lists it.
std::array<std::int32_t, 4> key_of(ElementFace const& face) {
  auto key = face.corner;
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

ElementShape const* element_shape(std::int64_t number) {
  static std::vector<ElementShape> const shapes = all_shapes();
  auto const found =
      std::find_if(shapes.begin(), shapes.end(), [&](ElementShape const& k) { return k.number == number; });
  return found == shapes.end() ? nullptr : &*found;
}

void add_faces(ElementShape const& shape, std::span<std::int32_t const> nodes, std::vector<ElementFace>& faces) {
  for (auto const& corners : shape.faces) {
    ElementFace face;
    int const n = int(corners.size());
    for (int s = 0; s < n; ++s) {
      int const a = corners[s], b = corners[(s + 1) % n];
      face.corner[s] = nodes[a];
      for (std::size_t e = 0; e < shape.mid_points.size(); ++e)
        if (auto const [from, to] = shape.mid_points[e]; (from == a && to == b) || (from == b && to == a))
          face.amid[s] = nodes[shape.corners + e];
    }
    if (shape.dimension == 2 && shape.nodes > shape.corners + int(shape.mid_points.size())) face.middle = nodes.back();
    faces.push_back(face);
  }
}

std::vector<ElementFace> outer_faces(std::vector<ElementFace> const& faces) {
  std::vector<std::pair<std::array<std::int32_t, 4>, std::size_t>> sorted;
  sorted.reserve(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) sorted.emplace_back(key_of(faces[f]), f);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::size_t> outer;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && sorted[end].first == sorted[begin].first) ++end;
    if (end - begin == 1) outer.push_back(sorted[begin].second);
  }
  std::sort(outer.begin(), outer.end());
  std::vector<ElementFace> out;
  for (std::size_t const f : outer) out.push_back(faces[f]);
  return out;
}

void add_facets(ElementFace const& face, std::vector<std::array<std::int32_t, 4>>& facets) {
  auto const& c = face.corner;
  auto const& m = face.amid;
  if (m[0] < 0) {
    facets.push_back(c);
  } else if (face.sides() == 3) {
    facets.insert(facets.end(),
                  {{c[0], m[0], m[2], -1}, {m[0], c[1], m[1], -1}, {m[2], m[1], c[2], -1}, {m[0], m[1], m[2], -1}});
  } else if (face.middle >= 0) {
    facets.insert(facets.end(), {{c[0], m[0], face.middle, m[3]},
                                 {m[0], c[1], m[1], face.middle},
                                 {face.middle, m[1], c[2], m[2]},
                                 {m[3], face.middle, m[2], c[3]}});
  } else {
    facets.insert(facets.end(), {{c[0], m[0], m[3], -1},
                                 {c[1], m[1], m[0], -1},
                                 {c[2], m[2], m[1], -1},
                                 {c[3], m[3], m[2], -1},
                                 {m[0], m[1], m[2], m[3]}});
  }
}

}  // namespace gridmorph::cgns
