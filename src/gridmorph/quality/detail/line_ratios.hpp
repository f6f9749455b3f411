// Edges and faces of cells against those that continue them along the grid lines, inside zones and across 1-to-1
// interfaces; internal to the quality part.
//
//   growth ratio     edges pq and qr that follow one another along a grid line: max(|pq| / |qr|, |qr| / |pq|)
//   face area ratio  faces F and G of one grid surface with an edge in common: max(A_F / A_G, A_G / A_F),
//                    A = |d1 x d2| / 2 with the diagonals
//                    d1, d2 of the face, the size of its area vector
//
// A cell has the largest ratio of any of its 12 edges, or 6 faces, to those that continue them, 1 where none does.
// Edges shorter than `collapsed_fraction` of the cell's longest one, and faces smaller than that of its largest one,
// are left out (poles, wedges); `unbounded` where a corner is not finite. Squares are compared, so that a cell has one
// square root and one division. Cost per cell: 16 lengths (128 flops) or 17 areas (340), 24 comparisons; nothing is
// kept.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <vector>

namespace gridmorph::detail {

enum class LinePart { edge, face };

/// Cells of a zone on one side of an interface, begin <= c < end, and the nodes behind them.
struct LinkedFace {
  int axis = 0, side = 0;  ///< of the zone's face
  int begin[3] = {0, 0, 0}, end[3] = {0, 0, 0};
  Index donor_first_node = 0;
  Index donor_stride[3] = {0, 0, 0};                   ///< along the donor's axes
  int to_axis[3] = {0, 1, 2}, to_sign[3] = {1, 1, 1};  ///< own axis a runs along donor axis to_axis[a]
  int own_origin[3] = {0, 0, 0}, donor_origin[3] = {0, 0, 0};
  int into_donor = 0;  ///< along to_axis[axis]: 0 where cells follow the interface there, -1 where they end at it

  /// Node of the donor at an own node of the interface.
  KOKKOS_INLINE_FUNCTION void donor_of(int const (&own)[3], int (&donor)[3]) const {
    for (int a = 0; a < 3; ++a) donor[to_axis[a]] = donor_origin[to_axis[a]] + to_sign[a] * (own[a] - own_origin[a]);
  }
};

/// Both sides of every interface that joins faces of zones, those of zone z being first[z] <= n < first[z + 1]. Ranges
/// have been checked by interface_table().
struct LinkedFaceTable {
  std::vector<LinkedFace> faces;
  std::vector<int> first;
};
LinkedFaceTable linked_face_table(Mesh const& mesh);

/// The same on the device.
template <class MemorySpace>
struct LinkedFaces {
  Kokkos::View<LinkedFace const*, MemorySpace> faces;
  Kokkos::View<int const*, MemorySpace> first;
};

template <class Exec>
LinkedFaces<typename Exec::memory_space> upload_linked_faces(Exec const& exec, Mesh const& mesh) {
  LinkedFaceTable const table = linked_face_table(mesh);
  return {upload(exec, "gridmorph::quality::linked_faces", table.faces),
          upload(exec, "gridmorph::quality::first_linked_faces", table.first)};
}

/// The two squares of the largest ratio so far of up to N cells in a row: ratios are compared by products, so that one
/// is divided.
template <int N>
struct RowRatios {
  double largest[N], smallest[N], limit[N], finite[N];

  KOKKOS_INLINE_FUNCTION void begin(int count) {
    for (int n = 0; n < count; ++n) {
      largest[n] = smallest[n] = 1;
      limit[n] = finite[n] = 0;
    }
  }
  /// The cells' own sizes, all of them: what is too small to count.
  KOKKOS_INLINE_FUNCTION void own(double const* size, int count) {
    for (int n = 0; n < count; ++n) {
      limit[n] = kernels::larger(limit[n], size[n]);
      finite[n] += size[n] - size[n];
    }
  }
  KOKKOS_INLINE_FUNCTION void limits_known(int count) {
    for (int n = 0; n < count; ++n) limit[n] *= kernels::collapsed_fraction * kernels::collapsed_fraction;
  }
  /// Takes the ratios of cells begin <= n < end: size[n] is continued by next[n].
  KOKKOS_INLINE_FUNCTION void compare(double const* size, double const* next, int begin, int end) {
    for (int n = begin; n < end; ++n) take(n, size[n], next[n]);
  }
  KOKKOS_FORCEINLINE_FUNCTION void take(int n, double a, double b) {
    double const least = kernels::smaller(a, b), most = kernels::larger(a, b);
    bool const worse = (least > limit[n]) & (most * smallest[n] > largest[n] * least);
    largest[n] = worse ? most : largest[n];
    smallest[n] = worse ? least : smallest[n];
    finite[n] += b - b;
  }
  KOKKOS_INLINE_FUNCTION double result(int n) const {
    return finite[n] == 0 ? kernels::compat::math::sqrt(largest[n] / smallest[n]) : kernels::unbounded;
  }
};

/// Squares of the lengths of edges along, or four times those of the areas of faces across, direction a, by their node
/// with the lowest indices.
template <LinePart part, class MemorySpace>
struct LineSizes {
  CoordinateViews<MemorySpace> x;

  KOKKOS_INLINE_FUNCTION double at(Index node, Index const (&stride)[3], int a) const {
    Index const b = stride[(a + 1) % 3], c = stride[(a + 2) % 3];
    Vec3 const v = part == LinePart::edge ? step(node, node + stride[a])
                                          : cross(step(node, node + b + c), step(node + b, node + c));
    return dot(v, v);
  }
  /// The ratios at `count` nodes that follow one another along i.
  KOKKOS_INLINE_FUNCTION void row(Index first, Index const (&stride)[3], int a, int count, double* out) const {
    for (int n = 0; n < count; ++n) out[n] = at(first + n, stride, a);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION Vec3 step(Index p, Index q) const {
    return {x.x(q) - x.x(p), x.y(q) - x.y(p), x.z(q) - x.z(p)};
  }
};

/// Where a row of cells lies.
struct RowPlace {
  Index first;  ///< its first node
  Index stride[3];
  int p[3];
  int count;
  bool below[3], above[3];  ///< whether cells follow on either side: along i of the first and of the last of the row

  KOKKOS_INLINE_FUNCTION RowPlace(kernels::ZoneCells const& zone, kernels::RowOfCells const& row)
      : stride{1, zone.node_stride(1), zone.node_stride(2)}, p{row.i, row.j, row.k}, count(row.count) {
    first = zone.first_node + row.i + row.j * stride[1] + row.k * stride[2];
    for (int a = 0; a < 3; ++a) {
      below[a] = p[a] > 0;
      above[a] = p[a] + (a == 0 ? row.count : 1) < zone.extent[a];
    }
  }
};

/// Sizes of one part of the cells of a row and of what continues it on both sides along one direction, other than i.
template <int N>
struct ContinuedRow {
  double own[N + 1], before[N + 1], after[N + 1];

  template <class Sizes>
  KOKKOS_INLINE_FUNCTION void fill(Sizes const& sizes, RowPlace const& at, Index offset, int a, int count) {
    sizes.row(at.first + offset, at.stride, a, count, own);
  }
  template <class Sizes>
  KOKKOS_INLINE_FUNCTION void fill_next(Sizes const& sizes, RowPlace const& at, Index offset, int a, int d, int count) {
    if (at.below[d]) sizes.row(at.first + offset - at.stride[d], at.stride, a, count, before);
    if (at.above[d]) sizes.row(at.first + offset + at.stride[d], at.stride, a, count, after);
  }
  /// shift 1: of the nodes at the far end of the cells.
  KOKKOS_INLINE_FUNCTION void compare(RowPlace const& at, int d, int shift, RowRatios<N>& r) const {
    if (at.below[d]) r.compare(own + shift, before + shift, 0, at.count);
    if (at.above[d]) r.compare(own + shift, after + shift, 0, at.count);
  }
};

/// Sizes of one part of the cells of a row, of the cell before them and of that after them.
template <int N>
struct RowAlongI {
  double sizes_with_ends[N + 2];

  [[nodiscard]] KOKKOS_INLINE_FUNCTION double const* own() const { return sizes_with_ends + 1; }
  template <class Sizes>
  KOKKOS_INLINE_FUNCTION void fill(Sizes const& sizes, RowPlace const& at, Index offset, int a) {
    int const begin = at.below[0] ? -1 : 0, end = at.count + (at.above[0] ? 1 : 0);
    sizes.row(at.first + offset + begin, at.stride, a, end - begin, sizes_with_ends + 1 + begin);
  }
  KOKKOS_INLINE_FUNCTION void compare(RowPlace const& at, RowRatios<N>& r) const {
    r.compare(own(), own() - 1, at.below[0] ? 0 : 1, at.count);
    r.compare(own(), own() + 1, 0, at.above[0] ? at.count : at.count - 1);
  }
};

/// Edges of the cells of a row inside their zone.
template <int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void row_ratios(LineSizes<LinePart::edge, MemorySpace> const& sizes, RowPlace const& at,
                                       RowRatios<N>& r) {
  RowAlongI<N> i[4];
  ContinuedRow<N> across[2][2];  // along j and k, on either side of the cell along k and j
  r.begin(at.count);
  for (int s = 0; s < 4; ++s) {
    i[s].fill(sizes, at, (s & 1) * at.stride[1] + (s >> 1) * at.stride[2], 0);
    r.own(i[s].own(), at.count);
  }
  for (int a = 1; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      across[a - 1][s].fill(sizes, at, s * at.stride[3 - a], a, at.count + 1);
      for (int shift = 0; shift < 2; ++shift) r.own(across[a - 1][s].own + shift, at.count);
    }
  r.limits_known(at.count);
  for (auto const& row : i) row.compare(at, r);
  for (int a = 1; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      across[a - 1][s].fill_next(sizes, at, s * at.stride[3 - a], a, a, at.count + 1);
      for (int shift = 0; shift < 2; ++shift) across[a - 1][s].compare(at, a, shift, r);
    }
}

/// Their faces.
template <int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void row_ratios(LineSizes<LinePart::face, MemorySpace> const& sizes, RowPlace const& at,
                                       RowRatios<N>& r) {
  ContinuedRow<N> i;         // across i, at both ends of the cells
  RowAlongI<N> along[2][2];  // across j and k, on both sides of the cell
  ContinuedRow<N> across;    // the same, one after the other
  r.begin(at.count);
  i.fill(sizes, at, 0, 0, at.count + 1);
  for (int shift = 0; shift < 2; ++shift) r.own(i.own + shift, at.count);
  for (int a = 1; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      along[a - 1][s].fill(sizes, at, s * at.stride[a], a);
      r.own(along[a - 1][s].own(), at.count);
    }
  r.limits_known(at.count);
  for (int d = 1; d < 3; ++d) {
    i.fill_next(sizes, at, 0, 0, d, at.count + 1);
    for (int shift = 0; shift < 2; ++shift) i.compare(at, d, shift, r);
  }
  for (int a = 1; a < 3; ++a)
    for (int s = 0; s < 2; ++s) {
      along[a - 1][s].compare(at, r);
      for (int n = 0; n < at.count; ++n) across.own[n] = along[a - 1][s].own()[n];
      across.fill_next(sizes, at, s * at.stride[a], a, 3 - a, at.count);
      across.compare(at, 3 - a, 0, r);
    }
}

/// Cell n of a row at an interface: what lies behind it. The edge along the interface's axis, or the face across `a`,
/// at offsets s along e and q along f in the interface.
template <LinePart part, int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void compare_across(LineSizes<part, MemorySpace> const& sizes, LinkedFace const& face,
                                           RowPlace const& at, int n, int a, int e, int s, int f, int q,
                                           RowRatios<N>& r) {
  int const d = face.axis;
  int own[3] = {at.p[0] + n, at.p[1], at.p[2]};
  own[e] += s;
  own[f] += q;
  Index const here = at.first + n + s * at.stride[e] + q * at.stride[f];
  own[d] += face.side;  // the node on the interface
  int donor[3];
  face.donor_of(own, donor);
  donor[face.to_axis[d]] += face.into_donor;
  // A face spans one more edge of the interface, which may run the other way there.
  if (part == LinePart::face && face.to_sign[f] < 0) --donor[face.to_axis[f]];
  Index behind = face.donor_first_node;
  for (int m = 0; m < 3; ++m) behind += donor[m] * face.donor_stride[m];
  r.take(n, sizes.at(here, at.stride, a), sizes.at(behind, face.donor_stride, face.to_axis[a]));
}

/// ratio[n] of the cells of a row of at most N.
template <LinePart part, int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void worst_line_ratios(LineSizes<part, MemorySpace> const& sizes,
                                              LinkedFaces<MemorySpace> const& linked, kernels::ZoneCells const& zone,
                                              kernels::RowOfCells const& row, double (&ratio)[N]) {
  RowPlace const at(zone, row);
  RowRatios<N> r;
  row_ratios(sizes, at, r);
  bool const inside = at.below[0] && at.above[0] && at.below[1] && at.above[1] && at.below[2] && at.above[2];
  for (int m = linked.first(row.zone); !inside && m < linked.first(row.zone + 1); ++m) {
    LinkedFace const& face = linked.faces(m);
    if (row.j < face.begin[1] || row.j >= face.end[1] || row.k < face.begin[2] || row.k >= face.end[2]) continue;
    int const begin = face.begin[0] > row.i ? face.begin[0] - row.i : 0;
    int const end = face.end[0] < row.i + row.count ? face.end[0] - row.i : row.count;
    int const d = face.axis, e = (d + 1) % 3, f = (d + 2) % 3;
    for (int n = begin; n < end; ++n)
      for (int s = 0; s < 2; ++s) {
        if constexpr (part == LinePart::edge) {
          for (int q = 0; q < 2; ++q) compare_across(sizes, face, at, n, d, e, s, f, q, r);
        } else {
          compare_across(sizes, face, at, n, e, e, s, f, 0, r);
          compare_across(sizes, face, at, n, f, f, s, e, 0, r);
        }
      }
  }
  for (int n = 0; n < row.count; ++n) ratio[n] = r.result(n);
}

}  // namespace gridmorph::detail
