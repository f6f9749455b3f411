// The motion in common (common_motion.hpp) of the nodes inside pieces of blocks, row by row within the pass through the
// volume.
//
//   u = v + A(x + v),   rates F v' + A'(x + v)
//
// v what chains have made of the rest. What slip surfaces correct comes after it.
//
// Cost per node of a part that has one: 24 bytes of coordinates read, where the pass does not read them anyway; about
// 50 flops.
#pragma once

#include <gridmorph/kernels/common_motion.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/row_correction.hpp>

namespace gridmorph::kernels {

/// The motions of the parts of a mesh, of several fields.
template <class MemorySpace>
struct CommonMoves {
  Kokkos::View<CommonFrame const*, MemorySpace> frames;  ///< per part
  CommonMove const* moves = nullptr;                     ///< part after part, in each one per field
  Index n_moves = 0;                                     ///< of a part
  int field = 0;                                         ///< the first of those that are written
  int of = 0;                                            ///< where that holds rates, of which field
  Vec3 const* before = nullptr;                          ///< v of that field by node; null: no rates
  bool leaves_out = false;                               ///< v alone is written, of parts that have such a motion

  [[nodiscard]] KOKKOS_INLINE_FUNCTION CommonMove const& move(int part, int f) const {
    return moves[part * n_moves + f];
  }

  /// A row of nodes, the first of which is `node`, from v to u; x: its baseline. f: counted from `field` on.
  template <int width>
  GRIDMORPH_CALLED_ON_HOST KOKKOS_FUNCTION void add_to(int part, int f, Index node, int n, VectorRow<width> const& x,
                                                       VectorRow<width>& u) const {
    CommonFrame const& frame = frames(part);
    CommonMove const& own = move(part, field + f);
    if (before != nullptr) return add_rate(frame, move(part, of), own.map, before + node, n, x, u);
    for (int w = 0; w < n; ++w) {
      Vec3 const v{u.x[w], u.y[w], u.z[w]};
      Vec3 const out = v + own.map(frame, Vec3{x.x[w], x.y[w], x.z[w]} + own.share * v);
      u.x[w] = out.x;
      u.y[w] = out.y;
      u.z[w] = out.z;
    }
  }

 private:
  template <int width>
  KOKKOS_INLINE_FUNCTION static void add_rate(CommonFrame const& frame, CommonMove const& at, CommonMap const& rate,
                                              Vec3 const* v, int n, VectorRow<width> const& x, VectorRow<width>& u) {
    for (int w = 0; w < n; ++w) {
      Vec3 const out =
          at.forward * Vec3{u.x[w], u.y[w], u.z[w]} + rate(frame, Vec3{x.x[w], x.y[w], x.z[w]} + at.share * v[w]);
      u.x[w] = out.x;
      u.y[w] = out.y;
      u.z[w] = out.z;
    }
  }
};

/// Makes F^T g of every gradient g in a row.
template <int width>
KOKKOS_INLINE_FUNCTION void pull_row(CommonMove const& move, int n, VectorRow<width>& g) {
  Mat3 const back = transpose(move.forward);
  for (int w = 0; w < n; ++w) {
    Vec3 const pulled = back * Vec3{g.x[w], g.y[w], g.z[w]};
    g.x[w] = pulled.x;
    g.y[w] = pulled.y;
    g.z[w] = pulled.z;
  }
}

}  // namespace gridmorph::kernels
