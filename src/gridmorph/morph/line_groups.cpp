#include <gridmorph/morph/detail/line_groups.hpp>

#include <gridmorph/core/index.hpp>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <utility>

namespace gridmorph::detail {
namespace {

/// Up to three directions of nodes, as they are stored, on the lines of a chain.
struct Nodes {
  int n[3] = {1, 1, 1};
  Index3 origin{};      ///< (s, a, b) of node (0, 0, 0)
  Index3 step[3] = {};  ///< along each direction
  Index value = 0, value_step[3] = {};
  Index t = -1, t_step[3] = {};
  Index x = 0, x_step[3] = {};
};

/// Directions that run against the chain's are turned round.
PlacedBundle placed(Nodes nodes) {
  PlacedBundle out{{}, {nodes.origin[1], nodes.origin[2]}, {1, 1}};
  kernels::LineBundle& p = out.bundle;
  p.n_s = 1;
  p.matrix = -1;
  p.in_volume = 0;
  Index steps[3][3] = {};
  Index3 begin = nodes.origin, count{1, 1, 1};
  Index value = nodes.value, t = nodes.t, x = nodes.x;
  for (int d = 0; d < 3; ++d) {
    if (nodes.n[d] == 1) continue;
    int const axis = nodes.step[d][0] != 0 ? 0 : nodes.step[d][1] != 0 ? 1 : 2;
    int const sign = nodes.step[d][axis];
    count[axis] = nodes.n[d];
    Index const last = nodes.n[d] - 1;
    if (sign < 0) {
      begin[axis] -= int(last);
      value += last * nodes.value_step[d];
      if (t >= 0) t += last * nodes.t_step[d];
      x += last * nodes.x_step[d];
    }
    steps[0][axis] = sign * nodes.value_step[d];
    steps[1][axis] = sign * nodes.t_step[d];
    steps[2][axis] = sign * nodes.x_step[d];
  }
  auto const step = [&](int of) { return kernels::LineStep{steps[of][0], steps[of][1], steps[of][2]}; };
  p.s = begin[0];
  p.n_s = count[0];
  p.value = value;
  p.value_step = step(0);
  p.t = t;
  p.t_step = step(1);
  p.x = x;
  p.x_step = step(2);
  out.first = {begin[1], begin[2]};
  out.n = {count[1], count[2]};
  return out;
}

/// The part of a bundle between two lines along a (axis 0) or b.
PlacedBundle part(PlacedBundle p, int axis, int first, int end) {
  Index const skip = first - p.first[axis];
  auto const along = [&](kernels::LineStep const& s) { return axis == 0 ? s.a : s.b; };
  p.bundle.value += skip * along(p.bundle.value_step);
  if (p.bundle.t >= 0) p.bundle.t += skip * along(p.bundle.t_step);
  p.bundle.x += skip * along(p.bundle.x_step);
  p.first[axis] = first;
  p.n[axis] = end - first;
  return p;
}

/// Cut where any of them begins or ends, so that two of them have the same lines or none in common.
std::vector<PlacedBundle> cut_alike(std::vector<PlacedBundle> bundles) {
  for (int axis = 0; axis < 2; ++axis) {
    auto const d = std::size_t(axis);
    std::set<int> cuts;
    for (PlacedBundle const& p : bundles) cuts.insert({p.first[d], p.first[d] + p.n[d]});
    std::vector<PlacedBundle> pieces;
    for (PlacedBundle const& p : bundles) {
      int first = p.first[d];
      for (auto cut = cuts.upper_bound(first); first < p.first[d] + p.n[d]; first = *cut++)
        pieces.push_back(part(p, axis, first, *cut));
    }
    bundles = std::move(pieces);
  }
  return bundles;
}

/// Whether most nodes of a group follow on one another in memory along its lines, or its lines have hardly a neighbour.
bool runs_along_s(std::vector<kernels::LineBundle> const& bundles, int n_a) {
  constexpr int short_row = 4;  // neighbouring lines: a vector register or two
  Index along = 0, all = 0;
  for (kernels::LineBundle const& p : bundles) {
    all += p.n_s;
    bool const nearer = std::abs(p.value_step.s) < std::abs(p.value_step.a);
    if (p.n_s > short_row && (nearer || n_a <= short_row)) along += p.n_s;
  }
  return 2 * along > all;
}

}  // namespace

PlacedBundle bundle_of(kernels::SkeletonSweep const& sweep) {
  Nodes nodes;
  nodes.n[0] = sweep.n_p;
  nodes.n[1] = sweep.n_q;
  nodes.origin = {sweep.s[0], sweep.a[0], sweep.b[0]};
  for (int d = 0; d < 2; ++d) nodes.step[d] = {sweep.s[1 + d], sweep.a[1 + d], sweep.b[1 + d]};
  nodes.value = sweep.slot;
  nodes.value_step[0] = 1;
  nodes.value_step[1] = sweep.slot_q;
  nodes.t = sweep.t;
  nodes.t_step[0] = sweep.t_p;
  nodes.t_step[1] = sweep.t_q;
  nodes.x = sweep.x;
  nodes.x_step[0] = 1;
  nodes.x_step[1] = sweep.n_p;
  PlacedBundle out = placed(nodes);
  out.bundle.matrix = sweep.matrix;
  return out;
}

PlacedBundle bundle_of(kernels::VolumeBox const& box, kernels::VolumeTerm const& term) {
  Nodes nodes;
  nodes.origin = {term.s[0], term.a[0], term.b[0]};
  nodes.value = box.first;
  nodes.t = term.t;
  Index const value_step[3] = {1, box.stride_j, box.stride_k}, t_step[3] = {1, box.n[0], Index(box.n[0]) * box.n[1]};
  for (int d = 0; d < 3; ++d) {
    nodes.n[d] = box.n[d];
    nodes.step[d] = {term.s[1 + d], term.a[1 + d], term.b[1 + d]};
    nodes.value_step[d] = nodes.x_step[d] = value_step[d];
    nodes.t_step[d] = t_step[d];
  }
  nodes.x = box.first;
  PlacedBundle out = placed(nodes);
  out.bundle.matrix = term.matrix;
  out.bundle.in_volume = 1;
  out.bundle.offset = term.offset;
  out.bundle.common = box.common;
  return out;
}

LineGroups groups_of(BundlesOfChains const& of_chains) {
  LineGroups out;
  for (auto const& [chain, bundles] : of_chains) {
    using Place = std::array<int, 4>;  // b first: neighbours in memory follow one another
    std::map<Place, std::vector<kernels::LineBundle>> places;
    for (PlacedBundle const& p : cut_alike(bundles))
      places[{p.first[1], p.first[0], p.n[1], p.n[0]}].push_back(p.bundle);
    for (auto& [place, list] : places) {
      std::stable_sort(list.begin(), list.end(), [](auto const& a, auto const& b) { return a.s < b.s; });
      out.groups.push_back({chain, place[1], place[0], place[3], place[2], std::int32_t(out.bundles.size()),
                            std::int32_t(list.size()), runs_along_s(list, place[3]) ? 1 : 0});
      out.bundles.insert(out.bundles.end(), list.begin(), list.end());
    }
  }
  return out;
}

}  // namespace gridmorph::detail
