#include <gridmorph/app/clearances.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

std::vector<Vec3> places_of_nodes(Coordinates const& x, std::vector<Index> const& nodes) {
  std::vector<Vec3> at;
  for (Index const n : nodes) at.push_back(x[n]);
  return at;
}

std::vector<Index> each_once(std::vector<Index> nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

Clearances::Clearances(CaseFile const& case_file, Coordinates const& baseline, NodesOf nodes_of)
    : case_file_(case_file), baseline_(baseline), nodes_of_(std::move(nodes_of)) {
  auto const& rules = case_file_.motion.rules;
  for (ClearanceCase const& one : case_file_.clearances) {
    auto wall = each_once(nodes_of_(one.walls));
    auto const blade = each_once(nodes_of_(one.tips));
    ClearanceWall before(case_file_.motion.axis, places_of_nodes(baseline_, wall));
    // Nodes slide on a wall that slips, and those of a blade may be off it: the wall itself stays.
    int const r = rule_of(wall);
    bool const moves = r >= 0 && (case_file_.timed[std::size_t(r)].at ||
                                  std::holds_alternative<AttachedRule>(rules[std::size_t(r)].rule));
    auto const blade_places = places_of_nodes(baseline_, blade);
    double side = 0;
    for (Vec3 const& node : blade_places) side += before.distance(node);
    std::vector<Index> tip;
    for (std::size_t const n : tip_nodes(before, blade_places, one.rim)) tip.push_back(blade[n]);
    tips_.push_back({one.name, std::move(wall), std::move(tip), moves, side < 0 ? -1.0 : 1.0, std::move(before)});
  }
}

int Clearances::rule_of(std::span<Index const> nodes) const {
  auto const& rules = case_file_.motion.rules;
  for (std::size_t r = 0; r < rules.size(); ++r) {
    std::vector<Index> named;
    try {
      named = nodes_of_(rules[r].patches);
    } catch (MotionError const&) {  // it names interfaces alone
      continue;
    }
    std::sort(named.begin(), named.end());
    if (std::includes(named.begin(), named.end(), nodes.begin(), nodes.end())) return int(r);
  }
  return -1;
}

TipClearance Clearances::of(std::size_t t, Coordinates const& morphed, ByRule const& by_rule) const {
  Tip const& tip = tips_[t];
  ClearanceWall const after =
      tip.wall_moves ? ClearanceWall(case_file_.motion.axis, places_of_nodes(morphed, tip.wall)) : tip.before;
  auto at = places_of_nodes(baseline_, tip.nodes);
  TipClearance found{tip.name,
                     tip.nodes.size(),
                     tip.before.of(at, tip.outwards),
                     {},
                     after.of(places_of_nodes(morphed, tip.nodes), tip.outwards),
                     std::max(tip.before.scatter(), after.scatter())};
  std::vector<Vec3> u(at.size());
  if (!by_rule(tip.nodes, u)) return found;
  for (std::size_t n = 0; n < at.size(); ++n) at[n] += u[n];
  found.by_rule = after.of(at, tip.outwards);
  return found;
}

}  // namespace gridmorph::cli
