#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/mesh/coincident_pairs.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/blocks/boundary_facts.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

std::vector<Index> patch_nodes(Mesh const& mesh, bool sliding) {
  std::vector<Index> out;
  for (Patch const& patch : mesh.patches)
    if ((patch.kind == PatchKind::connection) == sliding)
      for_each_node(mesh.zones[patch.zone], patch.range, [&](Index n) { out.push_back(n); });
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Pairs of nodes at one place, those on planes that slide left out.
std::vector<std::pair<Index, Index>> pairs_at_one_place(Mesh const& mesh, double mesh_size) {
  std::vector<Index> const all = patch_nodes(mesh, false), sliding = patch_nodes(mesh, true);
  std::vector<Index> nodes;
  std::set_difference(all.begin(), all.end(), sliding.begin(), sliding.end(), std::back_inserter(nodes));
  return coincident_pairs(
      mesh.coordinates, nodes, [&](Index n) { return mesh.zone_of(n); },
      coincidence_tolerance(mesh_size, coordinate_resolution(mesh)));
}

/// Slots of the nodes that occur in the pairs.
std::unordered_map<Index, Index> slots_of(std::vector<std::pair<Index, Index>> const& pairs, Plan const& plan) {
  std::unordered_map<Index, Index> slot;
  for (auto const& [a, b] : pairs) slot[a] = slot[b] = -1;
  for (kernels::NodeCopy const& copy : plan.skeleton_nodes)
    for (Index q = 0; q < copy.n_q; ++q)
      for (Index p = 0; p < copy.n_p; ++p)
        if (auto const at = slot.find(copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q);
            at != slot.end())
          at->second = copy.source + p * copy.source_stride_p + q * copy.source_stride_q;
  return slot;
}

/// The zones of the nodes that are in those slots.
std::unordered_map<Index, std::vector<int>> zones_of(std::unordered_map<Index, Index> const& slots, Mesh const& mesh,
                                                     Plan const& plan) {
  std::unordered_map<Index, std::vector<int>> zones;
  for (auto const& [node, slot] : slots)
    if (slot >= 0) zones[slot];
  for (kernels::NodeCopy const& copy : plan.skeleton_nodes)
    for (Index q = 0; q < copy.n_q; ++q)
      for (Index p = 0; p < copy.n_p; ++p)
        if (auto const at = zones.find(copy.source + p * copy.source_stride_p + q * copy.source_stride_q);
            at != zones.end())
          at->second.push_back(
              mesh.zone_of(copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q));
  return zones;
}

}  // namespace

void note_loose_nodes(Mesh const& mesh, BoundaryRequests const& boundary, Plan& plan) {
  if (mesh.zones.size() < 2) return;
  auto const pairs = pairs_at_one_place(mesh, plan.mesh_size);
  if (pairs.empty()) return;
  auto const slot = slots_of(pairs, plan);
  auto const zones = zones_of(slot, mesh, plan);
  // Where cells are thinner than what coordinates resolve, the node beside the one that it is joined to is as near.
  auto const is_joined = [&](Index s, Index other) {
    std::vector<int> const& joined = zones.at(s);
    return std::find(joined.begin(), joined.end(), mesh.zone_of(other)) != joined.end();
  };
  std::unordered_map<Index, int> rule_of_slot;
  for (auto const& request : boundary.requests)
    rule_of_slot.try_emplace(plan.boundary_slots[std::size_t(request.boundary_node)], request.rule);
  auto const rule = [&](Index s) {
    auto const at = rule_of_slot.find(s);
    return at == rule_of_slot.end() ? -1 : at->second;
  };
  Index count = 0;
  std::pair<Index, Index> first{-1, -1};
  for (auto const& [a, b] : pairs) {
    Index const p = slot.at(a), q = slot.at(b);
    if (p < 0 || q < 0 || p == q || (rule(p) >= 0 && rule(p) == rule(q))) continue;
    if (is_joined(p, b) || is_joined(q, a)) continue;
    if (count++ == 0) first = {a, b};
  }
  if (count > 0)
    plan.notes.push_back(
        std::to_string(count) + " pairs of nodes of two zones coincide where no interface joins them, the first " +
        describe_node(mesh, first.first) + " and " + describe_node(mesh, first.second) +
        "; they move each with their own zone and may come apart: where they are to stay one, declare 1-to-1 "
        "interfaces, or give the patches on both sides one explicit rule");
}

}  // namespace gridmorph
