// Elements_t of a zone: volume elements, boundary faces, and the numbers the file gives them.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cgns {

/// What a CGNS ElementType_t number stands for; nothing for the numbers that are no shape.
struct ElementKind {
  int dimension = 0;  ///< 0 (NODE) to 3
  ElementType type = ElementType::triangle;
  int nodes = 0;    ///< in the list
  int corners = 0;  ///< how many of its nodes are corners; they are the first in the list
};
std::optional<ElementKind> element_kind(std::int64_t cgns_type);

/// One Elements_t as it stands in the file: nodes are 1-based numbers of its zone.
struct Section {
  std::string name;
  std::int64_t first = 0, last = 0;       ///< ElementRange
  std::vector<unsigned char> cgns_types;  ///< one per element; NGON_n and NFACE_n too
  std::vector<Index> start;               ///< (elements + 1) in `list`
  std::vector<std::int64_t> list;         ///< nodes, or the signed faces of NFACE_n
  std::vector<std::int64_t> parents;      ///< ParentElements of NGON_n: left ones, then right ones

  [[nodiscard]] Index size() const { return Index(cgns_types.size()); }
  [[nodiscard]] std::span<std::int64_t const> operator[](Index e) const {
    return {list.data() + start[e], std::size_t(start[e + 1] - start[e])};
  }
};

/// ElementType_t numbers as they have been since CGNS 3.1. Version 3.0 counted PYRA_13 as 13, before PYRA_14; 3.1 moved
/// it to 21, behind MIXED, so that the numbers of 2.x hold again.
class ElementTypes {
 public:
  /// tree: of the whole file, which names the version that wrote it.
  ElementTypes(File const& file, Node const& tree);
  [[nodiscard]] std::int64_t operator()(std::int64_t stored) const;

 private:
  bool version_3_0_;
};

/// All sections of a zone. Adds to problems what cannot be read, and nodes outside the zone.
std::vector<Section> read_sections(File const& file, ElementTypes const& types, ZoneLayout const& zone,
                                   Problems& problems);

/// Highest dimension of the elements of some sections: 3 or 2, or less where there are none.
int dimension_of(std::vector<Section> const& sections);

/// Faces (edges in 2-D) that the sections of a zone list, with their numbers in the file.
struct ListedFaces {
  struct Group {
    std::string name;  ///< of the section
    Index begin = 0, end = 0;
    bool polygons = false;  ///< NGON_n, which holds the inner faces too
  };
  std::vector<std::int64_t> number;  ///< ascending within a group
  CsrGraph nodes;                    ///< corners, numbered as in the mesh
  std::vector<char> claimed;         ///< by a boundary condition
  std::vector<Group> groups;
  std::vector<std::array<std::int64_t, 2>>
      smaller;  ///< first and last of elements of lower dimension: points, and edges in 3-D

  /// The face with this number in the file, or -1.
  [[nodiscard]] Index find(std::int64_t file_number) const;
  void add_smaller(std::int64_t file_number) {
    if (smaller.empty() || smaller.back()[1] + 1 != file_number) smaller.push_back({file_number, file_number});
    smaller.back()[1] = file_number;
  }
  /// Whether the number is that of a point or an edge, which bounds no element.
  [[nodiscard]] bool is_smaller(std::int64_t file_number) const;
};

/// Appends the elements of a zone (of `dimension`) to its place in the mesh and collects its faces.
ListedFaces add_elements(std::vector<Section> const& sections, std::string const& where, Mesh& mesh,
                         Problems& problems);

/// Appends the volume elements that the sections describe by faces. Those with the faces of a tetrahedron, pyramid,
/// prism or hexahedron become one, in SIDS order; the others become polyhedra.
void add_polyhedra(std::vector<Section> const& sections, ListedFaces const& faces, std::string const& where, Mesh& mesh,
                   Problems& problems);

}  // namespace gridmorph::cgns
