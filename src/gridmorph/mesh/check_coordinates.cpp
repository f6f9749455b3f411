#include <gridmorph/core/text.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

void check_usable(HostInstance const& host, Mesh const& mesh, char const* who) {
  auto const begin = [&] { return std::string(who) + ": mesh '" + mesh.source + "': "; };
  MeshExtent const extent = extent_of(host, mesh.coordinates);
  if (!extent.usable())
    for (Index n = 0; n < mesh.coordinates.size(); ++n)
      if (!is_usable(mesh.coordinates[n]))
        throw MeshError(begin() + describe_node(mesh, n) + " is at " + to_text(mesh.coordinates[n], 9) +
                        ", which is not finite or larger than 1e100; repair the mesh first");
  auto const misplaced = find_misplaced(mesh, extent);
  if (!misplaced.empty()) throw MeshError(begin() + misplaced.front());
}

std::vector<std::string> find_misplaced(Mesh const& mesh, MeshExtent const& extent) {
  std::vector<std::string> out;
  if (mesh.coordinates.size() == 0 || !extent.usable()) return out;
  MeshCore const core = core_of(mesh.coordinates);
  std::string const half = "half of all nodes lie within " + to_text(core.radius, 3) + " of " + to_text(core.middle, 6);
  Vec3 const low = core.middle - extent.low, high = extent.high - core.middle;
  if (core.is_far(core.middle + Vec3{std::max(low.x, high.x), std::max(low.y, high.y), std::max(low.z, high.z)}))
    for (Zone const& zone : mesh.zones) {
      Index count = 0, first = -1;
      for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n)
        if (core.is_far(mesh.coordinates[n]) && count++ == 0) first = n;
      if (count == 0) continue;
      Vec3 const at = mesh.coordinates[first];
      out.push_back(std::to_string(count) + (count == 1 ? " node" : " nodes") + " of zone '" + zone.name +
                    "' cannot belong to this mesh, the first is " + describe_node(mesh, first) + " at " +
                    to_text(at, 9) + ", " + to_text(distance(at, core.middle) / core.radius, 2) +
                    " times as far away as half of all nodes (" + half + "; at most " + to_text(MeshCore::limit, 1) +
                    " times can be told apart); repair the mesh where it was made");
    }
  double largest = 0;
  for (double const v : {extent.low.x, extent.low.y, extent.low.z, extent.high.x, extent.high.y, extent.high.z})
    largest = std::max(largest, std::abs(v));
  if (out.empty() && core.is_rounded_away(largest))
    out.push_back("coordinates as large as " + to_text(largest, 3) + " are known to " +
                  to_text(std::numeric_limits<double>::epsilon() * largest, 2) + " and no better, and " + half +
                  "; write the mesh nearer to the origin where it was made");
  return out;
}

}  // namespace gridmorph
