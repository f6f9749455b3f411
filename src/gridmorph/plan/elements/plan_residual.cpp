#include <gridmorph/core/for_all.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/fit_domain.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace gridmorph::detail {

void UnstructuredPlanner::plan_residual() {
  UnstructuredPlan& plan = out_.plan;
  plan_other_nodes();
  plan_middle_nodes();
  plan_joint_nodes();
  plan.fade.assign(is_other_.size(), 0);
  for_all(host_, "gridmorph::fade", mesh_.n_nodes(), [&](Index at) {
    auto const n = std::size_t(at);
    if (out_.graph.carries(Index32(n)) && !drives_[n] && !is_other_[n]) plan.fade[n] = float(fade(n, from_other_));
  });
  // Columns are as rigid as their walls ask for.
  for (Index32 const n : columns_.node) plan.fade[n] = 0;
  plan_start();
  MeshExtent const box = extent_of(host_, mesh_.coordinates);
  std::vector<Index32> const boundary(plan.residual_nodes.begin(), plan.residual_nodes.end() - n_held());
  ScatterLattice lattice{box.low, box.high};
  lattice.readers = plan.residual_nodes;
  for (std::size_t n = 0; n < plan.fade.size(); ++n)
    if (plan.fade[n] != 0) lattice.readers.push_back(Index32(n));
  plan.residual = make_scatter_lattice(host_, mesh_.coordinates, boundary, areas(boundary), mesh_.dimension, lattice);
  if (plan.residual.empty()) return;
  double const reach = 2 * plan.residual.shape.spacing;
  Mask wanted = mask();
  for (std::size_t n = 0; n < wanted.size(); ++n)
    wanted[n] = plan.fade[n] != 0 && from_other_.distance[n] < reach ? 1 : 0;
  plan.residual_detail =
      make_layers(host_, out_.graph, mesh_.coordinates, is_other_, wanted, from_other_.distance, inverse_distance());
  for (Index32 const n : plan.residual_detail.rows.target) {
    double const s = from_other_.distance[n] / reach;
    plan.detail_fade.push_back(float(plan.fade[n] * (1 - s * s * (3 - 2 * s))));
  }
}

void UnstructuredPlanner::plan_start() {
  UnstructuredPlan& plan = out_.plan;
  auto& start = plan.start;
  Mask seeds = mask(), wanted = mask();
  Index n_boundary = 0;
  for (std::size_t k = 0; k < plan.residual_nodes.size(); ++k) {
    Index32 const n = plan.residual_nodes[k];
    if (k + plan.sliding.size() >= plan.residual_nodes.size()) break;
    bool const given = plan.residual_slot[k] >= 0;
    (given ? start.given : start.node).push_back(n);
    (given ? seeds : wanted)[n] = 1;
    if (!given) continue;
    start.given_slot.push_back(plan.residual_slot[k]);
    n_boundary += k + std::size_t(n_held()) < plan.residual_nodes.size() ? 1 : 0;
  }
  start.fade.assign(start.node.size(), 0);
  start.detail_fade.assign(start.node.size(), 0);
  if (start.node.empty() || n_boundary == 0) return;
  MeshExtent const box = extent_of(host_, mesh_.coordinates);
  std::vector<Index32> const boundary(start.given.begin(), start.given.begin() + n_boundary);
  // It is needed on surfaces alone, and what it misses passes along them.
  ScatterLattice lattice{box.low, box.high, 20'000};
  lattice.readers = start.given;
  lattice.readers.insert(lattice.readers.end(), start.node.begin(), start.node.end());
  start.residual = make_scatter_lattice(host_, mesh_.coordinates, boundary, areas(boundary), mesh_.dimension, lattice);
  double const reach = 2 * start.residual.shape.spacing;
  std::vector<Index32> place(mesh_.n_nodes(), -1);
  for (std::size_t k = 0; k < start.node.size(); ++k) {
    Index32 const n = start.node[k];
    place[n] = Index32(k);
    start.fade[k] = drives_[n] ? 0 : float(fade(std::size_t(n), from_given_));
    if (!(from_given_.distance[n] < reach)) wanted[n] = 0;
  }
  start.detail =
      make_layers(host_, out_.graph, mesh_.coordinates, seeds, wanted, from_given_.distance, inverse_distance());
  for (Index32 const n : start.detail.rows.target) {
    double const s = from_given_.distance[n] / reach;
    std::size_t const k = std::size_t(place[n]);
    start.detail_fade[k] = float(start.fade[k] * (1 - s * s * (3 - 2 * s)));
  }
}

std::vector<double> UnstructuredPlanner::areas(std::vector<Index32> const& nodes) const {
  std::vector<double> area(mesh_.n_nodes(), 0);
  Mask is_periodic = mask();
  for (auto const& image : out_.boundary.images) is_periodic[image.node] = is_periodic[image.owner] = 1;
  auto const paired = periodic_nodes(mesh_);
  for (std::size_t n = 0; n < paired.size(); ++n)
    if (paired[n] != 0) is_periodic[owner(Index32(n))] = 1;
  for (Index f = 0; f < topology_.boundary.size(); ++f) {
    auto const face = topology_.boundary.nodes[f];
    // Between two zones there is no boundary.
    if (face_patches_.patch[f] == BoundaryFacePatches::connection &&
        std::none_of(face.begin(), face.end(), [&](Index32 n) { return is_periodic[owner(n)] != 0; }))
      continue;
    double const size = boundary_face_size(mesh_, topology_.boundary, f);
    for (Index32 const n : face) area[owner(n)] += size / double(face.size());
  }
  double sum = 0;
  Index count = 0;
  for (double const a : area)
    if (a > 0) {
      sum += a;
      ++count;
    }
  double const mean = count > 0 ? sum / double(count) : 1;
  std::vector<double> out;
  for (Index32 const n : nodes) out.push_back(area[n] > 0 ? area[n] : mean);
  return out;
}

double UnstructuredPlanner::fade(std::size_t n, NearestSource const& from) const {
  double const other = from.distance[n];
  if (!std::isfinite(other)) return 0;
  double const d = beyond_column(n);
  if (!std::isfinite(d)) return 1;
  return d + other > 0 ? d / (d + other) : 0;
}

void UnstructuredPlanner::plan_other_nodes() {
  UnstructuredPlan& plan = out_.plan;
  BoundaryConditions const& b = out_.boundary;
  std::vector<Index32> slot(mesh_.n_nodes(), -1), slip(std::size_t(mesh_.n_nodes()), -1);
  for (std::size_t k = 0; k < b.known.size(); ++k) slot[b.known[k]] = Index32(k);
  for (std::size_t k = 0; k < b.slip_nodes.size(); ++k) slip[b.slip_nodes[k]] = Index32(k);
  Mask in_column = mask();
  for (auto const* columns : {&standing_, &sliding_})
    for (Index32 const n : columns->node) in_column[n] = 1;
  // Boundary nodes, columns on walls that stand, columns on walls that slip: UnstructuredPlan has them in this order.
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (!is_other_[n] || in_column[n]) continue;
    plan.residual_nodes.push_back(n);
    plan.residual_slot.push_back(slot[n]);
    if (slip[n] >= 0) {
      plan.residual_surfaces.add(b.slip_surfaces[slip[n]]);
    } else {
      plan.residual_surfaces.add({});
    }
  }
  for (std::size_t k = 0; k < standing_.node.size(); ++k) {
    plan.residual_nodes.push_back(standing_.node[k]);
    plan.residual_slot.push_back(slot[standing_.root[k]]);
    plan.residual_surfaces.add(slip[standing_.node[k]] >= 0 ? b.slip_surfaces[slip[standing_.node[k]]]
                                                            : std::span<Index32 const>{});
  }
  for (std::size_t k = 0; k < sliding_.node.size(); ++k) {
    plan.residual_nodes.push_back(sliding_.node[k]);
    plan.residual_slot.push_back(-1);
    plan.residual_surfaces.add({});
    plan.sliding.push_back(sliding_.node[k]);
    plan.sliding_root.push_back(sliding_.root[k]);
  }
  group_images(false, plan.image_owners, plan.images_of_owner);
}

void UnstructuredPlanner::group_images(bool middle, std::vector<Index32>& owners, CsrGraph& images_of_owner) const {
  auto const& all = out_.boundary.images;
  std::vector<std::pair<Index32, Index32>> by_owner;
  for (std::size_t k = 0; k < all.size(); ++k)
    if ((is_middle_[all[k].owner] != 0) == middle) by_owner.emplace_back(all[k].owner, Index32(k));
  std::sort(by_owner.begin(), by_owner.end());
  for (std::size_t k = 0; k < by_owner.size();) {
    std::vector<Index32> images;
    Index32 const o = by_owner[k].first;
    for (; k < by_owner.size() && by_owner[k].first == o; ++k) images.push_back(by_owner[k].second);
    owners.push_back(o);
    images_of_owner.add(images);
  }
}

void UnstructuredPlanner::plan_middle_nodes() {
  if (out_.plan.middle.size() == 0) return;
  BoundaryConditions const& b = out_.boundary;
  auto& at = out_.plan.middle_boundary;
  for (std::size_t k = 0; k < b.known.size(); ++k) {
    if (is_middle_[b.known[k]] == 0) continue;
    at.node.push_back(b.known[k]);
    at.slot.push_back(Index32(k));
    at.surfaces.add({});
  }
  for (std::size_t k = 0; k < b.slip_nodes.size(); ++k) {
    if (is_middle_[b.slip_nodes[k]] == 0) continue;
    at.node.push_back(b.slip_nodes[k]);
    at.slot.push_back(-1);
    at.surfaces.add(b.slip_surfaces[Index(k)]);
  }
  group_images(true, at.image_owners, at.images_of_owner);
}

void UnstructuredPlanner::plan_joint_nodes() {
  UnstructuredPlan& plan = out_.plan;
  BoundaryConditions const& b = out_.boundary;
  Mask slides = mask(), has_images = mask();
  for (Index32 const n : plan.sliding) slides[n] = 1;
  std::unordered_map<Index32, std::vector<Index32>> images_of;
  for (std::size_t k = 0; k < b.images.size(); ++k) {
    has_images[b.images[k].node] = has_images[b.images[k].owner] = 1;
    images_of[b.images[k].owner].push_back(Index32(k));
  }
  JointSlip const& all = b.joint_slip;
  for (std::size_t k = 0; k < all.of.size(); ++k) {
    Index32 const owner = all.of[k];
    std::vector<Index32> const images = images_of.contains(owner) ? images_of.at(owner) : std::vector<Index32>();
    bool const slide = slides[owner] != 0 || std::any_of(images.begin(), images.end(),
                                                         [&](Index32 i) { return slides[b.images[i].node] != 0; });
    auto& to = is_middle_[owner] != 0 ? plan.middle_boundary.joint : slide ? plan.joint_sliding : plan.joint;
    to.images.add(images);
    to.slip.of.push_back(owner);
    for (auto s = std::size_t(all.first[k]); s < std::size_t(all.first[k + 1]); ++s) {
      to.slip.surface.push_back(all.surface[s]);
      to.slip.place.push_back(all.place[s]);
      to.slip.turned.push_back(all.turned[s]);
    }
    to.slip.first.push_back(Index(to.slip.surface.size()));
  }
  // What goes along with a wall that slips may lie on another surface that slips.
  for (std::size_t k = 0; k < b.slip_nodes.size(); ++k) {
    Index32 const n = b.slip_nodes[k];
    if (slides[n] == 0 || has_images[n] != 0) continue;
    JointSlip& to = plan.joint_sliding.slip;
    plan.joint_sliding.images.add({});
    to.of.push_back(n);
    for (Index32 const s : b.slip_surfaces[Index(k)]) {
      to.surface.push_back(s);
      to.place.push_back(n);
      to.turned.push_back(-1);
    }
    to.first.push_back(Index(to.surface.size()));
  }
}

std::function<double(Index32, Index32)> UnstructuredPlanner::inverse_distance() const {
  return [this](Index32 a, Index32 b) {
    double const d = distance(mesh_.coordinates[a], mesh_.coordinates[b]);
    return 1 / std::max(d, std::numeric_limits<double>::min());
  };
}

}  // namespace gridmorph::detail
