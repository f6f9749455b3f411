#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/motion/ffd/ffd_motion.hpp>
#include <gridmorph/motion/goes_along.hpp>
#include <gridmorph/plan/boundary_size.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace gridmorph {
namespace {

constexpr char const* who_ffd = "gridmorph::ffd_gradient";

/// A plan as rules see it.
struct Asked {
  BoundaryRequests const& boundary;
  BoundaryMotion const& motion;
  std::vector<Mat3> const& rotations;
};

Asked asked_by(MorphPlan const& plan) {
  static std::vector<Mat3> const none;
  if (auto const* blocks = PlanAccess::blocks(plan))
    return {blocks->planned.boundary, blocks->surface, blocks->plan().rotations};
  auto const& boundary = PlanAccess::elements(plan)->boundary;
  return {boundary.requests, *boundary.motion, none};
}

/// Gradients of the nodes that take no displacement from a lattice of their own, and may go along with one.
class Others {
 public:
  Others(MorphPlan const& plan, ResolvedMotion const& resolved, int rule, std::vector<Vec3> dJ_db)
      : plan_(plan), rule_(std::size_t(rule)), dJ_db_(std::move(dJ_db)) {
    motion_.axis = resolved.axis;
    motion_.conformity_tolerance = resolved.conformity_tolerance;
    motion_.rules = resolved.rules;
  }

  void add(FfdRule const& rule, FfdMotion const& lattice, double step, std::vector<Vec3>& out) {
    for (int k = 0; k < rule.counts[2]; ++k)
      for (int j = 0; j < rule.counts[1]; ++j)
        for (int i = 0; i < rule.counts[0]; ++i) {
          if (lattice.is_held(i, j, k)) continue;
          std::size_t const n = rule.number(i, j, k);
          out[n] += {slope(n, {step, 0, 0}), slope(n, {0, step, 0}), slope(n, {0, 0, step})};
        }
  }

 private:
  double slope(std::size_t n, Vec3 const& step) {
    auto const displaced = [&](Vec3 const& by) {
      Motion other = motion_;
      std::get<FfdRule>(other.rules[rule_].rule).displacement[n] += by;
      return plan_.boundary_displacement(other);
    };
    std::vector<Vec3> const after = displaced(step), before = displaced(-step);
    double sum = 0;
    for (std::size_t m = 0; m < dJ_db_.size(); ++m) sum += dot(after[m] - before[m], dJ_db_[m]);
    return sum / (2 * norm(step));
  }

  MorphPlan const& plan_;
  std::size_t rule_;
  std::vector<Vec3> dJ_db_;
  Motion motion_;
};

}  // namespace

std::vector<Vec3> ffd_gradient(MorphPlan const& plan, int rule, std::span<Vec3 const> dJ_db) {
  Asked const asked = asked_by(plan);
  ResolvedMotion const& resolved = asked.motion.motion();
  auto const* ffd = rule >= 0 && std::size_t(rule) < resolved.rules.size()
                        ? std::get_if<FfdRule>(&resolved.rules[rule].rule)
                        : nullptr;
  if (ffd == nullptr)
    throw ConfigError(std::string(who_ffd) + ": rule number " + std::to_string(rule) + " of " +
                      std::to_string(resolved.rules.size()) + " is no ffd rule; give its number in Motion::rules");
  require_boundary_size(who_ffd, dJ_db.size(), std::size_t(asked.boundary.n_boundary_nodes),
                        "MorphPlan::boundary_nodes()");

  FfdMotion const& lattice = *asked.motion.lattice(rule);
  bool const alone = asked.motion.alone(rule);
  std::vector<Vec3> out(ffd->size()), left(dJ_db.size());
  bool any_left = false;
  std::vector<Index> const given_by = deciding_requests(asked.boundary, asked.motion);
  for (std::size_t m = 0; m < dJ_db.size(); ++m) {
    if (given_by[m] < 0) continue;
    auto const& request = asked.boundary.requests[given_by[m]];
    if (request.rule == rule && alone) {
      Vec3 const g = request.rotation < 0 ? dJ_db[m] : asked.rotations[request.rotation] * dJ_db[m];
      lattice.add_gradient(asked.motion.boundary().coordinates()[request.node], g, out);
    } else if (request.rule == rule || goes_along(resolved.rules[request.rule].rule)) {
      left[m] = dJ_db[m];
      any_left = any_left || !(dJ_db[m] == Vec3{});
    }
  }
  if (any_left) {
    double const size =
        distance(lattice.lattice().control_point(0, 0, 0),
                 lattice.lattice().control_point(ffd->counts[0] - 1, ffd->counts[1] - 1, ffd->counts[2] - 1));
    Others(plan, resolved, rule, std::move(left)).add(*ffd, lattice, 1e-5 * (size > 0 ? size : 1), out);
  }
  return out;
}

}  // namespace gridmorph
