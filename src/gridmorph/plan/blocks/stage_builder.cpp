#include <gridmorph/plan/blocks/chain_tables.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>
#include <gridmorph/plan/blocks/turned_lines.hpp>
#include <gridmorph/plan/blocks/wall_roots.hpp>

#include <gridmorph/kernels/turned_line.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {

int kind_rank(EndKind kind, std::vector<std::string> const& order) {
  if (kind >= named_ends) return kind / named_ends - named_ends;  // before all others
  auto const it = std::find(order.begin(), order.end(), end_kind_name(kind));
  return int(it - order.begin());
}

namespace {

std::string list_of(std::vector<std::string> const& names) {
  std::string text;
  for (std::string const& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Appends the tubes and segments of a laid-out chain.
void append_lines(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                  LineTables& lines) {
  for (int pb = 0; pb < layout.n[2]; ++pb)
    for (int pa = 0; pa < layout.n[1]; ++pa) {
      kernels::Tube tube{};
      tube.chain = number;
      tube.a_begin = layout.a_begin[pa];
      tube.b_begin = layout.b_begin[pb];
      tube.first_segment = std::int32_t(lines.segments.size());
      tube.n_segments = layout.n[0];
      for (int ps = 0; ps < layout.n[0]; ++ps)
        lines.segments.push_back(make_segment(context.mesh, placed_box(context, chain, layout, ps, pa, pb)));
      PieceNodes const nodes = piece_nodes(context.mesh, context.topology.lattice, layout.at(0, pa, pb));
      tube.n_a = nodes.count[1];
      tube.n_b = nodes.count[2];
      lines.tubes.push_back(tube);
    }
}

/// Makes the chain write every entity that `writes(entity)` grants it; `first_segment` is that of its first tube.
template <class Writes>
void append_writers(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                    std::size_t first_segment, LineTables& lines, std::vector<kernels::SkeletonSweep>& sweeps,
                    std::vector<VolumePart>& volume, Writes&& writes) {
  std::size_t at = first_segment;
  for (int pb = 0; pb < layout.n[2]; ++pb)
    for (int pa = 0; pa < layout.n[1]; ++pa)
      for (int ps = 0; ps < layout.n[0]; ++ps, ++at) {
        PlacedBox const box = placed_box(context, chain, layout, ps, pa, pb);
        ChainPiece const& piece = layout.at(ps, pa, pb);
        for (int category = 0; category < 27; ++category) {
          int const entity =
              chain_entity(context.topology.lattice, piece, {category % 3, (category / 3) % 3, category / 9});
          if (writes(entity))
            add_writer(context, lines, sweeps, volume, number, box, piece.piece, entity, category, lines.segments[at]);
        }
      }
}

/// Calls visit(box, piece, entity, ca, cb) for the entities of the chain's face at its lower (end 0) or upper end, each
/// once.
template <class Visit>
void for_end_entities(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int end,
                      Visit&& visit) {
  int const ps = end == 0 ? 0 : layout.n[0] - 1;
  for (int pb = 0; pb < layout.n[2]; ++pb)
    for (int pa = 0; pa < layout.n[1]; ++pa) {
      PlacedBox const box = placed_box(context, chain, layout, ps, pa, pb);
      for (int cb = pb == 0 ? 0 : 1; cb < 3; ++cb)
        for (int ca = pa == 0 ? 0 : 1; ca < 3; ++ca)
          visit(box, chain_entity(context.topology.lattice, layout.at(ps, pa, pb), {2 * end, ca, cb}));
    }
}

kernels::Chain device_chain(ChainLayout const& layout, ChainLaw const& law, bool open_end) {
  kernels::Chain c{};
  c.n_s = layout.n_nodes[0];
  c.n_a = layout.n_nodes[1];
  c.n_b = layout.n_nodes[2];
  c.law = law.law;
  for (int end = 0; end < 2; ++end) c.slope[end] = law.slope[end];
  c.first_knot = law.knots[0];
  c.n_intervals = law.knots[1];
  c.open_end = open_end ? 1 : 0;
  c.first_side = -1;
  return c;
}

/// Sets how a turn fades far from a wall: from a body to what is at rest; between two ends that turn, about what they
/// have in common.
void set_far_law(double reach, bool one_body, kernels::Chain& device) {
  if (device.turned_ends == 3) {
    device.turn = one_body ? kernels::TurnLaw::common : kernels::TurnLaw::c1;
  } else {
    device.turn_reach = reach;
    device.turn_scale = 1 / (kernels::far_growth(reach) - 1);
  }
}

/// Sets the pivots of a chain's ends: those that turn with a body turn about its centre.
void set_pivots(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                kernels::Chain const& device, LineTables& lines) {
  for (int end = 0; end < 2; ++end)
    for_end_entities(context, chain, layout, end, [&](PlacedBox const& box, int entity) {
      int const body = known.body[context.topology.lattice.class_of(entity)];
      auto const rows = context.skeleton.rows(entity);
      if (body == no_body || !rows) return;
      Vec3 const centre = box.in_chain_frame(context.roots->centre_of_body(body));
      for (int q = 0; q < rows->n_q; ++q)
        for (int p = 0; p < rows->n_p; ++p) {
          Index3 const at = box.position(node_at(*rows, p, q));
          lines.end_pivots[device.first_end_value + end * device.section_size() + at[1] + Index(device.n_a) * at[2]] =
              centre;
        }
    });
}

/// What a face counts as when a chain has made it known.
struct Origin {
  EndKind kind = unknown_end;
  std::vector<int> patches;
};
/// The one that ranks better, both where they rank alike.
Origin better_of(Origin const& a, Origin const& b, std::vector<std::string> const& kind_order) {
  int const first = kind_rank(a.kind, kind_order), second = kind_rank(b.kind, kind_order);
  if (first != second) return first < second ? a : b;
  Origin both{std::min(a.kind, b.kind), {}};
  std::set_union(a.patches.begin(), a.patches.end(), b.patches.begin(), b.patches.end(),
                 std::back_inserter(both.patches));
  return both;
}
Origin origin_of(Chain const& chain, bool open_end, std::vector<std::string> const& kind_order) {
  Origin const first{chain.first.kind, chain.first.patches};
  return open_end ? first : better_of(first, {chain.last.kind, chain.last.patches}, kind_order);
}

/// Which ends carry a rotation, and how it fades: a near field turns with its wall, other chains where an end of theirs
/// does. Returns whose rotation the chain carries, where all of it is one body's.
int set_turn(PlanContext const& context, Chain const& chain, ChainLayout const& layout, StageChain const& entry,
             Known const& known, kernels::Chain& device) {
  bool const near_field = entry.turn == kernels::TurnLaw::near_field;
  if (entry.turn == kernels::TurnLaw::none) return no_body;
  std::set<int> bodies;
  for (int end = 0; end < (near_field || entry.open_end ? 1 : 2); ++end)
    for_end_entities(context, chain, layout, end, [&](PlacedBox const&, int entity) {
      int const c = context.topology.lattice.class_of(entity);
      if (known.turns[c] == 0) return;
      device.turned_ends |= 1u << end;
      bodies.insert(known.body[c]);
    });
  int const body = bodies.size() == 1 ? *bodies.begin() : no_body;
  if (near_field) device.turned_ends = 3;
  if (device.turned_ends == 0) return no_body;
  device.turn = entry.turn;
  if (entry.turn == kernels::TurnLaw::far) set_far_law(entry.turn_reach, body != no_body, device);
  return body;
}

/// Turns the cross-section of a chain so that a and b run forward in memory, a through nearer nodes than b.
Chain with_contiguous_a(PlanContext const& context, Chain chain) {
  auto turn = [&](Orientation const& o) {
    for (ChainStep& step : chain.steps) step.to_chain = step.to_chain.then(o);
  };
  auto strides = [&] {
    return piece_nodes(context.mesh, context.topology.lattice, lay_out(context.topology, chain).pieces.front()).stride;
  };
  if (auto const s = strides(); std::abs(s[1]) > std::abs(s[2])) turn({{0, 2, 1}, {1, 1, 1}});
  auto const s = strides();
  turn({{0, 1, 2}, {1, s[1] < 0 ? -1 : 1, s[2] < 0 ? -1 : 1}});
  return chain;
}

}  // namespace

Stage build_stage(PlanContext const& context, std::vector<StageChain> const& chains, Known& known,
                  std::vector<std::string> const& kind_order) {
  Stage stage;
  Lattice const& lattice = context.topology.lattice;
  std::map<int, int> writer;      // entity class -> entity that is written
  std::map<int, Origin> becomes;  // entity class -> what it counts as
  std::map<int, int> turning;     // entity class that gets a rotation -> whose it is
  std::vector<SideWalk> walks;
  for (StageChain const& entry : chains) {
    Chain const chain = with_contiguous_a(context, entry.chain);
    ChainLayout const layout = lay_out(context.topology, chain);
    Origin const origin = origin_of(chain, entry.open_end, kind_order);
    int const number = int(stage.lines.chains.size());
    std::size_t const first_segment = stage.lines.segments.size();
    kernels::Chain device = device_chain(layout, entry.law, entry.open_end);
    device.first_end_value = stage.lines.n_end_values;
    int const body = set_turn(context, chain, layout, entry, known, device);
    stage.turns = stage.turns || device.turn != kernels::TurnLaw::none;
    stage.lines.n_end_values += 2 * device.section_size();
    stage.lines.chains.push_back(device);
    for (int end = 0; end < (entry.open_end ? 1 : 2); ++end)
      for_end_entities(context, chain, layout, end, [&](PlacedBox const& box, int entity) {
        add_gather(
            context, box, entity, device.first_end_value + end * device.section_size(),
            [&](Index3 const& at) { return at[1] + Index(device.n_a) * at[2]; }, stage.ends);
      });
    append_lines(context, chain, layout, number, stage.lines);
    add_side_tables(context, chain, layout, known, number, stage, walks);
    if (device.turn != kernels::TurnLaw::none) add_turn_positions(context, chain, layout, number, stage);
    if (entry.turn == kernels::TurnLaw::far && device.turned_ends != 0)
      set_pivots(context, chain, layout, known, device, stage.lines);
    if (device.turn == kernels::TurnLaw::near_field) add_near_field_lines(context, chain, layout, number, stage);
    append_writers(context, chain, layout, number, first_segment, stage.lines, stage.sweeps, stage.volume,
                   [&](int entity) {
                     int const c = lattice.class_of(entity);
                     if (known(c)) return false;
                     if (device.turn != kernels::TurnLaw::none) turning.try_emplace(c, body);
                     auto const [it, fresh] = becomes.try_emplace(c, origin);
                     if (!fresh) it->second = better_of(it->second, origin, kind_order);
                     return writer.try_emplace(c, entity).first->second == entity && fresh;
                   });
    for (ChainPiece const& p : layout.pieces) {
      Piece const& piece = lattice.pieces()[p.piece];
      IndexRange cells = piece.nodes;
      for (int a = 0; a < 3; ++a) --cells.end[a];
      stage.cells.push_back({piece.zone, cells});
      stage.chain_of_cells.push_back(number);
      stage.axis_of_cells.push_back(p.to_chain.inverse().axis[0]);
    }
    ChainPath path{{}, {list_of(end_names(context.mesh, chain.first)), list_of(end_names(context.mesh, chain.last))}};
    for (ChainStep const& step : chain.steps) path.blocks.push_back(step.block);
    stage.paths.push_back(std::move(path));
  }
  find_side_parameters(context, walks, stage);
  for (auto const& [c, entity] : writer) {
    known.known[c] = 1;
    known.kind[c] = becomes.at(c).kind;
    known.patches[c] = becomes.at(c).patches;
  }
  for (auto const& [c, body] : turning) {
    known.turns[c] = 1;
    known.body[c] = body;
  }
  return stage;
}

namespace {

/// Slip surfaces of every entity class: faces have one, edges and corners up to three.
std::map<int, std::vector<int>> surfaces_of_classes(Topology const& topology,
                                                    std::vector<int> const& surface_of_patch) {
  Lattice const& lattice = topology.lattice;
  std::map<int, std::vector<int>> surfaces_of;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = topology.blocks.patch_of_face()[c];
    if (patch < 0 || surface_of_patch[patch] < 0) continue;
    for (EntityCopy const& copy : lattice.copies(c))
      for_closure(lattice, copy.entity, [&](int entity) {
        auto& list = surfaces_of[lattice.class_of(entity)];
        if (std::find(list.begin(), list.end(), surface_of_patch[patch]) == list.end())
          list.push_back(surface_of_patch[patch]);
      });
  }
  return surfaces_of;
}

/// The slip ends of one entity at an end of a chain.
void add_slip_ends(PlanContext const& context, PlacedBox const& box, int entity, kernels::Chain const& chain, int end,
                   std::vector<int> const& surfaces, double tolerance, std::vector<kernels::SlipEnd>& out) {
  auto const rows = context.skeleton.rows(entity);
  if (!rows) return;
  EntityCopy const& copy = context.topology.lattice.copy_of(entity);
  kernels::SlipEnd slip{};
  slip.to_node = copy.moved ? context.rotations.number(copy.transform.rotation) : -1;
  slip.to_chain = box.rotated ? context.rotations.number(transpose(box.rotation)) : -1;
  slip.tolerance = tolerance;
  for (std::size_t m = 0; m < 3; ++m) slip.surface[m] = m < surfaces.size() ? surfaces[m] : -1;
  Zone const& zone = context.mesh.zones[box.zone];
  for (int q = 0; q < rows->n_q; ++q)
    for (int p = 0; p < rows->n_p; ++p) {
      Index3 const node = node_at(*rows, p, q);
      Index3 const at = box.position(node);
      slip.node = zone.node(node);
      slip.slot = rows->slot + p + q * rows->slot_q;
      slip.value = chain.first_end_value + end * chain.section_size() + at[1] + Index(chain.n_a) * at[2];
      out.push_back(slip);
    }
}

double given_tolerance(std::vector<int> const& surfaces, Plan const& plan) {
  double tolerance = 0;
  for (int const s : surfaces) tolerance = std::max(tolerance, given_tolerance(plan.surfaces[s], plan.mesh_size));
  return tolerance;
}

}  // namespace

/// A surface fitted to nodes that scatter is tilted by their scatter over its size: a displacement along the true one
/// leaves it by as much.
double given_tolerance(SlipSurface const& surface, double mesh_size) {
  return std::max(1e-10 * mesh_size, std::min(2 * surface.baseline_deviation, 1e-6 * surface.size));
}

SpreadPass build_spread(PlanContext const& context, std::vector<Chain> const& chains, kernels::LineLaw law,
                        std::vector<int> const& surface_of_patch, Known const& given, Plan const& plan) {
  SpreadPass pass;
  Lattice const& lattice = context.topology.lattice;
  auto const surfaces_of = surfaces_of_classes(context.topology, surface_of_patch);
  std::map<int, int> writer;
  for (Chain const& entry : chains) {
    Chain const chain = with_contiguous_a(context, entry);
    ChainLayout const layout = lay_out(context.topology, chain);
    int const number = int(pass.lines.chains.size());
    std::size_t const first_segment = pass.lines.segments.size();
    kernels::Chain device = device_chain(layout, law, false);
    device.first_end_value = pass.lines.n_end_values;
    pass.lines.n_end_values += 2 * device.section_size();
    pass.lines.chains.push_back(device);
    append_lines(context, chain, layout, number, pass.lines);
    append_writers(context, chain, layout, number, first_segment, pass.lines, pass.sweeps, pass.volume,
                   [&](int entity) {
                     auto const [it, fresh] = writer.try_emplace(lattice.class_of(entity), entity);
                     return fresh && it->second == entity;
                   });
    for (int end = 0; end < 2; ++end) {
      int const patch = end == 0 ? chain.first.patch : chain.last.patch;
      if (patch < 0 || surface_of_patch[patch] < 0) continue;
      for_end_entities(context, chain, layout, end, [&](PlacedBox const& box, int entity) {
        int const c = lattice.class_of(entity);
        add_slip_ends(context, box, entity, device, end, surfaces_of.at(c),
                      given(c) ? given_tolerance(surfaces_of.at(c), plan) : 0, pass.ends);
      });
    }
  }
  return pass;
}

}  // namespace gridmorph
