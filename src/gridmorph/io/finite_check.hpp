// Finds coordinates that are not numbers, or none of the mesh they stand in.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <string>

namespace gridmorph::io {

/// What is said of a zone's nodes that cannot be computed with.
std::string unusable_nodes(std::string const& where, Index count, std::string const& zone, std::string const& first,
                           Vec3 const& at);

/// One problem per zone that has NaN or infinite coordinates: the first such node, its value, and how many there are.
void check_finite(Mesh const& mesh, Coordinates const& coordinates, std::string const& where, Problems& problems);

/// The same for a mesh that was read, whose nodes have to lie where one mesh can have them, too (find_misplaced()).
void check_places(Mesh const& mesh, std::string const& path, Problems& problems);

}  // namespace gridmorph::io
