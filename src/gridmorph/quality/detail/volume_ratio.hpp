// Volume of a cell against its face neighbours, inside zones and across 1-to-1 interfaces; internal to the quality
// part.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <optional>
#include <vector>

namespace gridmorph::detail {

struct FaceOfRange {
  int axis, side;
};
/// The face of a zone that a node range lies on; nothing for edges, corners and ranges inside the zone.
std::optional<FaceOfRange> face_of(Zone const& zone, IndexRange const& range);

/// Cells behind one side of an interface: for own cell p (begin <= p < end, on face `side` along `axis`) the neighbour
/// is cell donor_offset + sum of donor_stride[a] * p[a].
struct InterfaceCells {
  int axis = 0, side = 0;
  int begin[3] = {0, 0, 0}, end[3] = {0, 0, 0};
  Index donor_offset = 0;
  Index donor_stride[3] = {0, 0, 0};
};

/// Interfaces of all zones, those of zone z being first[z] <= n < first[z + 1]. Interfaces that the mesh stores on one
/// side only are entered on both. Throws MeshError for ranges outside their zones; an interface that is no face range
/// has no neighbours and is left out.
struct InterfaceTable {
  std::vector<InterfaceCells> cells;
  std::vector<int> first;
};
InterfaceTable interface_table(Mesh const& mesh);

/// The same on the device.
template <class MemorySpace>
struct Neighbours {
  Kokkos::View<InterfaceCells const*, MemorySpace> cells;
  Kokkos::View<int const*, MemorySpace> first;
};

template <class Exec>
Neighbours<typename Exec::memory_space> upload_neighbours(Exec const& exec, Mesh const& mesh) {
  InterfaceTable const table = interface_table(mesh);
  return {upload(exec, "gridmorph::quality::interface_cells", table.cells),
          upload(exec, "gridmorph::quality::interface_first", table.first)};
}

/// Smallest and largest volume of the cells of a row and their neighbours so far.
template <int N>
struct VolumeRange {
  double least[N], largest[N];

  /// Takes in the neighbours of the cells begin <= n < end: those of `begin` at `volume`, and on in steps of `stride`.
  KOKKOS_INLINE_FUNCTION void add(double const* volume, Index stride, int begin, int end) {
    if (stride == 1)
      for (int n = begin; n < end; ++n) take(n, volume[n - begin]);
    else
      for (int n = begin; n < end; ++n) take(n, volume[(n - begin) * stride]);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION void take(int n, double volume) {
    least[n] = kernels::smaller(least[n], volume);
    largest[n] = kernels::larger(largest[n], volume);
  }
};

/// Neighbours behind the interfaces of the row's zone.
template <int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void add_interface_neighbours(Kokkos::View<double const*, MemorySpace> const& volumes,
                                                     Neighbours<MemorySpace> const& neighbours,
                                                     kernels::RowOfCells const& row, VolumeRange<N>& range) {
  for (int f = neighbours.first(row.zone); f < neighbours.first(row.zone + 1); ++f) {
    InterfaceCells const& c = neighbours.cells(f);
    if (row.j < c.begin[1] || row.j >= c.end[1] || row.k < c.begin[2] || row.k >= c.end[2]) continue;
    int const begin = c.begin[0] > row.i ? c.begin[0] : row.i;
    int const end = c.end[0] < row.i + row.count ? c.end[0] : row.i + row.count;
    if (begin >= end) continue;
    Index const donor =
        c.donor_offset + begin * c.donor_stride[0] + row.j * c.donor_stride[1] + row.k * c.donor_stride[2];
    range.add(volumes.data() + donor, c.donor_stride[0], begin - row.i, end - row.i);
  }
}

/// ratio[n]: largest ratio of larger to smaller volume between cell n of the row and its face neighbours; 1 for a cell
/// without any, unbounded unless all volumes are positive. The ratio to one neighbour grows with the distance of its
/// volume, so only the smallest and the largest are divided. N: the greatest length of rows.
template <int N, class MemorySpace>
KOKKOS_INLINE_FUNCTION void worst_volume_ratios(Kokkos::View<double const*, MemorySpace> const& volumes,
                                                kernels::ZoneCells const& zone,
                                                Neighbours<MemorySpace> const& neighbours,
                                                kernels::RowOfCells const& row, double* ratio) {
  double const* const own = volumes.data() + kernels::first_cell(zone, row);
  VolumeRange<N> range;
  for (int n = 0; n < row.count; ++n) range.least[n] = range.largest[n] = own[n];
  bool const at_begin = row.i == 0, at_end = row.i + row.count == zone.extent[0];
  if (!at_begin) range.add(own - 1, 1, 0, 1);
  range.add(own, 1, 1, row.count);
  range.add(own + 1, 1, 0, row.count - 1);
  if (!at_end) range.add(own + row.count, 1, row.count - 1, row.count);
  int const p[3] = {row.i, row.j, row.k};
  bool on_face = at_begin || at_end;
  for (int a = 1; a < 3; ++a) {
    if (p[a] > 0) range.add(own - zone.cell_stride(a), 1, 0, row.count);
    if (p[a] < zone.extent[a] - 1) range.add(own + zone.cell_stride(a), 1, 0, row.count);
    on_face = on_face || p[a] == 0 || p[a] == zone.extent[a] - 1;
  }
  if (on_face) add_interface_neighbours(volumes, neighbours, row, range);
  for (int n = 0; n < row.count; ++n) {
    double const worst = kernels::larger(own[n] / range.least[n], range.largest[n] / own[n]);
    ratio[n] = range.least[n] > 0 ? worst : kernels::unbounded;
  }
}

}  // namespace gridmorph::detail
