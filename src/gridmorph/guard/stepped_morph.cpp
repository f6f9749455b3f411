#include <gridmorph/core/error.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/motion_path.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_access.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

}  // namespace

Coordinates morph_in_steps(Mesh const& mesh, UnstructuredTopology const& topology,
                           BoundaryFacePatches const& face_patches, MorphPlan const& plan,
                           std::vector<Vec3> const& displacement, StepOptions const& options,
                           std::vector<signed char> const& signs) {
  if (options.plan.elements.background)
    throw PlanError(
        "a background mesh of your own stands still while the walls move: it serves one step alone; leave it out to "
        "morph in "
        "steps");
  auto const first = PlanAccess::guarded_elements(plan);
  if (!first)
    throw PlanError("gridmorph::morph_in_steps: the plan is of a mesh of blocks, whose motions are made in one step");
  std::vector<Vec3> const kept = PlanAccess::put_back(plan, mesh.coordinates, displacement);
  MotionPath const path(mesh.coordinates, first->graph, first->conditions, kept);
  auto const& known = first->known;
  Mesh now = mesh;
  for (int step = 1; step <= options.steps; ++step) {
    if (options.progress) options.progress(step);
    auto given = path.at(double(step) / options.steps);
    for (std::size_t k = 0; k < given.size(); ++k)
      given[k] = mesh.coordinates[known[k]] + given[k] - now.coordinates[known[k]];
    MorphPlan const step_plan =
        PlanAccess::of(now, topology, face_patches, first->graph, first->conditions, options.plan, given);
    Coordinates moved(mesh.n_nodes());
    apply_on_host(Morpher<Exec>(Exec(), step_plan, now.coordinates), given, moved);
    // Against this step, not the baseline: smoothing undoes what the motion asks for by now, and was seen to leave more
    // bad elements.
    (void)relax_bad_elements(now, topology, *PlanAccess::guarded_elements(step_plan), moved, {.signs = signs});
    now.coordinates = moved;
  }
  Coordinates moved = now.coordinates;
  // Steps round, their sum is given.
  for (std::size_t k = 0; k < known.size(); ++k) moved.set(known[k], mesh.coordinates[known[k]] + kept[k]);
  for (std::size_t k = 0; k < first->copies.size(); ++k)
    if (std::binary_search(known.begin(), known.end(), first->copied[k]))
      moved.set(first->copies[k], moved[first->copied[k]]);
  return moved;
}

Coordinates morph_in_steps(IndexedMesh const& mesh, MorphPlan const& plan, std::vector<Vec3> const& displacement,
                           StepOptions const& options) {
  return morph_in_steps(mesh.mesh(), mesh.topology(), mesh.face_patches(), plan, displacement, options, mesh.signs());
}

}  // namespace gridmorph
