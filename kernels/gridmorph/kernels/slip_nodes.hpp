// What boundaries beyond the moving walls ask of their nodes: the displacement of a rule, or of the nodes themselves as
// the surfaces that they slide on let it be (slip_edge.hpp).
//
// Cost per node: 12 bytes of tables, 24 of coordinates, 24 read and 24 written; a node that slides as slip_surface.hpp
// says.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/slip_edge.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

template <class MemorySpace>
struct SlipNodeTable {
  Kokkos::View<std::int32_t const*, MemorySpace> node, slot;  ///< slot: of the given displacement, -1: its own
  Kokkos::View<Index const*, MemorySpace> first;              ///< (n_nodes + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> surface;     ///< those of entry k from first(k) on
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
};

/// prescribed: with the nodes' own displacements on entry. With `Rate` also the rates of change.
template <class MemorySpace, bool Rate>
struct PrescribeNodes {
  SlipNodeTable<MemorySpace> table;
  VectorArray boundary, boundary_rate;
  Field<double const> x;
  Vec3 *prescribed, *prescribed_rate;

  [[nodiscard]] Index size() const { return Index(table.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = table.node(k), slot = table.slot(k);
    Vec3 u = slot >= 0 ? boundary[slot] : prescribed[n], rate;
    if constexpr (Rate) rate = slot >= 0 ? boundary_rate[slot] : prescribed_rate[n];
    constrain(k, u, rate);
    prescribed[n] = u;
    if constexpr (Rate) prescribed_rate[n] = rate;
  }
  /// What its surfaces make of a displacement, and with `Rate` of its rate.
  KOKKOS_INLINE_FUNCTION void constrain(Index k, Vec3& u, Vec3& rate) const {
    Index const from = table.first(k);
    int const count = int(table.first(k + 1) - from);
    if (count == 0) return;
    Vec3 const baseline = x[table.node(k)];
    Surfaces const surface{table, from};
    constrain_to_all<Rate>(count, surface, Offsets{surface, baseline}, baseline, u, rate);
  }

 private:
  /// The surfaces of one node, as constrain_to_all() asks for them.
  struct Surfaces {
    SlipNodeTable<MemorySpace> const& table;
    Index from;
    KOKKOS_INLINE_FUNCTION SlipSurfaceView const& operator()(int m) const {
      return table.surfaces(table.surface(from + m));
    }
  };
  struct Offsets {
    Surfaces const& surface;
    Vec3 const& baseline;
    KOKKOS_INLINE_FUNCTION double operator()(int m) const { return surface(m).own_offset(baseline); }
  };
};

}  // namespace gridmorph::kernels
