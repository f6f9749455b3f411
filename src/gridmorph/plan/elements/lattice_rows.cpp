#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/background.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {
namespace {

using Host = Kokkos::DefaultHostExecutionSpace;
using Range = Kokkos::RangePolicy<Host, Kokkos::IndexType<Index>>;

/// Where a point is: the lattice cell and its place in it.
struct Place {
  int zone = -1;
  Index3 node{};                     ///< lower corner of the cell, in its zone
  std::array<double, 3> fraction{};  ///< 0 ... 1
  double distance = 0;               ///< of the point from the cell
};

class Locator {
 public:
  Locator(Background const& background) : lattice_(*background.lattice), dimension_(background.dimension) {}

  [[nodiscard]] Place operator()(Vec3 const& point) const {
    Vec3 const q = lattice_.chart(point);
    std::array<double, 3> x{q.x, q.y, q.z};
    if (dimension_ == 2) x[2] = lattice_.planes[2].front();
    Index3 slab{};
    for (std::size_t a = 0; a < 3; ++a) slab[a] = lattice_.slab[a][cell(a, x[a])];
    int zone = lattice_.zone[lattice_.box(slab)];
    if (zone < 0) {
      slab = nearest(x);
      zone = lattice_.zone[lattice_.box(slab)];
    }
    Place place;
    place.zone = zone;
    double squares = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      auto const [low, high] = limits(a, slab[a]);
      double const in = std::clamp(x[a], low, high);
      squares += (x[a] - in) * (x[a] - in);
      int const first = lattice_.cut[a][slab[a]], end = lattice_.cut[a][std::size_t(slab[a]) + 1];
      int const c = std::clamp(cell(a, in), first, end - 1);
      double const from = lattice_.planes[a][c], to = lattice_.planes[a][c + 1];
      place.node[a] = c - first;
      place.fraction[a] = std::clamp((in - from) / (to - from), 0.0, 1.0);
    }
    place.distance = std::sqrt(squares);
    return place;
  }

 private:
  [[nodiscard]] int cell(std::size_t axis, double x) const {
    auto const& p = lattice_.planes[axis];
    return int(std::upper_bound(p.begin() + 1, p.end() - 1, x) - p.begin()) - 1;
  }
  [[nodiscard]] std::pair<double, double> limits(std::size_t axis, int slab) const {
    auto plane = [&](int s) { return lattice_.planes[axis][lattice_.cut[axis][s]]; };
    return {plane(slab), plane(slab + 1)};
  }
  /// The box of slabs outside the wrap nearest to a point, the first of equals.
  [[nodiscard]] Index3 nearest(std::array<double, 3> const& x) const {
    Index3 best{};
    double least = 1e300;
    for (int k = 0; k < lattice_.slabs(2); ++k)
      for (int j = 0; j < lattice_.slabs(1); ++j)
        for (int i = 0; i < lattice_.slabs(0); ++i) {
          Index3 const s{i, j, k};
          if (lattice_.zone[lattice_.box(s)] < 0) continue;
          double squares = 0;
          for (std::size_t a = 0; a < 3; ++a) {
            auto const [low, high] = limits(a, s[a]);
            double const d = x[a] - std::clamp(x[a], low, high);
            squares += d * d;
          }
          if (squares < least) {
            least = squares;
            best = s;
          }
        }
    return best;
  }

  FineLattice const& lattice_;
  int dimension_;
};

/// Nodes with their weights, at most 8 of them; those without weight left out.
struct Weights {
  std::array<Index32, 8> node{};
  std::array<double, 8> weight{};
  int size = 0;
};

Weights weights(Zone const& zone, Place const& place, int dimension) {
  Weights out;
  for (int corner = 0; corner < (dimension == 2 ? 4 : 8); ++corner) {
    double w = 1;
    Index3 node = place.node;
    for (std::size_t a = 0; a < std::size_t(dimension); ++a) {
      int const upper = corner >> a & 1;
      w *= upper == 1 ? place.fraction[a] : 1 - place.fraction[a];
      node[a] += upper;
    }
    if (w == 0) continue;
    out.node[out.size] = Index32(zone.node(node));
    out.weight[out.size++] = w;
  }
  return out;
}

}  // namespace

FarRows lattice_rows(HostInstance const& host, Background const& background, Coordinates const& coordinates,
                     std::span<Index32 const> nodes) {
  if (!background.lattice)
    throw MeshError("this background mesh is not made of lattice cells; its cells are found by the element locator");
  Locator const locate(background);
  Index const n = Index(nodes.size());
  double const round_off = 1e-12 * extent_of(host, background.mesh.coordinates).size();
  FarRows out;
  out.rows.target.assign(nodes.begin(), nodes.end());
  out.rows.first.assign(n + 1, 0);
  auto row = [&](Index r) {
    Place const place = locate(coordinates[nodes[r]]);
    return std::pair(weights(background.mesh.zones[place.zone], place, background.dimension), place.distance);
  };
  // Twice the same search: cheaper than keeping what it found.
  std::vector<float> distance(n, 0);
  detail::for_all(host, "gridmorph::lattice_rows::count", n, [&](Index r) {
    auto const [w, d] = row(r);
    out.rows.first[r + 1] = w.size;
    distance[r] = float(d);
  });
  for (Index r = 0; r < n; ++r) {
    out.rows.first[r + 1] += out.rows.first[r];
    if (distance[r] > round_off) ++out.n_outside;
    out.largest_distance = std::max(out.largest_distance, double(distance[r]));
  }
  out.rows.item.resize(out.rows.first.back());
  out.rows.weight.resize(out.rows.item.size());
  detail::for_all(host, "gridmorph::lattice_rows::fill", n, [&](Index r) {
    Weights const w = row(r).first;
    auto const first = std::size_t(out.rows.first[r]);
    for (int k = 0; k < w.size; ++k) {
      out.rows.item[first + std::size_t(k)] = w.node[k];
      out.rows.weight[first + std::size_t(k)] = float(w.weight[k]);
    }
  });
  return out;
}

}  // namespace gridmorph
