#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/cgns/cgns_sections.hpp>
#include <gridmorph/io/element_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// A triangle or quadrilateral with, in elements of higher order, a node amid each side and one in the middle.
struct ElementFace {
  std::array<std::int32_t, 4> corner{-1, -1, -1, -1};  ///< the last one is -1 in a triangle
  std::array<std::int32_t, 4> amid{-1, -1, -1, -1};    ///< between corner s and the next one
  std::int32_t middle = -1;

  [[nodiscard]] int sides() const { return corner[3] < 0 ? 3 : 4; }
};

/// A finite element, in the numbering of the CGNS standard (SIDS, "Unstructured Grid Element Numbering Conventions").
struct ElementShape {
  int number;  ///< ElementType_t
  std::string_view name;
  int dimension;                               ///< 0 node, 1 line, 2 shell, 3 solid
  int nodes;                                   ///< per element
  std::vector<std::vector<int>> faces;         ///< corners, 0-based
  std::vector<std::array<int, 2>> mid_points;  ///< ends of the edges that the nodes after the corners lie on
  int corners;
};

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

/// The shape with an ElementType_t number; nullptr for shapes that are not read.
ElementShape const* element_shape(std::int64_t number) {
  static std::vector<ElementShape> const shapes = all_shapes();
  auto const found =
      std::find_if(shapes.begin(), shapes.end(), [&](ElementShape const& k) { return k.number == number; });
  return found == shapes.end() ? nullptr : &*found;
}

/// Appends the faces of one element; `nodes` are its numbers in the mesh.
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

/// The faces that belong to one element alone, in their order. Cost O(n log n).
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

/// Appends the face as linear triangles and quadrilaterals that use each of its nodes.
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

constexpr std::int64_t mixed = 20;
constexpr std::array<char const*, 3> coordinate_names{"CoordinateX", "CoordinateY", "CoordinateZ"};
constexpr std::array<char const*, 3> displacement_names{"DisplacementX", "DisplacementY", "DisplacementZ"};

/// Reads one file, zone after zone; problems of the mesh are collected, damage is thrown.
class ModelReader {
 public:
  ModelReader(std::string const& path, std::string solution)
      : file_(path, cgns::File::Mode::read), wanted_(std::move(solution)) {}

  ElementModel read() {
    cgns::Node const tree = file_.tree();
    types_.emplace(file_, tree);
    for (auto const* base : tree.all("CGNSBase_t"))
      for (auto const* zone : base->all("Zone_t")) read_zone(*zone);
    if (zones_ == 0) throw IoError(file_.path() + ": holds no Zone_t node; there is no model in it");
    problems_.throw_if_any<MeshError>();
    // Shells are the surface that the analyst chose; the outside of solids is taken where there are none.
    auto const faces = shells_.empty() ? outer_faces(solids_) : shells_;
    for (auto const& face : faces) add_facets(face, out_.facets);
    if (!shells_.empty() && !solids_.empty())
      out_.notes.push_back(file_.path() + ": solid elements are left out; the shell elements beside them are used");
    if (passed_over_ > 0)
      out_.notes.push_back(file_.path() + ": " + std::to_string(passed_over_) + " node and line elements passed over");
    out_.solution = wanted_;
    return std::move(out_);
  }

 private:
  void read_zone(cgns::Node const& zone) {
    ++zones_;
    auto const sizes = file_.integers(zone);
    auto const dimensions = file_.dimensions(zone);
    auto const* type = zone.labelled("ZoneType_t");
    bool const structured = type == nullptr || file_.text(*type) == "Structured";
    int const index_dimension = structured && !dimensions.empty() ? int(dimensions[0]) : 1;
    if (sizes.empty() || Index(sizes.size()) < index_dimension) fail(zone, "has no sizes");
    if (structured && index_dimension != 2)
      fail(zone, "is structured with " + std::to_string(index_dimension) +
                     " index directions; a model is unstructured, or a surface of two index directions");
    Index n = 1;
    for (int a = 0; a < index_dimension; ++a) {
      if (sizes[a] < 1 || sizes[a] > std::numeric_limits<std::int32_t>::max() / n) fail(zone, "has unusable sizes");
      n *= sizes[a];
    }
    std::int32_t const first = std::int32_t(out_.position.size());
    if (n > std::numeric_limits<std::int32_t>::max() - first) fail(zone, "makes the model too large");
    read_nodes(zone, n);
    if (structured)
      add_cells(first, std::int32_t(sizes[0]), std::int32_t(sizes[1]));
    else
      for (auto const* section : zone.all("Elements_t")) read_section(*section, first, n);
  }

  [[noreturn]] void fail(cgns::Node const& node, std::string const& what) const {
    throw IoError(file_.path() + ", node " + node.path + ": " + what);
  }

  std::vector<double> array(cgns::Node const& node, Index n) const {
    if (file_.count(node) != n)
      fail(node,
           "has " + std::to_string(file_.count(node)) + " values, but the zone has " + std::to_string(n) + " nodes");
    return file_.reals(node);
  }

  /// A vector field from three arrays, of which at least one is there; empty otherwise.
  std::vector<Vec3> vectors(cgns::Node const& parent, std::array<char const*, 3> const& names, std::string const& part,
                            Index n) {
    std::vector<Vec3> out;
    for (int c = 0; c < 3; ++c) {
      auto const* node = parent.child(names[c] + part);
      if (node == nullptr) continue;
      auto const values = array(*node, n);
      out.resize(n);
      for (Index i = 0; i < n; ++i) {
        (c == 0 ? out[i].x : c == 1 ? out[i].y : out[i].z) = values[i];
        if (!std::isfinite(values[i])) {
          problems_.add(file_.path() + ", node " + node->path + ": value " + std::to_string(i + 1) +
                        " is not finite; correct the model");
          break;
        }
      }
    }
    return out;
  }

  void read_nodes(cgns::Node const& zone, Index n) {
    auto const* grid = zone.child("GridCoordinates");
    if (grid == nullptr) grid = zone.labelled("GridCoordinates_t");
    if (grid == nullptr) fail(zone, "has no GridCoordinates_t node");
    auto const position = vectors(*grid, coordinate_names, "", n);
    if (position.empty()) fail(*grid, "has none of CoordinateX, CoordinateY, CoordinateZ");
    out_.position.insert(out_.position.end(), position.begin(), position.end());

    std::string found;
    for (auto const* listed : zone.all("FlowSolution_t")) {
      found += (found.empty() ? "'" : ", '") + listed->name + "'";
      if (!wanted_.empty() && listed->name != wanted_) continue;
      cgns::Node solution = *listed;
      file_.load_children(solution);
      bool const any = std::any_of(displacement_names.begin(), displacement_names.end(),
                                   [&](char const* name) { return solution.child(name) != nullptr; });
      if (!any) continue;
      auto const* location = solution.labelled("GridLocation_t");
      if (location != nullptr && file_.text(*location) != "Vertex")
        fail(solution,
             "is given at " + file_.text(*location) + "; the displacement must be given at the nodes (Vertex)");
      wanted_ = listed->name;
      auto const real = vectors(solution, displacement_names, "", n);
      auto const imaginary = vectors(solution, displacement_names, "_im", n);
      if (zones_ > 1 && imaginary.empty() != out_.imaginary.empty())
        fail(solution, "has an imaginary part in some zones only");
      out_.displacement.insert(out_.displacement.end(), real.begin(), real.end());
      out_.imaginary.insert(out_.imaginary.end(), imaginary.begin(), imaginary.end());
      return;
    }
    fail(zone, "has no " +
                   (wanted_.empty() ? std::string("solution with DisplacementX, DisplacementY, DisplacementZ")
                                    : "solution '" + wanted_ + "' with DisplacementX, Y, Z") +
                   " (solutions there: " + (found.empty() ? "none" : found) + ")");
  }

  void add_cells(std::int32_t first, std::int32_t ni, std::int32_t nj) {
    for (std::int32_t j = 0; j + 1 < nj; ++j)
      for (std::int32_t i = 0; i + 1 < ni; ++i) {
        std::int32_t const a = first + i + ni * j;
        ElementFace face;
        face.corner = {a, a + 1, a + 1 + ni, a + ni};
        shells_.push_back(face);
      }
  }

  void read_section(cgns::Node const& listed, std::int32_t first, Index n) {
    cgns::Node section = listed;
    file_.load_children(section);
    auto const head = file_.integers(section);
    auto const* list = section.child("ElementConnectivity");
    if (head.empty() || list == nullptr) fail(section, "has no element type or no ElementConnectivity");
    auto const numbers = file_.integers(*list);
    std::vector<std::int32_t> nodes;
    for (std::size_t at = 0; at < numbers.size();) {
      std::int64_t const type = (*types_)((*types_)(head[0]) == mixed ? numbers[at++] : head[0]);
      auto const* shape = element_shape(type);
      if (shape == nullptr)
        fail(section, "holds elements of type number " + std::to_string(type) +
                          "; read are TRI_3, TRI_6, QUAD_4, QUAD_8, QUAD_9, TETRA_4, TETRA_10, PYRA_5, PENTA_6, "
                          "PENTA_15, HEXA_8, HEXA_20 and MIXED: convert the model to these");
      if (numbers.size() - at < std::size_t(shape->nodes)) fail(*list, "ends amid an element; the file is damaged");
      nodes.clear();
      bool good = true;
      for (int k = 0; k < shape->nodes; ++k, ++at) {
        good = good && numbers[at] >= 1 && numbers[at] <= n;
        if (good) nodes.push_back(first + std::int32_t(numbers[at] - 1));
      }
      if (!good) {
        problems_.add(file_.path() + ", node " + list->path + ": a " + std::string(shape->name) +
                      " element names a node that is not there (the zone has nodes 1 to " + std::to_string(n) + ")");
        return;
      }
      if (shape->dimension < 2) ++passed_over_;
      add_faces(*shape, nodes, shape->dimension == 3 ? solids_ : shells_);
    }
  }

  cgns::File file_;
  std::optional<cgns::ElementTypes> types_;
  std::string wanted_;
  ElementModel out_;
  Problems problems_;
  std::vector<ElementFace> shells_, solids_;
  Index passed_over_ = 0;
  int zones_ = 0;
};

}  // namespace

ElementModel read_element_model(std::string const& path, std::string const& solution) {
  return ModelReader(path, solution).read();
}

}  // namespace gridmorph
