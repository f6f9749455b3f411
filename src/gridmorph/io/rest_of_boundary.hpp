// What a file does not name of the boundary of its mesh. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph::io {

/// Boundary faces that no patch lists and no connection pairs become the patch `boundary` of their zone; how many there
/// are. The mesh must have passed check_mesh(). Linear in elements.
Index add_rest_of_boundary(Mesh& mesh);

}  // namespace gridmorph::io
