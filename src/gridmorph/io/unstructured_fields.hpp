// Fields of a morph beside the mesh in a CGNS file.
#pragma once

#include <gridmorph/io/cgns_layout.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

namespace gridmorph {

/// Adds the fields to the zones of a file that holds the mesh, each as one FlowSolution_t per zone, in the order of the
/// file. Displacements are `morphed` minus the mesh's coordinates.
void write_fields(cgns::File& file, cgns::Layout const& layout, UnstructuredMesh const& mesh,
                  Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph
