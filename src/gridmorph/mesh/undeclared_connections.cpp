#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

bool coincide(std::vector<Number> const& owner, TouchingPatches const& pair) {
  for (std::size_t n = 0; n < pair.nodes.size(); ++n)
    if (owner[std::size_t(pair.nodes[n])] != owner[std::size_t(pair.other_nodes[n])]) return false;
  return true;
}

}  // namespace

std::vector<TouchingPatches> undeclared_connections(UnstructuredMesh const& mesh, double tolerance) {
  std::vector<TouchingPatches> out;
  if (mesh.zones.size() < 2) return out;
  auto const owner = coincident_nodes(mesh);
  std::vector<std::vector<Number>> nodes;
  for (auto const& patch : mesh.patches) nodes.push_back(patch_nodes(patch));
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a + 1; b < nodes.size(); ++b) {
      if (mesh.patches[a].zone == mesh.patches[b].zone || nodes[a].size() != nodes[b].size() || nodes[a].empty())
        continue;
      // One node that finds no partner is enough to leave most pairs.
      std::span<Number const> const first(nodes[a].data(), 1);
      if (match_points(mesh.coordinates, first, nodes[b], tolerance).front() < 0) continue;
      TouchingPatches pair{int(a), int(b), nodes[a], match_points(mesh.coordinates, nodes[a], nodes[b], tolerance)};
      bool const all = std::find(pair.other_nodes.begin(), pair.other_nodes.end(), -1) == pair.other_nodes.end();
      if (all && !coincide(owner, pair)) out.push_back(std::move(pair));
    }
  return out;
}

std::string describe(UnstructuredMesh const& mesh, TouchingPatches const& pair) {
  return "patches " + describe_patch(mesh, mesh.patches[std::size_t(pair.patch)]) + " and " +
         describe_patch(mesh, mesh.patches[std::size_t(pair.other)]) + " coincide in all of their " +
         std::to_string(pair.nodes.size()) + " nodes, but no connection joins them; give both the same motion";
}

}  // namespace gridmorph
