// The faces of polyhedra in a memory space, for kernels.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

template <class MemorySpace>
struct PolyhedronViews {
  Kokkos::View<Index32 const*, MemorySpace> element;   ///< ascending
  Kokkos::View<Index const*, MemorySpace> first_face;  ///< (polyhedra + 1) in `faces`
  CsrViews<MemorySpace> faces;

  /// Place in the list of the polyhedron that element e is. Cost: a bisection.
  KOKKOS_INLINE_FUNCTION Index number_of(Index e) const {
    Index begin = 0, end = Index(element.extent(0));
    while (begin + 1 < end) {
      Index const middle = (begin + end) / 2;
      (element(middle) <= e ? begin : end) = middle;
    }
    return begin;
  }
};

template <class Exec>
PolyhedronViews<typename Exec::memory_space> views(Exec const& exec, Polyhedra const& polyhedra) {
  return {detail::view_of(exec, polyhedra.element, "gridmorph::Polyhedra::element"),
          detail::view_of(exec, polyhedra.first_face, "gridmorph::Polyhedra::first_face"),
          views(exec, polyhedra.faces)};
}

}  // namespace gridmorph
