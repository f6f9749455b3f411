// Finds coordinates that are not numbers.
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

}  // namespace gridmorph::io
