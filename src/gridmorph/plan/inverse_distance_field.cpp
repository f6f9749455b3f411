#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/make_rows.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

/// Boundary nodes in groups of groups, halved at the median along their longest extent.
struct Group {
  Vec3 centre;  ///< weighted by area
  double radius = 0, area = 0;
  Index32 part[2] = {-1, -1};  ///< -1: a leaf
  Index32 begin = 0, end = 0;  ///< of the ordered nodes
  int height = 0;              ///< 0: a leaf
};

class Tree {
 public:
  /// leaf_radius: of groups whose nodes need not be told apart.
  Tree(Coordinates const& x, std::vector<Index32> const& nodes, std::vector<double> const& area, double leaf_radius)
      : x_(x), nodes_(nodes), area_(area), leaf_radius_(leaf_radius), order_(nodes.size()) {
    std::iota(order_.begin(), order_.end(), Index32(0));
    // Coarse steps: which nodes make a group is seen in the field, so noise far above round-off should not decide it.
    PlaceOrder const is_before(x, 1.13e-3);
    std::sort(order_.begin(), order_.end(),
              [&](Index32 a, Index32 b) { return is_before(nodes_[std::size_t(a)], nodes_[std::size_t(b)]); });
    step_ = is_before.step();
    place_.resize(order_.size());
    steps_.resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      place_[std::size_t(order_[k])] = Index32(k);
      steps_[k] = is_before.steps(x[nodes[k]]);
    }
    if (!nodes.empty()) make(0, Index32(nodes.size()));
  }
  std::vector<Group> groups;  ///< the root first

  [[nodiscard]] Index32 item(Index32 k) const { return order_[std::size_t(k)]; }
  [[nodiscard]] Index32 node(Index32 k) const { return nodes_[std::size_t(order_[std::size_t(k)])]; }
  [[nodiscard]] double area(Index32 k) const { return area_[std::size_t(order_[std::size_t(k)])]; }

 private:
  static constexpr Index32 leaf_size = 4;
  double step_ = 1;  ///< of PlaceOrder

  Index32 make(Index32 begin, Index32 end) {
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
    for (Index32 k = begin; k < end; ++k) group.radius = std::max(group.radius, distance(x_[node(k)], group.centre));
    if (end - begin > leaf_size || (end - begin > 1 && group.radius > leaf_radius_)) {
      Vec3 const extent = box.high - box.low;
      // Extents that are the same but for round-off: the first axis.
      double const slack = step_;
      std::size_t const axis = extent.x + slack >= extent.y ? (extent.x + slack >= extent.z ? 0 : 2)
                                                            : (extent.y + slack >= extent.z ? 1 : 2);
      Index32 const middle = (begin + end) / 2;
      std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                       [&](Index32 a, Index32 b) {
                         auto const s = steps_[std::size_t(a)][axis], t = steps_[std::size_t(b)][axis];
                         return s < t || (s == t && place_[std::size_t(a)] < place_[std::size_t(b)]);
                       });
      group.part[0] = make(begin, middle);
      group.part[1] = make(middle, end);
      group.height = 1 + std::max(groups[std::size_t(group.part[0])].height, groups[std::size_t(group.part[1])].height);
    }
    groups[std::size_t(g)] = group;
    return g;
  }

  Coordinates const& x_;
  std::vector<Index32> const& nodes_;
  std::vector<double> const& area_;
  double leaf_radius_;
  std::vector<Index32> order_, place_;  ///< by position, and where each is in that order
  std::vector<std::array<std::int64_t, 3>> steps_;
};

kernels::UniformLattice lattice_over(Vec3 const& low, Vec3 const& high, int dimension, Index most_nodes) {
  kernels::UniformLattice lattice;
  lattice.low = low;
  double const size[3] = {high.x - low.x, high.y - low.y, dimension == 2 ? 0 : high.z - low.z};
  double spacing = std::max({size[0], size[1], size[2]}) / 4;
  auto const fits = [&](double h) {
    double n = 1;
    for (double const s : size) n *= s > 0 ? std::ceil(s / h) + 1 : 1;
    return n <= double(most_nodes);
  };
  while (fits(spacing / 1.1)) spacing /= 1.1;
  lattice.spacing = spacing;
  for (int a = 0; a < 3; ++a) lattice.nodes[a] = size[a] > 0 ? std::int32_t(std::ceil(size[a] / spacing)) + 1 : 1;
  return lattice;
}

}  // namespace

InverseDistanceField make_scatter_lattice(HostInstance const& host, Coordinates const& coordinates,
                                          std::vector<Index32> const& nodes, std::vector<double> const& area,
                                          int dimension, Vec3 const& low, Vec3 const& high, Index most_nodes,
                                          double opening) {
  InverseDistanceField out;
  if (nodes.empty()) return out;
  out.shape = lattice_over(low, high, dimension, most_nodes);
  // What cells of the lattice show. Where nodes of walls are further apart, the nearest of them decide about a cell,
  // and means of four would depend on which are grouped.
  Tree const tree(coordinates, nodes, area, 0.2513 * out.shape.spacing);
  out.n_groups = Index32(tree.groups.size());
  for (Group const& group : tree.groups) out.centre.push_back(group.centre);
  std::vector<Index32> items;
  std::vector<double> weights;
  std::vector<std::vector<Index32>> by_height(std::size_t(tree.groups.front().height) + 1);
  for (std::size_t g = 0; g < tree.groups.size(); ++g)
    by_height[std::size_t(tree.groups[g].height)].push_back(Index32(g));
  for (Index32 const g : by_height[0]) {
    items.clear();
    weights.clear();
    for (Index32 k = tree.groups[std::size_t(g)].begin; k < tree.groups[std::size_t(g)].end; ++k) {
      items.push_back(tree.item(k));
      weights.push_back(tree.area(k));
    }
    out.leaves.add(g, items, weights);
  }
  for (std::size_t h = 1; h < by_height.size(); ++h) {
    for (Index32 const g : by_height[h]) {
      Group const& group = tree.groups[std::size_t(g)];
      double const parts[2] = {tree.groups[std::size_t(group.part[0])].area,
                               tree.groups[std::size_t(group.part[1])].area};
      out.groups.rows.add(g, group.part, parts);
    }
    out.groups.level.push_back(out.groups.rows.size());
  }

  double const nearest = 0.05 * out.shape.spacing;
  struct Room {
    std::vector<Index32> open, items;
    std::vector<double> weights;
  };
  out.lattice = make_rows(host, "gridmorph::make_scatter_lattice", out.shape.size(),
                          [&, room = Room()](Index n, InterpolationOperator& rows) mutable {
                            Vec3 const x = out.shape.position(n);
                            room.items.clear();
                            room.weights.clear();
                            room.open.assign(1, 0);
                            while (!room.open.empty()) {
                              Index32 const g = room.open.back();
                              room.open.pop_back();
                              Group const& group = tree.groups[std::size_t(g)];
                              double const d = std::max(distance(x, group.centre), nearest);
                              if (group.part[0] >= 0 && group.radius > opening * d) {
                                room.open.push_back(group.part[1]);
                                room.open.push_back(group.part[0]);
                                continue;
                              }
                              room.items.push_back(g);
                              room.weights.push_back(group.area / (dimension == 2 ? d * d * d : d * d * d * d));
                            }
                            // Lengths may be tiny: only ratios of weights count.
                            double const largest = *std::max_element(room.weights.begin(), room.weights.end());
                            for (double& w : room.weights) w /= largest;
                            rows.add(Index32(n), room.items, room.weights);
                          });
  return out;
}

}  // namespace gridmorph
