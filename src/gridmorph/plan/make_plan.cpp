#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/blocks/boundary.hpp>
#include <gridmorph/plan/blocks/boundary_facts.hpp>
#include <gridmorph/plan/blocks/chain_laws.hpp>
#include <gridmorph/plan/blocks/independent_chains.hpp>
#include <gridmorph/plan/blocks/plan_basis.hpp>
#include <gridmorph/plan/blocks/spread_plan.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>
#include <gridmorph/plan/blocks/turned_lines.hpp>
#include <gridmorph/plan/blocks/wall_roots.hpp>
#include <gridmorph/plan/make_plan.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace gridmorph {
namespace {

/// What chains rank by where they end on patches: kinds, and what the priority names.
std::vector<EndKind> ranked_ends(Mesh const& mesh, std::vector<PatchKind> const& kinds, VolumeOptions const& options) {
  std::vector<EndKind> ends;
  for (PatchKind const kind : kinds) ends.push_back(end_kind(kind));
  for (PriorityRule const& rule : options.priority)
    for (int n = 0; n < int(rule.patches.size()); ++n)
      for (int const p : select_patches(mesh, {rule.patches[n]}))
        if (ends[p] < named_ends) ends[p] = named_end(n, ends[p]);
  return ends;
}

/// Patches that must not share a block face: other rules, other kinds, other near fields, named by other laws.
MergeLimits merge_limits(Mesh const& mesh, ResolvedMotion const& motion, std::vector<EndKind> const& ends,
                         ChainLaws const& laws, std::vector<NearField> const& fields) {
  MergeLimits limits;
  std::map<std::tuple<int, int, int, std::vector<char>>, int> labels;
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    int field = -1;
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (std::count(fields[f].walls.begin(), fields[f].walls.end(), p) > 0) field = int(f);
    limits.patch_label.push_back(
        labels.try_emplace({motion.patch[p].rule, ends[p], field, laws.naming(p)}, int(labels.size())).first->second);
  }
  std::map<std::tuple<int, std::vector<char>>, int> of_interfaces;
  for (int i = 0; i < int(motion.interface.size()); ++i)
    limits.interface_label.push_back(
        of_interfaces
            .try_emplace({motion.interface[i].rule, laws.naming(int(mesh.patches.size()) + i)},
                         int(of_interfaces.size()))
            .first->second);
  return limits;
}

/// The name of a block in messages: "zone 'a' [1:13, 1:48, 1:20]", and in which other zones the block has pieces.
std::string block_name(Mesh const& mesh, Topology const& topology, int block) {
  auto const& pieces = topology.blocks[block].pieces;
  Piece const& first = topology.lattice.pieces()[pieces.front().piece];
  std::string text = "zone '" + mesh.zones[first.zone].name + "' " + to_string(first.nodes);
  std::set<int> others;
  for (PlacedPiece const& placed : pieces) others.insert(topology.lattice.pieces()[placed.piece].zone);
  others.erase(first.zone);
  constexpr int most = 4;
  int listed = 0;
  for (int const zone : others)
    if (++listed <= most) text += (listed == 1 ? " with '" : ", '") + mesh.zones[zone].name + "'";
  if (listed > most) text += " and " + std::to_string(listed - most) + " more zones";
  return text;
}

std::string chain_name(Mesh const& mesh, Topology const& topology, Chain const& chain) {
  std::string text;
  for (ChainStep const& step : chain.steps) {
    if (!text.empty()) text += " - ";
    text += block_name(mesh, topology, step.block);
  }
  return text;
}

/// "'blade' to 'inlet'": what the ends of a chain lie on, or what made the faces known that they lie on; nothing where
/// neither is named.
std::string names_of_ends(Mesh const& mesh, Chain const& chain) {
  auto const names = [&](ChainEnd const& end) {
    constexpr std::size_t most = 3;
    auto const all = end_names(mesh, end);
    return all.empty() ? std::string("a pole") : quote_list(all, most);
  };
  if (chain.first.patches.empty() && chain.last.patches.empty()) return {};
  return names(chain.first) + " to " + names(chain.last);
}

/// The share of their walls' turn that near fields hand on to chains between moving ends: a line that starts turned has
/// to turn back, which costs more reach than the near field gains (docs/quality.md has the figures).
constexpr double passage_turn = 0;

struct HandedOn {
  double turn = 0;
  kernels::TurnLaw law = kernels::TurnLaw::none;
  double reach = 0;  ///< TurnLaw::far
};

class Scheduler {
 public:
  Scheduler(PlanContext const& context, Priority& priority, ChainLaws const& laws, Gaps const& gaps,
            BoundaryMotion const& surface, PlanOptions const& options, Plan& plan, Known& known, ChainChoice choice)
      : context_(context),
        surface_(surface),
        mesh_(context.mesh),
        topology_(context.topology),
        motion_(surface.motion()),
        options_(options),
        plan_(plan),
        known_(known),
        priority_(priority),
        laws_(laws),
        gaps_(gaps),
        choice_(choice) {}

  /// Stage 0. Near fields that get in each other's way follow one another: of walls that meet at a concave edge, and of
  /// walls so near that their near fields touch. There the later one has no room to move rigidly: it is interpolated
  /// between its wall and the face that the earlier one moves.
  void near_field(std::vector<StageChain> chains) {
    before_near_field_ = known_.known;
    for (int turn = 0; !chains.empty(); ++turn) {
      for (StageChain& chain : chains)
        if (outer_face_is_known(chain.chain)) {
          chain.law = laws_.along({laws_.usual()}, {});
          chain.open_end = false;
          if (chain.turn != kernels::TurnLaw::none) chain.turn = kernels::TurnLaw::square;
          chain.chain.last = {true, chain.chain.first.kind, -1, chain.chain.first.patches};
          if (is_active(chain.chain.steps.back().block))
            plan_.notes.push_back(
                "the near field at " + chain_name(mesh_, topology_, chain.chain) +
                " touches that of another wall, or a region, and is interpolated between the two; fewer layers keep "
                "both rigid");
        }
      IndependentChains independent(topology_, known_);
      std::vector<StageChain> now, later;
      std::vector<std::string> description;
      for (StageChain& chain : chains) {
        if (independent.add(chain.chain)) {
          description.push_back(chain_name(mesh_, topology_, chain.chain) +
                                (chain.open_end ? ": constant off the wall" : ": between touching near fields"));
          now.push_back(std::move(chain));
        } else {
          later.push_back(std::move(chain));
        }
      }
      Stage stage = build_stage(context_, now, known_, priority_.kind_order());
      stage.name = turn == 0 ? "near field" : "near field " + std::to_string(turn + 1);
      stage.description = std::move(description);
      plan_.near_field.insert(plan_.near_field.end(), stage.cells.begin(), stage.cells.end());
      plan_.stages.push_back(std::move(stage));
      chains = std::move(later);
    }
  }

  /// What near fields hand on of their turn, and how it fades. Where their lines end at rest: all of it if they move as
  /// rigid bodies, as far as the bodies' own motion does; none otherwise, as what turns differently from line to line
  /// tears far from the wall.
  HandedOn hand_on(std::vector<NearField> const& fields, WallRoots const& roots) {
    bool any = false;
    HandedOn const between_moving{options_.volume.turn.value_or(passage_turn), kernels::TurnLaw::square};
    for (RankedChain const& ranked : collect(Ends::both)) {
      auto const begins = [&](Chain const& chain) {
        auto const faces = topology_.blocks.face_entities(topology_.lattice, end_face(chain.steps.front(), 0));
        return std::any_of(faces.begin(), faces.end(),
                           [&](int e) { return known_.turns[topology_.lattice.class_of(e)] != 0; });
      };
      bool const first = begins(ranked.chain), last = begins(reversed(ranked.chain));
      if (!first && !last) continue;
      if ((first && last) || !ends_at_rest(first ? ranked.chain.last : ranked.chain.first)) return between_moving;
      any = true;
    }
    if (!any) return between_moving;
    double const turn = options_.volume.turn.value_or(is_rigid(fields, roots) ? 1 : 0);
    if (!(roots.body_size() > 0)) return {turn, kernels::TurnLaw::c1};
    return {turn, kernels::TurnLaw::far, std::max(1.0, 0.5 * plan_.mesh_size / roots.body_size())};
  }

  /// first: of these stages the chains are given; the others follow by priority. Returns the order of all.
  /// `next`: gets what the stage after those could be.
  ChainOrder volume(HandedOn const& handed_on, ChainOrder const& first, ChainOrder* next) {
    kernels::TurnLaw const turn_law = handed_on.turn > 0 ? handed_on.law : kernels::TurnLaw::none;
    ChainOrder order;
    after_near_field_ = known_.known;
    for (int number = 1; has_active_blocks(); ++number) {
      if (next != nullptr && order.size() == first.size()) *next = alternatives();
      bool open = false;
      std::vector<RankedChain> chains =
          order.size() < first.size() ? given_chains(first[order.size()], open) : best_chains(open);
      IndependentChains independent(topology_, known_);
      std::vector<StageChain> now;
      std::vector<std::string> description;
      order.emplace_back();
      for (RankedChain& ranked : chains) {
        // Chains of a stage may share lines, which have one law.
        ChainLaws::OfChain const law = laws_.of(ranked.chain, ranked.place.law, priority_.kind_order());
        bool const from_last = open ? !ranked.chain.first.known : law.from == ChainLaws::From::last;
        Chain const chain = from_last ? reversed(ranked.chain) : ranked.chain;
        ChainLaw const along = open ? ChainLaw(kernels::LineLaw::constant) : laws_.along(law, near_ends(chain));
        if (!now.empty() && along != now.front().law) continue;
        if (!independent.add(chain, along.is_directed())) continue;
        order.back().push_back(ranked.place);
        bool const across_gap = open && gaps_.runs_across(chain);
        description.push_back(described(ranked) + (across_gap ? ", across the gap" : "") +
                              (open || law.choice == laws_.usual() ? "" : ", law " + laws_.name(law.choice)));
        now.push_back(
            {chain, along, open, across_gap ? kernels::TurnLaw::none : turn_law, across_gap ? 0 : handed_on.reach});
      }
      Stage stage = build_stage(context_, now, known_, priority_.kind_order());
      stage.name = std::to_string(number);
      stage.description = std::move(description);
      plan_.stages.push_back(std::move(stage));
    }
    return order;
  }

 private:
  /// The chains of the best rank, best first.
  std::vector<RankedChain> best_chains(bool& open) {
    std::vector<RankedChain> chains = collect(Ends::both);
    if (chains.empty()) {
      chains = collect(Ends::across_gap);
      open = !chains.empty();
    }
    if (open) {
      // All at once: none of them says more about a gap than the others.
      priority_.sort(chains);
      return chains;
    }
    if (chains.empty()) chains = collect(Ends::through_gap);
    if (chains.empty()) {
      open = true;
      chains = collect(Ends::one);
    }
    if (chains.empty()) throw PlanError(unreachable());
    if (choice_ != ChainChoice::rules) {
      put_in_order(chains);
      return chains;
    }
    // A measure that comes first ranks all chains; one that breaks ties is found where there are some.
    bool const ranked = priority_.quality_leads();
    if (ranked) priority_.add_quality(chains);
    priority_.sort(chains);
    chains.erase(std::find_if(chains.begin(), chains.end(),
                              [&](RankedChain const& c) { return !priority_.same_rank(c, chains.front()); }),
                 chains.end());
    // Chains that do not get in each other's way need no order among them.
    if (!ranked && !independent(chains)) {
      priority_.add_quality(chains);
      priority_.sort(chains);
    }
    return chains;
  }
  /// Puts chains in order by the choice that is not the rules'; those decide where it says nothing.
  void put_in_order(std::vector<RankedChain>& chains) {
    priority_.add_quality(chains);
    priority_.sort(chains);
    auto const key = [&](RankedChain const& c) -> long long {
      switch (choice_) {
        case ChainChoice::sharp_first: return c.quality;
        case ChainChoice::blunt_first: return -c.quality;
        case ChainChoice::short_first: return c.aspect_ratio;
        case ChainChoice::long_first: return -c.aspect_ratio;
        case ChainChoice::few_blocks: return (long long)(c.chain.steps.size());
        case ChainChoice::many_blocks: return -(long long)(c.chain.steps.size());
        case ChainChoice::weakest_ends: return -1000LL * c.boundary[1] - c.boundary[0];
        case ChainChoice::rules: break;
      }
      return 0;
    };
    std::stable_sort(chains.begin(), chains.end(),
                     [&](RankedChain const& a, RankedChain const& b) { return key(a) < key(b); });
  }
  /// What could be the next stage: all chains of one rank, in either order where they compete, and each chain by
  /// itself.
  ChainOrder alternatives() {
    std::vector<RankedChain> chains = collect(Ends::both);
    for (Ends const ends : {Ends::across_gap, Ends::through_gap, Ends::one})
      if (chains.empty()) chains = collect(ends);
    priority_.add_quality(chains);
    priority_.sort(chains);
    std::map<std::array<int, 2>, std::vector<ChainPlace>> of_rank;
    ChainOrder out;
    for (RankedChain const& chain : chains) of_rank[chain.boundary].push_back(chain.place);
    for (auto& [rank, places] : of_rank) {
      out.push_back(places);
      std::reverse(places.begin(), places.end());
      out.push_back(places);
    }
    for (RankedChain const& chain : chains) out.push_back({chain.place});
    return out;
  }
  /// The chains at some places, all of them open or none.
  std::vector<RankedChain> given_chains(std::vector<ChainPlace> const& places, bool& open) {
    std::vector<RankedChain> chains;
    for (ChainPlace const& place : places) {
      std::optional<Chain> chain = find_chain(mesh_, topology_, known_, place.block, place.axis);
      if (!chain || !(chain->first.known || chain->last.known))
        throw PlanError("the order of chains names one along axis " + std::to_string(place.axis) + " of " +
                        block_name(mesh_, topology_, place.block) + " that comes to no known face when it is its turn");
      open = !(chain->first.known && chain->last.known);
      chains.push_back(priority_.rank(std::move(*chain)));
      chains.back().place = place;
    }
    return chains;
  }
  [[nodiscard]] bool is_active(int block) const {
    int const piece = topology_.blocks[block].pieces.front().piece;
    return !known_(topology_.lattice.class_of(topology_.lattice.entity_of_piece(piece, {1, 1, 1})));
  }
  /// Whether walls move as rigid bodies, by what the rules do to places on them; where that says nothing, by the rules
  /// themselves.
  [[nodiscard]] bool is_rigid(std::vector<NearField> const& fields, WallRoots const& roots) const {
    constexpr Index enough = 2000;
    std::vector<WallRoots::BodySample> const bodies = roots.sample_bodies(enough);
    if (!bodies.empty() && std::all_of(bodies.begin(), bodies.end(), [&](auto const& b) { return moves_rigidly(b); }))
      return true;
    return std::all_of(fields.begin(), fields.end(), [&](NearField const& field) {
      return !turns(field) || std::all_of(field.walls.begin(), field.walls.end(), [&](int wall) {
        return std::holds_alternative<RigidRule>(motion_.patch_rule(wall));
      });
    });
  }
  /// Whether a body moves rigidly, to a tenth of its largest displacement, or to a fifth where it turns by more than 30
  /// degrees: what turns far tears where it hands nothing on.
  [[nodiscard]] bool moves_rigidly(WallRoots::BodySample const& body) const {
    std::map<int, std::vector<std::size_t>> of_rule;
    for (std::size_t n = 0; n < body.places.size(); ++n) of_rule[motion_.patch[body.patches[n]].rule].push_back(n);
    std::vector<Vec3> moved = body.places;
    double largest = 0;
    for (auto const& [rule, nodes] : of_rule) {
      if (rule < 0 || !surface_.is_explicit(rule)) return false;
      std::vector<Vec3> places, u(nodes.size());
      for (std::size_t const n : nodes) places.push_back(body.places[n]);
      surface_.displacement(rule, places, u);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        moved[nodes[k]] += u[k];
        largest = std::max(largest, norm(u[k]));
      }
    }
    if (!(largest > 0)) return false;
    RigidTransform const fit = fit_rigid_transform(body.places, moved);
    auto const& r = fit.rotation.m;
    double const cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
    double const off = (cosine < std::sqrt(0.75) ? 0.2 : 0.1) * largest;
    for (std::size_t n = 0; n < moved.size(); ++n)
      if (distance(fit(body.places[n]), moved[n]) > off) return false;
    return true;
  }
  [[nodiscard]] bool ends_at_rest(ChainEnd const& end) const {
    return end.patch >= 0 && context_.kinds[end.patch] != PatchKind::wall &&
           std::holds_alternative<FixedRule>(motion_.patch_rule(end.patch));
  }
  /// Which ends of a chain lie on the edge of a near field.
  [[nodiscard]] std::array<bool, 2> near_ends(Chain const& chain) const {
    auto const is_edge = [&](ChainEnd const& end, BlockFace const& face) {
      int const c = topology_.lattice.class_of(topology_.blocks.face_entities(topology_.lattice, face).front());
      return end.known && end.patch < 0 && after_near_field_[c] != 0 && before_near_field_[c] == 0;
    };
    return {is_edge(chain.first, end_face(chain.steps.front(), 0)),
            is_edge(chain.last, end_face(chain.steps.back(), 1))};
  }
  [[nodiscard]] std::string described(RankedChain const& ranked) const {
    std::string const names = names_of_ends(mesh_, ranked.chain);
    return chain_name(mesh_, topology_, ranked.chain) + ": " + priority_.reason(ranked) +
           (names.empty() ? "" : ", " + names);
  }
  [[nodiscard]] bool outer_face_is_known(Chain const& chain) const {
    auto const faces = topology_.blocks.face_entities(topology_.lattice, end_face(chain.steps.back(), 1));
    return std::all_of(faces.begin(), faces.end(), [&](int e) { return known_(topology_.lattice.class_of(e)); });
  }
  [[nodiscard]] bool has_active_blocks() const {
    for (int b = 0; b < topology_.blocks.size(); ++b)
      if (is_active(b)) return true;
    return false;
  }
  [[nodiscard]] bool independent(std::vector<RankedChain> const& chains) const {
    IndependentChains independent(topology_, known_);
    return std::all_of(chains.begin(), chains.end(), [&](RankedChain const& c) { return independent.add(c.chain); });
  }

  enum class Ends {
    both,         ///< known, and no gap layer passed sideways
    across_gap,   ///< one known, the other on the wall that slips across a gap
    through_gap,  ///< both known
    one           ///< one known, the other on the boundary
  };
  /// All chains through active blocks with such ends, in the order of these: lines across gaps come before all that
  /// would cross them.
  std::vector<RankedChain> collect(Ends ends) {
    std::vector<RankedChain> chains;
    std::set<std::pair<int, int>> seen;
    for (int block = 0; block < topology_.blocks.size(); ++block) {
      if (!is_active(block)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        if (seen.contains({block, axis})) continue;
        std::optional<Chain> chain = find_chain(mesh_, topology_, known_, block, axis);
        if (!chain) continue;
        for (ChainStep const& step : chain->steps) seen.insert({step.block, step.to_chain.inverse().axis[0]});
        int const known_ends = int(chain->first.known) + int(chain->last.known);
        if (known_ends != (ends == Ends::both || ends == Ends::through_gap ? 2 : 1)) continue;
        if (ends == Ends::both && gaps_.is_crossed_by(*chain)) continue;
        if (ends == Ends::across_gap && !gaps_.runs_across(*chain)) continue;
        chains.push_back(priority_.rank(std::move(*chain)));
        chains.back().place = {block, axis};
      }
    }
    return chains;
  }

  [[nodiscard]] std::string unreachable() const {
    std::string text = "no chain of blocks connects known faces through";
    int listed = 0;
    for (int b = 0; b < topology_.blocks.size(); ++b) {
      if (!is_active(b)) continue;
      if (++listed <= 8) text += (listed > 1 ? ", " : " ") + block_name(mesh_, topology_, b);
    }
    if (listed > 8) text += " and " + std::to_string(listed - 8) + " more blocks";
    return text + "; prescribe the motion of more of their boundary (rule \"fixed\" is enough)";
  }

  PlanContext const& context_;
  BoundaryMotion const& surface_;
  Mesh const& mesh_;
  Topology const& topology_;
  ResolvedMotion const& motion_;
  PlanOptions const& options_;
  Plan& plan_;
  Known& known_;
  Priority& priority_;
  ChainLaws const& laws_;
  Gaps const& gaps_;
  ChainChoice choice_;
  std::vector<char> before_near_field_, after_near_field_;  ///< what was known, per entity class
};

std::string turn_note(HandedOn const& handed_on, bool given) {
  std::string number = std::to_string(handed_on.turn);
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  std::string text = "near fields turn with their walls and hand on " +
                     (handed_on.turn == 0   ? "none"
                      : handed_on.turn == 1 ? "all"
                                            : number) +
                     " of their turn";
  if (given) return text;
  if (handed_on.law == kernels::TurnLaw::square) return text + ", as chains from them end on what moves or on walls";
  return text + (handed_on.turn > 0 ? ", as they move rigidly and chains from them end at rest"
                                    : ", as they do not move rigidly and chains from them end at rest");
}

/// The nodes inside every piece that has any and is in no region. Returns the box of each piece, -1 for the others.
std::vector<int> inner_boxes(Mesh const& mesh, Topology const& topology, std::vector<kernels::VolumeBox>& boxes) {
  std::vector<int> box_of_piece;
  for (Piece const& piece : topology.lattice.pieces()) {
    Zone const& zone = mesh.zones[piece.zone];
    kernels::VolumeBox box{};
    Index3 first{};
    for (int d = 0; d < 3; ++d) {
      first[d] = piece.nodes.begin[d] + 1;
      box.n[d] = piece.nodes.extent(d) - 2;
    }
    bool const empty =
        box.n[0] <= 0 || box.n[1] <= 0 || box.n[2] <= 0 || topology.blocks.region_of(int(box_of_piece.size())) >= 0;
    box_of_piece.push_back(empty ? -1 : int(boxes.size()));
    if (empty) continue;
    box.first = zone.node(first);
    box.stride_j = zone.strides()[1];
    box.stride_k = zone.strides()[2];
    boxes.push_back(box);
  }
  return box_of_piece;
}

/// Arms that say how walls turn are so many times longer than what coordinates resolve. A deformation by a twentieth
/// turns them by a twentieth of the rest, and lines of the near field that stand beside one another must not cross for
/// that.
constexpr double resolved_arm = 256;

/// The topology with blocks that end at these planes, which become those of `limits`.
Topology bounded_topology(Mesh const& mesh, Links const& links, std::vector<CutPlane> planes, MergeLimits& limits) {
  std::sort(planes.begin(), planes.end());
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  limits.kept_planes = std::move(planes);
  return build_topology(mesh, links, limits);
}

}  // namespace

Index LineTables::n_lines() const {
  Index n = 0;
  for (kernels::Tube const& tube : tubes) n += Index(tube.n_a) * tube.n_b;
  return n;
}

PlanBasis plan_basis(Mesh const& mesh, Links const& links, BoundaryMotion const& surface, PlanOptions const& options) {
  std::vector<std::string> notes;
  std::vector<PatchKind> kinds = ranked_kinds(mesh, links, surface, options.boundary_layers, notes);
  std::vector<EndKind> ends = ranked_ends(mesh, kinds, options.volume);
  std::vector<char> const at_gap = gap_walls(mesh, links, surface, kinds);
  std::vector<NearField> fields = near_fields(mesh, links, surface, kinds, at_gap, options);
  ChainLaws laws(mesh, options.volume);
  notes.insert(notes.end(), laws.notes().begin(), laws.notes().end());
  std::vector<CutPlane> planes = near_field_limits(mesh, links, fields);
  for (CutPlane const& plane : planes_of(mesh, options.volume.cuts)) planes.push_back(plane);
  MergeLimits limits = merge_limits(mesh, surface.motion(), ends, laws, fields);
  Topology topology = bounded_topology(mesh, links, std::move(planes), limits);
  // Where near fields end that go as far as there is room shows in the blocks without them.
  if (std::vector<CutPlane> more = room_limits(mesh, topology, fields, notes); !more.empty()) {
    more.insert(more.end(), limits.kept_planes.begin(), limits.kept_planes.end());
    topology = bounded_topology(mesh, links, std::move(more), limits);
  }
  Gaps gaps(mesh, topology, surface.motion(), at_gap);
  return {mesh,
          std::move(notes),
          std::move(kinds),
          std::move(ends),
          std::move(fields),
          std::move(laws),
          std::move(limits),
          std::move(topology),
          std::move(gaps)};
}

PlannedMorph build_plan(PlanBasis const& basis, Priority& priority, PlanLines const& lines,
                        BoundaryMotion const& surface, PlanOptions const& options, ChainOrder const& first,
                        ChainOrder* next, ChainChoice choice) {
  ResolvedMotion const& motion = surface.motion();
  Mesh const& mesh = lines.mesh;
  Topology const& topology = lines.topology;
  PlannedMorph planned;
  Plan& plan = planned.plan;
  plan.notes = basis.notes;
  plan.law_knots = basis.laws.knots();
  plan.n_nodes = mesh.n_nodes();
  plan.mesh_size = topology.links.mesh_size;
  plan.notes.push_back(std::to_string(mesh.zones.size()) + " zones, " +
                       std::to_string(topology.lattice.pieces().size()) + " pieces with whole faces, " +
                       std::to_string(topology.blocks.size()) + " blocks");

  Skeleton const skeleton(mesh, topology.lattice, topology.blocks);
  plan.n_slots = skeleton.size();
  RotationTable rotations(plan.rotations);
  std::vector<int> const box_of_piece = inner_boxes(mesh, topology, plan.boxes);
  PlanContext context{priority.host(), mesh,        topology,   skeleton,     rotations,
                      box_of_piece,    basis.kinds, basis.ends, lines.lengths};
  WallRoots roots(context);
  context.roots = &roots;
  Known known(topology.lattice.n_classes());
  Scheduler scheduler(context, priority, basis.laws, basis.gaps, surface, options, plan, known, choice);
  std::vector<std::string> const& kind_order = priority.kind_order();
  planned.boundary = collect_boundary(context, surface, kind_order, known, plan);
  Known const given = known;
  if (auto poles = pole_stage(context, motion, kind_order, known, plan)) plan.stages.push_back(std::move(*poles));
  for (NearField const& field : basis.fields)
    if (turns(field)) roots.add_walls(field.walls, field.mode == BoundaryLayer::Mode::blend ? 0 : 1);
  roots.join_coincident();
  roots.find_bodies();
  // A body's centre is a place in one frame; where zones are turned into one another, each line end turns about itself.
  if (std::none_of(topology.links.all.begin(), topology.links.all.end(),
                   [](Link const& link) { return link.periodic; }))
    roots.find_centres();
  roots.turn_as_resolved(coordinate_precision(basis.mesh), resolved_arm);
  roots.mark(known);
  scheduler.near_field(near_field_chains(basis.mesh, basis.topology, known, basis.fields));
  HandedOn const handed_on = roots.nodes().empty() ? HandedOn{} : scheduler.hand_on(basis.fields, roots);
  planned.order = scheduler.volume(handed_on, first, next);
  std::vector<int> const surface_of_patch = slip_surface_numbers(mesh.patches.size(), surface, plan.surfaces);
  if (!roots.nodes().empty()) {
    roots.scale_turn(handed_on.turn);
    for (Stage& stage : plan.stages) leave_out_outer_edges_at_rest(roots, stage);
    EndWalls end_walls{surface_of_patch, {}};
    for (int p = 0; p < int(mesh.patches.size()); ++p)
      end_walls.is_given.push_back(motion.patch[p].rule >= 0 && surface.is_explicit(motion.patch[p].rule) ? 1 : 0);
    plan.turns = turn_tables(context, topology.links, roots, end_walls);
    bool const blends =
        std::none_of(roots.nodes().begin(), roots.nodes().end(), [](RootNode const& n) { return n.turn > 0; });
    if (!blends || handed_on.turn == 0) plan.notes.push_back(turn_note(handed_on, options.volume.turn.has_value()));
  }
  plan_spreads(context, motion, surface_of_patch, given, basis.gaps, plan);
  plan.skeleton_nodes = skeleton.to_nodes(rotations);
  for (int piece = 0; piece < int(topology.lattice.pieces().size()); ++piece) {
    int const region = topology.blocks.region_of(piece);
    if (region < 0) continue;
    Piece const& place = topology.lattice.pieces()[piece];
    plan.regions.push_back({place.zone, place.nodes});
    for (int& end : plan.regions.back().cells.end) --end;
    plan.region_names.push_back("region '" + mesh.patches[region].name + "'");
  }
  planned.boundary.n_boundary_nodes = Index(plan.boundary_nodes.size());
  return planned;
}

PlannedMorph make_plan(HostInstance const& host, Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                       PlanOptions const& options, ChainOrder const& first) {
  PlanBasis const basis = plan_basis(mesh, links, surface, options);
  Priority priority(host, mesh, basis.topology, options.volume, links.mesh_size);
  PlannedMorph planned =
      build_plan(basis, priority, {mesh, basis.topology, GridLengths(mesh)}, surface, options, first);
  note_loose_nodes(mesh, planned.boundary, planned.plan);
  return planned;
}

namespace {

std::string listed(std::vector<std::string> const& chains, std::size_t most) {
  std::string text;
  for (std::size_t n = 0; n < std::min(most, chains.size()); ++n) text += "  " + chains[n] + "\n";
  if (chains.size() > most) text += "  and " + std::to_string(chains.size() - most) + " more\n";
  return text;
}

std::string padded(std::string const& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// "farfield - wing 12, htail - wing 3 and 4 others": what most chains run between.
std::string most_ends(Stage const& stage) {
  std::map<std::string, int> counts;
  for (ChainPath const& path : stage.paths) {
    auto const name = [](std::string const& end) { return end.empty() ? std::string("inside") : end; };
    std::string a = name(path.ends[0]), b = name(path.ends[1]);
    if (b < a) std::swap(a, b);
    ++counts[a + " - " + b];
  }
  std::vector<std::pair<std::string, int>> ranked(counts.begin(), counts.end());
  std::stable_sort(ranked.begin(), ranked.end(), [](auto const& a, auto const& b) { return a.second > b.second; });
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t n = 0; n < std::min(most, ranked.size()); ++n)
    text += (n == 0 ? "" : ", ") + ranked[n].first + " " + std::to_string(ranked[n].second);
  int others = 0;
  for (std::size_t n = most; n < ranked.size(); ++n) others += ranked[n].second;
  return text + (others > 0 ? " and " + std::to_string(others) + " others" : "");
}

}  // namespace

std::string overview(Plan const& plan) {
  std::string text = "Overview        chains  longest    lines  what most of them run between\n";
  for (Stage const& stage : plan.stages) {
    std::size_t longest = 0;
    for (ChainPath const& path : stage.paths) longest = std::max(longest, path.blocks.size());
    std::string const name = stage.name.substr(0, 14);
    text += name + std::string(14 - name.size(), ' ') + padded(std::to_string(stage.lines.chains.size()), 8) +
            padded(std::to_string(longest), 9) + padded(std::to_string(stage.lines.n_lines()), 9) + "  " +
            most_ends(stage) + "\n";
  }
  return text;
}

std::string describe(Plan const& plan, std::size_t most_chains) {
  std::string text;
  text += std::to_string(plan.boundary_nodes.size()) + " boundary nodes with given displacement\n";
  for (Stage const& stage : plan.stages) {
    text += "stage " + stage.name + ": " + std::to_string(stage.lines.chains.size()) + " chains, " +
            std::to_string(stage.lines.n_lines()) + " grid lines" +
            (stage.sides.corrected.empty()
                 ? ""
                 : ", " + std::to_string(stage.sides.corrected.size()) + " with transfinite correction") +
            "\n";
    text += listed(stage.description, most_chains);
  }
  for (std::size_t n = 0; n < plan.spreads.size(); ++n) {
    text += "finalize " + std::to_string(n + 1) + ": " + std::to_string(plan.spreads[n].ends.size()) +
            " nodes on slip surfaces, spread along " + std::to_string(plan.spreads[n].lines.n_lines()) +
            " grid lines\n";
    text += listed(plan.spreads[n].description, most_chains);
  }
  return text;
}

}  // namespace gridmorph
