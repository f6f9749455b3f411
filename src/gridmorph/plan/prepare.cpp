#include <gridmorph/plan/prepare.hpp>

#include <utility>

namespace gridmorph {

PreparedMorph prepare(Mesh& mesh, Motion const& motion, PlanOptions const& options) {
  Links links = connect_and_check(mesh, options.topology);
  ResolvedMotion resolved = resolve(mesh, motion);
  SurfaceMotion surface(mesh, resolved);
  PlannedMorph planned = make_plan(mesh, links, resolved, surface, options);
  return {std::move(links), std::move(resolved), std::move(surface), std::move(planned)};
}

}  // namespace gridmorph
