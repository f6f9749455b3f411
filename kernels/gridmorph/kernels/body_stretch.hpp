// How bodies stretch as wholes, beside how they turn (body_turn.hpp): in thickness, length, size, by shear.
//
//   y + E y,   E = q (R^T (Pi + N) - Pi),   N = sum over the body's wall nodes of u l^T,   l = w M^-1 (x - c)
//
// R is the body's rotation, c the mean place of its walls, w the share of a wall node in their area, M the second
// moments of their places: Pi + N is the linear map that fits best, by least squares over the area, to where the walls
// went. Pi is the projection onto the directions in which the body extends and may stretch, which M^-1 is restricted
// to; q, planned, is how much of the stretch the body makes as a whole (plan/elements/body_stretch.hpp). Rigid bodies
// have E = 0 to rounding.
//
// Or, where limits say so, E is what the body grows by in all directions alike: with l = w (x - c) / tr M and Pi =
// M / tr M it is E = q tr(R^T (Pi + N) - Pi) I, in the plane where it may stretch in that alone.
//
// What stands on a wall keeps its distance from it there, and makes all of the stretch at the end of its column: a node
// x of a column on w makes, besides what its column does, R E h, h = s (x - w), with a share s that grows from 0 to 1.
//
// Cost per wall node: 52 bytes, 18 flops. Per body: three turns of a vector.
#pragma once

#include <gridmorph/kernels/dual.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/rotation.hpp>
#include <gridmorph/kernels/vector_array.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// A linear map by what it makes of the unit vectors; zero at first, unlike Mat3.
struct StretchMap {
  Vec3 column[3];

  KOKKOS_INLINE_FUNCTION Vec3 operator*(Vec3 const& y) const {
    return y.x * column[0] + y.y * column[1] + y.z * column[2];
  }
  KOKKOS_INLINE_FUNCTION StretchMap& operator+=(StretchMap const& other) {
    for (int a = 0; a < 3; ++a) column[a] += other.column[a];
    return *this;
  }
  /// Adds the product u l^T.
  KOKKOS_INLINE_FUNCTION void add(Vec3 const& u, Vec3 const& l) {
    column[0] += l.x * u;
    column[1] += l.y * u;
    column[2] += l.z * u;
  }
};

/// How a body may stretch.
struct StretchLimits {
  Mat3 span;          ///< Pi
  double share = 0;   ///< q
  bool even = false;  ///< in all directions alike
};

/// What N becomes where a body slides on a plane with the unit normal n, and stretches in it alone; n zero: what it is.
KOKKOS_INLINE_FUNCTION StretchMap in_plane(StretchMap m, Vec3 const& n) {
  for (Vec3& c : m.column) c = c - dot(n, c) * n;
  return m;
}

/// The trace of a map times the unit one, or that of the plane with the unit normal n.
KOKKOS_INLINE_FUNCTION StretchMap evened(StretchMap const& e, Vec3 const& n) {
  double const trace = e.column[0].x + e.column[1].y + e.column[2].z;
  return in_plane({{{trace, 0, 0}, {0, trace, 0}, {0, 0, trace}}}, n);
}

/// Column a of E for a body whose rotation is `whole`, from that of N.
template <class V>
KOKKOS_INLINE_FUNCTION V stretched(StretchLimits const& limits, Quaternion<V> const& whole, int a, V const& moment) {
  return limits.share * (moment + whole.back().turned(V{column_of(limits.span, a)} + moment));
}

/// The sum of u l^T of each chunk of wall nodes, as SumBodyWalls has them.
template <class MemorySpace>
struct SumBodyStretches {
  Kokkos::View<std::int32_t const*, MemorySpace> slot;
  Kokkos::View<Vec3 const*, MemorySpace> lever;
  Kokkos::View<Index const*, MemorySpace> first;
  Index n_chunks;
  VectorArray boundary;  ///< displacements, or their rates
  StretchMap* sum;

  [[nodiscard]] Index size() const { return n_chunks; }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    StretchMap s;
    for (Index k = first(c); k < first(c + 1); ++k) s.add(boundary[slot(k)], lever(k));
    sum[c] = s;
  }
};

}  // namespace gridmorph::kernels
