#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace gridmorph {

namespace {

/// Patches whose nodes are all paired by periodic connections (SU2 markers are, always) would be fixed by default, against what
/// the connection says: those that no rule names get the rule `free` instead, after all others.
Motion with_periodic_patches(Boundary const& boundary, Motion motion, std::vector<std::string>& notes) {
  if (motion.strict) return motion;
  Mesh const& mesh = boundary.mesh();
  std::vector<std::uint8_t> named(mesh.patches.size(), 0);
  for (auto const& rule : motion.rules)
    for (auto const& selector : rule.patches) {
      if (selector == "type:periodic") continue;
      try {
        for (int const p : select(mesh, selector).patches) named[std::size_t(p)] = 1;
      } catch (MotionError const&) {
        return motion;  // resolve() says what is wrong, with all other problems
      }
    }
  std::vector<std::uint8_t> const paired = periodic_nodes(mesh);
  std::vector<std::string> free;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    auto const& nodes = boundary.surface(int(p)).nodes;
    if (named[p] != 0 || mesh.patches[p].kind != PatchKind::other || nodes.empty()) continue;
    if (!std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return paired[std::size_t(n)] != 0; })) continue;
    auto const& families = mesh.patches[p].families;
    free.push_back(families.empty() ? mesh.patches[p].name : families.front());
  }
  if (free.empty()) return motion;
  notes.push_back("patches " + quote_list(free) + ": periodic, and no rule names them; default: free");
  motion.rules.push_back({free, FreeRule{}, 0, "default of periodic patches"});
  return motion;
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
    patches_ = boundary->mesh().patches;
    ResolvedMotion const resolved = resolve(boundary->mesh(), with_periodic_patches(*boundary, motion, out_.notes));
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
  /// Regions, wakes found from their blades.
  [[nodiscard]] std::vector<InnerRegion> located(Motion const& motion) const {
    if (!have_wakes(motion.regions)) return motion.regions;
    auto const boundary = std::make_shared<Boundary const>(mesh_, topology_, face_patches_, size_);
    std::vector<std::string> notes;  // those of the rules come again
    Motion const rules = with_periodic_patches(*boundary, without_regions(boundary->mesh(), motion), notes);
    return locate_wakes(boundary, resolve(boundary->mesh(), rules), motion.regions, notes);
  }

  Index32 owner(Index n) const { return graph_.representative[std::size_t(n)]; }

  [[nodiscard]] ResolvedMotion const& rules() const { return out_.motion->motion(); }
  [[nodiscard]] bool is_explicit(int patch) const {
    return out_.motion->is_explicit(rules().patch[std::size_t(patch)].rule);
  }

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
      out_.motion->displacement(rules().patch[std::size_t(p)].rule, points, u);
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

  /// Patches of no kind are walls as far as anyone knows, but for those that their rule makes the ends or sides of a blade row.
  [[nodiscard]] bool is_wall(int p) const {
    Rule const& rule = rules().patch_rule(p);
    if (std::holds_alternative<CircumferentialSlideRule>(rule) || std::holds_alternative<FollowRule>(rule))
      return false;
    PatchKind const kind = patches_[std::size_t(p)].kind;
    return kind == PatchKind::wall || kind == PatchKind::other;
  }

  void choose_driving_patches(std::vector<std::string> const& walls, std::vector<std::uint8_t> const& moves) {
    if (!walls.empty()) {
      for (int const p : select_patches(mesh_, walls)) {
        if (!is_explicit(p))
          throw MotionError("the near field names patch " + describe_patch(mesh_, patches_[std::size_t(p)]) +
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
    std::vector<std::uint8_t> drives(std::size_t(mesh_.n_nodes()), 0);
    is_known_.assign(std::size_t(mesh_.n_nodes()), 0);
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
        is_known_[std::size_t(owner(n))] = 1;
        if (driving) drives[std::size_t(owner(n))] = 1;
      }
    });
    std::vector<Index32> slot(std::size_t(mesh_.n_nodes()), -1);
    for (std::size_t n = 0; n < is_known_.size(); ++n)
      if (is_known_[n]) {
        slot[n] = Index32(out_.known.size());
        out_.known.push_back(Index32(n));
        out_.drives.push_back(drives[n]);
      }
    each_explicit([&](int r, int p, int c, auto const& nodes) {
      for (auto const n : nodes) out_.requests.requests.push_back({slot[std::size_t(owner(n))], Index(n), -1, r, p, c});
    });
    out_.requests.sort(rules().rules);
    out_.requests.n_boundary_nodes = Index(out_.known.size());
    out_.requests.defaults_yield = true;
  }

  void find_slip_nodes() {
    std::vector<std::set<Index32>> surfaces;
    std::vector<Index32> place(std::size_t(mesh_.n_nodes()), -1);
    for (std::size_t p = 0; p < patches_.size(); ++p)
      out_.motion->each_slip_surface(int(p), [&](int surface, std::vector<Index> const& nodes) {
        for (Index const n : nodes) {
          Index32 const o = owner(n);
          if (is_known_[std::size_t(o)]) continue;
          if (place[std::size_t(o)] < 0) {
            place[std::size_t(o)] = Index32(surfaces.size());
            surfaces.emplace_back();
          }
          surfaces[std::size_t(place[std::size_t(o)])].insert(Index32(surface));
        }
      });
    for (std::size_t n = 0; n < place.size(); ++n)
      if (place[n] >= 0) {
        out_.slip_nodes.push_back(Index32(n));
        auto const& set = surfaces[std::size_t(place[n])];
        std::vector<Index32> const list(set.begin(), set.end());
        out_.slip_surfaces.add(list);
      }
  }

  /// Nodes joined by free periodic connections, with the rotation from the one that carries their displacement.
  void find_images() {
    struct Link {
      Index32 to;
      std::int32_t rotation;  ///< own displacement -> that of `to`
    };
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
        there = std::int32_t(out_.rotations.size());
        out_.rotations.push_back(rotation);
        back = std::int32_t(out_.rotations.size());
        out_.rotations.push_back(transpose(rotation));
      }
      for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
        Index32 const a = owner(connection.nodes[n]), b = owner(connection.donor_nodes[n]);
        if (a == b) continue;
        links[a].push_back({b, there});
        links[b].push_back({a, back});
      }
    }
    std::map<Index32, std::int32_t> reached;  // rotation from the owner of its class
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> composed;
    auto const compose = [&](std::int32_t first, std::int32_t next) {
      if (first < 0) return next;
      if (next < 0) return first;
      auto const [at, fresh] = composed.try_emplace({first, next}, std::int32_t(out_.rotations.size()));
      if (fresh) out_.rotations.push_back(out_.rotations[std::size_t(next)] * out_.rotations[std::size_t(first)]);
      return at->second;
    };
    auto const spread = [&](Index32 start) {
      if (reached.contains(start)) return;
      reached[start] = -1;
      std::vector<Index32> front{start};
      while (!front.empty()) {
        Index32 const a = front.back();
        front.pop_back();
        for (Link const& link : links[a]) {
          if (reached.contains(link.to)) continue;
          std::int32_t const rotation = compose(reached[a], link.rotation);
          reached[link.to] = rotation;
          if (!is_known_[std::size_t(link.to)]) out_.images.push_back({link.to, start, rotation});
          front.push_back(link.to);
        }
      }
    };
    // Nodes whose displacement is known pass it on; the others move by the mean of their class.
    for (auto const& [n, own] : links)
      if (is_known_[std::size_t(n)]) spread(n);
    for (auto const& [n, own] : links) spread(n);
    std::sort(out_.images.begin(), out_.images.end(),
              [](PeriodicImage const& a, PeriodicImage const& b) { return a.node < b.node; });
  }

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  BoundaryFacePatches const& face_patches_;
  NodeGraph const& graph_;
  double size_;
  std::vector<Patch> patches_;  ///< of the mesh without their faces, then regions
  BoundaryConditions out_;
  std::vector<std::uint8_t> is_known_;
};

}  // namespace

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
    if (out.empty()) out.assign(std::size_t(mesh.n_nodes()), 0);
    for (int const p : patches)
      for (Index32 const n : patch_nodes(mesh.patches[std::size_t(p)])) out[std::size_t(n)] = row;
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
  return std::make_shared<BoundaryMotion const>(
      surfaces, resolve(surfaces->mesh(), with_periodic_patches(*surfaces, motion, said)));
}

namespace {

std::vector<Vec3> evaluate_copies(BoundaryConditions const& boundary, BoundaryMotion const& motion) {
  Mesh const& mesh = boundary.motion->boundary().mesh();
  std::vector<Vec3> out = evaluate(mesh, boundary.requests, motion, {});
  require_equal_copies(mesh, boundary.requests, motion, out);
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
