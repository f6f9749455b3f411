// Motions passed on from layer to layer around walls, displacement and turn together:
//
//   u(x) = sum over k of w_k (u_k + G_k (x - x_k)),   G(x) = f sum over k of w_k G_k
//
// with k the sources of the row of node x in the layers before (interpolation_rows.hpp), u_k what they are displaced by
// and G_k = R_k - I how they turn, of which the node keeps a share f. So around a rigid wall every node makes the same
// rigid motion, and where a wall bends the layers turn as it does. Linear in u and G.
//
// Places: wall nodes, nodes of their columns, then the targets of the rows in their order; rows name places.
//
// Cost: per row 20 bytes of tables, 24 of coordinates, 120 written; per item 12 bytes of tables, a motion (96 bytes)
// and 24 of coordinates, in cache where rows follow one another in space; 42 flops.
#pragma once

#include <gridmorph/kernels/inverse_distance.hpp>

namespace gridmorph::kernels {

/// motion(place) of walls, as wall_turn.hpp finds it, and of columns: their displacement and a share of their wall's
/// turn.
template <class MemorySpace>
struct SeedMotions {
  Kokkos::View<std::int32_t const*, MemorySpace> node, root;  ///< of columns; root: in the list of wall nodes
  Kokkos::View<float const*, MemorySpace> share;
  Index n_walls;
  Vec3 const* u;
  AffineMotion const* frame;  ///< around wall nodes
  AffineMotion* motion;

  [[nodiscard]] Index size() const { return n_walls + Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index p) const {
    if (p < n_walls) {
      motion[p] = frame[p];
      return;
    }
    Index const k = p - n_walls;
    motion[p] = double(share(k)) * frame[root(k)];
    motion[p].u = u[node(k)];
  }
};

/// Rows of one layer. Written in differences from the first source, so that equal motions give exactly theirs.
template <class MemorySpace>
struct PassMotions {
  InterpolationTable<MemorySpace> rows;                 ///< of places
  Kokkos::View<std::int32_t const*, MemorySpace> node;  ///< (places)
  Kokkos::View<float const*, MemorySpace> kept;         ///< f per row
  Field<double const> x;
  AffineMotion* motion;
  Vec3* u;

  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    Index const place = rows.target(r), n = node(place);
    Vec3 const at = x[n];
    auto const seen = [&](Index k) {
      Index const source = rows.item(k);
      AffineMotion there = motion[source];
      there.u = value_at(there, x[node(source)], at);
      return there;
    };
    AffineMotion const base = seen(from);
    AffineMotion sum = base;
    for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (seen(k) - base);
    motion[place] = double(kept(r)) * sum;
    motion[place].u = sum.u;
    u[n] = sum.u;
  }
};

}  // namespace gridmorph::kernels
