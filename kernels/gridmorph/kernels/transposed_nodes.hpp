// Transposes of what is done to listed nodes of elements: listed_nodes.hpp, slip_nodes.hpp, periodic_mean.hpp.
// Gradients take the places of displacements; what was written over ends at zero. Costs as forwards.
#pragma once

#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/periodic_mean.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/kernels/transposed_rows.hpp>
#include <gridmorph/kernels/transposed_slip.hpp>

namespace gridmorph::kernels {

/// Reads the gradients of all nodes from where the caller keeps them.
struct ReadNodes {
  VectorArray nodes;
  Vec3* u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u[n] = nodes[n]; }
};
/// Writes the gradients of boundary nodes to where the caller keeps them.
struct WriteSlots {
  Vec3 const* slots;
  VectorArray out;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out.set(n, slots[n]); }
};

/// slots(slot(k)) += u(nodes(slot(k))), which ends at zero: transpose of SetFromSlots.
template <class MemorySpace>
struct AddToSlots {
  Kokkos::View<std::int32_t const*, MemorySpace> slots, nodes;
  Vec3 *u, *to;
  [[nodiscard]] Index size() const { return Index(slots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const slot = slots(k), n = nodes(slot);
    to[slot] += u[n];
    u[n] = {};
  }
};

/// Transpose of FramesFromSlots.
template <class MemorySpace>
struct FramesToSlots {
  Kokkos::View<std::int32_t const*, MemorySpace> slot;
  AffineMotion const* frame;
  Vec3* to;
  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to[slot(k)] += frame[k].u; }
};

/// Transpose of GivenResiduals: left by node and listed, to the slots' nodes and, listed, to the slots.
template <class MemorySpace>
struct GivenResidualsBack {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3 *left, *listed, *u;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    Vec3 const g = left[n] + listed[k];
    left[n] = {};
    listed[k] = g;
    u[n] = u[n] - g;
  }
};

/// Transpose of TakePrescribed.
template <class MemorySpace>
struct TakePrescribedBack {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3 *u, *prescribed;
  Vec3 const* listed;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    Vec3 const residual = prescribed[n] + listed[k];
    prescribed[n] = u[n] + residual;
    u[n] = -residual;
  }
};

/// What a field on a lattice is read with, by node: read(n) = sign u(n), or += with `Add`.
template <class MemorySpace, bool Add>
struct ReadWith {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  double sign;
  Vec3 const* u;
  Vec3* read;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    read[n] = Add ? read[n] + sign * u[n] : sign * u[n];
  }
};
/// What a field is read with where each node has a share of it: read(n) = share(n) u(n).
template <class MemorySpace>
struct ReadWithShare {
  Kokkos::View<float const*, MemorySpace> share;
  Vec3 const* u;
  Vec3* read;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { read[n] = double(share(n)) * u[n]; }
};
/// Transpose of FieldAndMissing: to what the nodes read and miss; u ends at zero.
template <class MemorySpace>
struct FieldAndMissingBack {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<float const*, MemorySpace> share;
  Vec3 *u, *missing, *read;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    read[n] = u[n];
    missing[n] = double(share(k)) * u[n];
    u[n] = {};
  }
};
/// Transpose of FieldMisses at nodes whose value stays with them: u(n) += left(n), read(n) = -left(n); left ends at
/// zero.
template <class MemorySpace>
struct FieldMissesBack {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3 *left, *u, *read;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    u[n] += left[n];
    read[n] = -left[n];
    left[n] = {};
  }
};
/// Transpose of StartFromField.
template <class MemorySpace>
struct StartFromFieldBack {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<float const*, MemorySpace> share, missing_share;
  Vec3 *start, *u, *read;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = node(k);
    Vec3 const g = start[n];
    u[n] += g;
    read[n] = double(share(k)) * g;
    start[n] = double(missing_share(k)) * g;
  }
};

/// Transpose of PeriodicMean.
template <class MemorySpace>
struct PeriodicMeanBack {
  PeriodicTable<MemorySpace> table;
  Vec3* u;
  [[nodiscard]] Index size() const { return Index(table.owner.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Index const owner = table.owner(c), from = table.first(c), to = table.first(c + 1);
    bool const known = table.owner_known(c) != 0;
    Vec3 sum = u[owner];
    for (Index k = from; k < to; ++k) {
      std::int32_t const turn = table.rotation(table.image(k));
      Vec3 const g = u[table.node(table.image(k))];
      sum += turn < 0 ? g : transpose(table.rotations(turn)) * g;
    }
    Vec3 const mean = known ? sum : (1.0 / double(to - from + 1)) * sum;
    u[owner] = mean;
    for (Index k = from; k < to; ++k) {
      std::int32_t const turn = table.rotation(table.image(k));
      Vec3 const g = known ? Vec3{} : mean;
      u[table.node(table.image(k))] = turn < 0 ? g : table.rotations(turn) * g;
    }
  }
};

/// Displacements that PrescribeNodes is about to ask with, kept for its transpose.
template <class MemorySpace>
struct KeepPrescribed {
  SlipNodeTable<MemorySpace> table;
  VectorArray boundary;
  Vec3 const* prescribed;
  Vec3* kept;
  [[nodiscard]] Index size() const { return Index(table.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    kept[k] = table.slot(k) >= 0 ? boundary[table.slot(k)] : prescribed[table.node(k)];
  }
};
/// Transpose of PrescribeNodes: to the slots, listed, or to the nodes' own displacements.
template <class MemorySpace>
struct PrescribeNodesBack {
  PrescribeNodes<MemorySpace, false> ask;
  Vec3 const* kept;
  Vec3 *prescribed, *listed;
  [[nodiscard]] Index size() const { return ask.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = ask.table.node(k);
    Vec3 g = prescribed[n];
    if (int const count = int(ask.table.first(k + 1) - ask.table.first(k)); count > 0) {
      Index const from = ask.table.first(k);
      Vec3 const baseline = ask.x[n];
      auto const surface = [&](int m) -> SlipSurfaceView const& {
        return ask.table.surfaces(ask.table.surface(from + m));
      };
      auto const own = [&](int m) { return surface(m).own_offset(baseline); };
      g = constrained_gradient(count, surface, own, baseline, kept[k], g);
    }
    bool const given = ask.table.slot(k) >= 0;
    prescribed[n] = given ? Vec3{} : g;
    listed[k] = given ? g : Vec3{};
  }
};

}  // namespace gridmorph::kernels
