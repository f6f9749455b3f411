#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/plan/blocks/boundary.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace gridmorph {
namespace {

/// A face of a patch or interface, or a piece in a region.
struct ExplicitEntity {
  int entity_class = -1;
  int rule = -1;
  int patch = -1, interface = -1;
};

std::vector<ExplicitEntity> explicit_entities(Mesh const& mesh, Topology const& topology,
                                              BoundaryMotion const& surface) {
  ResolvedMotion const& motion = surface.motion();
  std::vector<ExplicitEntity> out;
  Blocks const& blocks = topology.blocks;
  for (int c = 0; c < topology.lattice.n_classes(); ++c) {
    int const patch = blocks.patch_of_face()[c], interface = blocks.interface_of_face()[c];
    if (patch >= 0 && is_box(mesh.patches[patch])) continue;
    int const rule = patch >= 0 ? motion.patch[patch].rule : (interface >= 0 ? motion.interface[interface].rule : -1);
    if (rule >= 0 && surface.is_explicit(rule)) out.push_back({c, rule, patch, patch >= 0 ? -1 : interface});
  }
  Lattice const& lattice = topology.lattice;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    if (!is_box(mesh.patches[p])) continue;
    for (int piece = 0; piece < int(lattice.pieces().size()); ++piece)
      if (is_within(lattice.pieces()[piece], mesh.patches[p]))
        out.push_back({lattice.class_of(lattice.entity_of_piece(piece, {1, 1, 1})), motion.patch[p].rule, p, -1});
  }
  return out;
}

}  // namespace

Index add_boundary_nodes(PlanContext const& context, int entity_class, Plan& plan) {
  Lattice const& lattice = context.topology.lattice;
  Index const first = Index(plan.boundary_nodes.size());
  int const owner = lattice.copies(entity_class).front().entity;
  auto const rows = context.skeleton.rows(owner);
  if (!rows) return first;
  IndexRange const r = lattice.nodes(owner);
  Zone const& zone = context.mesh.zones[lattice.zone_of(owner)];
  Index slot = rows->slot;
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        plan.boundary_nodes.push_back(zone.node({i, j, k}));
        plan.boundary_slots.push_back(slot++);
      }
  if (auto const axis = lattice.axis_of(entity_class))
    plan.boundary_projections.push_back({rows->slot, 1, rows->slot_q, rows->slot, 1, rows->slot_q, rows->n_p, rows->n_q,
                                         context.rotations.number(onto(*axis))});
  return first;
}

BoundaryRequests collect_boundary(PlanContext const& context, BoundaryMotion const& surface,
                                  std::vector<std::string> const& kind_order, Known& known, Plan& plan) {
  ResolvedMotion const& motion = surface.motion();
  Mesh const& mesh = context.mesh;
  Topology const& topology = context.topology;
  Lattice const& lattice = topology.lattice;
  std::vector<ExplicitEntity> given = explicit_entities(mesh, topology, surface);
  for (ExplicitEntity const& own : given) {
    EndKind const kind = own.patch >= 0 ? context.ends[own.patch] : periodic_end;
    int const patch = own.patch >= 0 ? own.patch : int(mesh.patches.size()) + own.interface;
    for_closure(lattice, lattice.copies(own.entity_class).front().entity, [&](int entity) {
      int const c = lattice.class_of(entity);
      bool const better = !known(c) || kind_rank(kind, kind_order) < kind_rank(known.kind[c], kind_order);
      known.known[c] = 1;
      if (!better) return;
      known.kind[c] = kind;
      known.patches[c] = {patch};
    });
  }

  BoundaryRequests boundary;
  boundary.name(NamedBoundary(mesh));
  // Long lists that grow are copied again and again.
  Index n_known = 0, n_requests = 0;
  for (int c = 0; c < lattice.n_classes(); ++c)
    if (known(c)) n_known += lattice.nodes(lattice.copies(c).front().entity).size();
  for (ExplicitEntity const& asks : given)
    for_closure(lattice, lattice.copies(asks.entity_class).front().entity,
                [&](int part) { n_requests += lattice.nodes(part).size(); });
  plan.boundary_nodes.reserve(n_known);
  plan.boundary_slots.reserve(n_known);
  boundary.requests.reserve(n_requests);
  std::vector<Index> first_node(lattice.n_classes(), -1);
  for (int c = 0; c < lattice.n_classes(); ++c) {
    if (!known(c)) continue;
    first_node[c] = add_boundary_nodes(context, c, plan);
  }

  // The rule that outranks the others gives the value of a shared node, the earlier rule where ranks are equal.
  std::stable_sort(given.begin(), given.end(), [&](ExplicitEntity const& a, ExplicitEntity const& b) {
    return std::pair(motion.rules[a.rule].rank, a.rule) < std::pair(motion.rules[b.rule].rank, b.rule);
  });
  for (ExplicitEntity const& asks : given) {
    int const entity = lattice.copies(asks.entity_class).front().entity;
    Zone const& zone = mesh.zones[lattice.zone_of(entity)];
    for_closure(lattice, entity, [&](int part) {
      int const c = lattice.class_of(part);
      EntityCopy const& copy = lattice.copy_of(part);
      IndexRange const own = lattice.nodes(lattice.copies(c).front().entity);
      std::int32_t const rotation = copy.moved ? context.rotations.number(copy.transform.rotation) : -1;
      Index boundary_node = first_node[c];
      for (int k = own.begin[2]; k < own.end[2]; ++k)
        for (int j = own.begin[1]; j < own.end[1]; ++j)
          for (int i = own.begin[0]; i < own.end[0]; ++i)
            boundary.requests.push_back({boundary_node++, zone.node(copy.from_owner(Index3{i, j, k})), rotation,
                                         asks.rule, asks.patch, asks.interface});
    });
  }
  return boundary;
}

}  // namespace gridmorph
