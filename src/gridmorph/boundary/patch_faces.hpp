// Faces of patches whose nodes are no grid: of unstructured meshes.
#pragma once

#include <array>
#include <vector>

namespace gridmorph {

/// How the nodes of patches that are listed side by side (boundary_outline()) hang together.
struct PatchFaces {
  struct Patch {
    /// Corners in order around a face, the normal pointing into the mesh, as places in the patch's range along i; the fourth is -1
    /// in triangles, and the third too in lines. Empty for patches whose faces nobody asked for.
    std::vector<std::array<int, 4>> corners;
    std::vector<int> listed;  ///< the places in the order of the file's node numbers
  };

  bool lines = false;  ///< of a 2-D mesh
  std::vector<Patch> of_patch;
};

}  // namespace gridmorph
