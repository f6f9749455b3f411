// The two halves of mesh_io.hpp: files of blocks and files of elements. Internal to io.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <string>
#include <vector>

namespace gridmorph::io {

/// The meshes of CGNS files, of blocks and of elements, from a file and its tree.
Mesh read_blocks(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options);
Mesh read_elements(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options);
/// The coordinates of all zones of a file of elements, n_nodes together.
Coordinates read_coordinates(cgns::File const& file, cgns::Layout const& layout, Index n_nodes);
/// All nodes of the file that a mesh of elements was read from, those too that it left there.
NodesOfFile nodes_of_file(std::string const& path, Mesh const& mesh);

void write_blocks(std::string const& path, Mesh const& mesh, WriteOptions const& options);
/// Writes a mesh of blocks with other coordinates than its own, and with fields.
void write_blocks(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields,
                  WriteOptions const& options);

/// Writes what was read from `input` with morphed coordinates: blocks in CGNS and PLOT3D, elements in all their
/// formats.
void write_morphed_blocks(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields);
void write_morphed_elements(std::string const& input, std::string const& output, Mesh const& mesh,
                            Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph::io
