#include <gridmorph/plan/guarded_elements.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph {

GuardedElements::GuardedElements(PreparedUnstructured const& prepared)
    : graph(prepared.graph),
      conditions(prepared.boundary),
      known(prepared.plan.known),
      beside_known(prepared.plan.residual_nodes),
      in_columns(prepared.plan.columns.node),
      images(prepared.plan.images),
      surfaces(prepared.plan.surfaces),
      copies(prepared.plan.copies),
      copied(prepared.plan.copied),
      middle(prepared.plan.middle),
      middle_on_boundary(prepared.plan.middle_boundary.node),
      middle_slots(prepared.plan.middle_boundary.slot),
      middle_surfaces(prepared.plan.middle_boundary.surfaces) {}

}  // namespace gridmorph
