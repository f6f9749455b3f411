// Tables that kernels over unstructured elements need; internal to the quality part.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <vector>

namespace gridmorph::detail {

template <class MemorySpace>
using PackedPoints = Kokkos::View<kernels::PackedPoint const*, MemorySpace>;

template <class Exec>
PackedPoints<typename Exec::memory_space> pack(Exec const& exec, CoordinateViews<typename Exec::memory_space> const& c,
                                               Index n_nodes) {
  Kokkos::View<kernels::PackedPoint*, typename Exec::memory_space> const points(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::points"), std::size_t(n_nodes));
  kernels::pack_points(exec, field_of(c), points);
  return points;
}

template <class MemorySpace>
struct ElementTables {
  ElementViews<MemorySpace> elements;
  Vec3 plane_normal;

  KOKKOS_INLINE_FUNCTION ElementType type(Index e) const { return elements.type(e); }
  KOKKOS_INLINE_FUNCTION kernels::ElementCorners corners(PackedPoints<MemorySpace> const& points, Index e) const {
    return gather(e, [&](Index32 node) {
      kernels::PackedPoint const p = points(node);
      return Vec3{p.x, p.y, p.z};
    });
  }
  /// For few elements: x, y and z come from three places.
  KOKKOS_INLINE_FUNCTION kernels::ElementCorners corners(CoordinateViews<MemorySpace> const& c, Index e) const {
    return gather(e, [&](Index32 node) { return Vec3{c.x(node), c.y(node), c.z(node)}; });
  }
  KOKKOS_INLINE_FUNCTION kernels::ElementCorners corners(kernels::VectorArray const& x, Index e) const {
    return gather(e, [&](Index32 node) { return x[node]; });
  }

 private:
  template <class PointOf>
  KOKKOS_INLINE_FUNCTION kernels::ElementCorners gather(Index e, PointOf const& point) const {
    kernels::ElementCorners out;
    Index const first = elements.first(e);
    int const n = n_corners(elements.type(e));
    for (int k = 0; k < n; ++k) out.at[k] = point(elements.node(first + k));
    return out;
  }
};

template <class Exec>
ElementTables<typename Exec::memory_space> element_tables(Exec const& exec, Mesh const& mesh) {
  return {views(exec, mesh.elements), plane_normal(mesh)};
}

/// Elements zone after zone in chunks of cells_per_chunk; box_extent[0] counts those of the zone.
inline std::vector<kernels::CellChunk> element_chunks(Mesh const& mesh) {
  std::vector<kernels::CellChunk> chunks;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index const n = mesh.zones[std::size_t(z)].n_elements;
    for (Index begin = 0; begin < n; begin += kernels::cells_per_chunk)
      chunks.push_back({z,
                        {0, 0, 0},
                        {int(n), 1, 1},
                        begin,
                        begin + kernels::cells_per_chunk < n ? begin + kernels::cells_per_chunk : n});
  }
  return chunks;
}

inline std::vector<Index> first_elements(Mesh const& mesh) {
  std::vector<Index> first;
  for (auto const& zone : mesh.zones) first.push_back(zone.first_element);
  return first;
}

/// Largest volume ratio of element e to its neighbours; 1 without any, unbounded unless all volumes are positive.
template <class VolumeView, class MemorySpace>
KOKKOS_INLINE_FUNCTION double worst_ratio(VolumeView const& volumes, ElementViews<MemorySpace> const& elements,
                                          CsrViews<MemorySpace> const& neighbours, Index e) {
  double least = volumes(e), largest = least;
  for (Index n = neighbours.first(e); n < neighbours.first(e + 1); ++n) {
    Index32 const other = neighbours.item(n);
    if (elements.type(other) == ElementType::polyhedron) continue;
    least = kernels::smaller(least, volumes(other));
    largest = kernels::larger(largest, volumes(other));
  }
  double const own = volumes(e);
  if (!(least > 0)) return kernels::unbounded;
  return kernels::larger(largest / own, own / least);
}

/// Elements on the other side of each side of each element, through connections too, where there is one.
CsrGraph neighbour_lists(Mesh const& mesh, UnstructuredTopology const& topology);

/// `known` where it has an entry per element, else numbering_signs().
std::vector<signed char> signs_of(HostInstance const& host, Mesh const& mesh, ElementSides const& sides,
                                  std::vector<signed char> const& known);

}  // namespace gridmorph::detail
