#include <gridmorph/wheel/element_wheel_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/detail/append_notes.hpp>
#include <gridmorph/wheel/open_passage.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

/// The sides of rows whose blades differ move as the rules say, or not at all.
void refuse_free_sides(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                       std::vector<char> const& open, NodeGraph const& graph, std::vector<Index32> const& known) {
  Problems problems;
  std::set<int> reported;
  for (PassageLink const& link : links.all) {
    if (!link.periodic || open[rows.row_of_zone[link.zone]] == 0) continue;
    bool const all = std::all_of(link.pairs.begin(), link.pairs.end(), [&](auto const& pair) {
      return std::binary_search(known.begin(), known.end(), graph.representative[std::size_t(pair[0])]);
    });
    if (!all && reported.insert(link.connection).second) problems.add(no_rule_for_side(sector, link));
  }
  problems.throw_if_any<MotionError>();
}

}  // namespace

ElementWheelMotion::ElementWheelMotion(Mesh const& sector, UnstructuredTopology const& topology,
                                       BoundaryFacePatches const& face_patches, PassageLinks const& links,
                                       WheelRows const& rows, std::vector<Motion> const& motions, SameRules same_rules,
                                       PlanOptions options, std::vector<WheelRowBlades> const& blades,
                                       WheelTimes const& times)
    : sector_(sector), same_rules_(std::move(same_rules)), used_(used_motions(blades)) {
  refuse_regions(motions);
  auto const open = open_rows(blades);
  bool const one = used_.size() == 1 && times.steps == 0;
  Motion const& first = motions[used_.front()];
  NodeGraph graph = make_node_graph(sector, topology.elements_of_nodes, row_of_nodes(sector, first));
  BoundaryConditions conditions =
      boundary_conditions(sector, topology, face_patches, graph, first, options.elements.walls,
                          one && options.elements.motion < 0 ? Displacements::of_the_rules : Displacements::any);
  refuse_free_sides(sector, links, rows, open, graph, conditions.known);

  Boundary const& boundary = conditions.motion->boundary();
  requests_ = conditions.requests;
  for (int const m : used_) {
    int const rules = same_rules_[m];
    if (rules_.contains(rules)) continue;
    auto const surface = rules == used_.front() ? conditions.motion : boundary_motion(conditions, motions[rules]);
    rules_.emplace(rules, surface);
    detail::append_notes(notes_, surface->notes());
  }
  std::vector<Index> const known(conditions.known.begin(), conditions.known.end());
  auto const shares = blade_shares(
      boundary, links, rows, conditions.motion->motion(), open,
      [&](Index n) { return Index(graph.representative[std::size_t(n)]); }, conditions.requests, known);
  std::vector<PassageMotions::Node> nodes;
  for (std::size_t n = 0; n < known.size(); ++n)
    nodes.push_back({sector.coordinates[known[n]], rows.row_of_zone[sector.zone_of(known[n])], shares[n]});
  passages_ = PassageMotions(rows, blades, std::move(nodes), values_of(motions));

  std::optional<std::vector<Vec3>> most;
  if (options.elements.motion < 0) {
    double largest = -1;
    for (int p = 0; p < passages_.n_passages(); ++p) {
      if (passages_.first_alike(p) < p) continue;
      auto displacement = passages_.boundary(p);
      double const now = largest_norm(displacement);
      if (now <= largest) continue;
      largest = now;
      most = std::move(displacement);
    }
    for (int step = 0; step < times.steps; ++step)
      for (auto const& values : values_of(times.motions(step))) largest = std::max(largest, largest_norm(values));
    if (!one) {  // what turns leave of it differs from blade to blade
      options.elements.motion = largest;
      most.reset();
    }
  }
  prepared_ = prepare({}, sector, topology, face_patches, std::move(graph), std::move(conditions), options, most);
  detail::append_notes(notes_, prepared_.notes);
}

void ElementWheelMotion::move(std::vector<Motion> const& motions) { passages_.take(values_of(motions)); }

std::vector<Vec3> ElementWheelMotion::displacement(int m, Motion const& motion) const {
  return evaluate(sector_, requests_, rules_.at(same_rules_[m])->with(motion), {});
}

std::vector<std::vector<Vec3>> ElementWheelMotion::values_of(std::vector<Motion> const& motions) const {
  std::vector<std::vector<Vec3>> values(motions.size());
  for (int const m : used_) values[m] = displacement(m, motions[m]);
  return values;
}

}  // namespace gridmorph
