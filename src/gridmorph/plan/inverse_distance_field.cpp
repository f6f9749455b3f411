#include <gridmorph/plan/boundary_groups.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/make_rows.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

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
  BoundaryGroups const tree(coordinates, nodes, area, 0.2513 * out.shape.spacing);
  out.n_groups = Index32(tree.groups.size());
  for (auto const& group : tree.groups) out.centre.push_back(group.centre);
  tree.add_rows(out.leaves, out.groups);

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
                              auto const& group = tree.groups[g];
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
