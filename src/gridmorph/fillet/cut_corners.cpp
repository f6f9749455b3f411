#include <gridmorph/fillet/corners.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

namespace gridmorph {

namespace {

using Quadrilateral = std::array<Index32, 4>;

Quadrilateral sorted(Quadrilateral nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Cells in the order in which they are found, each once.
class Cut {
 public:
  Cut(CornerLattice const& lattice, std::vector<CornerCell> const& cells) : lattice_(lattice) {
    for (CornerCell const& cell : cells) add(cell);
    for (CornerCell const& cell : cells)
      for (int end = 0; end < 2; ++end)
        for (auto behind = lattice.behind(cell, end); behind && !cells_.contains(behind->element);
             behind = lattice.behind(*behind, end))
          add(*behind);
  }

  [[nodiscard]] std::unordered_map<Index32, CornerCell> const& cells() const { return cells_; }
  /// The two triangles of a face that is cut; nothing where it is whole.
  [[nodiscard]] std::vector<std::array<Index32, 3>> triangles(std::span<Index32 const> face) const {
    if (face.size() != 4) return {};
    auto const found = faces_.find(sorted({face[0], face[1], face[2], face[3]}));
    if (found == faces_.end()) return {};
    // In the order of the face, which begins at either end of the diagonal.
    auto const from = std::size_t(std::find(face.begin(), face.end(), found->second) - face.begin());
    auto const at = [&](std::size_t k) { return face[(from + k) % 4]; };
    return {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}};
  }

 private:
  void add(CornerCell const& cell) {
    if (!cells_.emplace(cell.element, cell).second)
      throw MeshError(lattice_.elements().mesh().source + ": the corner's " +
                      describe_element(lattice_.elements().mesh(), cell.element) +
                      " would be cut twice, along two root lines; fill them one at a time, or with fewer layers");
    for (int end = 0; end < 2; ++end) faces_[sorted(CornerLattice::end_face(cell, end))] = cell.node[end][0][0];
  }

  CornerLattice const& lattice_;
  std::unordered_map<Index32, CornerCell> cells_;
  std::map<Quadrilateral, Index32> faces_;  ///< that are cut, and where their diagonals begin
};

double volume(Mesh const& mesh, std::array<Index32, 6> const& prism) {
  auto const at = [&](std::size_t k) { return mesh.coordinates[prism[k]]; };
  return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) +
         dot(cross(at(4) - at(3), at(5) - at(3)), at(3) - at(0));
}

double volume_of_hexahedron(Mesh const& mesh, std::span<Index32 const> c) {
  auto const at = [&](std::size_t k) { return mesh.coordinates[c[k]]; };
  return dot(cross(at(1) - at(0), at(3) - at(0)), at(4) - at(0)) +
         dot(cross(at(7) - at(6), at(5) - at(6)), at(2) - at(6));
}

/// Numbered the same way round as the hexahedron they come from.
std::array<std::array<Index32, 6>, 2> prisms_of(Mesh const& mesh, CornerCell const& cell) {
  auto const &a = cell.node[0], &b = cell.node[1];
  std::array<std::array<Index32, 6>, 2> out{
      {{a[0][0], a[1][0], a[1][1], b[0][0], b[1][0], b[1][1]}, {a[0][0], a[1][1], a[0][1], b[0][0], b[1][1], b[0][1]}}};
  bool const negative = volume_of_hexahedron(mesh, mesh.elements.corners(cell.element)) < 0;
  for (auto& prism : out)
    if ((volume(mesh, prism) < 0) != negative) {
      std::swap(prism[1], prism[2]);
      std::swap(prism[4], prism[5]);
    }
  return out;
}

CsrGraph cut_faces(Cut const& cut, CsrGraph const& faces) {
  CsrGraph out;
  for (Index f = 0; f < faces.size(); ++f) {
    auto const pieces = cut.triangles(faces[f]);
    if (pieces.empty()) out.add(faces[f]);
    for (auto const& triangle : pieces) out.add(triangle);
  }
  return out;
}

}  // namespace

Mesh cut_corners(CornerLattice const& lattice, std::vector<CornerCell> const& cells) {
  Mesh const& mesh = lattice.elements().mesh();
  Cut const cut(lattice, cells);
  Mesh out = mesh;
  out.elements = {};
  out.file_order = {};
  std::vector<Index32> first_piece;  // of every old element
  for (Zone& zone : out.zones) {
    Index const begin = zone.first_element, end = begin + zone.n_elements;
    zone.first_element = out.n_elements();
    for (Index e = begin; e < end; ++e) {
      first_piece.push_back(Index32(out.elements.size()));
      if (auto const found = cut.cells().find(Index32(e)); found != cut.cells().end()) {
        for (auto const& prism : prisms_of(mesh, found->second)) {
          out.elements.type.push_back(ElementType::prism);
          out.elements.nodes.add(prism);
        }
      } else {
        out.elements.type.push_back(mesh.elements.type[e]);
        out.elements.nodes.add(mesh.elements.nodes[e]);
      }
    }
    zone.n_elements = out.n_elements() - zone.first_element;
  }
  first_piece.push_back(Index32(out.elements.size()));
  for (Patch& patch : out.patches) patch.faces = cut_faces(cut, patch.faces);
  for (Index32& e : out.polyhedra.element) e = first_piece[e];
  for (Subset& subset : out.subsets) {
    subset.faces = cut_faces(cut, subset.faces);
    std::vector<Index32> elements;
    for (Index32 const e : subset.elements)
      for (Index32 piece = first_piece[e]; piece < first_piece[e + 1]; ++piece) elements.push_back(piece);
    subset.elements = std::move(elements);
  }
  return out;
}

}  // namespace gridmorph
