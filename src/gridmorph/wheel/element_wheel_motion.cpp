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
                                       WheelRows const& rows, std::vector<Motion> const& motions, PlanOptions options,
                                       std::vector<WheelRowBlades> const& blades) {
  refuse_regions(motions);
  auto const open = open_rows(blades);
  auto const used = used_motions(blades);
  bool const one = used.size() == 1;
  Motion const& first = motions[used.front()];
  NodeGraph graph = make_node_graph(sector, topology.elements_of_nodes, row_of_nodes(sector, first));
  BoundaryConditions conditions =
      boundary_conditions(sector, topology, face_patches, graph, first, options.elements.walls,
                          one && options.elements.motion < 0 ? Displacements::of_the_rules : Displacements::any);
  refuse_free_sides(sector, links, rows, open, graph, conditions.known);

  Boundary const& boundary = conditions.motion->boundary();
  std::vector<std::vector<Vec3>> values(motions.size());
  for (int const m : used) {
    auto const surface = m == used.front() ? conditions.motion : boundary_motion(conditions, motions[m]);
    detail::append_notes(notes_, surface->notes());
    values[m] = evaluate(sector, conditions.requests, *surface, {});
  }
  std::vector<Index> const known(conditions.known.begin(), conditions.known.end());
  auto const shares = blade_shares(
      boundary, links, rows, conditions.motion->motion(), open,
      [&](Index n) { return Index(graph.representative[std::size_t(n)]); }, conditions.requests, known);
  std::vector<PassageMotions::Node> nodes;
  for (std::size_t n = 0; n < known.size(); ++n)
    nodes.push_back({sector.coordinates[known[n]], rows.row_of_zone[sector.zone_of(known[n])], shares[n]});
  passages_ = PassageMotions(first.axis, blades, std::move(nodes), std::move(values));

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
    if (!one) {  // what turns leave of it differs from blade to blade
      options.elements.motion = largest;
      most.reset();
    }
  }
  prepared_ = prepare({}, sector, topology, face_patches, std::move(graph), std::move(conditions), options, most);
  detail::append_notes(notes_, prepared_.notes);
}

}  // namespace gridmorph
