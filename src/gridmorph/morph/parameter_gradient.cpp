#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/plan/boundary_size.hpp>

#include <string>

namespace gridmorph {
namespace {

constexpr char const* who = "gridmorph::parameter_gradient";

void check(MorphPlan const& plan, std::span<double const> parameters, std::span<double const> steps,
           std::span<Vec3 const> dJ_db) {
  if (steps.size() != parameters.size())
    throw ConfigError(std::string(who) + ": " + std::to_string(parameters.size()) + " parameters and " +
                      std::to_string(steps.size()) + " steps; give one for each");
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (!(steps[k] > 0))
      throw ConfigError(std::string(who) + ": the step of parameter " + std::to_string(k) + " is " +
                        std::to_string(steps[k]) + "; give a positive one");
  require_boundary_size(who, dJ_db.size(), plan.boundary_nodes().size(), "MorphPlan::boundary_nodes()");
}

}  // namespace

std::vector<double> parameter_gradient(MorphPlan const& plan, ParametricMotion const& motion,
                                       std::span<double const> parameters, std::span<double const> steps,
                                       std::span<Vec3 const> dJ_db) {
  check(plan, parameters, steps, dJ_db);
  std::vector<double> p(parameters.begin(), parameters.end()), gradient;
  for (std::size_t k = 0; k < p.size(); ++k) {
    auto const displaced = [&](double step) {
      p[k] = parameters[k] + step;
      return plan.boundary_displacement(motion(p));
    };
    std::vector<Vec3> const after = displaced(steps[k]), before = displaced(-steps[k]);
    p[k] = parameters[k];
    double sum = 0;
    for (std::size_t m = 0; m < dJ_db.size(); ++m) sum += dot(after[m] - before[m], dJ_db[m]);
    gradient.push_back(sum / (2 * steps[k]));
  }
  return gradient;
}

}  // namespace gridmorph
