// Volume of a cell against its face neighbours, inside zones and across 1-to-1 interfaces; internal to the quality part.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <vector>

namespace gridmorph::detail {

/// Cells behind one side of an interface: for own cell p (begin <= p < end, on face `side` along `axis`) the neighbour is
/// cell donor_offset + sum of donor_stride[a] * p[a].
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

/// Larger / smaller volume of two neighbours; unbounded unless both are positive.
KOKKOS_INLINE_FUNCTION double volume_ratio(double a, double b) {
  return a > 0 && b > 0 ? larger(a, b) / smaller(a, b) : unbounded;
}

/// Largest volume ratio of cell (i, j, k) to its face neighbours; 1 for a cell without any.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION double worst_volume_ratio(Kokkos::View<double const*, MemorySpace> const& volumes,
                                                 int zone_number, ZoneCells const& zone,
                                                 Neighbours<MemorySpace> const& neighbours, int i, int j, int k) {
  int const p[3] = {i, j, k};
  Index const own = zone.first_cell + i + j * zone.cell_stride(1) + k * zone.cell_stride(2);
  double const volume = volumes(own);
  double worst = 1;
  bool on_face = false;
  for (int a = 0; a < 3; ++a) {
    if (p[a] > 0)
      worst = larger(worst, volume_ratio(volume, volumes(own - zone.cell_stride(a))));
    else
      on_face = true;
    if (p[a] < zone.extent[a] - 1)
      worst = larger(worst, volume_ratio(volume, volumes(own + zone.cell_stride(a))));
    else
      on_face = true;
  }
  if (!on_face) return worst;
  for (int n = neighbours.first(zone_number); n < neighbours.first(zone_number + 1); ++n) {
    InterfaceCells const& c = neighbours.cells(n);
    bool inside = true;
    for (int a = 0; a < 3; ++a) inside = inside && p[a] >= c.begin[a] && p[a] < c.end[a];
    if (!inside) continue;
    Index const donor = c.donor_offset + p[0] * c.donor_stride[0] + p[1] * c.donor_stride[1] + p[2] * c.donor_stride[2];
    worst = larger(worst, volume_ratio(volume, volumes(donor)));
  }
  return worst;
}

}  // namespace gridmorph::detail
