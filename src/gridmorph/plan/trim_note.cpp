#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/plan/trim_note.hpp>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace gridmorph {

namespace {

/// Gathers what rules and surfaces say of one another.
class Gathering {
 public:
  Gathering(Mesh const& mesh, BoundaryRequests const& requests, BoundaryMotion const& motion,
            std::vector<Vec3> const& given)
      : mesh_(mesh),
        requests_(requests),
        motion_(motion),
        given_(given),
        deciding_(deciding_requests(mesh, requests, motion)) {
    largest_.assign(motion.motion().rules.size(), 0);
    for (std::size_t n = 0; n < given.size(); ++n)
      if (int const r = rule_of(n); r >= 0)
        largest_[std::size_t(r)] = std::max(largest_[std::size_t(r)], norm(given[n]));
  }

  /// A node whose displacement is given[slot], and that lies on a surface.
  void look(Index node, std::size_t slot, int surface, double tolerance) {
    Vec3 const u = given_[slot];
    if (u == Vec3{}) return;
    double const d =
        distance(motion_.slip_surfaces()[std::size_t(surface)].view().constrain(mesh_.coordinates[node], u), u);
    int const rule = rule_of(slot);
    if (!(d > tolerance) || rule < 0) return;
    Found& found = found_[{surface, rule}];
    found.nodes.insert(node);
    if (d <= found.most) return;
    found.most = d;
    found.where = node;
  }

  [[nodiscard]] std::vector<Trim> result() const {
    std::vector<Trim> out;
    for (auto const& [of, found] : found_) {
      auto const [surface, rule] = of;
      out.push_back({name_of(surface), motion_.motion().rules[std::size_t(rule)].where, Index(found.nodes.size()),
                     found.most, describe_node(mesh_, found.where), largest_[std::size_t(rule)]});
    }
    return out;
  }

 private:
  struct Found {
    std::unordered_set<Index> nodes;
    double most = 0;
    Index where = 0;
  };

  [[nodiscard]] int rule_of(std::size_t slot) const {
    Index const request = slot < deciding_.size() ? deciding_[slot] : -1;
    return request < 0 ? -1 : requests_.requests[std::size_t(request)].rule;
  }

  [[nodiscard]] std::string name_of(int surface) const {
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (motion_.slip_surface_of(int(p)) == surface) return describe_patch(mesh_, mesh_.patches[p]);
    return "a patch";
  }

  Mesh const& mesh_;
  BoundaryRequests const& requests_;
  BoundaryMotion const& motion_;
  std::vector<Vec3> const& given_;
  std::vector<Index> deciding_;
  std::vector<double> largest_;
  std::map<std::pair<int, int>, Found> found_;  ///< by surface and rule
};

}  // namespace

std::vector<Trim> trims(Mesh const& mesh, Plan const& plan, BoundaryRequests const& requests,
                        BoundaryMotion const& motion, std::vector<Vec3> const& boundary) {
  std::unordered_map<Index, std::size_t> slot_of;
  for (std::size_t n = 0; n < plan.boundary_nodes.size(); ++n) slot_of.emplace(plan.boundary_nodes[n], n);
  Gathering gathering(mesh, requests, motion, boundary);
  for (SpreadPass const& pass : plan.spreads)
    for (kernels::SlipEnd const& end : pass.ends) {
      auto const slot = slot_of.find(end.node);
      if (end.tolerance == 0 || slot == slot_of.end()) continue;
      for (int const s : end.surface)
        if (s >= 0) gathering.look(end.node, slot->second, s, end.tolerance);
    }
  return gathering.result();
}

std::vector<Trim> trims(BoundaryConditions const& boundary, std::vector<Vec3> const& given) {
  BoundaryMotion const& motion = *boundary.motion;
  Mesh const& mesh = motion.boundary().mesh();
  std::unordered_map<Index, std::size_t> slot_of;
  for (auto const& r : boundary.requests.requests) slot_of.emplace(r.node, std::size_t(r.boundary_node));
  Gathering gathering(mesh, boundary.requests, motion, given);
  double const size = motion.boundary().size();
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    int const s = motion.slip_surface_of(p);
    if (s < 0) continue;
    SlipSurface const& surface = motion.slip_surfaces()[std::size_t(s)];
    double const tolerance = std::max(1e-10 * size, std::min(2 * surface.baseline_deviation, 1e-6 * surface.size));
    for (Index const n : boundary.nodes_of(p))
      if (auto const slot = slot_of.find(n); slot != slot_of.end()) gathering.look(n, slot->second, s, tolerance);
  }
  return gathering.result();
}

std::string describe(Trim const& trim) {
  return "the displacement by " + trim.rule + " takes " + std::to_string(trim.nodes) +
         " nodes off the slip surface of patch " + trim.patch + ", most " + trim.where + ", by " +
         to_text(trim.most, 3) + ", " + to_text(100 * trim.share(), 3) + " % of its largest, " +
         to_text(trim.displacement, 3);
}

void refuse_undone(std::vector<Trim> const& trims, double allowed) {
  constexpr double most = 0.5;
  Problems problems;
  for (Trim const& trim : trims)
    if (trim.share() > std::max(most, allowed))
      problems.add(
          describe(trim) +
          ": slip would undo it; give that patch the rule free or a motion of its own, or move the wall along it");
  problems.throw_if_any<MotionError>();
}

}  // namespace gridmorph
