#include <gridmorph/io/cgns/cgns_polyhedra.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

namespace gridmorph::cgns {

namespace {

constexpr unsigned char ngon = 22, nface = 23;

/// The faces of one element, each with its normal pointing outwards.
using Faces = std::vector<std::vector<Index32>>;

bool contains(std::vector<Index32> const& list, Index32 n) {
  return std::find(list.begin(), list.end(), n) != list.end();
}

std::vector<Index32> unique_nodes(Faces const& faces) {
  std::vector<Index32> nodes;
  for (auto const& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The node that an edge outside `base` joins to base node n; -1 when there is none.
Index32 above(Faces const& faces, std::vector<Index32> const& base, Index32 n) {
  for (auto const& face : faces) {
    auto const at = std::find(face.begin(), face.end(), n);
    if (at == face.end()) continue;
    std::size_t const k = std::size_t(at - face.begin()), size = face.size();
    for (Index32 const neighbour : {face[(k + 1) % size], face[(k + size - 1) % size]})
      if (!contains(base, neighbour)) return neighbour;
  }
  return -1;
}

struct Shape {
  ElementType type = ElementType::polyhedron;
  std::vector<Index32> nodes;
};

/// The element in SIDS order if its faces are those of a shape that has one.
Shape recognise(Faces const& faces) {
  Shape const other{ElementType::polyhedron, unique_nodes(faces)};
  std::size_t triangles = 0, quadrilaterals = 0;
  for (auto const& face : faces) {
    triangles += face.size() == 3;
    quadrilaterals += face.size() == 4;
  }
  std::size_t const n = other.nodes.size();
  if (triangles + quadrilaterals != faces.size()) return other;
  Shape out;
  std::size_t base_size = 3;
  if (n == 4 && triangles == 4 && quadrilaterals == 0) {
    out.type = ElementType::tetrahedron;
  } else if (n == 5 && triangles == 4 && quadrilaterals == 1) {
    out.type = ElementType::pyramid;
    base_size = 4;
  } else if (n == 6 && triangles == 2 && quadrilaterals == 3) {
    out.type = ElementType::prism;
  } else if (n == 8 && triangles == 0 && quadrilaterals == 6) {
    out.type = ElementType::hexahedron;
    base_size = 4;
  } else {
    return other;
  }
  auto const found =
      std::find_if(faces.begin(), faces.end(), [&](auto const& face) { return face.size() == base_size; });
  std::vector<Index32> const base(found->rbegin(), found->rend());  // seen from inside
  out.nodes = base;
  bool const apex = out.type == ElementType::tetrahedron || out.type == ElementType::pyramid;
  for (std::size_t k = 0; k < (apex ? 1 : base.size()); ++k) {
    Index32 const top = above(faces, base, base[k]);
    if (top < 0) return other;
    out.nodes.push_back(top);
  }
  auto sorted = out.nodes;
  std::sort(sorted.begin(), sorted.end());
  return sorted == other.nodes ? out : other;
}

class PolyhedronReader {
 public:
  PolyhedronReader(ListedFaces const& faces, Mesh& mesh) : faces_(faces), mesh_(mesh) {}

  /// A face of the element to come; false when there is no such face.
  bool add_face(std::int64_t file_number, bool outward) {
    Index const face = faces_.find(file_number);
    if (face < 0) return false;
    auto const nodes = faces_.nodes[face];
    current_.emplace_back(nodes.begin(), nodes.end());
    if (!outward) std::reverse(current_.back().begin(), current_.back().end());
    return true;
  }
  [[nodiscard]] std::size_t n_faces() const { return current_.size(); }

  void end_element(std::int64_t file_number) {
    Shape const shape = recognise(current_);
    if (shape.type == ElementType::polyhedron) {
      auto& p = mesh_.polyhedra;
      if (p.first_face.empty()) p.first_face.push_back(0);
      p.element.push_back(Index32(mesh_.n_elements()));
      for (auto const& face : current_) p.faces.add(face);
      p.first_face.push_back(p.faces.size());
    }
    mesh_.add_element(shape.type, shape.nodes);
    mesh_.elements.number.push_back(Index32(file_number));
    current_.clear();
  }

 private:
  ListedFaces const& faces_;
  Mesh& mesh_;
  Faces current_;
};

}  // namespace

void add_polyhedra(std::vector<Section> const& sections, ListedFaces const& faces, std::string const& where, Mesh& mesh,
                   Problems& problems) {
  PolyhedronReader reader(faces, mesh);
  bool any = false;
  for (auto const& s : sections) {
    if (s.cgns_types.front() != nface) continue;
    any = true;
    for (Index e = 0; e < s.size(); ++e) {
      for (auto const face : s[e])
        if (face == 0 || face == std::numeric_limits<std::int64_t>::min() || !reader.add_face(std::abs(face), face > 0))
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
        auto const parent = s.parents[std::size_t(f + side * s.size())];
        if (parent > 0 && parent < std::numeric_limits<Index32>::max())
          elements[parent].push_back(side == 0 ? s.first + f : -(s.first + f));
      }
  for (auto const& [number, list] : elements) {
    // Files with boundary sections of usual shapes may name their volume elements as parents.
    if (list.size() < 4) continue;
    for (auto const face : list) reader.add_face(std::abs(face), face > 0);
    reader.end_element(number);
  }
}

}  // namespace gridmorph::cgns
