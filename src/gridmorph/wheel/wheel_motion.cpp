#include <gridmorph/wheel/wheel_motion.hpp>

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/make_plan.hpp>
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
      return std::binary_search(known.begin(), known.end(), graph.representative[pair[0]]);
    });
    if (!all && reported.insert(link.connection).second) problems.add(no_rule_for_side(sector, link));
  }
  problems.throw_if_any<MotionError>();
}

/// Whether passages do the same. What sides do that one shares with another blade's is not what all of either does.
bool are_alike(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
  double const largest = std::max(largest_norm(a), largest_norm(b));
  constexpr double alike = 1e-9;
  return std::equal(a.begin(), a.end(), b.begin(),
                    [&](Vec3 const& p, Vec3 const& q) { return distance(p, q) <= alike * largest; });
}

}  // namespace

WheelMotion::WheelMotion(IndexedMesh sector, PassageLinks const& links, WheelRows const& rows,
                         std::vector<Motion> const& motions, SameRules same_rules, PlanOptions const& options,
                         std::vector<WheelRowBlades> const& blades, WheelTimes const& times)
    : sector_(std::move(sector)), same_rules_(std::move(same_rules)), used_(used_motions(blades)) {
  refuse_regions(motions);
  Asked const asked{links, rows, motions, options, blades, times, open_rows(blades)};
  if (sector_.is_structured())
    plan_blocks(asked);
  else
    plan_elements(asked);
}

template <class Make>
void WheelMotion::add_rules(Make const& make) {
  for (int const m : used_) {
    int const rules = same_rules_[m];
    if (rules_.contains(rules)) continue;
    auto const& surface = rules_.emplace(rules, make(rules)).first->second;
    detail::append_notes(notes_, surface->notes());
  }
}

void WheelMotion::add_passages(Asked const& asked, std::vector<Index> const& nodes,
                               std::vector<BladeShare> const& shares) {
  std::vector<PassageMotions::Node> shared;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    shared.push_back(
        {sector_.mesh().coordinates[nodes[n]], asked.rows.row_of_zone[sector_.mesh().zone_of(nodes[n])], shares[n]});
  passages_ = PassageMotions(asked.rows, asked.blades, std::move(shared), {});
  move(asked.motions);
}

void WheelMotion::plan_blocks(Asked const& asked) {
  Mesh const& sector = sector_.mesh();
  auto const boundary = std::make_shared<Boundary const>(sector);
  ResolvedMotion const resolved = resolve(sector, asked.motions[used_.front()]);
  detail::append_notes(notes_, resolved.notes);
  OpenedPassage opened = open_passage(sector, asked.links, asked.rows, resolved, asked.open);
  Links links = connect(opened.mesh, asked.options.topology);
  BoundaryMotion surface(opened.mesh, opened.motion);
  PlannedMorph made = make_plan({}, opened.mesh, links, surface, asked.options);
  detail::append_notes(notes_, made.plan.notes);
  requests_ = made.boundary;
  rotations_ = made.plan.rotations;
  add_rules([&](int m) { return std::make_shared<BoundaryMotion const>(boundary, resolve(sector, asked.motions[m])); });
  // Where nothing was opened the plan has the rules themselves: guards look for periodic sides that follow a blade.
  if (std::none_of(asked.open.begin(), asked.open.end(), [](char open) { return open != 0; }))
    surface = rules_.at(same_rules_[used_.front()])->with(asked.motions[used_.front()]);
  plan_ = PlanAccess::of(std::move(opened.mesh), std::move(links), std::move(surface), std::move(made), asked.options);

  auto const nodes = plan_->boundary_nodes();
  add_passages(asked, nodes,
               blade_shares(*boundary, asked.links, asked.rows, resolved, asked.open,
                            one_of_place(asked.links, asked.rows), requests_, nodes));
}

void WheelMotion::plan_elements(Asked const& asked) {
  Mesh const& sector = sector_.mesh();
  PlanOptions options = asked.options;
  bool const one = used_.size() == 1 && asked.times.steps == 0;
  Motion const& first = asked.motions[used_.front()];
  NodeGraph graph = make_node_graph(sector, sector_.topology().elements_of_nodes, row_of_nodes(sector, first));
  BoundaryConditions conditions =
      boundary_conditions(sector, sector_.topology(), sector_.face_patches(), graph, first, options.elements.walls,
                          one && options.elements.motion < 0 ? Displacements::of_the_rules : Displacements::any);
  refuse_free_sides(sector, asked.links, asked.rows, asked.open, graph, conditions.known);

  requests_ = conditions.requests;
  add_rules(
      [&](int m) { return m == used_.front() ? conditions.motion : boundary_motion(conditions, asked.motions[m]); });
  std::vector<Index> const known(conditions.known.begin(), conditions.known.end());
  add_passages(asked, known,
               blade_shares(
                   conditions.motion->boundary(), asked.links, asked.rows, conditions.motion->motion(), asked.open,
                   [&](Index n) { return Index(graph.representative[n]); }, requests_, known));

  auto most = largest_of(asked, options);
  plan_ = PlanAccess::of(sector, sector_.topology(), sector_.face_patches(), std::move(graph), std::move(conditions),
                         options, std::move(most));
  detail::append_notes(notes_, plan_->notes());
}

std::optional<std::vector<Vec3>> WheelMotion::largest_of(Asked const& asked, PlanOptions& options) const {
  if (options.elements.motion >= 0) return {};
  std::optional<std::vector<Vec3>> most;
  double largest = -1;
  std::vector<Vec3> first;
  for (int p = 0; p < passages_.n_passages(); ++p) {
    if (passages_.first_alike(p) < p) continue;
    auto displacement = passages_.boundary(p);
    double const now = largest_norm(displacement);
    if (first.empty()) first = displacement;
    if (!are_alike(first, displacement)) options.elements.with_sides = false;
    if (now <= largest) continue;
    largest = now;
    most = std::move(displacement);
  }
  if (used_.size() == 1 && asked.times.steps == 0) return most;
  for (int step = 0; step < asked.times.steps; ++step) {
    auto const values = values_of(asked.times.motions(step));
    for (int const m : used_) {
      largest = std::max(largest, largest_norm(values[m]));
      if (!are_alike(values[used_.front()], values[m])) options.elements.with_sides = false;
    }
  }
  options.elements.motion = largest;  // what turns leave of it differs from blade to blade
  if (most) options.elements.shape = std::move(*most);
  return {};
}

std::vector<std::vector<Vec3>> WheelMotion::values_of(std::vector<Motion> const& motions) const {
  std::vector<std::vector<Vec3>> values(motions.size());
  for (int const m : used_) values[m] = displacement(m, motions[m]);
  return values;
}

std::vector<Vec3> WheelMotion::displacement(int m, Motion const& motion) const {
  return evaluate(requests_, rules_.at(same_rules_[m])->with(motion), rotations_);
}

std::vector<Trim> WheelMotion::trims(std::vector<Vec3> const& boundary) const {
  // In words of the rules: those of a plan that was opened give no values.
  return PlanAccess::trims(*plan_, boundary, *rules_.at(same_rules_[used_.front()]));
}

}  // namespace gridmorph
