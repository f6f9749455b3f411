// Columns of cells on a wall move with it:
//
//   u(x) = u(w) + (R - I)(x - w)
//
// with w the wall node of the column and R a share of the wall's rotation there: 0 translates, 1 rotates.
//
// Cost per node: 12 bytes of tables, 48 of coordinates and 48 of the wall read, 24 written; about 60 flops.
#pragma once

#include <gridmorph/kernels/wall_turn.hpp>

namespace gridmorph::kernels {

template <class MemorySpace>
struct ColumnTable {
  Kokkos::View<std::int32_t const*, MemorySpace> node, root;  ///< root: in the list of wall nodes
  Kokkos::View<float const*, MemorySpace> share;
};

/// The columns on each wall node, those of node r from first(r) on.
template <class MemorySpace>
struct ColumnsOf {
  Kokkos::View<Index const*, MemorySpace> first;
  Kokkos::View<std::int32_t const*, MemorySpace> column;
};

/// V: as in wall_turn.hpp. u: displacements, or with rates their rates; those of the wall's nodes are there.
template <class MemorySpace, class V>
struct MoveColumns {
  ColumnTable<MemorySpace> columns;
  Kokkos::View<std::int32_t const*, MemorySpace> wall;
  Vec3 const *turn, *turn_rate;
  Field<double const> x;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(columns.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const root = columns.root(k), n = columns.node(k), w = wall(root);
    Vec3 const away = x[n] - x[w];
    double const share = columns.share(k);
    if constexpr (has_rate<V>)
      u[n] = u[w] + turned_by(share * V{turn[root], turn_rate[root]}, V{away}).rate;
    else
      u[n] = u[w] + turned_by(share * turn[root], away);
  }
};

}  // namespace gridmorph::kernels
