#include <gridmorph/boundary/boundary_outline.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace gridmorph {

namespace {

std::string label(MotionRule const& rule, std::size_t r) {
  return "rule " + std::to_string(r + 1) + " (" + std::string(rule_name(rule.rule)) +
         (rule.where.empty() ? "" : ", " + rule.where) + ")";
}

bool slips_on_baseline(Rule const& rule) {
  auto const* slip = std::get_if<SlipRule>(&rule);
  return slip != nullptr && slip->surface == SlipRule::Surface::baseline;
}

/// What follows from the positions of a patch's nodes alone.
ResolvedMotion by_position(ResolvedMotion motion) {
  for (auto& rule : motion.rules)
    if (slips_on_baseline(rule.rule)) rule.rule = FreeRule{};
  return motion;
}

class Finder {
 public:
  Finder(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
         NodeGraph const& graph)
      : mesh_(mesh), topology_(topology), face_patches_(face_patches), graph_(graph) {}

  BoundaryConditions run(Motion const& motion, std::vector<std::string> const& walls, Displacements displacements) {
    refuse_blade_rules(motion);
    out_.nodes_of_patch = nodes_of_patches(mesh_, topology_, face_patches_);
    out_.outline = boundary_outline(mesh_, out_.nodes_of_patch);
    out_.motion = resolve(out_.outline, with_periodic_patches(motion));
    out_.notes.insert(out_.notes.end(), out_.motion.notes.begin(), out_.motion.notes.end());
    make_surfaces();
    find_driving_patches(walls, displacements);
    find_known();
    find_slip_nodes();
    find_images();
    return std::move(out_);
  }

 private:
  Index32 owner(Index32 n) const { return graph_.representative[std::size_t(n)]; }

  /// Patches whose nodes are all paired by periodic connections (SU2 markers are, always) would be fixed by default, against what
  /// the connection says: those that no rule names get the rule `free` instead, after all others.
  Motion with_periodic_patches(Motion motion) {
    if (motion.strict) return motion;
    std::vector<std::uint8_t> named(mesh_.patches.size(), 0);
    for (auto const& rule : motion.rules)
      for (auto const& selector : rule.patches) {
        if (selector == "type:periodic") continue;
        try {
          for (int const p : select(out_.outline, selector).patches) named[std::size_t(p)] = 1;
        } catch (MotionError const&) {
          return motion;  // resolve() says what is wrong, with all other problems
        }
      }
    std::vector<std::uint8_t> const paired = periodic_nodes(mesh_);
    std::vector<std::string> free;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
      auto const& nodes = out_.nodes_of_patch[p];
      if (named[p] != 0 || mesh_.patches[p].kind != PatchKind::other || nodes.empty()) continue;
      if (!std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) { return paired[std::size_t(n)] != 0; })) continue;
      auto const& families = mesh_.patches[p].families;
      free.push_back(families.empty() ? mesh_.patches[p].name : families.front());
    }
    if (free.empty()) return motion;
    out_.notes.push_back("patches " + quote_list(free) + ": periodic, and no rule names them; default: free");
    motion.rules.push_back({free, FreeRule{}, 0, "default of periodic patches"});
    return motion;
  }

  static void refuse_blade_rules(Motion const& motion) {
    Problems problems;
    for (std::size_t r = 0; r < motion.rules.size(); ++r) {
      Rule const& rule = motion.rules[r].rule;
      if (std::holds_alternative<SectionsRule>(rule) || std::holds_alternative<CircumferentialSlideRule>(rule) ||
          std::holds_alternative<FollowRule>(rule))
        problems.add(
            label(motion.rules[r], r) +
            " needs the structured surface of a blade, and this mesh is unstructured; give the displacement by "
            "rigid, formula or field");
    }
    problems.throw_if_any<MotionError>();
  }

  /// Slip surfaces from the positions of the patches' nodes; those that are the patch itself need its faces.
  void make_surfaces() {
    std::vector<std::uint8_t> targeted;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      targeted.push_back(std::holds_alternative<TargetRule>(out_.motion.patch_rule(int(p))) ? 1 : 0);
    out_.target_faces = patch_faces(mesh_, topology_, face_patches_, out_.nodes_of_patch, targeted);
    out_.surface = std::make_shared<SurfaceMotion const>(out_.outline, by_position(out_.motion), &out_.target_faces);
    out_.notes.insert(out_.notes.end(), out_.surface->notes().begin(), out_.surface->notes().end());
    surface_of_patch_.assign(mesh_.patches.size(), -1);
    std::map<int, int> seen;  // numbers of SurfaceMotion: nothing else tells surfaces apart for sure
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
      int const number = out_.surface->slip_surface_number(int(p));
      if (number < 0) continue;
      auto const [at, fresh] = seen.try_emplace(number, int(out_.surfaces.size()));
      if (fresh) out_.surfaces.push_back(*out_.surface->slip_surface(int(p)));
      surface_of_patch_[p] = at->second;
    }
    for (std::size_t r = 0; r < out_.motion.rules.size(); ++r)
      if (slips_on_baseline(out_.motion.rules[r].rule)) baseline_surface(int(r));
  }

  void baseline_surface(int r) {
    MotionRule const& rule = out_.motion.rules[std::size_t(r)];
    std::string const who = label(rule, std::size_t(r));
    if (mesh_.dimension == 2)
      throw MotionError(who + ": the boundary of a 2-D mesh has no facets to slide on; give surface = \"plane\"");
    FacetList list;
    std::map<Index32, std::int32_t> number;
    for (Index f = 0; f < topology_.boundary.size(); ++f) {
      int const p = face_patches_.patch[std::size_t(f)];
      if (p < 0 || out_.motion.patch[std::size_t(p)].rule != r) continue;
      auto const face = topology_.boundary.nodes[f];
      std::vector<std::int32_t> corners;
      for (Index32 const n : face) {
        auto const [at, fresh] = number.try_emplace(owner(n), std::int32_t(list.points.size()));
        if (fresh) list.points.push_back(mesh_.coordinates[owner(n)]);
        corners.push_back(at->second);
      }
      // Faces of polyhedra with more corners: a fan.
      if (corners.size() <= 4) {
        list.facets.push_back({corners[0], corners[1], corners[2], corners.size() == 4 ? corners[3] : -1});
      } else {
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
          list.facets.push_back({corners[0], corners[k], corners[k + 1], -1});
      }
    }
    if (list.facets.empty()) throw MotionError(who + ": its patches have no faces; give another rule");
    SlipSurface surface;
    PlaneFit const fit = fit_plane(list.points);
    double const flat = 1e-13 * (norm(fit.origin) + fit.extent);
    if (fit.determined && fit.deviation <= flat) {
      surface.kind = SlipKind::plane;
      surface.origin = fit.origin;
      surface.direction = fit.normal;
      surface.baseline_deviation = fit.deviation;
    } else {
      try {
        surface.kind = SlipKind::facets;
        surface.facets =
            FacetSurface::from_facets(list, {.crease_angle_rad = std::get<SlipRule>(rule.rule).crease_angle_rad});
      } catch (MotionError const& e) {
        throw MotionError(who + ": " + e.what());
      }
      surface.origin = surface.facets.boxes.front().low;
      for (Vec3 const& p : list.points)
        surface.baseline_deviation = std::max(surface.baseline_deviation, surface.facets.closest_point(p).distance);
      out_.notes.push_back(who + ": its own surface, smooth through " + std::to_string(surface.facets.facets.size()) +
                           " facets; nodes are within " + to_text(surface.baseline_deviation, 6) + " of it");
    }
    for (Vec3 const& p : list.points) surface.size = std::max(surface.size, distance(p, surface.origin));
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (out_.motion.patch[p].rule == r) surface_of_patch_[p] = int(out_.surfaces.size());
    out_.surfaces.push_back(std::move(surface));
  }

  /// Whether a rule could move a patch, whatever it gives now.
  [[nodiscard]] bool could_move(int p) const {
    int const r = out_.motion.patch[std::size_t(p)].rule;
    return out_.surface->is_explicit(r) && !std::holds_alternative<FixedRule>(out_.motion.rules[std::size_t(r)].rule);
  }

  /// Whether a rule displaces any node of a patch now.
  [[nodiscard]] bool moves_now(int p) const {
    if (!could_move(p)) return false;
    auto const& nodes = out_.nodes_of_patch[std::size_t(p)];
    // Most that move do so at their first node.
    for (std::size_t begin = 0, end = 1; begin < nodes.size(); begin = end, end = nodes.size()) {
      std::vector<Vec3> points, u(end - begin);
      for (std::size_t n = begin; n < end; ++n) points.push_back(mesh_.coordinates[nodes[n]]);
      out_.surface->displacement(out_.motion.patch[std::size_t(p)].rule, points, u);
      if (std::any_of(u.begin(), u.end(), [](Vec3 const& v) { return !(v == Vec3{}); })) return true;
    }
    return false;
  }

  void find_driving_patches(std::vector<std::string> const& walls, Displacements displacements) {
    std::vector<std::uint8_t> moves;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      moves.push_back((displacements == Displacements::any ? could_move(int(p)) : moves_now(int(p))) ? 1 : 0);
    if (std::find(moves.begin(), moves.end(), 1) == moves.end())
      for (std::size_t p = 0; p < mesh_.patches.size(); ++p) moves[p] = could_move(int(p)) ? 1 : 0;
    choose_driving_patches(walls, moves);
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (moves[p] == 0 && is_wall(int(p)) && out_.surface->is_explicit(out_.motion.patch[p].rule) &&
          !std::binary_search(out_.driving_patches.begin(), out_.driving_patches.end(), int(p)))
        out_.standing_patches.push_back(int(p));
  }

  /// Patches of no kind are walls as far as anyone knows.
  [[nodiscard]] bool is_wall(int p) const {
    PatchKind const kind = mesh_.patches[std::size_t(p)].kind;
    return kind == PatchKind::wall || kind == PatchKind::other;
  }

  void choose_driving_patches(std::vector<std::string> const& walls, std::vector<std::uint8_t> const& moves) {
    if (!walls.empty()) {
      for (int const p : select_patches(out_.outline, walls)) {
        if (!out_.surface->is_explicit(out_.motion.patch[std::size_t(p)].rule))
          throw MotionError("the near field names patch " + describe_patch(mesh_, mesh_.patches[std::size_t(p)]) +
                            " whose rule leaves its displacement to the volume; name walls with explicit rules");
        out_.driving_patches.push_back(p);
      }
      return;
    }
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
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
      for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
        if (int const r = out_.motion.patch[p].rule; out_.surface->is_explicit(r))
          visit(r, int(p), -1, out_.nodes_of_patch[p]);
      for (std::size_t c = 0; c < mesh_.connections.size(); ++c)
        if (int const r = out_.motion.interface[c].rule; r >= 0 && mesh_.connections[c].periodic)
          visit(r, -1, int(c), mesh_.connections[c].nodes);
    };
    each_explicit([&](int, int p, int, std::vector<Index32> const& nodes) {
      bool const driving = p >= 0 && std::binary_search(out_.driving_patches.begin(), out_.driving_patches.end(), p);
      for (Index32 const n : nodes) {
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
    each_explicit([&](int r, int p, int c, std::vector<Index32> const& nodes) {
      for (Index32 const n : nodes) out_.requests.push_back({slot[std::size_t(owner(n))], n, r, p, c});
    });
    std::stable_sort(out_.requests.begin(), out_.requests.end(), [&](auto const& a, auto const& b) {
      return std::pair(out_.motion.rules[std::size_t(a.rule)].rank, a.rule) <
             std::pair(out_.motion.rules[std::size_t(b.rule)].rank, b.rule);
    });
  }

  void find_slip_nodes() {
    std::vector<std::set<Index32>> surfaces;
    std::vector<Index32> place(std::size_t(mesh_.n_nodes()), -1);
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
      if (surface_of_patch_[p] < 0) continue;
      for (Index32 const n : out_.nodes_of_patch[p]) {
        Index32 const o = owner(n);
        if (is_known_[std::size_t(o)]) continue;
        if (place[std::size_t(o)] < 0) {
          place[std::size_t(o)] = Index32(surfaces.size());
          surfaces.emplace_back();
        }
        surfaces[std::size_t(place[std::size_t(o)])].insert(Index32(surface_of_patch_[p]));
      }
    }
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
      if (!connection.periodic || out_.motion.interface[c].rule >= 0) continue;
      std::vector<Vec3> from, to;
      for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
        from.push_back(mesh_.coordinates[connection.nodes[n]]);
        to.push_back(mesh_.coordinates[connection.donor_nodes[n]]);
      }
      if (from.empty()) continue;
      bool const turns = norm(connection.periodic->rotation_angle_rad) > 0;
      std::int32_t there = -1, back = -1;
      if (turns) {
        Mat3 const rotation = fit_periodic(*connection.periodic, from, to, mesh_.size()).rotation;
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
  BoundaryConditions out_;
  std::vector<int> surface_of_patch_;
  std::vector<std::uint8_t> is_known_;
};

std::string requester(Mesh const& mesh, BoundaryConditions::Request const& r) {
  return r.patch >= 0 ? describe_patch(mesh, mesh.patches[std::size_t(r.patch)])
                      : "'" + mesh.connections[std::size_t(r.interface)].name + "' (periodic)";
}

std::vector<Vec3> values_of(Mesh const& mesh, BoundaryConditions const& boundary, SurfaceMotion const& surface);

}  // namespace

BoundaryConditions boundary_conditions(Mesh const& mesh, UnstructuredTopology const& topology,
                                       BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                                       Motion const& motion, std::vector<std::string> const& walls,
                                       Displacements displacements) {
  return Finder(mesh, topology, face_patches, graph).run(motion, walls, displacements);
}

std::vector<Vec3> evaluate(Mesh const& mesh, BoundaryConditions const& boundary) {
  return values_of(mesh, boundary, *boundary.surface);
}

std::vector<Vec3> evaluate(Mesh const& mesh, BoundaryConditions const& boundary, Motion const& motion) {
  ResolvedMotion now = boundary.motion;
  for (std::size_t r = 0; r < motion.rules.size(); ++r) now.rules[r].rule = motion.rules[r].rule;
  return values_of(mesh, boundary, SurfaceMotion(boundary.outline, by_position(now), &boundary.target_faces));
}

namespace {

std::vector<Vec3> values_of(Mesh const& mesh, BoundaryConditions const& boundary, SurfaceMotion const& surface) {
  auto const& requests = boundary.requests;
  std::vector<Vec3> values(boundary.known.size());
  std::vector<Index> given_by(boundary.known.size(), -1);
  struct Conflict {
    double size = 0;
    Index first = 0, second = 0, count = 0;
    Vec3 a, b;
  };
  std::map<std::pair<std::string, std::string>, Conflict> conflicts;
  double const tolerance = boundary.motion.conformity_tolerance * mesh.size();
  auto const by_default = [&](BoundaryConditions::Request const& q) {
    return q.patch >= 0 && boundary.motion.patch[std::size_t(q.patch)].by_default;
  };
  for (std::size_t begin = 0, end = 0; begin < requests.size(); begin = end) {
    end = begin;
    while (end < requests.size() && requests[end].rule == requests[begin].rule) ++end;
    std::vector<Vec3> points(end - begin), u(end - begin);
    for (std::size_t n = begin; n < end; ++n) points[n - begin] = mesh.coordinates[requests[n].node];
    surface.displacement(requests[begin].rule, points, u);
    for (std::size_t n = begin; n < end; ++n) {
      auto const& r = requests[n];
      std::size_t const slot = std::size_t(r.slot);
      if (given_by[slot] < 0) {
        given_by[slot] = Index(n);
        values[slot] = u[n - begin];
        continue;
      }
      auto const& first = requests[std::size_t(given_by[slot])];
      // Where zones touch without a connection, the side that a rule names has the say.
      if (mesh.zone_of(first.node) != mesh.zone_of(r.node) && by_default(first) != by_default(r)) {
        if (by_default(first)) {
          given_by[slot] = Index(n);
          values[slot] = u[n - begin];
        }
        continue;
      }
      if (boundary.motion.rules[std::size_t(first.rule)].rank < boundary.motion.rules[std::size_t(r.rule)].rank)
        continue;
      double const gap = distance(values[slot], u[n - begin]);
      if (gap <= tolerance) continue;
      Conflict& c = conflicts[{requester(mesh, first), requester(mesh, r)}];
      ++c.count;
      if (gap > c.size) c = {gap, given_by[slot], Index(n), c.count, values[slot], u[n - begin]};
    }
  }
  Problems problems;
  for (auto const& [who, c] : conflicts) {
    auto const& first = requests[std::size_t(c.first)];
    auto const& second = requests[std::size_t(c.second)];
    problems.add("patches " + who.first + " and " + who.second + " disagree on " + std::to_string(c.count) +
                 " common nodes, most at " + describe_node(mesh, first.node) + ": " + to_text(c.a, 6) + " from " +
                 boundary.motion.rules[std::size_t(first.rule)].where + ", " + to_text(c.b, 6) + " from " +
                 boundary.motion.rules[std::size_t(second.rule)].where + ", apart by " + to_text(c.size, 6) +
                 "; make the two motions agree there, let one of them slip, or give the rules different ranks");
  }
  problems.throw_if_any<MotionError>();
  return values;
}

}  // namespace

}  // namespace gridmorph
