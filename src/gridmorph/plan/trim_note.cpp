#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/goes_along.hpp>
#include <gridmorph/plan/blocks/spread_plan.hpp>
#include <gridmorph/plan/trim_note.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

namespace gridmorph {

namespace {

/// Gathers what rules and surfaces say of one another.
class Gathering {
 public:
  Gathering(BoundaryRequests const& requests, BoundaryMotion const& motion, std::vector<Vec3> const& given)
      : boundary_(motion.boundary()),
        requests_(requests),
        rules_(motion.motion().rules),
        given_(given),
        deciding_(deciding_requests(requests, motion)),
        largest_(rules_.size(), 0) {
    for (std::size_t n = 0; n < given.size(); ++n)
      if (int const r = rule_of(n); r >= 0) largest_[r] = std::max(largest_[r], norm(given[n]));
  }

  /// A node whose displacement is given[slot], and that lies on the surface of a patch.
  void look(Index node, std::size_t slot, int patch, SlipSurface const& surface, double tolerance) {
    Vec3 const u = given_[slot];
    int const rule = rule_of(slot);
    if (u == Vec3{} || rule < 0) return;
    double const d = distance(surface.view().constrain(boundary_.coordinates()[node], u), u);
    if (!(d > tolerance)) return;
    Found& found = found_[{patch, rule}];
    found.nodes.insert(node);
    if (d <= found.most) return;
    found.most = d;
    found.where = node;
  }

  [[nodiscard]] std::vector<Trim> result(std::string const& outcome) const {
    std::vector<Trim> out;
    for (auto const& [of, found] : found_) {
      auto const [patch, rule] = of;
      out.push_back({boundary_.describe_patch(patch), rules_[rule].where, Index(found.nodes.size()), found.most,
                     boundary_.describe_node(found.where), largest_[rule], outcome, boundary_.size()});
    }
    return out;
  }

 private:
  struct Found {
    std::unordered_set<Index> nodes;
    double most = 0;
    Index where = 0;
  };

  /// The rule that gives a node a displacement of its own; -1 where none does: what goes along with walls asks for
  /// nothing itself.
  [[nodiscard]] int rule_of(std::size_t slot) const {
    Index const request = slot < deciding_.size() ? deciding_[slot] : -1;
    int const rule = request < 0 ? -1 : requests_.requests[request].rule;
    return rule >= 0 && goes_along(rules_[rule].rule) ? -1 : rule;
  }

  Boundary const& boundary_;
  BoundaryRequests const& requests_;
  std::vector<MotionRule> const& rules_;
  std::vector<Vec3> const& given_;
  std::vector<Index> deciding_;
  std::vector<double> largest_;                 ///< per rule
  std::map<std::pair<int, int>, Found> found_;  ///< by patch and rule
};

/// The first patch that slips on each surface of a plan of blocks, as slip_surface_numbers() puts these in order.
/// Passages of wheels have more patches, which do not slip.
std::vector<int> patches_of_surfaces(BoundaryMotion const& motion) {
  std::vector<int> out;
  std::set<int> known;
  for (int p = 0; p < int(motion.boundary().patches().size()); ++p)
    if (int const s = motion.slip_surface_of(p); s >= 0 && known.insert(s).second) out.push_back(p);
  return out;
}

}  // namespace

std::vector<Trim> trims(Plan const& plan, BoundaryRequests const& requests, BoundaryMotion const& motion,
                        std::vector<Vec3> const& boundary) {
  std::vector<Index> number(plan.n_slots, -1);  // of the boundary node in each slot of the skeleton
  for (std::size_t n = 0; n < plan.boundary_slots.size(); ++n) number[plan.boundary_slots[n]] = Index(n);
  std::vector<int> const patch_of = patches_of_surfaces(motion);
  Gathering gathering(requests, motion, boundary);
  for (SpreadPass const& pass : plan.spreads)
    for (kernels::SlipEnd const& end : pass.ends) {
      if (end.tolerance == 0) continue;
      Index const n = number[end.slot];
      if (n < 0 || plan.boundary_nodes[n] != end.node) continue;  // of a copy the owner tells
      for (int const s : end.surface)
        if (s >= 0) gathering.look(end.node, std::size_t(n), patch_of[s], plan.surfaces[s], end.tolerance);
    }
  return gathering.result("they are put back, and the correction is spread along the span");
}

std::vector<Trim> trims(BoundaryConditions const& boundary, std::vector<Vec3> const& given) {
  BoundaryMotion const& motion = *boundary.motion;
  Gathering gathering(boundary.requests, motion, given);
  double const size = motion.boundary().size();
  for (auto const& at : boundary.given_on_slip) {
    SlipSurface const& surface = motion.slip_surfaces()[at.surface];
    gathering.look(at.node, std::size_t(at.slot), at.patch, surface, given_tolerance(surface, size));
  }
  return gathering.result("they are put back");
}

std::string describe(Trim const& trim) {
  return "the displacement by " + trim.rule + " takes " + std::to_string(trim.nodes) +
         " nodes off the slip surface of patch " + trim.patch + ", most " + trim.where + ", by " +
         to_text(trim.most, 3) + ", " + to_text(100 * trim.share(), 3) + " % of its largest, " +
         to_text(trim.displacement, 3) + "; " + trim.outcome;
}

void refuse_undone(std::vector<Trim> const& trims, double allowed) {
  constexpr double most = 0.5;
  Problems problems;
  for (Trim const& trim : trims)
    if (trim.share() > std::max(most, allowed))
      problems.add(describe(trim) + ". " +
                   (trim.displacement > trim.mesh_size
                        ? "The whole mesh is no larger than " + to_text(trim.mesh_size, 3) +
                              ": displacements may be in another unit"
                        : "A patch that slips does not go along: give it the rule free or a motion of its own, or move "
                          "the wall along it"));
  problems.throw_if_any<MotionError>();
}

}  // namespace gridmorph
