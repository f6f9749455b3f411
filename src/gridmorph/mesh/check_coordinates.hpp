// What every entry point asks of the mesh it is given, before it reads a coordinate.
#pragma once

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Throws MeshError unless the mesh has zones and all three coordinates of each of their nodes, and
/// ConfigError where Kokkos is not running. `who` is the function that asks, for the message. Cost: none.
inline void check_coordinates(Mesh const& mesh, char const* who) {
  require_kokkos(who);
  auto const complain = [&](std::string const& what) {
    throw MeshError(std::string(who) + ": mesh '" + mesh.source + "' " + what);
  };
  if (mesh.zones.empty()) complain("has no zones; add them with add_zone()");
  Index const n = mesh.n_nodes();
  Coordinates const& c = mesh.coordinates;
  if (Index(c.x.extent(0)) == n && Index(c.y.extent(0)) == n && Index(c.z.extent(0)) == n) return;
  complain("has " + std::to_string(n) + " nodes in its zones, and coordinates for " + std::to_string(c.x.extent(0)) +
           " (x), " + std::to_string(c.y.extent(0)) + " (y), " + std::to_string(c.z.extent(0)) +
           " (z) of them; set coordinates = Coordinates(mesh.n_nodes()) once all zones are there, and fill them");
}

/// Throws MeshError where a coordinate cannot be computed with, or lies so far from all others that nothing can be told
/// apart beside it: searches by place would go on for ever. Cost: one pass.
void check_usable(HostInstance const& host, Mesh const& mesh, char const* who);
inline void check_usable(Mesh const& mesh, char const* who) { check_usable(HostInstance(), mesh, who); }

/// What is wrong with coordinates that are usable each by itself, but cannot belong to one mesh: nodes too far away,
/// one text for each of their zones, or coordinates so large that rounding leaves nothing of the mesh. `extent`: of all
/// coordinates. Cost: none where nothing is wrong.
std::vector<std::string> find_misplaced(Mesh const& mesh, MeshExtent const& extent);

}  // namespace gridmorph
