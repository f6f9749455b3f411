// Quality of the cells of a row, several at once; the definitions are those of cell_quality.hpp.
//
// Neighbouring cells along i are taken as lanes (lanes.hpp): their corners are contiguous in memory. Cells that are not
// regular, few in any mesh, are marked and measured again one by one with the general functions. The value of a cell
// depends on its corners alone, not on its place in the row or on the number of lanes.
//
// Quantities of the planes of nodes between two cells are computed once per row and kept in scratch arrays. Coordinates
// of the 4 node lines of a row are read from memory once, and again from the first-level cache.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/regular_cell.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// Cells that follow one another along i. x, y, z: coordinates of corner (0, 0, 0) of the first cell; the nodes are
/// contiguous along i and have the given strides along j and k.
struct CellRow {
  double const *x, *y, *z;
  std::int64_t stride_j, stride_k;
  int count;
  double handedness;  ///< +1 or -1

  /// Corners of cell n.
  KOKKOS_INLINE_FUNCTION HexCell cell(int n) const {
    HexCell c;
    for (int m = 0; m < 8; ++m) {
      std::int64_t const at = n + (m & 1) + (m >> 1 & 1) * stride_j + (m >> 2) * stride_k;
      c.corner[m] = {x[at], y[at], z[at]};
    }
    return c;
  }

  /// Nodes n, n + 1, ... of the line (j, k), j and k in {0, 1}.
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> node(int n, int j, int k) const {
    std::int64_t const at = n + j * stride_j + k * stride_k;
    return {load_lanes<T>(x + at), load_lanes<T>(y + at), load_lanes<T>(z + at)};
  }

  /// Edges along i of the cells n, n + 1, ...
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION FourVectors<T> i_edges(int n) const {
    return {node<T>(n + 1, 0, 0) - node<T>(n, 0, 0), node<T>(n + 1, 1, 0) - node<T>(n, 1, 0),
            node<T>(n + 1, 0, 1) - node<T>(n, 0, 1), node<T>(n + 1, 1, 1) - node<T>(n, 1, 1)};
  }

  /// Edges in the planes n, n + 1, ... of constant i.
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION PlaneEdges<T> plane_edges(int n) const {
    LaneVec3<T> const p00 = node<T>(n, 0, 0), p10 = node<T>(n, 1, 0), p01 = node<T>(n, 0, 1), p11 = node<T>(n, 1, 1);
    return {p10 - p00, p11 - p01, p01 - p00, p11 - p10};
  }

  /// All edges of the cells n, n + 1, ...
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION CellEdges<T> edges(int n) const {
    return cell_edges<T>([&](int i, int j, int k) { return node<T>(n + i, j, k); });
  }
};

/// Calls `f.operator()<T>(n)` for the cells n, n + 1, ... of a row of `count`, until all are done: with T = Lanes<W>
/// and, where the row is shorter than W, with T = double. The last lanes may take cells a second time.
template <int W, class Function>
KOKKOS_FORCEINLINE_FUNCTION void for_each_lanes(int count, Function const& f) {
  if constexpr (W > 1) {
    if (count >= W) {
      int n = 0;
      for (; n + W <= count; n += W) f.template operator()<Lanes<W>>(n);
      if (n < count) f.template operator()<Lanes<W>>(count - W);
      return;
    }
  }
  for (int n = 0; n < count; ++n) f.template operator()<double>(n);
}

/// determinant[n]: determinant_3x3x3 of cell n. mark: scratch for row.count values.
template <int W>
KOKKOS_INLINE_FUNCTION void row_determinants(CellRow const& row, double* determinant, double* mark) {
  for_each_lanes<W>(row.count, [&]<class T>(int n) {
    CellEdges<T> const edges = row.edges<T>(n);
    CellJacobians<T> const j = cell_jacobians(edges, row.handedness);
    T const ratio = determinant_ratio(j.all);
    store_lanes(determinant + n, ratio);
    store_lanes(mark + n, irregularity(square_extremes(edges), j.volume, ratio));
  });
  for (int n = 0; n < row.count; ++n)
    if (mark[n] != 0) determinant[n] = determinant_3x3x3(row.cell(n), row.handedness);
}

/// Values of CellMeasures for up to N cells, one array each.
template <int N>
struct RowMeasures {
  double determinant_2x2x2[N], determinant_3x3x3[N], smallest_corner_jacobian[N], volume[N], aspect_ratio[N],
      minimum_angle_deg[N], equiangle_skewness[N];
  bool collapsed[N];

  KOKKOS_INLINE_FUNCTION void set(int n, CellMeasures const& m) {
    determinant_2x2x2[n] = m.determinant_2x2x2;
    determinant_3x3x3[n] = m.determinant_3x3x3;
    smallest_corner_jacobian[n] = m.smallest_corner_jacobian;
    volume[n] = m.volume;
    aspect_ratio[n] = m.aspect_ratio;
    minimum_angle_deg[n] = m.minimum_angle_deg;
    equiangle_skewness[n] = m.equiangle_skewness;
    collapsed[n] = m.collapsed;
  }
};

/// M numbers per plane of nodes along a row of at most N cells, which the cells on both sides of a plane share.
template <int M, int N>
struct RowPlanes {
  double value[M][N + 1];

  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION void set(int m, int n, T const& v) {
    store_lanes(value[m] + n, v);
  }
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION void set(int m, int n, LaneVec3<T> const& v) {
    set(m, n, v.x);
    set(m + 1, n, v.y);
    set(m + 2, n, v.z);
  }
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION T get(int m, int n) const {
    return load_lanes<T>(value[m] + n);
  }
  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> get_vector(int m, int n) const {
    return {get<T>(m, n), get<T>(m + 1, n), get<T>(m + 2, n)};
  }
};

template <class T, int N>
KOKKOS_FORCEINLINE_FUNCTION void store_shape(RowPlanes<16, N>& planes, int n, PlaneShape<T> const& p) {
  planes.set(0, n, p.j0);
  planes.set(3, n, p.j1);
  planes.set(6, n, p.k0);
  planes.set(9, n, p.k1);
  planes.set(12, n, p.cosines.min);
  planes.set(13, n, p.cosines.max);
  planes.set(14, n, p.squares.min);
  planes.set(15, n, p.squares.max);
}

template <class T, int N>
KOKKOS_FORCEINLINE_FUNCTION PlaneShape<T> load_shape(RowPlanes<16, N> const& planes, int n) {
  return {planes.template get_vector<T>(0, n),
          planes.template get_vector<T>(3, n),
          planes.template get_vector<T>(6, n),
          planes.template get_vector<T>(9, n),
          {planes.template get<T>(12, n), planes.template get<T>(13, n)},
          {planes.template get<T>(14, n), planes.template get<T>(15, n)}};
}

/// Calls `f.operator()<T>(n, shape)` with the CellShape of the cells n, n + 1, ... of a row of at most N.
template <int W, int N, class Function>
KOKKOS_FORCEINLINE_FUNCTION void for_each_shape(CellRow const& row, Function const& f) {
  RowPlanes<16, N> planes;
  for_each_lanes<W>(row.count + 1, [&]<class T>(int n) {
    PlaneEdges<T> const e = row.plane_edges<T>(n);
    store_shape(planes, n, plane_shape(e.j0, e.j1, e.k0, e.k1));
  });
  for_each_lanes<W>(row.count, [&]<class T>(int n) {
    f.template operator()<T>(n, cell_shape(row.i_edges<T>(n), load_shape<T>(planes, n), load_shape<T>(planes, n + 1)));
  });
}

/// Aspect ratio, minimum angle and skewness of every cell; marks cells that are not regular.
template <int W, int N>
KOKKOS_INLINE_FUNCTION void row_shapes(CellRow const& row, RowMeasures<N>& m, double (&mark)[N]) {
  for_each_shape<W, N>(row, [&]<class T>(int n, CellShape<T> const& shape) {
    constexpr double degrees = 57.295779513082320877;
    // (a - 90) / 90 of an angle is (90 - a) / 90 of its supplement, whose cosine has the other sign.
    T const steepest = larger(shape.cosines.max, -shape.cosines.min);
    store_lanes(m.aspect_ratio + n, square_root(shape.squares.max / shape.squares.min));
    store_lanes(m.minimum_angle_deg + n, degrees * arc_cosine(shape.cosines.max));
    store_lanes(m.equiangle_skewness + n, 1 - degrees / 90 * arc_cosine(steepest));
    store_lanes(mark + n,
                irregularity(shape.squares, load_lanes<T>(m.volume + n), load_lanes<T>(m.determinant_3x3x3 + n)));
  });
}

/// cell_measures of every cell of a row of at most N.
template <int W, int N>
KOKKOS_INLINE_FUNCTION void row_measures(CellRow const& row, RowMeasures<N>& m) {
  double mark[N];
  for_each_lanes<W>(row.count, [&]<class T>(int n) {
    CellJacobians<T> const j = cell_jacobians(row.edges<T>(n), row.handedness);
    store_lanes(m.determinant_2x2x2 + n, determinant_ratio(j.eight));
    store_lanes(m.determinant_3x3x3 + n, determinant_ratio(j.all));
    store_lanes(m.smallest_corner_jacobian + n, j.eight.min);
    store_lanes(m.volume + n, j.volume);
  });
  // In loops of their own: registers do not hold both.
  row_shapes<W>(row, m, mark);
  for (int n = 0; n < row.count; ++n) {
    m.collapsed[n] = false;
    if (mark[n] != 0) m.set(n, cell_measures(row.cell(n), row.handedness));
  }
}

/// What a verdict needs of up to N cells; a third of the work of RowMeasures.
template <int N>
struct RowVerdicts {
  double determinant_3x3x3[N];
  double largest_cosine[N];   ///< of the face angles: that of the smallest one
  double smallest_cosine[N];  ///< that of the largest one
  double mark[N];             ///< nonzero: not a regular cell, the others mean nothing; use cell_measures
};

/// The verdicts on the cells of a row, with the values that row_measures gives, angles as cosines. Cost: about 720
/// flops per cell, 8 square roots, 9 divisions.
template <int W, int N>
KOKKOS_INLINE_FUNCTION void row_verdicts(CellRow const& row, RowVerdicts<N>& v) {
  double volume[N];
  for_each_lanes<W>(row.count, [&]<class T>(int n) {
    CellJacobians<T> const j = cell_jacobians(row.edges<T>(n), row.handedness);
    store_lanes(v.determinant_3x3x3 + n, determinant_ratio(j.all));
    store_lanes(volume + n, j.volume);
  });
  for_each_shape<W, N>(row, [&]<class T>(int n, CellShape<T> const& shape) {
    store_lanes(v.largest_cosine + n, shape.cosines.max);
    store_lanes(v.smallest_cosine + n, shape.cosines.min);
    store_lanes(v.mark + n,
                irregularity(shape.squares, load_lanes<T>(volume + n), load_lanes<T>(v.determinant_3x3x3 + n)));
  });
}

/// The relative displacements of up to N cells.
template <int N>
struct RowRelativeDisplacements {
  double along[3][N];  ///< i, j, k
  double largest[N];   ///< of the three
};

/// The components of relative_displacement of the cells of a row.
template <int W, int N>
KOKKOS_INLINE_FUNCTION void row_relative_displacements(CellRow const& baseline, CellRow const& morphed,
                                                       RowRelativeDisplacements<N>& relative) {
  double mark[N];
  RowPlanes<4, N> planes;
  for_each_lanes<W>(morphed.count + 1, [&]<class T>(int n) {
    PlaneEdges<T> const before = baseline.plane_edges<T>(n), after = morphed.plane_edges<T>(n);
    PairChange<T> const j = pair_change(before.j0, before.j1, after.j0, after.j1),
                        k = pair_change(before.k0, before.k1, after.k0, after.k1);
    planes.set(0, n, j.largest);
    planes.set(1, n, j.length);
    planes.set(2, n, k.largest);
    planes.set(3, n, k.length);
  });
  for_each_lanes<W>(morphed.count, [&]<class T>(int n) {
    FourVectors<T> const before = baseline.i_edges<T>(n), after = morphed.i_edges<T>(n);
    PairChange<T> const i[2] = {pair_change(before.v00, before.v10, after.v00, after.v10),
                                pair_change(before.v01, before.v11, after.v01, after.v11)};
    auto const pair = [&](int m, int at) -> PairChange<T> {
      return {planes.template get<T>(m, at), broadcast<T>(0), planes.template get<T>(m + 1, at)};
    };
    PairChange<T> const j[2] = {pair(0, n), pair(0, n + 1)}, k[2] = {pair(2, n), pair(2, n + 1)};
    MarkedDirections<T> const r = relative_displacement(i, j, k);
    store_lanes(relative.along[0] + n, r.i);
    store_lanes(relative.along[1] + n, r.j);
    store_lanes(relative.along[2] + n, r.k);
    store_lanes(relative.largest + n, larger(larger(r.i, r.j), r.k));
    store_lanes(mark + n, r.mark);
  });
  for (int n = 0; n < morphed.count; ++n)
    if (mark[n] != 0) {
      Vec3 const r = relative_displacement(baseline.cell(n), morphed.cell(n));
      relative.along[0][n] = r.x;
      relative.along[1][n] = r.y;
      relative.along[2][n] = r.z;
      relative.largest[n] = larger(r.x, larger(r.y, r.z));
    }
}

/// How many cells have a positive Jacobian determinant, minus how many have a negative one: the sum of those at the
/// opposite corners (0, 0, 0) and (1, 1, 1), one of which is sound where an edge or a face is collapsed.
KOKKOS_INLINE_FUNCTION int row_orientation(CellRow const& row) {
  int positive = 0;
  for (int n = 0; n < row.count; ++n) {
    HexEdges const e = hex_edges(row.cell(n));
    double const j = dot(cross(e.of[0][0], e.of[1][0]), e.of[2][0]) + dot(cross(e.of[0][3], e.of[1][3]), e.of[2][3]);
    positive += (j > 0 ? 1 : 0) - (j < 0 ? 1 : 0);
  }
  return positive;
}

}  // namespace gridmorph::kernels
