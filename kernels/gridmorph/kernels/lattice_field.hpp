// Fields on an even lattice, read at the nodes of a mesh: what they miss of given values, and shares of them.
//
// Cost per node: 24 bytes of coordinates, 8 corners of a cell (24 bytes each, from cache where nodes follow one another
// in space), 4 to 8 bytes of tables; 24 bytes read or written per displacement; about 60 flops.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/uniform_lattice.hpp>

namespace gridmorph::kernels {

struct LatticeField {
  UniformLattice shape;
  Vec3 const* value;
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Vec3 const& x) const { return shape.at(value, x); }
};

/// left(n) = value(n) - field(x_n) at listed nodes; the two may be one array.
template <class MemorySpace>
struct FieldMisses {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  LatticeField field;
  Field<double const> x;
  Vec3 const* value;
  Vec3* left;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    left[n] = value[n] - field(x[n]);
  }
};

/// u(n) = field(x_n) + share(n) missing(n) at listed nodes.
template <class MemorySpace>
struct FieldAndMissing {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<float const*, MemorySpace> share;
  LatticeField field;
  Field<double const> x;
  Vec3 const* missing;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    u[n] = field(x[n]) + double(share(k)) * missing[n];
  }
};

/// u(n) += share(n) field(x_n) at all nodes.
template <class MemorySpace>
struct AddField {
  Kokkos::View<float const*, MemorySpace> share;
  LatticeField field;
  Field<double const> x;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(share.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    double const f = share(n);
    if (f != 0) u[n] += f * field(x[n]);
  }
};

/// start(n) = u(n) + share field(x_n) + missing_share missing(n) at listed nodes, `start` and `missing` being one
/// array.
template <class MemorySpace>
struct StartFromField {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<float const*, MemorySpace> share, missing_share;
  LatticeField field;
  Field<double const> x;
  Vec3 const* u;
  Vec3* start;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    Vec3 v = u[n];
    if (share(k) != 0) v += double(share(k)) * field(x[n]);
    if (missing_share(k) != 0) v += double(missing_share(k)) * start[n];
    start[n] = v;
  }
};

}  // namespace gridmorph::kernels
