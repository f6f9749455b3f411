#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/block_points.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

/// visit(slot, node, matrix) for all nodes of the skeleton.
template <class Visit>
void for_each_skeleton_node(Plan const& plan, Visit&& visit) {
  for (kernels::NodeCopy const& copy : plan.skeleton_nodes)
    for (Index q = 0; q < copy.n_q; ++q)
      for (Index p = 0; p < copy.n_p; ++p)
        visit(copy.source + p * copy.source_stride_p + q * copy.source_stride_q,
              copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q, copy.matrix);
}

}  // namespace

BlockPoints::BlockPoints(PreparedMorph const& prepared)
    : slip_surfaces_(&prepared.surface.slip_surfaces()),
      rotations_(&prepared.plan().rotations),
      baseline_(prepared.mesh.coordinates),
      slot_(std::size_t(prepared.plan().n_nodes), -1),
      stays_(std::size_t(prepared.plan().n_nodes), 0) {
  gather(prepared.plan());
  find_slip(prepared);
  keep_given(prepared);
  keep_near_field(prepared);
  keep_axes(prepared);
}

void BlockPoints::gather(Plan const& plan) {
  first_.assign(plan.n_slots + 1, 0);
  for_each_skeleton_node(plan, [&](Index slot, Index node, std::int32_t) {
    ++first_[slot + 1];
    slot_[node] = Index32(slot);
  });
  for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
  nodes_.resize(first_.back());
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for_each_skeleton_node(plan, [&](Index slot, Index node, std::int32_t matrix) {
    nodes_[next[slot]++] = {node, matrix};
  });
}

/// Nodes with a given displacement, but for periodic interfaces inside the flow that follow a blade: these may be
/// anywhere, as long as copies match. Patches that no surface holds stay as the morph left them, whether a rule moved
/// them or not.
void BlockPoints::keep_given(PreparedMorph const& prepared) {
  Plan const& plan = prepared.plan();
  std::vector<std::uint8_t> asked(plan.boundary_nodes.size(), 0), given(plan.boundary_nodes.size(), 0);
  for (BoundaryRequests::Request const& request : prepared.planned.boundary.requests) {
    Rule const& rule = prepared.surface.motion().rules[request.rule].rule;
    bool const follows = request.interface >= 0 && std::holds_alternative<FollowRule>(rule);
    (follows ? asked : given)[request.boundary_node] = 1;
  }
  for (std::size_t n = 0; n < plan.boundary_nodes.size(); ++n)
    if (asked[n] == 0 || given[n] != 0) keep(plan.boundary_nodes[n]);
  Mesh const& mesh = prepared.mesh;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    Patch const& patch = mesh.patches[p];
    if (prepared.surface.slip_surface_of(int(p)) < 0)
      gridmorph::for_each_node(mesh.zones[patch.zone], patch.range, [&](Index node) { keep(node); });
  }
}

void BlockPoints::keep_near_field(PreparedMorph const& prepared) {
  for (CellBox const& box : prepared.plan().near_field) {
    IndexRange nodes = box.cells;
    for (int& end : nodes.end) ++end;
    gridmorph::for_each_node(prepared.mesh.zones[box.zone], nodes, [&](Index node) { keep(node); });
  }
}

/// Nodes that a rotation between periodic copies leaves in place can only move along the axis.
void BlockPoints::keep_axes(PreparedMorph const& prepared) {
  Coordinates const& x = prepared.mesh.coordinates;
  double const tolerance = place_tolerance(1e-9, prepared.links.mesh_size, coordinate_resolution(prepared.mesh));
  for (Link const& link : prepared.links.all)
    if (link.periodic)
      for_each_pair(prepared.mesh, link, [&](Index own, Index donor) {
        if (own == donor || distance(x[own], x[donor]) <= tolerance) keep(own);
      });
}

void BlockPoints::find_slip(PreparedMorph const& prepared) {
  Mesh const& mesh = prepared.mesh;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    int const surface = prepared.surface.slip_surface_of(int(p));
    Patch const& patch = mesh.patches[p];
    if (surface >= 0)
      gridmorph::for_each_node(mesh.zones[patch.zone], patch.range,
                               [&](Index node) { slips_.emplace_back(node, surface); });
  }
  std::sort(slips_.begin(), slips_.end());
  slips_.erase(std::unique(slips_.begin(), slips_.end()), slips_.end());
}

std::vector<int> BlockPoints::surfaces(Index node) const {
  std::vector<int> out;
  for (auto at = std::lower_bound(slips_.begin(), slips_.end(), std::pair(node, 0));
       at != slips_.end() && at->first == node; ++at)
    out.push_back(at->second);
  return out;
}

std::optional<SlidingPoint> BlockPoints::sliding(std::vector<PointNode> const& nodes) const {
  std::vector<int> all;
  PointNode frame = nodes.front();
  std::size_t most = 0;
  for (PointNode const& n : nodes) {
    std::vector<int> const own = surfaces(n.node);
    if (own.size() > most) frame = n;
    most = std::max(most, own.size());
  }
  for (PointNode const& n : nodes)
    for (int const s : surfaces(n.node)) {
      if (std::find(all.begin(), all.end(), s) != all.end()) continue;
      auto const in_frame = surfaces(frame.node);
      bool const known = std::find(in_frame.begin(), in_frame.end(), s) != in_frame.end();
      if (!known && n.matrix != frame.matrix) return {};
      all.push_back(s);
    }
  SlidingPoint out;
  if (all.size() > out.surface.size()) return {};
  out.node = frame;
  out.count = int(all.size());
  Vec3 const at = baseline_[frame.node];
  for (std::size_t m = 0; m < all.size(); ++m) {
    out.surface[m] = all[m];
    out.own_offset[m] = (*slip_surfaces_)[all[m]].view().own_offset(at);
  }
  return out;
}

}  // namespace gridmorph
