// Displacements of listed nodes set, read, copied and added; and those of all nodes written out.
//
// Cost per node of a list: 4 to 12 bytes of tables and 24 bytes per displacement read or written, scattered as the list
// is.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// Makes nodes that nothing reaches stay.
struct RestNodes {
  Vec3* u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u[n] = Vec3{}; }
};

/// u(nodes(s)) = boundary(s) for listed slots s.
template <class MemorySpace>
struct SetFromSlots {
  Kokkos::View<std::int32_t const*, MemorySpace> slots, nodes;
  VectorArray boundary;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(slots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u[nodes(slots(k))] = boundary[slots(k)]; }
};

/// The residual, given minus u, at nodes whose displacement is given, by node and in the order of the list.
template <class MemorySpace>
struct GivenResiduals {
  Kokkos::View<std::int32_t const*, MemorySpace> node, slot;
  VectorArray boundary;
  Vec3 const* u;
  Vec3 *left, *listed;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const r = boundary[slot(k)] - u[node(k)];
    left[node(k)] = r;
    listed[k] = r;
  }
};

/// u becomes what is prescribed; the residual, prescribed minus u before, is left in its place by node, and listed in
/// the order of the list.
template <class MemorySpace>
struct TakePrescribed {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3 *u, *prescribed, *listed;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    Vec3 const residual = prescribed[n] - u[n];
    u[n] = prescribed[n];
    prescribed[n] = listed[k] = residual;
  }
};

/// u(to) = u(from).
template <class MemorySpace>
struct CopyListed {
  Kokkos::View<std::int32_t const*, MemorySpace> to, from;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(to.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u[to(k)] = u[from(k)]; }
};

/// All nodes: their displacement, or with `Move` their position.
template <bool Move>
struct WriteNodes {
  Vec3 const* u;
  Field<double const> x;
  VectorArray out;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out.set(n, Move ? moved(x[n], u[n]) : u[n]); }
};

}  // namespace gridmorph::kernels
