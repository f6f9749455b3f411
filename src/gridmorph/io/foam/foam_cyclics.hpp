// Cyclic patches of OpenFOAM: face k of one is face k of the other. Internal to io.
#pragma once

#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph::foam {

/// Adds a connection for each pair of sides that name one another (neighbourPatch). The transform is fitted to the
/// middles of the faces: a translation where these are one translation apart (1e-6 of the mesh size), else a rotation
/// about rotationAxis and rotationCentre, or about the line that the faces themselves ask for. Nodes are paired by it.
/// Sides that do not fit become patches of kind `connection`, and a note says so.
void add_cyclics(std::vector<BoundaryEntry const*> const& sides, CsrGraph const& faces, Mesh& mesh);

/// The connections of sides that name one another and are mapped face by face in any order (cyclicAMI): where their
/// nodes match one by one, one from each side, by its name. Tried are the translation that is declared or lies between
/// their middles, and the rotation about rotationAxis and rotationCentre. Sides that lie on one another slide and are
/// left alone; others that do not match are too, with a note.
std::vector<Connection> matching_sides(std::vector<BoundaryEntry const*> const& sides, CsrGraph const& faces,
                                       Mesh& mesh);

}  // namespace gridmorph::foam
