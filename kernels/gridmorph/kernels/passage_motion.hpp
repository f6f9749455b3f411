// What the sides of a blade passage do, done by all of it: at each node what the place on the sides does that has the
// same meridional position, turned about the axis to the node.
//
//   c_k = S E(x_k)^T u_k            of nodes k of the sides: components along the axis, away from it and around it
//   C(x) = E(x) c(x),   c(x) = sum over k of w_k(x) c_k       w: of the facet of the sides at x's meridional position
//
// E(x) has the unit vectors at x as its columns, which in a linear cascade are the same everywhere. S halves what goes
// along the axis: what goes around is a shear, which never folds, but sides that are pressed together along the axis
// would press the blade's surroundings as much. The gradient of C takes differences d_a of c along the two meridional
// directions e_a, and what turning about the axis does:
//
//   grad C = sum over a of (E d_a) e_a^T + (1 / r) (c_away e_around - c_around e_away) e_around^T
//
// Linear in u.
//
// Cost per node: 12 bytes of a row, 8 and a vector from cache for each of its two to four places, 24 of coordinates and
// 48 of the displacement that C is added to; 60 flops.
#pragma once

#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/row_frame.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// S of what goes along the axis. By measurement on a cascade and a passage (docs/algorithms/passage_motion.md).
constexpr double along_share = 0.5;

/// c of the nodes of the sides.
template <class MemorySpace>
struct SideComponents {
  RowFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> slot, node;
  Field<double const> x;
  VectorArray boundary;
  Vec3* c;

  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const all = frame.basis(x[node(k)]).components(boundary[slot(k)]);
    c[k] = {along_share * all.x, all.y, all.z};
  }
};

/// u(n) += sign C(x(n)) for the targets n of rows.
template <class MemorySpace>
struct AddPassageMotion {
  RowFrame frame;
  InterpolationTable<MemorySpace> rows;
  double sign;
  Vec3 const* c;
  Field<double const> x;
  Vec3* u;

  [[nodiscard]] Index size() const { return rows.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const n = rows.target(r);
    u[n] += sign * frame.basis(x[n]).vector(mean_of_row(rows, c, r));
  }
};

/// Its transpose: gradients of c at each row, of which the sides gather theirs.
template <class MemorySpace>
struct PassageComponentsBack {
  RowFrame frame;
  InterpolationTable<MemorySpace> rows;
  double sign;
  Field<double const> x;
  Vec3 const* u;
  Vec3* of_row;

  [[nodiscard]] Index size() const { return rows.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const n = rows.target(r);
    of_row[r] = sign * frame.basis(x[n]).components(u[n]);
  }
};

/// Rows for each wall node: c there, before and behind it along the axis, before and behind it away from the axis.
constexpr Index passage_places = 5;

/// Where the gradient of C is taken at wall nodes.
template <class MemorySpace>
struct PassageSlopes {
  RowFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> wall;
  InterpolationTable<MemorySpace> places;
  Kokkos::View<double const*, MemorySpace> step;  ///< two per wall node, between the places; 0: nothing changes there

  [[nodiscard]] Index size() const { return Index(wall.extent(0)); }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double per_length(Index k, int a) const {
    double const s = step(2 * k + a);
    return s > 0 ? 1 / s : 0;
  }
};

/// Takes C off the motions of wall nodes.
template <class MemorySpace>
struct TakePassageFromFrames {
  PassageSlopes<MemorySpace> at;
  Vec3 const* c;
  Field<double const> x;
  AffineMotion* motion;

  [[nodiscard]] Index size() const { return at.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    RowBasis const basis = at.frame.basis(x[at.wall(k)]);
    Index const first = passage_places * k;
    AffineMotion taken = motion[k];
    Vec3 const own = mean_of_row(at.places, c, first);
    taken.u = taken.u - basis.vector(own);
    for (int a = 0; a < 2; ++a) {
      Index const before = first + 1 + 2 * a;
      Vec3 const slope =
          at.per_length(k, a) * (mean_of_row(at.places, c, before + 1) - mean_of_row(at.places, c, before));
      subtract(taken.gradient, basis.vector(slope), a == 0 ? basis.along : basis.away);
    }
    if (!at.frame.is_linear && basis.radius > 0)
      subtract(taken.gradient, (1 / basis.radius) * (own.y * basis.around - own.z * basis.away), basis.around);
    motion[k] = taken;
  }

 private:
  static KOKKOS_INLINE_FUNCTION void subtract(Mat3& m, Vec3 const& value, Vec3 const& along) {
    double const v[3] = {value.x, value.y, value.z}, a[3] = {along.x, along.y, along.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m.m[i][j] -= v[i] * a[j];
  }
};

/// Its transpose: gradients of c at the places.
template <class MemorySpace>
struct TakePassageFromFramesBack {
  PassageSlopes<MemorySpace> at;
  Field<double const> x;
  AffineMotion const* motion;
  Vec3* of_place;

  [[nodiscard]] Index size() const { return at.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    RowBasis const basis = at.frame.basis(x[at.wall(k)]);
    Index const first = passage_places * k;
    Vec3 own = -1.0 * basis.components(motion[k].u);
    for (int a = 0; a < 2; ++a) {
      Vec3 const of_slope =
          at.per_length(k, a) * basis.components(motion[k].gradient * (a == 0 ? basis.along : basis.away));
      of_place[first + 1 + 2 * a] = of_slope;
      of_place[first + 2 + 2 * a] = -1.0 * of_slope;
    }
    if (!at.frame.is_linear && basis.radius > 0) {
      Vec3 const g = (1 / basis.radius) * (motion[k].gradient * basis.around);
      own.y -= dot(basis.around, g);
      own.z += dot(basis.away, g);
    }
    of_place[first] = own;
  }
};

/// given(slot) += what the sides have gathered of c.
template <class MemorySpace>
struct SideComponentsBack {
  RowFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> slot, node;
  Field<double const> x;
  Vec3 const* c;
  Vec3* given;

  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    given[slot(k)] += frame.basis(x[node(k)]).vector({along_share * c[k].x, c[k].y, c[k].z});
  }
};

}  // namespace gridmorph::kernels
