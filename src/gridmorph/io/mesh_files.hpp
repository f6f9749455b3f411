// The two halves of mesh_io.hpp: files of blocks and files of elements. Internal to io.
#pragma once

#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <string>
#include <vector>

namespace gridmorph::io {

/// Of a CGNS file and its tree.
Mesh read_blocks(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options);
Mesh read_elements(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options);

void write_blocks(std::string const& path, Mesh const& mesh, WriteOptions const& options);
/// With other coordinates than those of the mesh, and with fields.
void write_blocks(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields,
                  WriteOptions const& options);

/// CGNS and PLOT3D; all formats of elements.
void write_morphed_blocks(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields);
void write_morphed_elements(std::string const& input, std::string const& output, Mesh const& mesh,
                            Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph::io
