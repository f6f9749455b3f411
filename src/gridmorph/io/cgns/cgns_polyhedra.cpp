#include <gridmorph/io/cgns/cgns_sections.hpp>
#include <gridmorph/io/polyhedron.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

namespace gridmorph::cgns {

namespace {

constexpr unsigned char ngon = 22, nface = 23;

/// Adds a face that the file lists; false when there is no such face.
bool add_face(ListedFaces const& faces, std::int64_t file_number, bool outward, io::ElementsByFaces& elements) {
  Index const face = faces.find(file_number);
  if (face < 0) return false;
  elements.add_face(faces.nodes[face], outward);
  return true;
}

}  // namespace

void add_polyhedra(std::vector<Section> const& sections, ListedFaces const& faces, std::string const& where, Mesh& mesh,
                   Problems& problems) {
  io::ElementsByFaces reader(mesh);
  bool any = false;
  for (auto const& s : sections) {
    if (s.cgns_types.front() != nface) continue;
    any = true;
    for (Index e = 0; e < s.size(); ++e) {
      for (auto const face : s[e])
        if (face == 0 || face == std::numeric_limits<std::int64_t>::min() ||
            !add_face(faces, std::abs(face), face > 0, reader))
          return problems.add(where + ", elements '" + s.name + "': element " + std::to_string(s.first + e) +
                              " has face " + std::to_string(face) + ", which no NGON_n section lists");
      if (reader.n_faces() < 4)
        return problems.add(where + ", elements '" + s.name + "': element " + std::to_string(s.first + e) + " has " +
                            std::to_string(reader.n_faces()) + " faces; a volume needs 4");
      reader.end_element(s.first + e);
    }
  }
  if (any) return;
  // Parents: element -> faces, with the normal leading from the left parent to the right one.
  std::map<std::int64_t, std::vector<std::int64_t>> elements;
  for (auto const& s : sections)
    for (Index f = 0; f < Index(s.parents.size()) / 2; ++f)
      for (int const side : {0, 1}) {
        auto const parent = s.parents[f + side * s.size()];
        if (parent > 0 && parent < std::numeric_limits<Index32>::max())
          elements[parent].push_back(side == 0 ? s.first + f : -(s.first + f));
      }
  for (auto const& [number, list] : elements) {
    // Files with boundary sections of usual shapes may name their volume elements as parents.
    if (list.size() < 4) continue;
    for (auto const face : list) add_face(faces, std::abs(face), face > 0, reader);
    reader.end_element(number);
  }
}

}  // namespace gridmorph::cgns
