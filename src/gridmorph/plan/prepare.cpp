#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <utility>

namespace gridmorph {

namespace {

/// The regions of a motion, with wakes found from their blades.
std::vector<InnerRegion> located(Mesh& mesh, Links const& links, Motion const& motion) {
  if (!have_wakes(motion.regions)) return motion.regions;
  auto const boundary = std::make_shared<Boundary const>(mesh, links.mesh_size);
  std::vector<std::string> notes;  // those of the rules come again
  return locate_wakes(boundary, resolve(mesh, without_regions(NamedBoundary(mesh), motion)), motion.regions, notes);
}

}  // namespace

PreparedMorph prepare(HostInstance const& host, Mesh const& given, Motion const& motion, PlanOptions const& options) {
  check_coordinates(given, "gridmorph::prepare");
  if (!given.is_structured())
    throw MeshError("gridmorph::prepare: mesh '" + given.source +
                    "' has elements, which are planned with their topology (gridmorph::MorphPlan takes both kinds)");
  Stopwatch watch;
  Mesh mesh = given;
  PreparedMorph::Seconds seconds;
  Links links = connect_and_check(host, mesh, options.topology);
  add_regions(mesh, located(mesh, links, motion));
  seconds.topology = watch.lap();
  BoundaryMotion surface(std::make_shared<Boundary const>(mesh, links.mesh_size), resolve(mesh, motion));
  seconds.rules = watch.lap();
  PlannedMorph planned = make_plan(host, mesh, links, surface, options);
  seconds.plan = watch.lap();
  return {std::move(mesh), std::move(links), std::move(surface), std::move(planned), seconds, options};
}

}  // namespace gridmorph
