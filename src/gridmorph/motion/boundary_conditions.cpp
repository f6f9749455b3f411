#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/motion/detail/free_periodics.hpp>
#include <gridmorph/motion/detail/joint_slip.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace gridmorph {

namespace {

/// Patches whose nodes are all paired by periodic connections (SU2 markers are, always) would be fixed by default,
/// against what the connection says: those that no rule names get the rule `free` instead, after all others.
Motion with_periodic_patches(Boundary const& boundary, Motion motion, std::vector<std::string>& notes) {
  if (motion.strict) return motion;
  std::vector<std::uint8_t> named(boundary.patches().size(), 0);
  for (auto const& rule : motion.rules)
    for (auto const& selector : rule.patches) {
      if (selector == "type:periodic") continue;
      try {
        for (int const p : boundary.select(selector).patches) named[p] = 1;
      } catch (MotionError const&) {
        return motion;  // resolve() says what is wrong, with all other problems
      }
    }
  std::vector<std::uint8_t> const paired = boundary.periodic_nodes();
  std::vector<std::string> free;
  for (std::size_t p = 0; p < boundary.patches().size(); ++p) {
    auto const& nodes = boundary.surface(int(p)).nodes;
    if (named[p] != 0 || boundary.patches()[p].kind != PatchKind::other || nodes.empty()) continue;
    if (!std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return paired[n] != 0; })) continue;
    auto const& families = boundary.patches()[p].families;
    free.push_back(families.empty() ? boundary.patches()[p].name : families.front());
  }
  if (free.empty()) return motion;
  notes.push_back("patches " + quote_list(free) + ": periodic, and no rule names them; default: free");
  motion.rules.push_back({free, FreeRule{}, 0, "default of periodic patches"});
  return motion;
}

/// Whether periodic connections take a rule: resolve() says what they do with others.
bool fits_connections(Rule const& rule) {
  return std::holds_alternative<FollowRule>(rule) || std::holds_alternative<CircumferentialSlideRule>(rule) ||
         std::holds_alternative<FixedRule>(rule) || std::holds_alternative<RigidRule>(rule) ||
         std::holds_alternative<FunctionRule>(rule);
}

/// Files that list a periodic boundary twice, as patches and as a connection: a rule that names a patch there is one of
/// the connection, and so holds for both sides, whichever of them is named. Patches on both sides with different rules
/// keep these.
class RulesOfConnections {
 public:
  RulesOfConnections(Boundary const& boundary, ResolvedMotion& motion)
      : boundary_(boundary),
        connections_(boundary.connections()),
        motion_(motion),
        is_side_(boundary_.patches().size(), 0) {
    std::vector<std::uint8_t> const paired = boundary_.periodic_nodes();
    for (std::size_t p = 0; p < boundary_.patches().size(); ++p) {
      auto const& nodes = boundary_.surface(int(p)).nodes;
      is_side_[p] = !nodes.empty() && boundary_.patches()[p].kind != PatchKind::region &&
                            std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return paired[n] != 0; })
                        ? 1
                        : 0;
    }
  }

  void give() {
    auto const free = detail::free_by_default(connections_, motion_);
    give_to_connections();
    auto const left = detail::free_by_default(connections_, motion_);
    if (left == free) return;
    auto const note = [](std::vector<std::string> const& names) {
      return detail::default_note(detail::periodics, names, detail::move_as_one);
    };
    auto const said = std::find(motion_.notes.begin(), motion_.notes.end(), note(free));
    if (said == motion_.notes.end()) return;
    if (left.empty())
      motion_.notes.erase(said);
    else
      *said = note(left);
  }

 private:
  void give_to_connections() {
    std::map<int, std::set<Index>> nodes_of;  // by rule
    for (std::size_t p = 0; p < is_side_.size(); ++p) {
      Resolution const& own = motion_.patch[p];
      if (is_side_[p] == 0 || own.by_default || !fits_connections(motion_.patch_rule(int(p)))) continue;
      auto const& nodes = boundary_.surface(int(p)).nodes;
      nodes_of[own.rule].insert(nodes.begin(), nodes.end());
    }
    if (nodes_of.empty()) return;
    for (AnyConnection const& c : connections_) {
      if (!is_left(c.number)) continue;
      Sides const sides = sides_of(c.number);
      if (sides.own.empty()) continue;
      std::vector<int> rules;
      for (auto const& [rule, nodes] : nodes_of)
        if (covers(nodes, sides.own) || covers(nodes, sides.donor)) rules.push_back(rule);
      if (rules.size() != 1) continue;
      give(c.number, sides, rules.front());
    }
    give_to_halos();
    let_patches_go();
  }

  /// The nodes of a connection.
  struct Sides {
    std::vector<Index> own, donor;
  };
  [[nodiscard]] Sides sides_of(int c) const {
    Sides out;
    for (auto const& [own, donor] : boundary_.pairs(c)) {
      out.own.push_back(own);
      out.donor.push_back(donor);
    }
    return out;
  }
  [[nodiscard]] static bool covers(std::set<Index> const& nodes, std::vector<Index> const& list) {
    return std::all_of(list.begin(), list.end(), [&](Index n) { return nodes.contains(n); });
  }

  /// Whether a connection is periodic and no rule names it, not even `free`.
  [[nodiscard]] bool is_left(int c) const { return motion_.interface[c].by_default; }

  void give(int c, Sides const& sides, int rule) {
    motion_.interface[c] = {rule, false};
    held_[rule].insert(sides.own.begin(), sides.own.end());
    held_[rule].insert(sides.donor.begin(), sides.donor.end());
    given_.push_back({c, rule});
  }

  /// Connections of the same periodicity that no patch lists: rows of elements beyond the sides that belong to the
  /// passage behind, and what they are copies of. They move with the sides.
  void give_to_halos() {
    std::set<Index> of_sides;
    for (std::size_t p = 0; p < is_side_.size(); ++p)
      if (is_side_[p] != 0)
        of_sides.insert(boundary_.surface(int(p)).nodes.begin(), boundary_.surface(int(p)).nodes.end());
    auto const given = given_;
    for (AnyConnection const& c : connections_) {
      if (!is_left(c.number)) continue;
      Sides const sides = sides_of(c.number);
      auto const is_free = [&](Index n) { return !of_sides.contains(n); };
      if (sides.own.empty() || !std::all_of(sides.own.begin(), sides.own.end(), is_free) ||
          !std::all_of(sides.donor.begin(), sides.donor.end(), is_free))
        continue;
      RigidTransform const own = boundary_.transform(c.number);
      auto const alike = std::find_if(given.begin(), given.end(), [&](auto const& g) {
        RigidTransform const other = boundary_.transform(g.first);
        return are_alike(own, other, boundary_.size()) || are_alike(own, other.inverse(), boundary_.size());
      });
      if (alike != given.end()) give(c.number, sides, alike->second);
    }
  }

  /// Whether a patch has no kind that tells what it is. Thin inlets and walls, all of whose nodes lie on the edges of
  /// sides, have one.
  [[nodiscard]] bool has_no_kind(std::size_t p) const {
    return boundary_.patches()[p].kind == PatchKind::other || boundary_.patches()[p].kind == PatchKind::connection;
  }

  /// Patches all of whose nodes connections now have the rule for.
  void let_patches_go() {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < is_side_.size(); ++p) {
      Resolution& own = motion_.patch[p];
      if (is_side_[p] == 0) continue;
      auto const& nodes = boundary_.surface(int(p)).nodes;
      if (std::none_of(held_.begin(), held_.end(), [&](auto const& held) {
            return (own.rule == held.first || (own.by_default && has_no_kind(p))) && covers(held.second, nodes);
          }))
        continue;
      own.rule = int(motion_.rules.size());
      names.push_back(boundary_.patches()[p].name);
    }
    if (!names.empty()) motion_.rules.push_back({std::move(names), FreeRule{}, 0, "default of periodic patches"});
  }

  Boundary const& boundary_;
  std::vector<AnyConnection> connections_;
  ResolvedMotion& motion_;
  std::vector<std::uint8_t> is_side_;
  std::vector<std::pair<int, int>> given_;  ///< connections and the rules that they have from patches
  std::map<int, std::set<Index>> held_;     ///< nodes of connections by the rule they have from a patch
};

/// The rules of a mesh of elements.
ResolvedMotion resolve_on(Boundary const& boundary, Motion const& motion, std::vector<std::string>& notes) {
  ResolvedMotion out = resolve(boundary.names(), with_periodic_patches(boundary, motion, notes));
  RulesOfConnections(boundary, out).give();
  return out;
}

class Finder {
 public:
  Finder(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
         BoundaryFacePatches const& face_patches, NodeGraph const& graph)
      : mesh_(mesh),
        topology_(topology),
        face_patches_(face_patches),
        graph_(graph),
        size_(extent_of(host, mesh.coordinates).size()) {}

  BoundaryConditions run(Motion const& motion, std::vector<std::string> const& walls, Displacements displacements) {
    std::vector<Patch> const regions = regions_of_elements(mesh_, located(motion), out_.notes);
    auto const boundary = std::make_shared<Boundary const>(mesh_, topology_, face_patches_, size_, regions);
    patches_ = boundary->patches();
    ResolvedMotion const resolved = resolve_on(*boundary, motion, out_.notes);
    out_.notes.insert(out_.notes.end(), resolved.notes.begin(), resolved.notes.end());
    out_.motion = std::make_shared<BoundaryMotion const>(boundary, resolved);
    out_.notes.insert(out_.notes.end(), out_.motion->notes().begin(), out_.motion->notes().end());
    find_driving_patches(walls, displacements);
    find_known();
    find_slip_nodes();
    find_images();
    return std::move(out_);
  }

 private:
  /// The regions of a motion, with wakes found from their blades.
  [[nodiscard]] std::vector<InnerRegion> located(Motion const& motion) const {
    if (!have_wakes(motion.regions)) return motion.regions;
    auto const boundary = std::make_shared<Boundary const>(mesh_, topology_, face_patches_, size_);
    std::vector<std::string> notes;  // those of the rules come again
    return locate_wakes(boundary, resolve_on(*boundary, without_regions(boundary->names(), motion), notes),
                        motion.regions, notes);
  }

  Index32 owner(Index n) const { return graph_.representative[n]; }

  [[nodiscard]] ResolvedMotion const& rules() const { return out_.motion->motion(); }
  [[nodiscard]] bool is_explicit(int patch) const { return out_.motion->is_explicit(rules().patch[patch].rule); }

  /// Whether a rule could move a patch, whatever it gives now.
  [[nodiscard]] bool could_move(int p) const {
    return is_explicit(p) && !std::holds_alternative<FixedRule>(rules().patch_rule(p));
  }

  /// Whether a rule displaces any node of a patch now.
  [[nodiscard]] bool moves_now(int p) const {
    if (!could_move(p)) return false;
    if (std::holds_alternative<PrescribedRule>(rules().patch_rule(p))) return true;
    auto const& nodes = out_.nodes_of(p);
    // Most that move do so at their first node.
    for (std::size_t begin = 0, end = 1; begin < nodes.size(); begin = end, end = nodes.size()) {
      std::vector<Vec3> points, u(end - begin);
      for (std::size_t n = begin; n < end; ++n) points.push_back(mesh_.coordinates[nodes[n]]);
      out_.motion->displacement(rules().patch[p].rule, points, u);
      if (std::any_of(u.begin(), u.end(), [](Vec3 const& v) { return !(v == Vec3{}); })) return true;
    }
    return false;
  }

  void find_driving_patches(std::vector<std::string> const& walls, Displacements displacements) {
    std::vector<std::uint8_t> moves;
    for (std::size_t p = 0; p < patches_.size(); ++p)
      moves.push_back((displacements == Displacements::any ? could_move(int(p)) : moves_now(int(p))) ? 1 : 0);
    if (std::find(moves.begin(), moves.end(), 1) == moves.end())
      for (std::size_t p = 0; p < patches_.size(); ++p) moves[p] = could_move(int(p)) ? 1 : 0;
    choose_driving_patches(walls, moves);
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (moves[p] == 0 && is_wall(int(p)) && is_explicit(int(p)) &&
          !std::binary_search(out_.driving_patches.begin(), out_.driving_patches.end(), int(p)))
        out_.standing_patches.push_back(int(p));
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (is_wall(int(p)) && std::holds_alternative<SlipRule>(rules().patch_rule(int(p))))
        out_.sliding_patches.push_back(int(p));
  }

  /// Patches of no kind are walls as far as anyone knows, but for those that their rule makes the ends or sides of a
  /// blade row.
  [[nodiscard]] bool is_wall(int p) const {
    Rule const& rule = rules().patch_rule(p);
    if (std::holds_alternative<CircumferentialSlideRule>(rule) || std::holds_alternative<FollowRule>(rule))
      return false;
    PatchKind const kind = patches_[p].kind;
    return kind == PatchKind::wall || kind == PatchKind::other;
  }

  void choose_driving_patches(std::vector<std::string> const& walls, std::vector<std::uint8_t> const& moves) {
    if (!walls.empty()) {
      for (int const p : select_patches(mesh_, walls)) {
        if (!is_explicit(p))
          throw MotionError("the near field names patch " + describe_patch(mesh_, patches_[p]) +
                            " whose rule leaves its displacement to the volume; name walls with explicit rules");
        out_.driving_patches.push_back(p);
      }
      return;
    }
    for (std::size_t p = 0; p < patches_.size(); ++p)
      if (moves[p] != 0 && is_wall(int(p))) out_.driving_patches.push_back(int(p));
    if (out_.driving_patches.empty())
      throw MotionError(
          "no wall moves: every rule is fixed, slip or free, or names inflow, outflow, farfield and symmetry patches "
          "only; give "
          "a wall a rigid, formula or field rule, or name the walls of the near field");
  }

  void find_known() {
    std::vector<std::uint8_t> drives(mesh_.n_nodes(), 0);
    is_known_.assign(mesh_.n_nodes(), 0);
    auto const each_explicit = [&](auto&& visit) {
      for (std::size_t p = 0; p < patches_.size(); ++p)
        if (is_explicit(int(p))) visit(rules().patch[p].rule, int(p), -1, out_.nodes_of(int(p)));
      for (std::size_t c = 0; c < mesh_.connections.size(); ++c)
        if (int const r = rules().interface[c].rule; r >= 0 && mesh_.connections[c].periodic) {
          // On both sides: files may store a connection from one alone, and copies have to move alike.
          visit(r, -1, int(c), mesh_.connections[c].nodes);
          visit(r, -1, int(c), mesh_.connections[c].donor_nodes);
        }
    };
    each_explicit([&](int, int p, int, auto const& nodes) {
      bool const driving = p >= 0 && std::binary_search(out_.driving_patches.begin(), out_.driving_patches.end(), p);
      for (auto const n : nodes) {
        is_known_[owner(n)] = 1;
        if (driving) drives[owner(n)] = 1;
      }
    });
    std::vector<Index32> slot(mesh_.n_nodes(), -1);
    for (std::size_t n = 0; n < is_known_.size(); ++n)
      if (is_known_[n]) {
        slot[n] = Index32(out_.known.size());
        out_.known.push_back(Index32(n));
        out_.drives.push_back(drives[n]);
      }
    each_explicit([&](int r, int p, int c, auto const& nodes) {
      for (auto const n : nodes) out_.requests.requests.push_back({slot[owner(n)], Index(n), -1, r, p, c});
    });
    out_.requests.name(out_.motion->boundary().names());
    out_.requests.sort(rules().rules);
    out_.requests.n_boundary_nodes = Index(out_.known.size());
    out_.requests.defaults_yield = true;
  }

  void find_slip_nodes() {
    std::vector<std::set<Index32>> surfaces;
    place_.assign(mesh_.n_nodes(), -1);
    for (std::size_t p = 0; p < patches_.size(); ++p)
      out_.motion->each_slip_surface(int(p), [&](int surface, std::vector<Index> const& nodes) {
        for (Index const n : nodes) {
          Index32 const o = owner(n);
          if (is_known_[o]) out_.given_on_slip.push_back({slot_of(o), Index32(n), int(p), surface});
          if (place_[o] < 0) {
            place_[o] = Index32(surfaces.size());
            surfaces.emplace_back();
          }
          surfaces[place_[o]].insert(Index32(surface));
        }
      });
    for (auto const& set : surfaces) surfaces_at_.add(std::vector<Index32>(set.begin(), set.end()));
    for (std::size_t n = 0; n < place_.size(); ++n)
      if (place_[n] >= 0 && !is_known_[n]) {
        out_.slip_nodes.push_back(Index32(n));
        out_.slip_surfaces.add(surfaces_at_[place_[n]]);
      }
  }

  [[nodiscard]] Index32 slot_of(Index32 known) const {
    return Index32(std::lower_bound(out_.known.begin(), out_.known.end(), known) - out_.known.begin());
  }
  /// Numbers of the slip surfaces that a representative lies on.
  [[nodiscard]] std::span<Index32 const> surfaces_of(Index32 n) const {
    Index32 const at = place_[n];
    return at < 0 ? std::span<Index32 const>{} : surfaces_at_[at];
  }

  /// Nodes joined by free periodic connections, with the rotation from the one that carries their displacement, and
  /// what they are held on together.
  void find_images() {
    struct Link {
      Index32 to;
      std::int32_t rotation;  ///< own displacement -> that of `to`
    };
    detail::RotationNumbers rotations;
    std::map<Index32, std::vector<Link>> links;
    for (std::size_t c = 0; c < mesh_.connections.size(); ++c) {
      auto const& connection = mesh_.connections[c];
      if (!connection.periodic || rules().interface[c].rule >= 0) continue;
      std::vector<Vec3> from, to;
      for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
        from.push_back(mesh_.coordinates[connection.nodes[n]]);
        to.push_back(mesh_.coordinates[connection.donor_nodes[n]]);
      }
      if (from.empty()) continue;
      bool const turns = norm(connection.periodic->rotation_angle_rad) > 0;
      std::int32_t there = -1, back = -1;
      if (turns) {
        Mat3 const rotation = fit_periodic(*connection.periodic, from, to, size_).rotation;
        there = rotations.add(rotation);
        back = rotations.add(transpose(rotation));
      }
      for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
        Index32 const a = owner(connection.nodes[n]), b = owner(connection.donor_nodes[n]);
        if (a != b || turns) links[a].push_back({b, there});
        if (a != b) links[b].push_back({a, back});
      }
    }
    detail::JointSlipFinder joint(
        mesh_.coordinates, out_.motion->slip_surfaces(), size_, [this](Index32 n) { return surfaces_of(n); },
        rotations);
    std::map<Index32, std::int32_t> reached;  // rotation from the owner of its class
    std::vector<std::uint8_t> done(out_.known.size(), 0);
    auto const spread = [&](Index32 start) {
      if (reached.contains(start)) return;
      reached[start] = -1;
      std::vector<detail::ClassMember> members{{start, -1}};
      std::vector<Mat3> around;
      std::vector<Index32> front{start};
      while (!front.empty()) {
        Index32 const a = front.back();
        front.pop_back();
        for (Link const& link : links[a]) {
          if (auto const known = reached.find(link.to); known != reached.end()) {
            // The long way round leads back to where the node is, turned.
            if (known->second >= 0 || link.rotation >= 0 || reached[a] >= 0)
              around.push_back(transpose(rotations[known->second]) *
                               (rotations[link.rotation] * rotations[reached[a]]));
            continue;
          }
          std::int32_t const rotation = rotations.then(reached[a], link.rotation);
          reached[link.to] = rotation;
          members.push_back({link.to, rotation});
          if (!is_known_[link.to]) out_.images.push_back({link.to, start, rotation});
          front.push_back(link.to);
        }
      }
      if (!is_known_[start]) return joint.add(members, 0, around, start, out_.joint_slip);
      for (std::size_t m = 0; m < members.size(); ++m)
        if (is_known_[members[m].node]) {
          Index32 const slot = slot_of(members[m].node);
          done[slot] = 1;
          joint.add(members, m, {}, slot, out_.given_slip);
        }
    };
    // Nodes whose displacement is known pass it on; the others move by the mean of their class.
    for (auto const& [n, own] : links)
      if (is_known_[n]) spread(n);
    for (auto const& [n, own] : links) spread(n);
    for (std::size_t k = 0; k < out_.known.size(); ++k)
      if (done[k] == 0 && !surfaces_of(out_.known[k]).empty())
        joint.add({{out_.known[k], -1}}, 0, {}, Index32(k), out_.given_slip);
    std::sort(out_.images.begin(), out_.images.end(),
              [](PeriodicImage const& a, PeriodicImage const& b) { return a.node < b.node; });
    out_.rotations = rotations.all();
    out_.across_axes = std::move(joint).across_axes();
  }

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  BoundaryFacePatches const& face_patches_;
  NodeGraph const& graph_;
  double size_;
  std::vector<Patch> patches_;  ///< of the mesh without their faces, then regions
  BoundaryConditions out_;
  std::vector<std::uint8_t> is_known_;
  std::vector<Index32> place_;  ///< of each node in surfaces_at_, -1: on no slip surface
  CsrGraph surfaces_at_;
};

}  // namespace

std::vector<SlipSurface> BoundaryConditions::surfaces() const {
  std::vector<SlipSurface> out = motion->slip_surfaces();
  out.insert(out.end(), across_axes.begin(), across_axes.end());
  return out;
}

std::vector<int> row_of_nodes(Mesh const& mesh, Motion const& motion) {
  std::vector<int> out;
  std::vector<std::vector<int>> blades;
  for (MotionRule const& rule : motion.rules) {
    auto const* slide = std::get_if<CircumferentialSlideRule>(&rule.rule);
    if (slide == nullptr) continue;
    std::vector<int> of, patches;
    try {
      of = select_patches(mesh, slide->of);
      patches = select_patches(mesh, rule.patches);
    } catch (MotionError const&) {
      continue;  // resolve() says what is wrong, with all other problems
    }
    auto const known = std::find(blades.begin(), blades.end(), of);
    int const row = int(known - blades.begin()) + 1;
    if (known == blades.end()) blades.push_back(of);
    if (out.empty()) out.assign(mesh.n_nodes(), 0);
    for (int const p : patches)
      for (Index32 const n : patch_nodes(mesh.patches[p])) out[n] = row;
  }
  return out;
}

BoundaryConditions boundary_conditions(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                                       BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                                       Motion const& motion, std::vector<std::string> const& walls,
                                       Displacements displacements) {
  return Finder(host, mesh, topology, face_patches, graph).run(motion, walls, displacements);
}

std::shared_ptr<BoundaryMotion const> boundary_motion(BoundaryConditions const& boundary, Motion const& motion) {
  auto const surfaces = boundary.motion->shared_boundary();
  std::vector<std::string> said;  // with the notes of the first motion
  return std::make_shared<BoundaryMotion const>(surfaces, resolve_on(*surfaces, motion, said));
}

namespace {

std::vector<Vec3> evaluate_copies(BoundaryConditions const& boundary, BoundaryMotion const& motion) {
  std::vector<Vec3> out = evaluate(boundary.requests, motion, {});
  require_equal_copies(boundary.requests, motion, out);
  return out;
}

}  // namespace

std::vector<Vec3> evaluate(BoundaryConditions const& boundary) { return evaluate_copies(boundary, *boundary.motion); }

std::vector<Vec3> evaluate(BoundaryConditions const& boundary, Motion const& motion) {
  return evaluate_copies(boundary, boundary.motion->with(motion));
}

double largest_norm(std::vector<Vec3> const& displacement) {
  double largest = 0;
  for (Vec3 const& u : displacement) largest = std::max(largest, norm(u));
  return largest;
}

}  // namespace gridmorph
