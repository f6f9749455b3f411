// Lists of elements: what the cells of a mesh are where they do not lie in blocks.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/element_shape.hpp>

#include <Kokkos_Core.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace gridmorph {

/// The name of a type of element: "triangle", "tetrahedron", ...
std::string_view to_string(ElementType type);

/// Elements of the mesh's own dimension (volumes in 3-D, surfaces in 2-D), zone after zone in file order.
struct Elements {
  std::vector<ElementType> type;  ///< (n_elements)
  CsrGraph nodes;                 ///< SIDS order: corners first, then the further nodes of second-order elements
  std::vector<Index32>
      number;  ///< as the file counts them, for messages; empty: first_number + place in the file's zone

  [[nodiscard]] Index size() const { return Index(type.size()); }
  /// Corner nodes of element e.
  [[nodiscard]] std::span<Index32 const> corners(Index e) const {
    auto const all = nodes[e];
    ElementType const t = type[e];
    return t == ElementType::polyhedron ? all : all.first(std::size_t(n_corners(t)));
  }
};

/// Faces of the elements of type polyhedron, in element order.
struct Polyhedra {
  std::vector<Index32> element;   ///< ascending
  std::vector<Index> first_face;  ///< (element.size() + 1) in `faces`; empty when there are none
  CsrGraph faces;                 ///< nodes in order around each face, the normal pointing outwards
};

/// Where in its file each node and element stands, counted from 0 through all zones; empty: where it stands in the
/// mesh. See file_order.hpp.
struct FileOrder {
  std::vector<Index32> node;     ///< (n_nodes) or empty
  std::vector<Index32> element;  ///< (n_elements) or empty
  Index left_out = 0;            ///< nodes that the file has and the mesh does not, see leave_out_unused_nodes()
};

/// Compressed element lists in a memory space, for kernels.
template <class MemorySpace>
struct ElementViews {
  Kokkos::View<ElementType const*, MemorySpace> type;  ///< (n_elements)
  Kokkos::View<Index const*, MemorySpace> first;       ///< (n_elements + 1)
  Kokkos::View<Index32 const*, MemorySpace> node;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index size() const { return Index(type.extent(0)); }
};

/// The element lists of a mesh in the memory space of `exec`.
template <class Exec>
ElementViews<typename Exec::memory_space> views(Exec const& exec, Elements const& elements) {
  return {detail::view_of(exec, elements.type, "gridmorph::Elements::type"),
          detail::view_of(exec, elements.nodes.first, "gridmorph::Elements::first"),
          detail::view_of(exec, elements.nodes.item, "gridmorph::Elements::node")};
}

}  // namespace gridmorph
