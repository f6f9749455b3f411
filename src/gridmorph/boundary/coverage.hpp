// Every cell of every zone face must belong to exactly one patch or interface. This checks it, and completes it where
// the user or the geometry allows.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/topology_options.hpp>
#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Marks patches other than walls, inlets and outlets that are collapsed to a line as poles (kind degenerate), and adds
/// patches where nothing is declared: faces collapsed to a line or point (name "pole", kind degenerate), and, when
/// options.open_faces is not empty, all other open faces as patches of that name. Notes go to mesh.notes.
/// Cost: O(boundary nodes).
void complete_patches(Mesh& mesh, Links const& links, TopologyOptions const& options);

/// Throws MeshError naming every patch outside its zone or not on a face, every pair of overlapping patches, every
/// patch that overlaps an interface, and every face range covered by nothing.
void check_coverage(Mesh const& mesh, Links const& links);

/// connect(), complete_patches() and check_coverage() in one: reports unmatched interfaces and uncovered faces
/// together.
Links connect_and_check(HostInstance const& host, Mesh& mesh, TopologyOptions const& options);
inline Links connect_and_check(Mesh& mesh, TopologyOptions const& options) {
  return connect_and_check(HostInstance(), mesh, options);
}

}  // namespace gridmorph
