// Vectors at nodes where their owner keeps them: component arrays of any stride, interleaved, or zones apart from one
// another; double or float.
//
// What the layout is, a program knows only when it runs. Kernels ask once per row of nodes, so one instance of each
// serves all layouts, and rows of unit stride cost what they cost in plain arrays.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <type_traits>

namespace gridmorph::kernels {

/// The nodes of one zone of blocks: (i, j, k) at x[i stride[0] + j stride[1] + k stride[2]]; strides in elements.
struct ZoneArray {
  Index first_node;
  Index n_i, n_j;
  Index stride[3];
  void *x, *y, *z;
};

/// Vectors of nodes wherever they lie, not owned. Which are only read is known to the Views that they come from
/// (mesh/vector_view.hpp).
struct VectorArray {
  void* x = nullptr;
  void* y = nullptr;
  void* z = nullptr;
  Index stride = 1;
  ZoneArray const* zones = nullptr;  ///< ascending first_node; where there are any, x, y, z and stride are not used
  int n_zones = 0;
  bool single = false;  ///< float

  /// Node n + w of a row along i at x[w * stride].
  template <class Real>
  struct Row {
    Real *x, *y, *z;
    Index stride;
  };

  /// body(row that begins at node n): a Row<double> or a Row<float>. Cost with zones: a bisection, two divisions.
  template <class Body>
  KOKKOS_INLINE_FUNCTION void with_row(Index n, Body const& body) const {
    if (single)
      body(row<float>(n));
    else
      body(row<double>(n));
  }

  /// Where the row that begins at node n is one of doubles with unit stride: its arrays.
  template <class Real>
  KOKKOS_INLINE_FUNCTION bool plain_row(Index n, Real*& at_x, Real*& at_y, Real*& at_z) const {
    if (single) return false;
    Row<double> const at = row<double>(n);
    at_x = at.x;
    at_y = at.y;
    at_z = at.z;
    return at.stride == 1;
  }

  KOKKOS_INLINE_FUNCTION Vec3 operator[](Index n) const {
    Vec3 v;
    with_row(n, [&](auto const& at) { v = {double(*at.x), double(*at.y), double(*at.z)}; });
    return v;
  }
  KOKKOS_INLINE_FUNCTION void set(Index n, Vec3 const& v) const {
    with_row(n, [&](auto const& at) {
      using Real = std::remove_reference_t<decltype(*at.x)>;
      *at.x = Real(v.x);
      *at.y = Real(v.y);
      *at.z = Real(v.z);
    });
  }

 private:
  template <class Real>
  KOKKOS_INLINE_FUNCTION static Row<Real> row_at(void* x, void* y, void* z, Index offset, Index stride) {
    return {static_cast<Real*>(x) + offset, static_cast<Real*>(y) + offset, static_cast<Real*>(z) + offset, stride};
  }
  template <class Real>
  KOKKOS_INLINE_FUNCTION Row<Real> row(Index n) const {
    if (zones == nullptr) return row_at<Real>(x, y, z, n * stride, stride);
    int lo = 0, hi = n_zones;
    while (hi - lo > 1) {
      int const mid = (lo + hi) / 2;
      (zones[mid].first_node <= n ? lo : hi) = mid;
    }
    ZoneArray const& zone = zones[lo];
    Index const local = n - zone.first_node, line = local / zone.n_i;
    Index const i = local - line * zone.n_i, k = line / zone.n_j, j = line - k * zone.n_j;
    return row_at<Real>(zone.x, zone.y, zone.z, i * zone.stride[0] + j * zone.stride[1] + k * zone.stride[2],
                        zone.stride[0]);
  }
};

}  // namespace gridmorph::kernels
