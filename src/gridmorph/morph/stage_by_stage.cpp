#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/morph/stage_by_stage.hpp>

#include <vector>

namespace gridmorph {

void morph_stage_by_stage(Plan const& plan, Coordinates const& baseline, std::span<Vec3 const> boundary,
                          std::function<void(StagesDone const&, Coordinates const&)> const& visit) {
  for (StagesDone const& done : stages_of(plan)) {
    Plan const part = first_stages(plan, done);
    std::vector<Vec3> given(boundary.begin(), boundary.end());
    given.resize(part.boundary_slots.size(), Vec3{0, 0, 0});
    Coordinates positions(baseline.size());
    for (Index n = 0; n < baseline.size(); ++n) positions.set(n, baseline[n]);
    apply_on_host(MorpherAccess::of(Kokkos::DefaultHostExecutionSpace(), part, baseline), given, positions);
    visit(done, positions);
  }
}

}  // namespace gridmorph
