#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/plan_access.hpp>

namespace gridmorph {

GuardReport guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan, Coordinates& morphed) {
  if (PreparedMorph const* const blocks = PlanAccess::blocks(plan))
    return report_of(smooth_shapes(host, *blocks, mesh.handedness(), morphed));
  return relax_bad_elements(mesh.mesh(), mesh.topology(), *PlanAccess::elements(plan), morphed,
                            {.signs = mesh.signs()});
}

}  // namespace gridmorph
