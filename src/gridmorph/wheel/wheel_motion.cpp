#include <gridmorph/wheel/wheel_motion.hpp>

#include <gridmorph/wheel/detail/append_notes.hpp>
#include <gridmorph/wheel/open_passage.hpp>

#include <memory>
#include <utility>

namespace gridmorph {

WheelMotion::WheelMotion(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                         std::vector<Motion> const& motions, PlanOptions const& options,
                         std::vector<WheelRowBlades> const& blades) {
  refuse_regions(motions);
  auto const open = open_rows(blades);
  auto const used = used_motions(blades);
  auto const boundary = std::make_shared<Boundary const>(sector);

  ResolvedMotion const resolved = resolve(sector, motions[used.front()]);
  detail::append_notes(notes_, resolved.notes);
  OpenedPassage const opened = open_passage(sector, links, rows, resolved, open);
  Links const opened_links = connect(opened.mesh, options.topology);
  planned_ = make_plan({}, opened.mesh, opened_links, BoundaryMotion(opened.mesh, opened.motion), options);
  detail::append_notes(notes_, planned_.plan.notes);

  std::vector<std::vector<Vec3>> values(motions.size());
  for (int const m : used) {
    BoundaryMotion const surface(boundary, resolve(sector, motions[m]));
    detail::append_notes(notes_, surface.notes());
    values[m] = evaluate(opened.mesh, planned_.boundary, surface, planned_.plan.rotations);
  }
  auto const shares = blade_shares(*boundary, links, rows, resolved, open, one_of_place(links, rows), planned_.boundary,
                                   planned_.plan.boundary_nodes);
  std::vector<PassageMotions::Node> nodes;
  for (std::size_t n = 0; n < shares.size(); ++n) {
    Index const node = planned_.plan.boundary_nodes[n];
    nodes.push_back({sector.coordinates[node], rows.row_of_zone[sector.zone_of(node)], shares[n]});
  }
  passages_ = PassageMotions(motions.front().axis, blades, std::move(nodes), std::move(values));
}

}  // namespace gridmorph
