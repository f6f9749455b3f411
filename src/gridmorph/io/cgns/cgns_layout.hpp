// Which zones a CGNS file has, how they are numbered in the mesh, and where their coordinates are. Shared by the reader
// and by the writer that puts coordinates back, so that both always mean the same nodes.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>

#include <array>
#include <string>
#include <vector>

namespace gridmorph::cgns {

/// One zone of the file. Index triples are 1-based in the file; a 2-D zone is flat along one axis: one node plane in
/// the file, two in the mesh.
struct ZoneLayout {
  Node const* base = nullptr;
  Node const* node = nullptr;
  std::string name;         ///< as in Mesh::zones: "Zone", or "Base/Zone" where several bases have zones
  int index_dimension = 3;  ///< 2 or 3, the length of index tuples in the file; 1 of unstructured zones
  Index3 extent{1, 1, 1};   ///< nodes in the file
  int flat_axis = -1;       ///< 0..2, or -1 for a 3-D zone

  Node const* grid = nullptr;          ///< the GridCoordinates_t that is used
  std::array<Node const*, 3> array{};  ///< CoordinateX, Y, Z; absent ones only where flat
  std::array<bool, 3> single_precision{};
  Index3 rind_low{0, 0, 0}, rind_high{0, 0, 0};  ///< rind planes stored before and after the nodes

  [[nodiscard]] bool is_block() const { return index_dimension > 1; }
  /// Whether any component is stored in it.
  [[nodiscard]] bool is_single_precision() const {
    return single_precision[0] || single_precision[1] || single_precision[2];
  }
  [[nodiscard]] Index3 mesh_extent() const {
    Index3 out = extent;
    if (flat_axis >= 0) out[flat_axis] = 2;
    return out;
  }
  [[nodiscard]] Index nodes_in_file() const { return Index(extent[0]) * extent[1] * extent[2]; }
  /// Values stored per coordinate array, rind planes included.
  [[nodiscard]] Index stored_size() const;
  /// Number in the stored array of the first node of the line (j, k); nodes of the line follow at step 1.
  [[nodiscard]] Index stored_line(int j, int k) const;
};

struct Layout {
  std::vector<ZoneLayout> zones;
  std::vector<std::string> notes;
  std::vector<std::string> leave_out;  ///< as it was asked for
};

/// Finds zones and coordinate arrays in the tree of a file. Adds to problems what makes the file unusable as a
/// structured mesh: unstructured zones, missing or misfitting coordinate arrays, cylindrical coordinates, ...
/// `leave_out`: bases and zones to pass over, as is_left_out() takes them; a name that means nothing in the file is a
/// problem.
Layout find_zones(File const& file, Node const& tree, Problems& problems,
                  std::vector<std::string> const& leave_out = {});

/// Finds zones and coordinate arrays of meshes with unstructured zones: those are lines of nodes, extent {nodes, 1, 1};
/// flat_axis is 2 where the file has no CoordinateZ. Structured zones among them are as find_zones() has them, but
/// stand in the mesh as in the file, planes too.
Layout find_unstructured_zones(File const& file, Node const& tree, Problems& problems,
                               std::vector<std::string> const& leave_out = {});

/// Whether one of the names (globs) is that of the base, of the zone, or "Base/Zone".
bool is_left_out(std::vector<std::string> const& leave_out, std::string const& base, std::string const& zone);

/// What to leave out to find the zones with these names alone; nothing where the file lacks one of them.
std::vector<std::string> all_but(Node const& tree, std::vector<std::string> const& zones);

/// ZoneType_t of a zone; "Structured" where it has none.
std::string zone_type(File const& file, Node const& zone);

/// Coordinates of one component of one zone as doubles, without rind; dest has nodes_in_file() entries.
void read_component(File const& file, ZoneLayout const& zone, int component, double* dest);
/// Writes what read_component() reads; keeps the array's precision, and what is stored in rind planes.
void write_component(File& file, ZoneLayout const& zone, int component, double const* source);

}  // namespace gridmorph::cgns
