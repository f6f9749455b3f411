// Structured meshes as unstructured ones: oracles for what is derived and measured.
#pragma once

#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

namespace gridmorph::test {

/// as_hexahedra().
inline Mesh to_hexahedra(Mesh const& mesh) { return as_hexahedra(mesh); }

/// The cells below k = `prism_layers` of each zone split into two prisms along k, the others into six tetrahedra (H.
/// Kuhn's subdivision): conforming inside each zone. Right-handed zones only. Patches become faces.
Mesh to_prisms_and_tetrahedra(Mesh const& mesh, int prism_layers);

/// A box of unit cells from (0, 0, 0) with patches "i_min" ... "k_max"; k_min is a wall, the others are of no kind.
Mesh unit_box(Index3 cells);

/// A 2-D mesh of one zone: cells (i, j) of the plane z = 0, below j = `layers` quadrilaterals, above two triangles
/// each; patches "i_min" ... "j_max", j_min a wall.
Mesh flat_box(int ni, int nj, int layers);

/// The same with its sides i as a pair of periodic connections.
Mesh periodic_flat_box(int ni, int nj, int layers);

/// Zones, elements, polyhedra, patches, connections and, bit for bit, coordinates; numbers of elements in messages
/// aside.
void expect_same_mesh(Mesh const& a, Mesh const& b);

}  // namespace gridmorph::test
