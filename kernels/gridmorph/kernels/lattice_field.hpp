// Fields on an even lattice, read at the nodes of a mesh: what they miss of given values, and shares of them.
//
// Cost per node: 24 bytes of coordinates, 8 corners of a cell (32 bytes each, from cache where nodes follow one another
// in space), 4 to 8 bytes of tables; 24 bytes read or written per displacement; about 60 flops.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/uniform_lattice.hpp>
#include <gridmorph/kernels/vector_runs.hpp>

namespace gridmorph::kernels {

/// Finds the cells of a lattice and reads fields on its nodes, with what all places have in common made beforehand. V:
/// packed_vec3.hpp.
template <class V>
class LatticeReader {
 public:
  KOKKOS_INLINE_FUNCTION explicit LatticeReader(UniformLattice const& of)
      : low_(as<V>(of.low)),
        last_(as<V>(Vec3{double(of.nodes[0] - 1), double(of.nodes[1] - 1), double(of.nodes[2] - 1)})),
        last_cell_(larger_parts(as<V>(Vec3{}), last_ - as<V>(Vec3{1, 1, 1}))),
        strides_(as<V>(Vec3{1, double(of.nodes[0]), double(of.nodes[0]) * of.nodes[1]})),
        spacing_(of.spacing),
        i_(of.nodes[0] < 2 ? 0 : 1),
        j_(of.nodes[1] < 2 ? 0 : of.nodes[0]),
        k_(of.nodes[2] < 2 ? 0 : std::int64_t(of.nodes[0]) * of.nodes[1]) {}

  /// The cell of x, whole numbers, and the place of x in it; outside the lattice of its nearest point.
  struct Place {
    V cell, t;
  };
  KOKKOS_INLINE_FUNCTION Place place(V const& x) const {
    V const p = larger_parts(as<V>(Vec3{}), smaller_parts(last_, over(x - low_, spacing_)));
    V const cell = smaller_parts(last_cell_, whole_parts(p));
    return {cell, p - cell};
  }

  /// Value at x of a field on the nodes; outside the lattice that of its nearest point. Written in differences, so that
  /// equal values come back bit for bit.
  template <class Value>
  KOKKOS_INLINE_FUNCTION V at(Value const* value, V const& x) const {
    Place const p = place(x);
    Value const* const v = value + std::int64_t(dot(p.cell, strides_));
    V const low_plane = bilinear(v, p.t), high_plane = bilinear(v + k_, p.t);
    return low_plane + component(p.t, 2) * (high_plane - low_plane);
  }

 private:
  template <class Value>
  KOKKOS_INLINE_FUNCTION V bilinear(Value const* v, V const& t) const {
    V const low = as<V>(v[0]), high = as<V>(v[j_]);
    V const a = low + component(t, 0) * (as<V>(v[i_]) - low), b = high + component(t, 0) * (as<V>(v[i_ + j_]) - high);
    return a + component(t, 1) * (b - a);
  }

  V low_, last_, last_cell_, strides_;  ///< whole numbers but for the first, as which they are exact
  double spacing_;
  std::int64_t i_, j_, k_;  ///< to the upper corners of a cell
};

struct LatticeField {
  UniformLattice shape;
  PackedVec3 const* value;
};

/// What reads it, made once for many nodes.
template <class V>
class ReadLatticeField {
 public:
  KOKKOS_INLINE_FUNCTION explicit ReadLatticeField(LatticeField const& of) : at_(of.shape), value_(of.value) {}
  KOKKOS_INLINE_FUNCTION V operator()(Vec3 const& x) const { return at_.at(value_, as<V>(x)); }

 private:
  LatticeReader<V> at_;
  PackedVec3 const* value_;
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
  template <class V>
  KOKKOS_INLINE_FUNCTION void run(Index begin, Index end) const {
    ReadLatticeField<V> const read(field);
    for (Index k = begin; k < end; ++k) {
      Index const n = node(k);
      put(left[n], as<V>(value[n]) - read(x[n]));
    }
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
  template <class V>
  KOKKOS_INLINE_FUNCTION void run(Index begin, Index end) const {
    ReadLatticeField<V> const read(field);
    for (Index k = begin; k < end; ++k) {
      Index const n = node(k);
      put(u[n], read(x[n]) + double(share(k)) * as<V>(missing[n]));
    }
  }
};

/// u(n) += share(n) field(x_n) + missing_share(n) missing(n) at all nodes; those without a share have none of what is
/// missing either.
template <class MemorySpace>
struct AddFieldAndMissing {
  Kokkos::View<float const*, MemorySpace> share, missing_share;
  LatticeField field;
  Field<double const> x;
  Vec3 const* missing;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(share.extent(0)); }
  template <class V>
  KOKKOS_INLINE_FUNCTION void run(Index begin, Index end) const {
    ReadLatticeField<V> const read(field);
    for (Index n = begin; n < end; ++n) {
      if (share(n) == 0) continue;
      V v = as<V>(u[n]) + double(share(n)) * read(x[n]);
      if (missing_share(n) != 0) v += double(missing_share(n)) * as<V>(missing[n]);
      put(u[n], v);
    }
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
  template <class V>
  KOKKOS_INLINE_FUNCTION void run(Index begin, Index end) const {
    ReadLatticeField<V> const read(field);
    for (Index k = begin; k < end; ++k) {
      Index const n = node(k);
      V v = as<V>(u[n]);
      if (share(k) != 0) v += double(share(k)) * read(x[n]);
      if (missing_share(k) != 0) v += double(missing_share(k)) * as<V>(start[n]);
      put(start[n], v);
    }
  }
};

}  // namespace gridmorph::kernels
