// The lists of a polyMesh folder, checked against one another. Internal to io.
#pragma once

#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph::foam {

struct Lists {
  Coordinates points;
  bool single_precision = false;
  CsrGraph faces;                         ///< those inside the mesh first, then patch by patch
  std::vector<Index32> owner, neighbour;  ///< the latter of faces inside the mesh
  std::vector<BoundaryEntry> boundary;
  std::vector<ZoneEntry> cell_zones, face_zones;

  /// The number of cells: one more than the largest cell of owner and neighbour.
  [[nodiscard]] Index32 n_cells() const;
};

/// Throws IoError for files that cannot be read, MeshError for labels that name what there is not.
Lists read_lists(Folders const& from);

}  // namespace gridmorph::foam
