// Elements given by their faces, as CGNS (NFACE_n, NGON_n with parents) and OpenFOAM have them. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph::io {

/// Appends elements to a mesh, face by face. Those with the faces of a tetrahedron, pyramid, prism or hexahedron become
/// one, in SIDS order; the others become polyhedra.
class ElementsByFaces {
 public:
  explicit ElementsByFaces(Mesh& mesh) : mesh_(mesh) {}

  /// A face of the element to come; `outward`: whether its normal, right-handed around its nodes, points out of it.
  void add_face(std::span<Index32 const> nodes, bool outward);
  /// The number of faces so far of the element to come.
  [[nodiscard]] std::size_t n_faces() const { return n_faces_; }
  /// Appends the element to the last zone of the mesh, under its number in the file.
  void end_element(std::int64_t file_number);

 private:
  Mesh& mesh_;
  std::vector<std::vector<Index32>> faces_;  ///< the first n_faces_; the others keep their memory
  std::size_t n_faces_ = 0;
};

}  // namespace gridmorph::io
