// Non-orthogonality and face skewness of elements, from their centres (kernels/face_geometry.hpp); internal to the
// quality part.
#pragma once

#include <gridmorph/quality/detail/partial_sums.hpp>
#include <gridmorph/quality/element_tables.hpp>

namespace gridmorph::detail {

/// The worst faces of one element.
struct FaceQuality {
  double non_orthogonality_deg = 0, skewness = 0;
};

/// Of both regions of one chunk.
struct FaceSums {
  PartialMeasure non_orthogonality_deg[2], skewness[2];

  KOKKOS_INLINE_FUNCTION void join(FaceSums const& other) {
    for (int r = 0; r < 2; ++r) {
      non_orthogonality_deg[r].join(other.non_orthogonality_deg[r], true);
      skewness[r].join(other.skewness[r], true);
    }
  }
};

/// What is behind each side, in the order of the sides: LinkedSides.
template <class MemorySpace>
struct SideTables {
  Kokkos::View<Index const*, MemorySpace> first;
  Kokkos::View<Index32 const*, MemorySpace> neighbour;
  Kokkos::View<SideLink const*, MemorySpace> links;
};

/// Of side `side` of element e.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::FaceGeometry face_of(ElementTables<MemorySpace> const& tables,
                                                     PackedPoints<MemorySpace> const& points, Index e, int side) {
  return tables.with_faces(points, e, [&](auto const& faces) {
    return kernels::face_geometry(
        faces.n_corners(side), [&](int k) { return faces.at(side, k); }, tables.plane_normal);
  });
}

/// (n_elements) centres.
template <class Exec>
Kokkos::View<kernels::PackedPoint*, typename Exec::memory_space> element_centres(
    Exec const& exec, ElementTables<typename Exec::memory_space> const& tables,
    PackedPoints<typename Exec::memory_space> const& points, bool solid) {
  Index const n = tables.elements.size();
  Kokkos::View<kernels::PackedPoint*, typename Exec::memory_space> const centres(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::centres"), std::size_t(n));
  Kokkos::parallel_for(
      "gridmorph::measure_quality::centres", Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, n),
      KOKKOS_LAMBDA(Index const e) {
        Vec3 const c = tables.with_faces(points, e, [&](auto const& faces) {
          auto const face = [&](int f) {
            return kernels::face_geometry(
                faces.n_corners(f), [&](int k) { return faces.at(f, k); }, tables.plane_normal);
          };
          return kernels::element_centre(faces.n_faces(), face, solid).at;
        });
        centres(e) = {c.x, c.y, c.z};
      });
  return centres;
}

/// Of element e; boundary faces have no line between centres, but a skewness. Behind a connection the neighbour lies as
/// far from the face there as its image does from the one here, whatever became of the two sides: d = (f - x) + turn (y
/// - f'), f' the centre of the face there.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION FaceQuality face_quality(ElementTables<MemorySpace> const& tables,
                                                SideTables<MemorySpace> const& sides,
                                                PackedPoints<MemorySpace> const& points,
                                                Kokkos::View<kernels::PackedPoint*, MemorySpace> const& centres,
                                                Index e) {
  return tables.with_faces(points, e, [&](auto const& faces) {
    FaceQuality worst;
    Vec3 const own = point(centres(e));
    for (int f = 0; f < faces.n_faces(); ++f) {
      int const n = faces.n_corners(f);
      auto const at = [&](int k) { return faces.at(f, k); };
      kernels::FaceGeometry const face = kernels::face_geometry(n, at, tables.plane_normal);
      double const square = dot(face.area, face.area);
      if (!(square > 0)) continue;  // a side that is a line or a point
      Index32 const other = sides.neighbour(sides.first(e) + f);
      bool const inside = other >= 0 || other <= first_link;
      Vec3 d;
      if (other >= 0) {
        d = point(centres(other)) - own;
      } else if (inside) {
        SideLink const& link = sides.links(first_link - other);
        Vec3 const there = face_of(tables, points, link.element, link.side).centre;
        d = (face.centre - own) + link.turn * (point(centres(link.element)) - there);
      } else {
        d = (dot(face.area, face.centre - own) / square) * face.area;
      }
      if (inside)
        worst.non_orthogonality_deg =
            kernels::larger(worst.non_orthogonality_deg, kernels::non_orthogonality_deg(face, own, own + d));
      worst.skewness = kernels::larger(worst.skewness, kernels::face_skewness(face, own, d, inside ? 0.2 : 0.4, n, at));
    }
    return worst;
  });
}

}  // namespace gridmorph::detail
