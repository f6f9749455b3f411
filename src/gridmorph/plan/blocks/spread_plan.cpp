#include <gridmorph/plan/blocks/independent_chains.hpp>
#include <gridmorph/plan/blocks/spread_plan.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {
namespace {

/// A chain off a slip block face, slip end first, and how many of its steps are used.
struct Candidate {
  int rule = -1;
  bool curved = false;
  Chain chain;
  int steps = 0;
  bool across_gap = false;
  [[nodiscard]] bool whole() const { return steps == int(chain.steps.size()); }
};

/// Regions keep what their rules give them: chains end on them, and so do those beside them.
class Held {
 public:
  Held(Mesh const& mesh, Topology const& topology)
      : topology_(topology),
        faces_(topology.lattice.n_classes()),
        inside_(std::size_t(topology.lattice.n_classes()), 0) {
    Lattice const& lattice = topology.lattice;
    for (int c = 0; c < lattice.n_classes(); ++c) {
      int const patch = topology.blocks.patch_of_face()[c];
      bool const region = patch >= 0 && mesh.patches[patch].kind == PatchKind::region;
      faces_.known[c] = region ? 1 : 0;
      int const owner = lattice.copies(c).front().entity;
      bool const held =
          region || (lattice.dimension(owner) == 3 && topology.blocks.region_of(lattice.piece_of_volume(owner)) >= 0);
      if (held) for_closure(lattice, owner, [&](int entity) { inside_[lattice.class_of(entity)] = 1; });
      any_ = any_ || held;
    }
  }

  /// The faces that chains end on.
  [[nodiscard]] Known const& faces() const { return faces_; }

  /// How many steps of a chain, one at least, have no region beside them; a chain inside of one has only itself.
  [[nodiscard]] int free_steps(Chain const& chain) const {
    auto const all = int(chain.steps.size());
    if (!any_) return all;
    for (int m = 0; m < all; ++m)
      if (is_beside(chain.steps[m])) return std::max(1, m);
    return all;
  }

 private:
  [[nodiscard]] bool is_beside(ChainStep const& step) const {
    Lattice const& lattice = topology_.lattice;
    for (PlacedPiece const& placed : topology_.blocks[step.block].pieces) {
      if (topology_.blocks.region_of(placed.piece) >= 0) return false;
      int const along = placed.to_block.then(step.to_chain).inverse().axis[0];
      Index3 which{};
      for (which[0] = 0; which[0] < 3; ++which[0])
        for (which[1] = 0; which[1] < 3; ++which[1])
          for (which[2] = 0; which[2] < 3; ++which[2])
            if (which[along] == 1 && inside_[lattice.class_of(lattice.entity_of_piece(placed.piece, which))] != 0)
              return true;
    }
    return false;
  }

  Topology const& topology_;
  Known faces_;
  std::vector<char> inside_;  ///< entity classes of regions, with what bounds them
  bool any_ = false;
};

/// How many steps of a chain are in one gap layer, or come before one.
int steps_to_gap(Gaps const& gaps, Chain const& chain) {
  bool const within = gaps.runs_across(chain.steps.front());
  auto const end = std::find_if(chain.steps.begin(), chain.steps.end(),
                                [&](ChainStep const& step) { return gaps.runs_across(step) != within; });
  return int(end - chain.steps.begin());
}

std::vector<Candidate> find_candidates(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion,
                                       Gaps const& gaps, std::vector<int> const& surface_of_patch,
                                       std::vector<SlipSurface> const& surfaces) {
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  Held const held(mesh, topology);
  std::vector<Candidate> candidates;
  std::set<BlockFace> seen;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = blocks.patch_of_face()[c];
    if (patch < 0 || surface_of_patch[patch] < 0) continue;
    BlockFace const face = blocks.face_of(lattice.face_sides(c).front());
    if (!seen.insert(face).second) continue;
    // To the opposite boundary, or through one block where the way there would come back to one of its blocks.
    Chain chain;
    if (auto whole = find_chain(mesh, topology, held.faces(), face.block, face.axis)) {
      bool const slip_first = end_face(whole->steps.front(), 0) == face;
      chain = slip_first ? std::move(*whole) : reversed(std::move(*whole));
    } else {
      auto one = walk_from(mesh, topology, held.faces(), face, [](Chain const&) { return true; });
      if (!one) continue;
      chain = std::move(*one);
    }
    int const steps = std::min(held.free_steps(chain), steps_to_gap(gaps, chain));
    bool const across_gap = gaps.runs_across(chain.steps.front());
    SlipKind const kind = surfaces[surface_of_patch[patch]].kind;
    bool const curved = kind == SlipKind::revolution || kind == SlipKind::meridional || kind == SlipKind::facets;
    candidates.push_back({motion.patch[patch].rule, curved, std::move(chain), steps, across_gap});
  }
  return candidates;
}

/// Shortens the chains of one rule until their common region has no inner side: a node on a side that another block
/// shares would move with the chain and the block's own nodes would not. Chains side by side get equal length.
void close_sides(Topology const& topology, std::vector<Candidate*> const& group) {
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  using Place = std::pair<Candidate*, int>;  // chain, step
  std::map<int, std::vector<Place>> beside;  // inner side face -> who has it
  for (Candidate* c : group)
    for (int m = 0; m < int(c->chain.steps.size()); ++m) {
      ChainStep const& step = c->chain.steps[m];
      for (int axis = 0; axis < 3; ++axis) {
        if (step.to_chain.axis[axis] == 0) continue;
        for (int side = 0; side < 2; ++side)
          for (int const entity : blocks.face_entities(lattice, {step.block, axis, side})) {
            int const face = lattice.class_of(entity);
            if (blocks.patch_of_face()[face] < 0) beside[face].emplace_back(c, m);
          }
      }
    }
  for (bool changed = true; changed;) {
    changed = false;
    auto shorten = [&](Candidate* c, int steps) {
      if (c->steps <= std::max(1, steps)) return;
      c->steps = std::max(1, steps);
      changed = true;
    };
    for (auto const& [face, places] : beside)
      for (Place const& place : places) {
        auto const [c, m] = place;
        if (m >= c->steps) continue;
        auto const other = std::find_if(places.begin(), places.end(),
                                        [&](Place const& p) { return &p != &place && p.second < p.first->steps; });
        if (other == places.end() || other->second != m)
          shorten(c, m);
        else
          shorten(c, other->first->steps);
      }
  }
}

Chain used_part(Candidate const& c) {
  Chain chain = c.chain;
  if (!c.whole()) {
    chain.steps.resize(c.steps);
    chain.last = {};
  }
  return chain;
}

/// The chains of one rule, or of two rules whose chains are the same from end to end (hub and case).
struct RuleChains {
  struct Entry {
    Chain chain;
    bool across_gap = false;
  };
  std::set<int> rules;
  bool curved = false;
  std::vector<Entry> chains;
};

/// The chains of every rule, in the order they are to be spread. Planes and axial constraints come first: their
/// corrections leave other planes alone, but not curved surfaces, which are put right last and by lines that lie in
/// those planes.
std::vector<RuleChains> chains_by_rule(Topology const& topology, ResolvedMotion const& motion,
                                       std::vector<int> const& surface_of_patch, std::vector<Candidate>& candidates) {
  using Key = std::pair<bool, int>;  // (curved, rule)
  std::map<Key, std::vector<Candidate*>> groups;
  for (Candidate& c : candidates) groups[{c.curved, c.rule}].push_back(&c);
  std::map<Key, std::set<std::pair<int, int>>> whole_blocks;  // (block, axis), if all chains of the rule are whole
  for (auto& [key, group] : groups) {
    close_sides(topology, group);
    auto& blocks = whole_blocks[key];
    for (Candidate const* c : group)
      for (ChainStep const& step : c->chain.steps)
        if (c->whole()) blocks.insert({step.block, step.to_chain.inverse().axis[0]});
    if (!std::all_of(group.begin(), group.end(), [](Candidate const* c) { return c->whole(); })) blocks.clear();
  }
  std::vector<RuleChains> lists;
  std::map<Key, std::size_t> list_of;
  for (auto const& [key, group] : groups) {
    // Done with an earlier rule at the other end of the same chains?
    auto const same = std::find_if(list_of.begin(), list_of.end(), [&, k = key](auto const& other) {
      return !whole_blocks.at(k).empty() && whole_blocks.at(other.first) == whole_blocks.at(k);
    });
    if (same != list_of.end()) {
      lists[same->second].rules.insert(key.second);
      continue;
    }
    list_of[key] = lists.size();
    RuleChains list;
    list.rules.insert(key.second);
    list.curved = key.first;
    std::set<std::pair<int, int>> taken;  // a chain with both ends on this rule's patches is found twice
    for (Candidate const* c : group) {
      Chain chain = used_part(*c);
      ChainStep const& first = chain.steps.front();
      if (taken.contains({first.block, first.to_chain.inverse().axis[0]}) && c->whole()) continue;
      for (ChainStep const& step : chain.steps) taken.insert({step.block, step.to_chain.inverse().axis[0]});
      // The far end is put back too only where all chains are whole; otherwise its own rule does it.
      bool const same_rule = chain.last.patch >= 0 && surface_of_patch[chain.last.patch] >= 0 &&
                             motion.patch[chain.last.patch].rule == key.second;
      if (whole_blocks.at(key).empty() && !same_rule) chain.last = {};
      list.chains.push_back({std::move(chain), c->across_gap});
    }
    lists.push_back(std::move(list));
  }
  return lists;
}

/// What a curved surface asks for, spread along lines on another curved surface, takes their nodes off it. So the
/// passes of curved surfaces are swept there and back: each sweep leaves a small share of the disturbance of the one
/// before.
void sweep_again(std::vector<RuleChains>& lists) {
  constexpr int sweeps = 2;
  auto const first_curved = std::find_if(lists.begin(), lists.end(), [](RuleChains const& l) { return l.curved; });
  std::vector<RuleChains> sweep(first_curved, lists.end());
  if (sweep.size() < 2) return;
  for (int n = 0; n < sweeps; ++n) {
    std::reverse(sweep.begin(), sweep.end());
    lists.insert(lists.end(), sweep.begin() + 1, sweep.end());
  }
}

}  // namespace

std::vector<int> slip_surface_numbers(std::size_t n_patches, BoundaryMotion const& motion,
                                      std::vector<SlipSurface>& surfaces) {
  std::vector<int> number(n_patches, -1);
  std::map<int, int> place;  // in the order of patches
  for (int p = 0; p < int(n_patches); ++p) {
    int const s = motion.slip_surface_of(p);
    if (s < 0) continue;
    auto const [at, fresh] = place.try_emplace(s, int(surfaces.size()));
    if (fresh) surfaces.push_back(motion.slip_surfaces()[s]);
    number[p] = at->second;
  }
  return number;
}

void plan_spreads(PlanContext const& context, ResolvedMotion const& motion, std::vector<int> const& surface_of_patch,
                  Known const& given, Gaps const& gaps, Plan& plan) {
  Mesh const& mesh = context.mesh;
  Topology const& topology = context.topology;
  if (plan.surfaces.empty()) return;
  Known const nothing(topology.lattice.n_classes());
  std::vector<Candidate> candidates = find_candidates(mesh, topology, motion, gaps, surface_of_patch, plan.surfaces);
  // A node on several surfaces is put on those of earlier passes and its own: each correction is spread along the lines
  // of its own rule.
  std::vector<int> surface_so_far(mesh.patches.size(), -1);
  std::vector<RuleChains> lists = chains_by_rule(topology, motion, surface_of_patch, candidates);
  sweep_again(lists);
  for (RuleChains& list : lists) {
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      if (list.rules.contains(motion.patch[p].rule)) surface_so_far[p] = surface_of_patch[p];
    while (!list.chains.empty()) {
      IndependentChains independent(topology, nothing);
      std::vector<Chain> now;
      std::vector<RuleChains::Entry> later;
      bool const across_gap = list.chains.front().across_gap;
      for (RuleChains::Entry& entry : list.chains)
        if (entry.across_gap == across_gap && independent.add(entry.chain))
          now.push_back(std::move(entry.chain));
        else
          later.push_back(std::move(entry));
      // Zero slope at both ends keeps the first spacings at end walls; across a gap all cells share what it opens or
      // closes by.
      kernels::LineLaw const law = across_gap ? kernels::LineLaw::linear : kernels::LineLaw::c1;
      SpreadPass pass = build_spread(context, now, law, surface_so_far, given, plan);
      std::map<std::pair<std::string, std::string>, int> ends;
      for (Chain const& chain : now) {
        auto name = [&](ChainEnd const& end) {
          if (end.patch < 0) return std::string("an inner face");
          Patch const& p = mesh.patches[end.patch];
          return p.families.empty() ? p.name : p.families.front();
        };
        ++ends[{name(chain.first), name(chain.last)}];
      }
      for (auto const& [who, count] : ends)
        pass.description.push_back(std::to_string(count) + " chains from " + who.first + " to " + who.second +
                                   (across_gap ? ", across the gap" : ""));
      plan.spreads.push_back(std::move(pass));
      list.chains = std::move(later);
    }
  }
}

}  // namespace gridmorph
