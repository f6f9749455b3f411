// A structured mesh as an unstructured one.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

namespace gridmorph {

/// The mesh with every cell a hexahedron: the same nodes with the same numbers, the same cells in the same order (zone
/// after zone, i fastest). Left-handed zones are turned, bottom for top, so that sound elements have positive volumes;
/// inverted cells stay inverted. Collapsed cells (poles, wedges) stay hexahedra with corners that coincide. 2-D meshes
/// become one layer of hexahedra between their two node planes. Patches become faces, interfaces connections. The
/// coordinates are copied. Throws MeshError for a mesh with more nodes than an Index32 can count. Linear cost.
Mesh as_hexahedra(Mesh const& mesh);

}  // namespace gridmorph
