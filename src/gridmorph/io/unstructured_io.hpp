// Unstructured meshes in and out of files: CGNS (HDF5 and ADF) and SU2. The counterpart of mesh_io.hpp, with its errors and
// promises.
#pragma once

#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

enum class MeshKind { structured, unstructured };

/// What is known of a mesh file before it is read.
struct MeshFileFacts {
  MeshFormat format = MeshFormat::cgns;
  MeshKind kind = MeshKind::structured;
  std::vector<std::string>
      linked;  ///< other files that links of a CGNS file lead to, as far as they are there; ascending
};

/// Opens a CGNS file once and reads its tree. Throws as mesh_kind() does.
MeshFileFacts look_at_mesh(std::string const& path, std::vector<std::string> const& leave_out = {});

/// What a file holds, from its first bytes and its zone types. Files that are neither CGNS nor SU2 count as structured, so
/// that read_mesh() says what it makes of them. Throws IoError for a file that mixes structured and unstructured zones.
/// `leave_out`: as in ReadOptions.
MeshKind mesh_kind(std::string const& path, std::vector<std::string> const& leave_out = {});

/// Reads an unstructured mesh. All problems of the mesh are reported in one error; what was skipped or assumed is in
/// UnstructuredMesh::notes. Elements are taken as they are numbered, inside out or not.
/// ReadOptions::leave_out counts for CGNS files; the other options do not.
UnstructuredMesh read_unstructured_mesh(std::string const& path, ReadOptions const& options = {});

/// Writes a mesh as a new CGNS file: zones, elements, coordinates, families, boundary conditions (faces as sections of their
/// own), connections as Abutting1to1 point lists with Periodic_t; in the order of the file that the mesh came from. Polyhedra are
/// refused. The file appears whole or not at all.
void write_mesh(std::string const& path, UnstructuredMesh const& mesh, WriteOptions const& options = {});

/// The same with other coordinates than the mesh's own, and with fields.
void write_mesh(std::string const& path, UnstructuredMesh const& mesh, Coordinates const& morphed,
                OutputFields const& fields, WriteOptions const& options = {});

/// Copies the file that `mesh` was read from and replaces its node coordinates; everything else comes through unchanged.
/// CGNS: in the precision they are stored in. SU2: as text, byte for byte the same where a coordinate did not change; it
/// holds no fields. output may be input. On any failure the output is as it was before.
void write_morphed(std::string const& input, std::string const& output, UnstructuredMesh const& mesh,
                   Coordinates const& morphed, OutputFields const& fields = {});

}  // namespace gridmorph
