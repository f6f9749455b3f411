#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/plan_access.hpp>

namespace gridmorph {

GuardReport guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan, Coordinates& morphed) {
  if (auto const elements = PlanAccess::guarded_elements(plan))
    return relax_bad_elements(mesh.mesh(), mesh.topology(), *elements, morphed, {.signs = mesh.signs()});
  return report_of(smooth_shapes(host, mesh, plan, morphed));
}

}  // namespace gridmorph
