#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/block_graph.hpp>
#include <gridmorph/plan/block_points.hpp>
#include <gridmorph/plan/given_slip.hpp>
#include <gridmorph/plan/guarded_elements.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <utility>

namespace gridmorph {

MorphPlan PlanAccess::of(Mesh mesh, Links links, BoundaryMotion rules, PlannedMorph planned,
                         PlanOptions const& options) {
  return of(PreparedMorph{std::move(mesh), std::move(links), std::move(rules), std::move(planned), {}, options});
}

MorphPlan PlanAccess::of(Mesh const& mesh, UnstructuredTopology const& topology,
                         BoundaryFacePatches const& face_patches, NodeGraph graph, BoundaryConditions conditions,
                         PlanOptions const& options, std::optional<std::vector<Vec3>> displacement) {
  return of(prepare({}, mesh, topology, face_patches, std::move(graph), std::move(conditions), options,
                    std::move(displacement)));
}

Mesh const* PlanAccess::patched_mesh(MorphPlan const& plan) {
  PreparedMorph const* const of = blocks(plan);
  return of != nullptr ? &of->mesh : nullptr;
}

Plan const* PlanAccess::chains(MorphPlan const& plan) {
  PreparedMorph const* const of = blocks(plan);
  return of != nullptr ? &of->plan() : nullptr;
}

std::optional<BlockGraph> PlanAccess::block_graph(MorphPlan const& plan) {
  PreparedMorph const* const of = blocks(plan);
  if (of == nullptr) return {};
  return gridmorph::block_graph(*of);
}

BlockPoints PlanAccess::block_points(MorphPlan const& plan) { return BlockPoints(*blocks(plan)); }

std::optional<GuardedElements> PlanAccess::guarded_elements(MorphPlan const& plan) {
  PreparedUnstructured const* const of = elements(plan);
  if (of == nullptr) return {};
  return GuardedElements(*of);
}

std::optional<PlannedElements> PlanAccess::planned_elements(MorphPlan const& plan) {
  PreparedUnstructured const* const of = elements(plan);
  if (of == nullptr) return {};
  return PlannedElements(*of);
}

std::vector<Vec3> PlanAccess::put_back(MorphPlan const& plan, Coordinates const& x, std::vector<Vec3> given) {
  return put_back_given(elements(plan)->plan, x, std::move(given));
}

std::vector<Trim> PlanAccess::trims(MorphPlan const& plan, std::vector<Vec3> const& boundary,
                                    BoundaryMotion const& rules) {
  if (PreparedUnstructured const* const of = elements(plan)) return gridmorph::trims(of->boundary, boundary);
  PreparedMorph const& of = *blocks(plan);
  return gridmorph::trims(of.plan(), of.planned.boundary, rules, boundary);
}

}  // namespace gridmorph
