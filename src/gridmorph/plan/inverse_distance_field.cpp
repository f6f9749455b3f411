#include <gridmorph/kernels/lattice_field.hpp>
#include <gridmorph/plan/boundary_groups.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/make_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace gridmorph {

namespace {

kernels::UniformLattice lattice_over(ScatterLattice const& asked, int dimension) {
  Vec3 const &low = asked.low, &high = asked.high;
  kernels::UniformLattice lattice;
  lattice.low = low;
  double const size[3] = {high.x - low.x, high.y - low.y, dimension == 2 ? 0 : high.z - low.z};
  double spacing = std::max({size[0], size[1], size[2]}) / 4;
  auto const fits = [&](double h) {
    double n = 1;
    for (double const s : size) n *= s > 0 ? std::ceil(s / h) + 1 : 1;
    return n <= double(asked.most_nodes);
  };
  while (fits(spacing / 1.1)) spacing /= 1.1;
  lattice.spacing = spacing;
  for (int a = 0; a < 3; ++a) lattice.nodes[a] = size[a] > 0 ? std::int32_t(std::ceil(size[a] / spacing)) + 1 : 1;
  return lattice;
}

/// The nodes of a lattice that nodes of a mesh read, ascending. Those a little off count too: who morphs may have the
/// mesh in single precision, far from the origin too.
std::vector<Index> nodes_read(kernels::UniformLattice const& lattice, Coordinates const& x,
                              std::vector<Index32> const& readers) {
  Vec3 const &low = lattice.low, high = lattice.position(lattice.size() - 1);
  double const farthest = std::max(
      {std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y), std::abs(high.z)});
  double const off = double(std::numeric_limits<float>::epsilon()) * farthest / lattice.spacing;
  double const margin = std::max(1e-3, off);  // of a cell
  kernels::LatticeReader<Vec3> const at(lattice);
  std::vector<std::uint8_t> is_read(lattice.size(), 0);
  for (Index32 const n : readers) {
    auto const place = at.place(x[n]);
    double const cell[3] = {place.cell.x, place.cell.y, place.cell.z}, t[3] = {place.t.x, place.t.y, place.t.z};
    Index from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = std::max<Index>(0, Index(cell[a]) - (t[a] < margin ? 1 : 0));
      to[a] = std::min<Index>(lattice.nodes[a] - 1, Index(cell[a]) + (t[a] > 1 - margin ? 2 : 1));
    }
    for (Index k = from[2]; k <= to[2]; ++k)
      for (Index j = from[1]; j <= to[1]; ++j)
        for (Index i = from[0]; i <= to[0]; ++i) is_read[i + lattice.nodes[0] * (j + lattice.nodes[1] * k)] = 1;
  }
  std::vector<Index> out;
  for (Index n = 0; n < lattice.size(); ++n)
    if (readers.empty() || margin > 1 || is_read[n] != 0) out.push_back(n);
  return out;
}

}  // namespace

InverseDistanceField make_scatter_lattice(HostInstance const& host, Coordinates const& coordinates,
                                          std::vector<Index32> const& nodes, std::vector<double> const& area,
                                          int dimension, ScatterLattice const& lattice) {
  InverseDistanceField out;
  if (nodes.empty()) return out;
  out.shape = lattice_over(lattice, dimension);
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
  std::vector<Index> const read = nodes_read(out.shape, coordinates, lattice.readers);
  out.lattice = make_rows(host, "gridmorph::make_scatter_lattice", std::ssize(read),
                          [&, room = Room()](Index k, InterpolationOperator& rows) mutable {
                            Index const n = read[k];
                            Vec3 const x = out.shape.position(n);
                            room.items.clear();
                            room.weights.clear();
                            room.open.assign(1, 0);
                            while (!room.open.empty()) {
                              Index32 const g = room.open.back();
                              room.open.pop_back();
                              auto const& group = tree.groups[g];
                              double const d = std::max(distance(x, group.centre), nearest);
                              if (group.part[0] >= 0 && group.radius > lattice.opening * d) {
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
