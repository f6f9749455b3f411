// Vectors of a part of a mesh, in the order of its own nodes, from those of the mesh and back.
//
// Cost per node of the part: 4 bytes of its list, 24 read and 24 written.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// to(k) = from(list(k)); From: a VectorArray, a Field or a pointer.
template <class MemorySpace, class From>
struct GatherPart {
  Kokkos::View<std::int32_t const*, MemorySpace> list;
  From from;
  Vec3* to;

  [[nodiscard]] Index size() const { return Index(list.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to[k] = from[list(k)]; }
};

/// to(list(k)) = from(k); a node is in one part.
template <class MemorySpace>
struct ScatterPart {
  Kokkos::View<std::int32_t const*, MemorySpace> list;
  Vec3 const* from;
  Vec3* to;

  [[nodiscard]] Index size() const { return Index(list.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to[list(k)] = from[k]; }
};

/// to(list(k)) = from(k), where `to` is a Field.
template <class MemorySpace>
struct SetPart {
  Kokkos::View<std::int32_t const*, MemorySpace> list;
  Vec3 const* from;
  Field<double> to;

  [[nodiscard]] Index size() const { return Index(list.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to.set(list(k), from[k]); }
};

/// to(list(k)) += a(k) + b(k) of a list without repetition.
template <class MemorySpace>
struct AddPart {
  Kokkos::View<std::int32_t const*, MemorySpace> list;
  Vec3 const *a, *b;
  VectorArray to;

  [[nodiscard]] Index size() const { return Index(list.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to.set(list(k), to[list(k)] + (a[k] + b[k])); }
};

struct ClearVectorArray {
  VectorArray vectors;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { vectors.set(n, {}); }
};

}  // namespace gridmorph::kernels
