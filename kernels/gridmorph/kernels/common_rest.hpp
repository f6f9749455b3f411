// What displacements have beyond the motion in common (common_motion.hpp), so that what rounding makes of large ones
// stays out of means and sums:
//
//   - the fit once more, to u - A(x) at boundary nodes, which mathematics has nothing left for: A is then good to the
//     last bits of its coefficients
//   - u - A(x) of all nodes, whose means get A at their own place
//   - nodes that go along with another one: A(x) less A there besides
//
// Cost: 72 bytes per node.
#pragma once

#include <gridmorph/kernels/common_motion.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// rest(k) = u(k) - A(x(k)) of listed places.
template <class MemorySpace>
struct RestBeyondCommon {
  CommonFrame frame;
  Kokkos::View<Vec3 const*, MemorySpace> position;
  CommonMove const* move;
  Vec3 const* u;
  Vec3* rest;

  [[nodiscard]] Index size() const { return Index(position.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { rest[k] = u[k] - move->map(frame, position(k)); }
};

/// rest(n) = u(n) - A(x(n)) of all nodes.
struct NodesBeyondCommon {
  CommonFrame frame;
  Field<double const> x;
  CommonMove const* move;
  Vec3 const* u;
  Vec3* rest;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { rest[n] = u[n] - move->map(frame, x[n]); }
};

/// u(n) += A(x(n)) of listed nodes.
template <class MemorySpace>
struct AddCommonAt {
  CommonFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Field<double const> x;
  CommonMove const* move;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u[node(k)] += move->map(frame, x[node(k)]); }
};

/// y at listed nodes less y at others, one for each.
template <class MemorySpace>
struct CommonDistances {
  CommonFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> node, from;
  Field<double const> x;
  Vec3* distance;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const d = x[node(k)] - x[from(k)];
    distance[k] = {dot(frame.axis[0], d), dot(frame.axis[1], d), dot(frame.axis[2], d)};
  }
};

/// u(n) += A(x(n)) less A at the other node.
template <class MemorySpace>
struct AddCommonDistances {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<Vec3 const*, MemorySpace> distance;
  CommonMove const* move;
  Vec3* u;

  [[nodiscard]] Index size() const { return Index(distance.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const d = distance(k);
    u[node(k)] += d.x * move->map.a[1] + d.y * move->map.a[2] + d.z * move->map.a[3];
  }
};

}  // namespace gridmorph::kernels
