#include <gridmorph/io/polyhedron.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::io {

namespace {

/// The faces of one element, each with its normal pointing outwards.
using Faces = std::span<std::vector<Index32> const>;

bool contains(std::vector<Index32> const& list, Index32 n) {
  return std::find(list.begin(), list.end(), n) != list.end();
}

std::vector<Index32> unique_nodes(Faces faces) {
  std::vector<Index32> nodes;
  for (auto const& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The node that an edge outside `base` joins to base node n; -1 when there is none.
Index32 above(Faces faces, std::vector<Index32> const& base, Index32 n) {
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
Shape recognise(Faces faces) {
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

}  // namespace

void ElementsByFaces::add_face(std::span<Index32 const> nodes, bool outward) {
  if (n_faces_ == faces_.size()) faces_.emplace_back();
  std::vector<Index32>& face = faces_[n_faces_++];
  face.assign(nodes.begin(), nodes.end());
  if (!outward) std::reverse(face.begin(), face.end());
}

void ElementsByFaces::end_element(std::int64_t file_number) {
  Faces const faces(faces_.data(), n_faces_);
  Shape const shape = recognise(faces);
  if (shape.type == ElementType::polyhedron) {
    auto& p = mesh_.polyhedra;
    if (p.first_face.empty()) p.first_face.push_back(0);
    p.element.push_back(Index32(mesh_.n_elements()));
    for (auto const& face : faces) p.faces.add(face);
    p.first_face.push_back(p.faces.size());
  }
  mesh_.add_element(shape.type, shape.nodes);
  mesh_.elements.number.push_back(Index32(file_number));
  n_faces_ = 0;
}

}  // namespace gridmorph::io
