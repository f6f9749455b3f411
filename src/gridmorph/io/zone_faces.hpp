// The elements of a zone by their faces, each face once: what NGON_n and NFACE_n sections hold. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph::io {

class ZoneFaces {
 public:
  /// Corners alone: nodes amid the edges of second-order elements are on no face. Faces are numbered in the order of
  /// the elements that have them first, their nodes as these see them from outside. Throws MeshError for a face of more
  /// than two elements. Cost O(n log n) in faces.
  ZoneFaces(Mesh const& mesh, Zone const& zone);

  /// Nodes of the mesh around each face.
  [[nodiscard]] CsrGraph const& faces() const { return faces_; }
  /// Faces of each element of the zone, from 1 on; negative where the normal points into it.
  [[nodiscard]] CsrGraph const& elements() const { return elements_; }
  /// The face with these nodes in any order; -1 where there is none.
  [[nodiscard]] Index find(std::span<Index32 const> nodes) const;

 private:
  CsrGraph faces_, elements_;
  std::vector<std::pair<std::uint64_t, Index32>> by_key_;  ///< sorted
};

}  // namespace gridmorph::io
