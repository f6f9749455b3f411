#include <gridmorph/plan/elements/turning_bodies.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

namespace gridmorph::detail {

namespace {

/// How many numbers a list of numbers from 0 on has.
std::size_t count_of(std::vector<Index32> const& number) {
  Index32 largest = -1;
  for (Index32 const n : number) largest = std::max(largest, n);
  return std::size_t(largest + 1);
}

/// Puts what belongs to ascending slots in the order that the part has them in.
void order_as(std::vector<Index32> const& slots, CommonMotion& common) {
  std::vector<Index32> ascending = slots;
  std::sort(ascending.begin(), ascending.end());
  CommonMotion const before = common;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    auto const from = std::lower_bound(ascending.begin(), ascending.end(), slots[k]) - ascending.begin();
    common.position[k] = before.position[from];
    common.weight[k] = before.weight[from];
  }
}

}  // namespace

std::vector<UnstructuredPlanner::Part> UnstructuredPlanner::find_parts() const {
  // A background mesh of the user's serves the mesh as a whole.
  if (options_.elements.background) return {};
  auto const n_nodes = std::size_t(mesh_.n_nodes());
  std::vector<Index32> slot(n_nodes, -1);
  for (std::size_t k = 0; k < out_.plan.known.size(); ++k) slot[out_.plan.known[k]] = Index32(k);
  auto const slots_of = [&](std::vector<Index32> const& number) {
    std::vector<std::vector<Index32>> out(count_of(number));
    for (std::size_t n = 0; n < n_nodes; ++n)
      if (Index32 const s = slot[owner(Index32(n))]; number[n] >= 0 && s >= 0) out[number[n]].push_back(s);
    for (auto& list : out) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return out;
  };
  auto const part = parts_of_nodes(mesh_, out_.graph, {});
  auto const slots = slots_of(part);
  // Zones on two sides of nodes whose displacement is given learn nothing of one another.
  bool const cut =
      std::any_of(out_.plan.copied.begin(), out_.plan.copied.end(), [&](Index32 n) { return is_known_[n] != 0; });
  auto const domain = cut ? parts_of_nodes(mesh_, out_.graph, is_known_) : part;
  auto const domain_slots = cut ? slots_of(domain) : slots;
  std::vector<Index32> part_of_domain(domain_slots.size(), -1), domains_of_part(slots.size(), 0);
  for (std::size_t n = 0; n < n_nodes; ++n)
    if (domain[n] >= 0 && std::exchange(part_of_domain[domain[n]], part[n]) < 0) ++domains_of_part[part[n]];
  std::vector<Part> out;
  std::vector<Index32> place_of_domain(domain_slots.size(), -1), place_of_part(slots.size(), -1);
  auto const add = [&](std::optional<CommonMotion> common) {
    out.push_back({mask(), std::move(common)});
    return Index32(out.size()) - 1;
  };
  for (std::size_t p = 0; p < slots.size(); ++p) {
    auto common = motion_in_common(part, Index32(p), slots[p]);
    place_of_part[p] = add(common);
    if (common || domains_of_part[p] < 2) continue;
    for (std::size_t d = 0; d < domain_slots.size(); ++d)
      if (part_of_domain[d] == Index32(p))
        if (auto own = motion_in_common(domain, Index32(d), domain_slots[d])) place_of_domain[d] = add(std::move(own));
  }
  if (out.size() == 1 && !out.front().common) return {};
  for (std::size_t n = 0; n < n_nodes; ++n) {
    if (domain[n] < 0) continue;
    Index32 const own = place_of_domain[domain[n]];
    out[own >= 0 ? own : place_of_part[part[n]]].nodes[n] = 1;
  }
  std::erase_if(out, [](Part const& p) { return std::find(p.nodes.begin(), p.nodes.end(), 1) == p.nodes.end(); });
  return out;
}

std::optional<CommonMotion> UnstructuredPlanner::motion_in_common(std::vector<Index32> const& number, Index32 of,
                                                                  std::vector<Index32> const& slots) const {
  if (slots.empty()) return {};
  auto const& rules = out_.boundary.motion->motion().rules;
  Mask is_here(out_.plan.known.size(), 0);
  for (Index32 const s : slots) is_here[s] = 1;
  std::set<int> asking;
  for (auto const& request : out_.boundary.requests.requests)
    if (is_here[request.boundary_node] != 0) asking.insert(request.rule);
  auto const rule = [&](int r) -> Rule const& { return rules[r].rule; };
  // What stands has nothing in common with what moves.
  if (std::any_of(asking.begin(), asking.end(), [&](int r) { return std::holds_alternative<FixedRule>(rule(r)); }))
    return {};
  std::vector<Vec3> given;
  if (out_.displacement)
    for (Index32 const s : slots) given.push_back((*out_.displacement)[s]);
  bool const prescribed =
      std::any_of(asking.begin(), asking.end(), [&](int r) { return std::holds_alternative<PrescribedRule>(rule(r)); });
  bool const is_known = out_.displacement && largest_norm(*out_.displacement) > 0 && !prescribed;
  // Of displacements to come one rule for all may be expected to move all alike.
  if (is_known ? !(largest_norm(given) > 0) : asking.size() > 1) return {};
  for (std::size_t k = 0; k < out_.boundary.slip_nodes.size(); ++k) {
    if (number[out_.boundary.slip_nodes[k]] != of) continue;
    for (Index32 const s : out_.boundary.slip_surfaces[Index(k)]) {
      SlipKind const kind = out_.plan.surfaces[s].kind;
      if (kind == SlipKind::axial || kind == SlipKind::facets) return {};
    }
  }
  std::vector<Index32> nodes;
  std::vector<Vec3> position;
  for (Index32 const s : slots) {
    nodes.push_back(out_.plan.known[s]);
    position.push_back(mesh_.coordinates[nodes.back()]);
  }
  CommonMotion common = common_motion(std::move(position), areas(nodes), common_limits(number, of));
  if (is_known && !common.is_common(given)) return {};
  return common;
}

CommonLimits UnstructuredPlanner::common_limits(std::vector<Index32> const& number, Index32 of) const {
  BoundaryConditions const& b = out_.boundary;
  CommonLimits limits;
  std::set<Index32> surfaces;
  for (std::size_t k = 0; k < b.slip_nodes.size(); ++k)
    if (number[b.slip_nodes[k]] == of)
      surfaces.insert(b.slip_surfaces[Index(k)].begin(), b.slip_surfaces[Index(k)].end());
  for (Index32 const s : surfaces) {
    SlipSurface const& surface = out_.plan.surfaces[s];
    if (surface.kind == SlipKind::plane)
      limits.planes.push_back({surface.origin, surface.direction});
    else
      limits.axes.push_back({surface.origin, surface.direction});
  }
  BoundaryConditions own;  // copies that move as one; where a rule gives both they are no limit
  for (PeriodicImage const& image : b.images)
    if (number[image.node] == of) own.images.push_back(image);
  if (!own.images.empty()) limits.copies = periodic_moves(host_, mesh_, out_.graph, own, 1);
  return limits;
}

void UnstructuredPlanner::plan_parts(std::vector<Part> parts) {
  UnstructuredReport& report = out_.report;
  auto const n_nodes = std::size_t(mesh_.n_nodes());
  report.layer.assign(n_nodes, -1);
  report.regions.element.assign(mesh_.n_elements(), Region::far);
  report.regions.near.assign(n_nodes, 0);
  report.regions.inside.assign(n_nodes, 0);
  for (Part& part : parts) plan_part(std::move(part));
  report.regions.count();
  plan_middle_nodes();
}

void UnstructuredPlanner::plan_part(Part part) {
  PartPlan to;
  to.common = std::move(part.common);
  bool const all = std::find(part.nodes.begin(), part.nodes.end(), 0) == part.nodes.end();
  std::optional<MeshPart> taken;
  if (all) {
    to.nodes.resize(part.nodes.size());
    std::iota(to.nodes.begin(), to.nodes.end(), Index32(0));
    to.slots.resize(out_.plan.known.size());
    std::iota(to.slots.begin(), to.slots.end(), Index32(0));
  } else {
    taken = mesh_part(host_, mesh_, out_.graph, out_.boundary, part.nodes);
    to.nodes = taken->nodes;
    to.slots = taken->slots;
    if (to.common) order_as(to.slots, *to.common);
  }
  auto const rest_of = [&](std::vector<Vec3> const& displacement) {
    std::vector<Vec3> rest;
    for (Index32 const s : to.slots) rest.push_back(displacement[s]);
    if (to.common) {
      auto const move = kernels::common_move(to.common->frame, to.common->fit(rest), true);
      for (std::size_t k = 0; k < rest.size(); ++k)
        kernels::TakeCommonMotion<Kokkos::HostSpace>{to.common->frame, to.common->view(), &move, rest.data(),
                                                     rest.data()}(Index(k));
    }
    return rest;
  };
  std::optional<std::vector<Vec3>> rest;
  if (out_.displacement) rest = rest_of(*out_.displacement);
  PlanOptions options = options_;
  if (!options_.elements.shape.empty()) options.elements.shape = rest_of(options_.elements.shape);
  BoundaryConditions boundary = taken ? std::move(taken->boundary) : out_.boundary;
  boundary.notes.clear();  // they are here already
  UnstructuredPlanner planner(host_, taken ? taken->mesh : mesh_, taken ? taken->topology : topology_,
                              taken ? taken->face_patches : face_patches_, taken ? std::move(taken->graph) : out_.graph,
                              std::move(boundary), options, std::move(rest), out_.plan.axes);
  planner.is_part_ = true;
  PreparedUnstructured planned = planner.run();
  for (auto& note : planned.notes)
    if (std::find(out_.notes.begin(), out_.notes.end(), note) == out_.notes.end())
      out_.notes.push_back(std::move(note));
  to.plan = std::make_shared<UnstructuredPlan const>(std::move(planned.plan));
  if (taken) {
    take_part(to, taken->elements, planned);
  } else {
    std::vector<Index32> elements(mesh_.n_elements());
    std::iota(elements.begin(), elements.end(), Index32(0));
    take_part(to, elements, planned);
  }
  out_.plan.parts.push_back(std::move(to));
  out_.part_reports.push_back(std::move(planned.report));
}

void UnstructuredPlanner::take_part(PartPlan const& part, std::vector<Index32> const& elements,
                                    PreparedUnstructured const& planned) {
  UnstructuredPlan const& from = *part.plan;
  UnstructuredPlan& to = out_.plan;
  auto const node = [&](Index32 n) { return part.nodes[n]; };
  for (std::size_t k = 0; k < from.columns.node.size(); ++k) {
    Index32 const own = from.driving_slots[from.columns.root[k]];
    Index32 const wall = to.known[part.slots[own]];
    to.columns.node.push_back(node(from.columns.node[k]));
    to.columns.root.push_back(
        Index32(std::lower_bound(to.driving.begin(), to.driving.end(), wall) - to.driving.begin()));
    to.columns.turn.push_back(from.columns.turn[k]);
  }
  for (std::size_t k = 0; k < from.residual_nodes.size(); ++k) {
    Index32 const slot = from.residual_slot[k];
    to.residual_nodes.push_back(node(from.residual_nodes[k]));
    to.residual_slot.push_back(slot < 0 ? -1 : part.slots[slot]);
    to.residual_surfaces.add(from.residual_surfaces[Index(k)]);
  }
  UnstructuredReport const& own = planned.report;
  UnstructuredReport& sum = out_.report;
  for (std::size_t n = 0; n < part.nodes.size(); ++n) {
    auto const at = std::size_t(part.nodes[n]);
    sum.layer[at] = own.layer[n];
    sum.regions.near[at] = own.regions.near[n];
    sum.regions.inside[at] = own.regions.inside[n];
  }
  for (std::size_t e = 0; e < elements.size(); ++e) sum.regions.element[elements[e]] = own.regions.element[e];
  sum.layer_height = std::max(sum.layer_height, own.layer_height);
  sum.offset = std::max(sum.offset, own.offset);
  sum.wrap_distance = std::max(sum.wrap_distance, own.wrap_distance);
  sum.n_layers = std::max(sum.n_layers, own.n_layers);
  for (auto const count :
       {&UnstructuredReport::n_columns, &UnstructuredReport::wrap_nodes, &UnstructuredReport::wrap_outside,
        &UnstructuredReport::far_nodes, &UnstructuredReport::far_outside, &UnstructuredReport::unreached})
    sum.*count += own.*count;
  using Seconds = UnstructuredReport::Seconds;
  for (auto const step : {&Seconds::boundary, &Seconds::columns, &Seconds::distances, &Seconds::wrap, &Seconds::layers,
                          &Seconds::background, &Seconds::location, &Seconds::residual})
    sum.seconds.*step += own.seconds.*step;
}

}  // namespace gridmorph::detail
