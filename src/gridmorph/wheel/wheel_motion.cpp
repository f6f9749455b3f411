#include <gridmorph/wheel/wheel_motion.hpp>

#include <gridmorph/wheel/detail/append_notes.hpp>
#include <gridmorph/wheel/open_passage.hpp>

#include <memory>
#include <utility>

namespace gridmorph {

WheelMotion::WheelMotion(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                         std::vector<Motion> const& motions, SameRules same_rules, PlanOptions const& options,
                         std::vector<WheelRowBlades> const& blades)
    : same_rules_(std::move(same_rules)), used_(used_motions(blades)) {
  refuse_regions(motions);
  auto const open = open_rows(blades);
  auto const boundary = std::make_shared<Boundary const>(sector);

  ResolvedMotion const resolved = resolve(sector, motions[used_.front()]);
  detail::append_notes(notes_, resolved.notes);
  OpenedPassage opened = open_passage(sector, links, rows, resolved, open);
  Links const opened_links = connect(opened.mesh, options.topology);
  planned_ = make_plan({}, opened.mesh, opened_links, BoundaryMotion(opened.mesh, opened.motion), options);
  detail::append_notes(notes_, planned_.plan.notes);
  opened_ = std::move(opened.mesh);

  for (int const m : used_) {
    int const rules = same_rules_[m];
    if (rules_.contains(rules)) continue;
    auto const& surface =
        rules_.emplace(rules, BoundaryMotion(boundary, resolve(sector, motions[rules]))).first->second;
    detail::append_notes(notes_, surface.notes());
  }
  auto const shares = blade_shares(*boundary, links, rows, resolved, open, one_of_place(links, rows), planned_.boundary,
                                   planned_.plan.boundary_nodes);
  std::vector<PassageMotions::Node> nodes;
  for (std::size_t n = 0; n < shares.size(); ++n) {
    Index const node = planned_.plan.boundary_nodes[n];
    nodes.push_back({sector.coordinates[node], rows.row_of_zone[sector.zone_of(node)], shares[n]});
  }
  passages_ = PassageMotions(rows, blades, std::move(nodes), {});
  move(motions);
}

void WheelMotion::move(std::vector<Motion> const& motions) {
  std::vector<std::vector<Vec3>> values(motions.size());
  for (int const m : used_) values[m] = displacement(m, motions[m]);
  passages_.take(std::move(values));
}

std::vector<Trim> WheelMotion::trims(std::vector<Vec3> const& boundary) const {
  return gridmorph::trims(opened_, planned_.plan, planned_.boundary, rules_.at(same_rules_[used_.front()]), boundary);
}

std::vector<Vec3> WheelMotion::displacement(int m, Motion const& motion) const {
  return evaluate(opened_, planned_.boundary, rules_.at(same_rules_[m]).with(motion), planned_.plan.rotations);
}

}  // namespace gridmorph
