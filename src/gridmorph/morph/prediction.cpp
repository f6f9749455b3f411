#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>

namespace gridmorph {

Prediction predict(HostInstance const& host, MorphPlan const& plan, std::span<Vec3 const> boundary,
                   PredictionOptions const& options) {
  if (PlanAccess::blocks(plan) == nullptr)
    throw ConfigError(
        "gridmorph::predict: the plan is of a mesh of elements; predictions follow the grid lines of blocks. Morph it "
        "and ask measure_quality()");
  return Predictor(host, *PlanAccess::blocks(plan), options).predict(boundary);
}

}  // namespace gridmorph
