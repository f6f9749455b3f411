// Meshes in and out of files. One small interface; it speaks CGNS (HDF5 and ADF), PLOT3D, SU2, OpenFOAM, Gmsh, VTK and
// UGRID.
//
// What is read, what is refused and what is kept: docs/formats.md. The functions throw IoError (the file cannot be
// opened, is damaged, or holds something else), MeshError (ranges, donors or coordinates that cannot be used) or
// MachineError (disk full, no permission to write). They are not safe to call from several threads at once, because
// the CGNS library is not.
#pragma once

#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// How a file is stored on disk.
enum class FileFormat { cgns_hdf5, cgns_adf };

std::string_view to_string(FileFormat format);

enum class MeshKind { structured, unstructured };

/// What is known of a mesh file before it is read.
struct MeshFileFacts {
  MeshFormat format = MeshFormat::cgns;
  MeshKind kind = MeshKind::structured;
  /// What the mesh consists of beside the file that is named, as far as it is there: files that links of a CGNS file
  /// lead to or a multi-block file of VTK names, a .mapbc file, files and folders of an OpenFOAM case.
  std::vector<std::string> linked;
};

/// Opens a CGNS file once and reads its tree. Throws IoError as read_mesh() does. `leave_out`: as in ReadOptions.
MeshFileFacts look_at_mesh(std::string const& path, std::vector<std::string> const& leave_out = {});

/// All files, and folders, that write_morphed() of the mesh of `input` would write; of SeriesWriter where there are
/// times.
std::vector<std::string> files_to_write(std::string const& input, std::string const& output,
                                        std::vector<double> const& times = {});

/// What a file holds, from its first bytes and its zone types. Files that are neither CGNS nor SU2 count as structured,
/// so that read_mesh() says what it makes of them. Files of both kinds of zones (hybrid ones) count as unstructured.
MeshKind mesh_kind(std::string const& path, std::vector<std::string> const& leave_out = {});

struct ReadOptions {
  /// false: topology only, Mesh::coordinates stays empty (2-D zones are still made two planes thick in their index
  /// ranges). For listings of large files; of meshes of blocks only.
  bool coordinates = true;
  /// What a PLOT3D file is, for files that could be several things: "unformatted", "big-endian", "single", ...
  /// (docs/formats.md).
  std::string plot3d_format = {};
  /// Bases and zones of a CGNS file that are no part of the mesh, by name ("Base", "Zone", "Base/Zone"; globs).
  /// Connections that lead to them become patches of kind `connection`. write_morphed() and SeriesWriter leave them as
  /// they are.
  std::vector<std::string> leave_out = {};
};

/// Reads a mesh of blocks or of elements. All problems of the mesh are reported in one error; what was skipped or
/// assumed is in Mesh::notes. PLOT3D files have neither patches nor interfaces: read_side_file (casefile) or
/// find_interfaces (boundary) add them. Elements are taken as they are numbered, inside out or not. Blocks beside zones
/// of elements keep their extent; their cells are elements, their 1-to-1 interfaces connections. Cost: one pass over
/// the file's coordinates, read straight into the flat arrays where they are stored in double precision, and one over
/// its elements.
Mesh read_mesh(std::string const& path, ReadOptions const& options = {});

struct WriteOptions {
  FileFormat format = FileFormat::cgns_hdf5;
  /// Meshes of Mesh::dimension 2 are written as index dimension 2; 2 drops CoordinateZ, 3 keeps it.
  int physical_dimension = 3;
  /// Unstructured meshes: a boundary condition lists its nodes, as older programs write it; its faces are a section of
  /// elements of the same name, where a reader that wants them finds them.
  bool boundary_nodes = false;
};

/// Writes a mesh as a new CGNS file: zones, coordinates (single precision where the zone says so), families, boundary
/// conditions, connections with Periodic_t; no units. The file appears whole or not at all.
///
/// Blocks: 1-to-1 interfaces with Transform. A family whose patches share one BC type gets that type, and its patches
/// become FamilySpecified. Patches of kind `connection` have no donor in a Mesh and become UserDefined boundary
/// conditions of the same name. Elements: faces of boundary conditions as sections of their own, connections as
/// Abutting1to1 point lists; in the order of the file that the mesh came from. A zone with polyhedra is written by its
/// faces (NGON_n, NFACE_n), with boundary conditions that list theirs; elements of second order are refused there.
/// Blocks beside elements are written as elements too.
void write_mesh(std::string const& path, Mesh const& mesh, WriteOptions const& options = {});

/// Writes a mesh as write_mesh does, but zone by zone: for meshes that never are in memory as a whole. Zones of
/// elements may share nodes and elements, which are then the same in each of them. The file appears with commit(), or
/// not at all. While a writer is alive, no other file may fail to be written (see MachineError above).
class MeshFileWriter {
 public:
  /// mesh: everything but the coordinates, which are not looked at; must outlive the writer. Writes all that is no
  /// coordinate when its zone comes.
  MeshFileWriter(std::string const& path, Mesh const& mesh, WriteOptions const& options = {});
  ~MeshFileWriter();
  MeshFileWriter(MeshFileWriter const&) = delete;
  MeshFileWriter& operator=(MeshFileWriter const&) = delete;

  /// Zones in any order, each once. x, y, z: Zone::size() values each.
  void write_zone(int zone, double const* x, double const* y, double const* z);
  /// Throws MeshError when a zone is missing.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What the values of a field are, from which their DataClass_t and units follow.
enum class FieldUnit { number, degree };

/// One value per node, numbered as Mesh::coordinates.
struct NodeField {
  std::string name;
  std::vector<double> values;  ///< (n_nodes)
  FieldUnit unit = FieldUnit::number;
};

/// One value per cell: blocks one after another, i fastest, or elements.
struct CellField {
  std::string name;
  std::vector<double> values;  ///< (n_cells)
  FieldUnit unit = FieldUnit::number;
};

/// What write_morphed adds to the file, zone by zone: to the solution that the zone has at the nodes, or in the cells,
/// since viewers show one of each; to one of our own where it has none. Names that are taken get "Morph" before them.
struct OutputFields {
  bool displacement =
      false;  ///< DisplacementX, Y, Z at the nodes: morphed minus Mesh::coordinates, of the same data class
  std::vector<NodeField> nodes;  ///< with the displacement; "MorphNodes" where there is no solution at the nodes
  std::vector<CellField> cells;  ///< "MorphCells" where there is no solution in the cells

  [[nodiscard]] bool empty() const { return !displacement && nodes.empty() && cells.empty(); }
};

/// A mesh as write_mesh() writes it, with other coordinates than its own, and with fields.
void write_mesh(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields,
                WriteOptions const& options = {});

/// A mesh of either kind, with other coordinates than its own and with fields, as a file of VTK (.vtu) for viewers: the
/// cells in the order of their file, blocks as hexahedra, then the faces of patches, told apart by the cell array
/// CellEntityIds (0 for cells, 1 for those of the first patch, ...; names in the array PatchNames). Displacement is one
/// vector field; cell fields of faces are NaN. The file appears whole or not at all.
void write_vtk(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields = {});

/// Copies the file that `mesh` was read from and replaces its node coordinates, in the precision they are stored in;
/// everything else comes through unchanged. Of blocks of a 2-D mesh plane 0 is written. output may be input. The copy
/// is made beside the output and renamed when complete: on any failure the output is as it was before. PLOT3D, SU2,
/// OpenFOAM, Gmsh and UGRID files have no place for fields; text stays text, byte for byte the same where a coordinate
/// did not change.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields = {});

}  // namespace gridmorph
