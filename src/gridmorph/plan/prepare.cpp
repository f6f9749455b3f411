#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <utility>

namespace gridmorph {

PreparedMorph prepare(HostInstance const& host, Mesh const& given, Motion const& motion, PlanOptions const& options) {
  check_coordinates(given, "gridmorph::prepare");
  if (!given.is_structured())
    throw MeshError("gridmorph::prepare: mesh '" + given.source +
                    "' has elements, which are planned with their topology (gridmorph::MorphPlan takes both kinds)");
  Stopwatch watch;
  Mesh mesh = given;
  PreparedMorph::Seconds seconds;
  Links links = connect_and_check(host, mesh, options.topology);
  add_regions(mesh, motion.regions);
  seconds.topology = watch.lap();
  BoundaryMotion surface(std::make_shared<Boundary const>(mesh, links.mesh_size), resolve(mesh, motion));
  seconds.rules = watch.lap();
  PlannedMorph planned = make_plan(host, mesh, links, surface, options);
  seconds.plan = watch.lap();
  return {std::move(mesh), std::move(links), std::move(surface), std::move(planned), seconds, options};
}

}  // namespace gridmorph
