#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/plan/boundary_groups.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gridmorph {

namespace {

constexpr Index32 leaf_size = 4;

}  // namespace

BoundaryGroups::BoundaryGroups(Coordinates const& x, std::vector<Index32> const& nodes, std::vector<double> const& area,
                               double leaf_radius, Along along)
    : x_(x), nodes_(nodes), area_(area), leaf_radius_(leaf_radius), along_(along), order_(nodes.size()) {
  std::iota(order_.begin(), order_.end(), Index32(0));
  PlaceOrder const is_before(x, along == Along::coordinates ? 1.13e-3 : 1.13e-6);
  std::sort(order_.begin(), order_.end(), [&](Index32 a, Index32 b) { return is_before(nodes_[a], nodes_[b]); });
  step_ = is_before.step();
  place_.resize(order_.size());
  steps_.resize(order_.size());
  key_.resize(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) {
    place_[order_[k]] = Index32(k);
    steps_[k] = is_before.steps(x[nodes[k]]);
  }
  if (!nodes.empty()) make(0, Index32(nodes.size()));
}

Index32 BoundaryGroups::make(Index32 begin, Index32 end) {
  Index32 const g = Index32(groups.size());
  groups.emplace_back();
  Group group;
  group.begin = begin;
  group.end = end;
  Box box;
  Vec3 sum;
  for (Index32 k = begin; k < end; ++k) {
    Vec3 const p = x_[node(k)];
    box.include(p);
    sum += area(k) * p;
    group.area += area(k);
  }
  group.centre = (1 / group.area) * sum;
  for (Index32 k = begin; k < end; ++k) {
    Vec3 const arm = x_[node(k)] - group.centre;
    group.radius = std::max(group.radius, norm(arm));
    if (along_ == Along::coordinates) continue;
    double const c[3] = {arm.x, arm.y, arm.z}, share = area(k) / group.area;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) group.moments[i][j] += share * c[i] * c[j];
  }
  if (end - begin > leaf_size || (end - begin > 1 && group.radius > leaf_radius_)) {
    Index32 const middle = halve(group, box.high - box.low);
    group.part[0] = make(begin, middle);
    group.part[1] = make(middle, end);
    group.height = 1 + std::max(groups[group.part[0]].height, groups[group.part[1]].height);
  }
  groups[g] = group;
  return g;
}

double BoundaryGroups::distance(Vec3 const& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (groups.empty()) return nearest;
  std::vector<Index32> open{0};
  auto const from = [&](Index32 g) { return gridmorph::distance(x, groups[g].centre); };
  while (!open.empty()) {
    Index32 const g = open.back();
    Group const& group = groups[g];
    open.pop_back();
    if (from(g) - group.radius > nearest) continue;
    if (group.part[0] < 0) {
      for (Index32 k = group.begin; k < group.end; ++k)
        nearest = std::min(nearest, gridmorph::distance(x, x_[node(k)]));
    } else {
      bool const first_is_nearer = from(group.part[0]) < from(group.part[1]);
      open.push_back(group.part[first_is_nearer ? 1 : 0]);
      open.push_back(group.part[first_is_nearer ? 0 : 1]);
    }
  }
  return nearest;
}

Vec3 BoundaryGroups::longest_axis(Group const& group) const {
  double moments[3][3], v[3][3];
  std::copy_n(&group.moments[0][0], 9, &moments[0][0]);
  kernels::diagonalise(moments, v);
  int first = 0;
  for (int k = 1; k < 3; ++k)
    if (moments[k][k] > moments[first][first]) first = k;
  double const next = std::max(moments[(first + 1) % 3][(first + 1) % 3], moments[(first + 2) % 3][(first + 2) % 3]);
  if (!(next < (1 - 1e-3) * moments[first][first])) return {};
  Vec3 const axis{v[first][0], v[first][1], v[first][2]};
  // Eigenvectors have no sense: towards the side that reaches farther, where there is one.
  double reach = 0, whole = 0;
  for (Index32 k = group.begin; k < group.end; ++k) {
    double const at = dot(x_[node(k)] - group.centre, axis), cubed = area(k) * at * at * at;
    reach += cubed;
    whole += std::abs(cubed);
  }
  if (std::abs(reach) < 1e-6 * whole) reach = dot(axis, {1, 0.618, 0.382});
  return reach < 0 ? -axis : axis;
}

Index32 BoundaryGroups::halve(Group const& group, Vec3 const& extent) {
  // Extents that are the same but for round-off: the first axis.
  double const slack = step_;
  std::size_t const axis =
      extent.x + slack >= extent.y ? (extent.x + slack >= extent.z ? 0 : 2) : (extent.y + slack >= extent.z ? 1 : 2);
  Vec3 const across = along_ == Along::principal_axes ? longest_axis(group) : Vec3{};
  bool const is_turned = norm(across) > 0;
  for (Index32 k = group.begin; k < group.end; ++k) {
    auto const n = std::size_t(order_[k]);
    key_[n] = is_turned ? std::int64_t(std::floor(dot(x_[nodes_[n]] - group.centre, across) / step_ + 0.3819))
                        : steps_[n][axis];
  }
  Index32 middle = (group.begin + group.end) / 2;
  std::nth_element(order_.begin() + group.begin, order_.begin() + middle, order_.begin() + group.end,
                   [&](Index32 a, Index32 b) {
                     auto const s = key_[a], t = key_[b];
                     return s < t || (s == t && place_[a] < place_[b]);
                   });
  if (!is_turned) return middle;
  // Those with the median's key to one side of it, the one that leaves halves more alike, where both have nodes.
  auto const median = key_[order_[middle]];
  auto const begin = order_.begin() + group.begin, end = order_.begin() + group.end;
  auto const below = Index32(std::partition(begin, end, [&](Index32 n) { return key_[n] < median; }) - order_.begin());
  auto const upto = Index32(std::partition(order_.begin() + below, end, [&](Index32 n) { return key_[n] == median; }) -
                            order_.begin());
  bool const lower = below > group.begin && (upto >= group.end || middle - below <= upto - middle);
  return lower ? below : upto < group.end ? upto : middle;
}

void BoundaryGroups::add_rows(InterpolationOperator& leaves, LayerRows& rows) const {
  std::vector<Index32> items;
  std::vector<double> weights;
  std::vector<std::vector<Index32>> by_height(std::size_t(groups.front().height) + 1);
  for (std::size_t g = 0; g < groups.size(); ++g) by_height[groups[g].height].push_back(Index32(g));
  for (Index32 const g : by_height[0]) {
    items.clear();
    weights.clear();
    for (Index32 k = groups[g].begin; k < groups[g].end; ++k) {
      items.push_back(item(k));
      weights.push_back(area(k));
    }
    leaves.add(g, items, weights);
  }
  for (std::size_t h = 1; h < by_height.size(); ++h) {
    for (Index32 const g : by_height[h]) {
      Group const& group = groups[g];
      double const parts[2] = {groups[group.part[0]].area, groups[group.part[1]].area};
      rows.rows.add(g, group.part, parts);
    }
    rows.level.push_back(rows.rows.size());
  }
}

}  // namespace gridmorph
