// Names for what nothing claims: open faces of several zones that continue one another are one patch.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// A name for each of the patches `first`, `first` + 1, ... of a mesh, which are rectangles of zone faces:
/// - a plane on a limit of the mesh is "x_min" ... "z_max";
/// - what keeps off the limits in two directions or more (one in a 2-D mesh), with all that joins it at whatever angle,
/// is "body", or
///   "body 1", "body 2", ... by the zones they begin in: six faces round a box are one body;
/// - the rest is joined where it goes on smoothly (30 degrees) and called "surface", or "surface 1", ...;
/// - poles keep the name "pole".
/// Cost: O(nodes + patch nodes log patch nodes).
std::vector<std::string> names_of_open_patches(Mesh const& mesh, std::size_t first);

}  // namespace gridmorph
