// Fields of a morph beside the mesh in a CGNS file.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <vector>

namespace gridmorph {

/// Adds the fields to the zones of a file that holds the mesh, in the order of the file (SolutionWriter says where).
/// `present`: of every zone, or empty where there are no fields. Displacements are `morphed` minus the mesh's
/// coordinates.
void write_fields(cgns::File& file, cgns::Layout const& layout, std::vector<io::ZoneSolutions> const& present,
                  Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph
