#include "warp.hpp"

gridmorph::Mesh collapsed_box(gridmorph::Index3 extent) {
  gridmorph::Mesh mesh;
  mesh.add_zone("box", extent);
  mesh.coordinates = gridmorph::Coordinates(mesh.n_nodes());
  for (gridmorph::Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, {0, 0, 0});
  return mesh;
}
