#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/mesh/coincident_pairs.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <cstdint>

namespace gridmorph {

namespace {

bool are_one(std::vector<Index32> const& owner, TouchingPatches const& pair) {
  for (std::size_t n = 0; n < pair.nodes.size(); ++n)
    if (owner[pair.nodes[n]] != owner[pair.other_nodes[n]]) return false;
  return true;
}

}  // namespace

std::vector<TouchingPatches> undeclared_connections(Mesh const& mesh, double tolerance) {
  std::vector<TouchingPatches> out;
  if (mesh.zones.size() < 2) return out;
  auto const owner = coincident_nodes(mesh), place = nodes_at_one_place(mesh);
  std::vector<std::vector<Index32>> nodes;
  for (auto const& patch : mesh.patches) nodes.push_back(patch_nodes(patch));
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a + 1; b < nodes.size(); ++b) {
      if (mesh.patches[a].zone == mesh.patches[b].zone || nodes[a].size() != nodes[b].size() || nodes[a].empty())
        continue;
      // One node that finds no partner is enough to leave most pairs.
      std::span<Index32 const> const first(nodes[a].data(), 1);
      if (match_points(mesh.coordinates, first, nodes[b], tolerance).front() < 0) continue;
      TouchingPatches pair{int(a), int(b), nodes[a], match_points(mesh.coordinates, nodes[a], nodes[b], tolerance)};
      bool const all = std::find(pair.other_nodes.begin(), pair.other_nodes.end(), -1) == pair.other_nodes.end();
      if (!all || are_one(owner, pair)) continue;
      pair.one = are_one(place, pair);
      out.push_back(std::move(pair));
    }
  return out;
}

namespace {

/// Nodes of patches, those of connections that do not match left out.
std::vector<Index> open_nodes(Mesh const& mesh) {
  std::vector<std::uint8_t> open(mesh.n_nodes(), 0);
  for (bool const slides : {false, true})
    for (auto const& patch : mesh.patches)
      if ((patch.kind == PatchKind::connection) == slides)
        for (auto const* list : {&patch.faces.item, &patch.nodes})
          for (Index32 const n : *list) open[n] = slides ? 0 : 1;
  std::vector<Index> out;
  for (std::size_t n = 0; n < open.size(); ++n)
    if (open[n] != 0) out.push_back(Index(n));
  return out;
}

}  // namespace

std::vector<Index32> nodes_at_one_place(HostInstance const& host, Mesh const& mesh, std::span<int const> groups) {
  DisjointSets<Index32> sets(coincident_nodes(mesh));
  if (mesh.zones.size() < 2) return sets.roots();
  auto const pairs = coincident_pairs(
      mesh.coordinates, open_nodes(mesh), [&](Index n) { return mesh.zone_of(n); },
      coincidence_tolerance(extent_of(host, mesh.coordinates).size(), coordinate_resolution(mesh)));
  for (auto const& [a, b] : pairs)
    if (groups.empty() || groups[a] == groups[b]) sets.join(Index32(a), Index32(b));
  return sets.roots();
}

std::string describe(Mesh const& mesh, TouchingPatches const& pair) {
  return "patches " + describe_patch(mesh, mesh.patches[pair.patch]) + " and " +
         describe_patch(mesh, mesh.patches[pair.other]) + " coincide in all of their " +
         std::to_string(pair.nodes.size()) + " nodes, but no connection joins them; " +
         (pair.one ? "their nodes move as one, and a rule for one of them holds for both, unless one of them slides "
                     "with a blade row"
                   : "give both the same motion");
}

}  // namespace gridmorph
