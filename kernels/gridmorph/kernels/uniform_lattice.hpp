// Trilinear interpolation in a lattice of equal cells.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// The cell of a lattice that holds a point, and the place of the point in it.
struct PlaceInCell {
  std::int64_t cell[3];
  double t[3];

  /// Share of corner c, bit a of which says whether it is the upper one along axis a.
  KOKKOS_INLINE_FUNCTION double weight(int c) const {
    double w = 1;
    for (int a = 0; a < 3; ++a) w *= ((c >> a) & 1) != 0 ? t[a] : 1 - t[a];
    return w;
  }
};

struct UniformLattice {
  Vec3 low;                           ///< node (0, 0, 0)
  double spacing = 1;                 ///< of nodes, along all axes
  std::int32_t nodes[3] = {1, 1, 1};  ///< along each axis, i fastest; 1: the lattice is flat

  KOKKOS_INLINE_FUNCTION std::int64_t size() const { return std::int64_t(nodes[0]) * nodes[1] * nodes[2]; }
  KOKKOS_INLINE_FUNCTION Vec3 position(std::int64_t n) const {
    std::int64_t const i = n % nodes[0], j = n / nodes[0] % nodes[1], k = n / (std::int64_t(nodes[0]) * nodes[1]);
    return low + spacing * Vec3{double(i), double(j), double(k)};
  }

  /// The cell of x; outside the lattice of its nearest point.
  KOKKOS_INLINE_FUNCTION PlaceInCell place(Vec3 const& x) const {
    double const place[3] = {(x.x - low.x) / spacing, (x.y - low.y) / spacing, (x.z - low.z) / spacing};
    PlaceInCell at;
    for (int a = 0; a < 3; ++a) {
      bool const flat = nodes[a] < 2;
      double const last = nodes[a] - 1, p = place[a] > 0 ? (place[a] < last ? place[a] : last) : 0;
      at.cell[a] = flat ? 0 : (p < last ? std::int64_t(p) : nodes[a] - 2);
      at.t[a] = flat ? 0 : p - double(at.cell[a]);
    }
    return at;
  }

  /// Value at x of a field on the nodes; outside the lattice that of its nearest point. Written in differences, so that
  /// equal values come back bit for bit.
  KOKKOS_INLINE_FUNCTION Vec3 at(Vec3 const* value, Vec3 const& x) const {
    PlaceInCell const p = place(x);
    std::int64_t const* const node = p.cell;
    double const* const t = p.t;
    std::int64_t step[3];
    for (int a = 0; a < 3; ++a) step[a] = nodes[a] < 2 ? 0 : 1;
    std::int64_t const row = nodes[0], plane = row * nodes[1];
    Vec3 const* v = value + node[0] + row * node[1] + plane * node[2];
    std::int64_t const i = step[0], j = row * step[1], k = plane * step[2];
    Vec3 const low_plane = bilinear(v, i, j, t), high_plane = bilinear(v + k, i, j, t);
    return low_plane + t[2] * (high_plane - low_plane);
  }

 private:
  KOKKOS_INLINE_FUNCTION static Vec3 bilinear(Vec3 const* v, std::int64_t i, std::int64_t j, double const* t) {
    Vec3 const a = v[0] + t[0] * (v[i] - v[0]), b = v[j] + t[0] * (v[i + j] - v[j]);
    return a + t[1] * (b - a);
  }
};

}  // namespace gridmorph::kernels
