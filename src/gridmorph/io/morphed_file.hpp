// What the writers of morphed meshes share: a file that a mesh was read from, and node values as that file has them.
// Internal to io.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/extrude.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <vector>

namespace gridmorph::cgns {

/// Throws IoError unless the file holds the mesh it is said to hold; also for coordinates that live in another file.
void check_same_mesh(File const& file, Layout const& layout, Mesh const& mesh);

/// Adds what keeps coordinates from being replaced in a copy of the file: arrays that are links, that two nodes share,
/// or that are not stored in the type that their node says.
void check_own_coordinates(File const& file, Layout const& layout, Problems& problems);

/// Reads one component of a zone back and compares it with what was written, bit by bit in the precision it is kept in.
/// Throws MachineError where they differ. Cost: reading, 8 bytes per node of memory.
void check_written(File const& file, ZoneLayout const& zone, int component, double const* expected);

/// find_zones or find_unstructured_zones for the zones of the mesh, with its problems thrown as IoError; what the mesh
/// left out is passed over.
Layout zones_of(File const& file, Node const& tree, Mesh const& mesh);

/// Calls put(values) with those of a zone's node values that the file has: all of them, or plane 0 of a 2-D zone.
template <class Put>
void with_file_nodes(ZoneLayout const& layout, Zone const& zone, double const* source, std::vector<double>& plane,
                     Put put) {
  if (layout.flat_axis < 0) return put(source);
  plane.clear();
  auto const p = plane_steps(zone, layout.flat_axis);
  for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
    for (int a = 0; a < zone.extent[p.axis[0]]; ++a) plane.push_back(source[a * p.step[0] + b * p.step[1]]);
  put(plane.data());
}

}  // namespace gridmorph::cgns
