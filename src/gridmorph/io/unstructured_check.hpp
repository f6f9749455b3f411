// Finds coordinates that are not numbers in unstructured meshes.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <string>

namespace gridmorph::io {

/// One problem per zone that has NaN or infinite coordinates: the first such node, its value, and how many there are.
void check_finite(UnstructuredMesh const& mesh, Coordinates const& coordinates, std::string const& where,
                  Problems& problems);

}  // namespace gridmorph::io
