#include <gridmorph/core/text.hpp>
#include <gridmorph/plan/elements/locate.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace gridmorph::detail {

void UnstructuredPlanner::plan_background() {
  UnstructuredPlan& plan = out_.plan;
  if (!plan.background) {
    if (fitted_ || out_.report.regions.n_far == 0 || driving_faces_.empty()) return;
    take_background(make_background(*out_.report.wrap, options_.elements.cells));
  }
  plan_outer_box();
}

void UnstructuredPlanner::plan_outer_box() {
  UnstructuredPlan& plan = out_.plan;
  // Any choice is made good by the residual, so a few thousand places to choose from are enough.
  constexpr std::size_t most = 2000, count = 6;
  std::vector<Index32> slots;
  for (std::size_t k = 0; k < plan.known.size(); ++k)
    if (!out_.boundary.drives[k]) slots.push_back(Index32(k));
  if (slots.empty()) return;
  PlaceOrder const is_before(mesh_.coordinates);
  std::sort(slots.begin(), slots.end(), [&](Index32 a, Index32 b) { return is_before(plan.known[a], plan.known[b]); });
  std::size_t const step = slots.size() / most + 1;
  WrapNodes const wrap = wrap_nodes(*plan.background, *plan.background_morph);
  auto const& nodes = plan.background_morph->plan().boundary_nodes;
  Mask is_wrap(nodes.size(), 0);
  for (Index32 const b : wrap.boundary_node) is_wrap[b] = 1;
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    if (is_wrap[b]) continue;
    Vec3 x = plan.background->mesh.coordinates[nodes[b]];
    if (mesh_.dimension == 2) x.z = 0;
    // The nearest ones, by how much nearer they are than the first that is left out (R. Franke, G. Nielson 1980).
    std::array<std::pair<double, Index32>, count + 1> nearest;
    nearest.fill({infinity, -1});
    for (std::size_t k = 0; k < slots.size(); k += step) {
      double const d = distance(x, mesh_.coordinates[plan.known[slots[k]]]);
      if (!(d < nearest.back().first * (1 - 1e-6))) continue;
      std::size_t at = nearest.size() - 1;
      for (; at > 0 && d < nearest[at - 1].first * (1 - 1e-6); --at) nearest[at] = nearest[at - 1];
      nearest[at] = {d, slots[k]};
    }
    std::array<Index32, count> slot{};
    std::array<double, count> weight{};
    std::size_t used = 0;
    double sum = 0;
    for (; used < count && nearest[used].second >= 0; ++used) {
      auto const [d, s] = nearest[used];
      slot[used] = s;
      double const beyond = nearest.back().first;
      double const share = std::isfinite(beyond) ? 1e-6 + (beyond - d) / beyond : 1;
      weight[used] = d > 0 ? share * share / (d * d) : infinity;
      if (used > 0 && !(weight[used] > 0)) break;
      if (!std::isfinite(weight[used])) {
        slot[0] = s;
        weight[0] = 1;
        used = 1;
        sum = 1;
        break;
      }
      sum += weight[used];
    }
    for (std::size_t k = 0; k < used; ++k) weight[k] /= sum;
    plan.outer.add(Index32(b), std::span(slot).first(used), std::span(weight).first(used));
  }
}

void UnstructuredPlanner::plan_projections() {
  UnstructuredPlan& plan = out_.plan;
  if (!plan.background) return;
  project_wrap();
  // Beyond the wrap the background mesh has the say, on partially wrapped elements too: layers went there only to
  // surround the wrap's nodes.
  Mask column = drives_;
  for (Index32 const n : columns_.node) column[n] = 1;
  std::vector<Index32> far;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n)
    if (out_.graph.carries(n) && !out_.graph.neighbours[n].empty() && !column[n] && !out_.report.regions.inside[n])
      far.push_back(n);
  FarRows rows = background_rows(host_, *plan.background, mesh_.coordinates, far);
  out_.report.far_nodes = Index(far.size());
  out_.report.far_outside = rows.n_outside;
  plan.far = std::move(rows.rows);
}

void UnstructuredPlanner::project_wrap() {
  UnstructuredPlan& plan = out_.plan;
  WrapNodes const wrap = wrap_nodes(*plan.background, *plan.background_morph);
  std::vector<Index32> candidates;
  for (Index e = 0; e < mesh_.n_elements(); ++e)
    if (out_.report.regions.element[e] != Region::far) candidates.push_back(Index32(e));
  std::vector<Location> const found = locate(host_, mesh_, candidates, wrap.position);
  plan.wrap = interpolation_rows(host_, mesh_, found, wrap.boundary_node);
  for (Index32& n : plan.wrap.item) n = owner(n);
  out_.report.wrap_nodes = Index(wrap.position.size());
  // On a boundary, but for round-off and the way that trimmed ends of the wrap go beyond it.
  double const on_boundary = out_.report.wrap ? 1e-3 * out_.report.wrap->offset : 0;
  for (Location const& where : found)
    if (where.distance > on_boundary) {
      ++out_.report.wrap_outside;
      out_.report.wrap_distance = std::max(out_.report.wrap_distance, where.distance);
    }
  if (out_.report.wrap_outside > 0)
    out_.notes.push_back(std::to_string(out_.report.wrap_outside) + " of " + std::to_string(out_.report.wrap_nodes) +
                         " nodes of the wrap lie outside all elements (in solids or beyond the domain), at most " +
                         to_text(out_.report.wrap_distance, 4) + " away; they move as the nearest place of an element");
}

}  // namespace gridmorph::detail
