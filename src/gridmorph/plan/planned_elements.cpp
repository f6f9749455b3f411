#include <gridmorph/plan/planned_elements.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph {

namespace {

PlannedPart planned_part(UnstructuredReport const& report, UnstructuredPlan const& plan) {
  PlannedPart out{report};
  if (plan.background) out.background = &*plan.background;
  out.n_nodes = plan.n_nodes;
  out.has_moving_walls = !plan.driving.empty();
  return out;
}

}  // namespace

PlannedElements::PlannedElements(PreparedUnstructured const& prepared)
    : whole(planned_part(prepared.report, prepared.plan)), axes(prepared.plan.axes) {
  for (std::size_t n = 0; n < prepared.plan.parts.size(); ++n) {
    PartPlan const& part = prepared.plan.parts[n];
    parts.push_back(planned_part(prepared.part_reports[n], *part.plan));
    parts.back().has_common_motion = part.common.has_value();
    parts.back().number = n;
  }
}

}  // namespace gridmorph
