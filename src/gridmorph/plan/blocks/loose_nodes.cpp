#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/mesh/coincident_pairs.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/blocks/boundary_facts.hpp>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

/// Nodes of patches, each once, those on planes that slide left out.
std::vector<Index> nodes_of_patches(Mesh const& mesh) {
  std::vector<bool> wanted(std::size_t(mesh.n_nodes()), true);
  auto const for_patches = [&](bool sliding, auto const& visit) {
    for (Patch const& patch : mesh.patches)
      if ((patch.kind == PatchKind::connection) == sliding) for_each_node(mesh.zones[patch.zone], patch.range, visit);
  };
  for_patches(true, [&](Index n) { wanted[n] = false; });
  std::vector<Index> out;
  for_patches(false, [&](Index n) {
    if (!wanted[n]) return;
    out.push_back(n);
    wanted[n] = false;
  });
  return out;
}

using Pairs = std::vector<std::pair<Index, Index>>;

/// Pairs of nodes at one place.
Pairs pairs_at_one_place(Mesh const& mesh, double mesh_size) {
  return coincident_pairs(
      mesh.coordinates, nodes_of_patches(mesh), [&](Index n) { return mesh.zone_of(n); },
      coincidence_tolerance(mesh_size, coordinate_resolution(mesh)));
}

/// visit(node, slot) for all nodes that have one.
template <class Visit>
void for_each_slot(Plan const& plan, Visit const& visit) {
  for (kernels::NodeCopy const& copy : plan.skeleton_nodes)
    for (Index q = 0; q < copy.n_q; ++q)
      for (Index p = 0; p < copy.n_p; ++p)
        visit(copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q,
              copy.source + p * copy.source_stride_p + q * copy.source_stride_q);
}

/// Slots of the nodes that occur in the pairs.
std::unordered_map<Index, Index> slots_of(Pairs const& pairs, Plan const& plan) {
  std::unordered_map<Index, Index> slots;
  for (auto const& [a, b] : pairs) slots[a] = slots[b] = -1;
  for_each_slot(plan, [&](Index node, Index slot) {
    if (auto const at = slots.find(node); at != slots.end()) at->second = slot;
  });
  return slots;
}

/// Drops pairs of which one node is joined to the other's zone: where cells are thinner than what coordinates resolve,
/// the node beside the one that it is joined to is as near.
void drop_joined(Mesh const& mesh, Plan const& plan, std::unordered_map<Index, Index> const& slots, Pairs& pairs) {
  std::unordered_map<Index, std::vector<int>> zones;  // of the nodes in a slot
  for (auto const& [a, b] : pairs)
    for (Index const n : {a, b}) zones[slots.at(n)];
  for_each_slot(plan, [&](Index node, Index slot) {
    if (auto const at = zones.find(slot); at != zones.end()) at->second.push_back(mesh.zone_of(node));
  });
  auto const is_joined = [&](Index n, Index other) {
    std::vector<int> const& joined = zones.at(slots.at(n));
    return std::find(joined.begin(), joined.end(), mesh.zone_of(other)) != joined.end();
  };
  std::erase_if(pairs, [&](auto const& pair) {
    return is_joined(pair.first, pair.second) || is_joined(pair.second, pair.first);
  });
}

}  // namespace

void note_loose_nodes(Mesh const& mesh, BoundaryRequests const& boundary, Plan& plan) {
  if (mesh.zones.size() < 2) return;
  Pairs pairs = pairs_at_one_place(mesh, plan.mesh_size);
  if (pairs.empty()) return;
  auto const slots = slots_of(pairs, plan);
  std::unordered_map<Index, int> rule_of_slot;
  for (auto const& request : boundary.requests)
    rule_of_slot.try_emplace(plan.boundary_slots[request.boundary_node], request.rule);
  auto const rule = [&](Index s) {
    auto const at = rule_of_slot.find(s);
    return at == rule_of_slot.end() ? -1 : at->second;
  };
  std::erase_if(pairs, [&](auto const& pair) {
    Index const p = slots.at(pair.first), q = slots.at(pair.second);
    return p < 0 || q < 0 || p == q || (rule(p) >= 0 && rule(p) == rule(q));
  });
  if (pairs.empty()) return;
  drop_joined(mesh, plan, slots, pairs);
  if (!pairs.empty())
    plan.notes.push_back(
        std::to_string(pairs.size()) +
        " pairs of nodes of two zones coincide where no interface joins them, the first " +
        describe_node(mesh, pairs.front().first) + " and " + describe_node(mesh, pairs.front().second) +
        "; they move each with their own zone and may come apart: where they are to stay one, declare 1-to-1 "
        "interfaces, or give the patches on both sides one explicit rule");
}

}  // namespace gridmorph
