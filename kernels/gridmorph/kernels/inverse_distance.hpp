// A smooth field between scattered boundary values, on the nodes of an even lattice (plan/inverse_distance_field.hpp
// has the weights):
//
//   v(x) = sum over n of w_n v_n(x) / sum over n of w_n,    w_n = A_n / |x - x_n|^p
//
// (Shepard 1968; with areas: Luke, Collins and Blades 2012), far groups of boundary nodes as one. What a boundary node
// says is a value, or a motion v_n(x) = u + G (x - x_n): a wall that turns rigidly then says the same rigid motion
// everywhere.
//
// Three sets of rows: leaves from boundary nodes, groups from their two parts level by level, lattice nodes from
// groups. Cost per boundary node and lattice node a few dozen groups, 8 bytes each and the group's value (32 bytes,
// motion: 160) from cache.
#pragma once

#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/uniform_lattice.hpp>
#include <gridmorph/kernels/vector_array.hpp>
#include <gridmorph/kernels/vector_runs.hpp>

namespace gridmorph::kernels {

/// Walls as they come again behind periodic boundaries: at x' = rotation x + translation.
struct WallImage {
  Mat3 rotation;
  Vec3 translation;
};

/// Displacement around a place: u + gradient (x - place).
struct AffineMotion {
  Vec3 u;
  Mat3 gradient{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};

  KOKKOS_INLINE_FUNCTION AffineMotion& operator+=(AffineMotion const& b) { return *this = *this + b; }
  friend KOKKOS_INLINE_FUNCTION AffineMotion operator+(AffineMotion const& a, AffineMotion const& b) {
    AffineMotion c{a.u + b.u};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) c.gradient.m[i][j] = a.gradient.m[i][j] + b.gradient.m[i][j];
    return c;
  }
  friend KOKKOS_INLINE_FUNCTION AffineMotion operator*(double w, AffineMotion const& a) {
    AffineMotion c{w * a.u};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) c.gradient.m[i][j] = w * a.gradient.m[i][j];
    return c;
  }
  friend KOKKOS_INLINE_FUNCTION AffineMotion operator-(AffineMotion const& a, AffineMotion const& b) {
    return a + -1.0 * b;
  }
};

/// The same, by columns: T is V to compute with, and PackedVec3 to be kept (packed_vec3.hpp).
template <class T>
struct MotionByColumns {
  T u, column[3];

  KOKKOS_INLINE_FUNCTION MotionByColumns& operator+=(MotionByColumns const& b) { return *this = *this + b; }
  friend KOKKOS_INLINE_FUNCTION MotionByColumns operator+(MotionByColumns const& a, MotionByColumns const& b) {
    return {a.u + b.u, {a.column[0] + b.column[0], a.column[1] + b.column[1], a.column[2] + b.column[2]}};
  }
  friend KOKKOS_INLINE_FUNCTION MotionByColumns operator-(MotionByColumns const& a, MotionByColumns const& b) {
    return {a.u - b.u, {a.column[0] - b.column[0], a.column[1] - b.column[1], a.column[2] - b.column[2]}};
  }
  friend KOKKOS_INLINE_FUNCTION MotionByColumns operator*(double w, MotionByColumns const& a) {
    return {w * a.u, {w * a.column[0], w * a.column[1], w * a.column[2]}};
  }
};

template <class V>
KOKKOS_INLINE_FUNCTION MotionByColumns<V> as(AffineMotion const& a) {
  auto const column = [&](int j) { return as<V>(Vec3{a.gradient.m[0][j], a.gradient.m[1][j], a.gradient.m[2][j]}); };
  return {as<V>(a.u), {column(0), column(1), column(2)}};
}
template <class V>
KOKKOS_INLINE_FUNCTION MotionByColumns<V> as(MotionByColumns<PackedVec3> const& a) {
  return {as<V>(a.u), {as<V>(a.column[0]), as<V>(a.column[1]), as<V>(a.column[2])}};
}
template <class V>
KOKKOS_INLINE_FUNCTION void put(MotionByColumns<PackedVec3>& to, MotionByColumns<V> const& a) {
  put(to.u, a.u);
  for (int j = 0; j < 3; ++j) put(to.column[j], a.column[j]);
}

/// The value at x of the motion of a group at `centre`.
KOKKOS_INLINE_FUNCTION Vec3 value_at(AffineMotion const& motion, Vec3 const& centre, Vec3 const& x) {
  return motion.u + motion.gradient * (x - centre);
}
template <class V>
KOKKOS_INLINE_FUNCTION V value_at(MotionByColumns<V> const& motion, V const& centre, V const& x) {
  V const away = x - centre;
  return motion.u + (component(away, 0) * motion.column[0] + component(away, 1) * motion.column[1] +
                     component(away, 2) * motion.column[2]);
}
template <class V>
KOKKOS_INLINE_FUNCTION V value_at(V const& u, V const&, V const&) {
  return u;
}

/// How groups keep what boundary nodes say.
template <class Value>
using PackedValue = std::conditional_t<std::is_same_v<Value, AffineMotion>, MotionByColumns<PackedVec3>, PackedVec3>;

template <class MemorySpace>
struct InverseDistanceTable {
  InterpolationTable<MemorySpace> leaves;               ///< boundary nodes -> groups
  LayerTable<MemorySpace> groups;                       ///< groups -> groups
  InterpolationTable<MemorySpace> lattice;              ///< groups -> lattice nodes
  Kokkos::View<PackedVec3 const*, MemorySpace> centre;  ///< of each group
  UniformLattice shape;

  [[nodiscard]] bool empty() const { return lattice.size() == 0; }
};

/// Boundaries that say where they go and nothing of what is around them: frame(k) = boundary(slot(k)).
template <class MemorySpace>
struct FramesFromSlots {
  Kokkos::View<std::int32_t const*, MemorySpace> slot;
  VectorArray boundary;
  AffineMotion* frame;

  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { frame[k] = {boundary[slot(k)]}; }
};

/// Lattice nodes from groups, each group at its own place.
template <class MemorySpace, class Value>
struct LatticeFromGroups {
  InterpolationTable<MemorySpace> rows;
  UniformLattice shape;
  Kokkos::View<PackedVec3 const*, MemorySpace> centre;
  PackedValue<Value> const* group;
  PackedVec3* value;

  [[nodiscard]] Index size() const { return rows.size(); }
  template <class V>
  KOKKOS_INLINE_FUNCTION void run(Index begin, Index end) const {
    for (Index r = begin; r < end; ++r) {
      Index const from = rows.first(r), to = rows.first(r + 1);
      V const x = as<V>(shape.position(rows.target(r)));
      auto const at = [&](Index k) { return value_at(as<V>(group[rows.item(k)]), as<V>(centre(rows.item(k))), x); };
      V const base = at(from);
      V sum = as<V>(Vec3{});
      for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (at(k) - base);
      put(value[rows.target(r)], base + sum);
    }
  }
};

/// Evaluates the field on the nodes of its lattice that have rows. given: what the boundary nodes say, in the order of
/// the plan. group: one per group, workspace. value: one per lattice node.
template <class Exec, class Value>
void spread_to_lattice(Exec const& exec, InverseDistanceTable<typename Exec::memory_space> const& table,
                       Value const* given, PackedValue<Value>* group, PackedVec3* value) {
  interpolate("gridmorph::scatter::leaves", exec, table.leaves, given, group);
  interpolate_layers("gridmorph::scatter::groups", exec, table.groups, group);
  launch("gridmorph::scatter::lattice", exec,
         LatticeFromGroups<typename Exec::memory_space, Value>{table.lattice, table.shape, table.centre, group, value});
}

}  // namespace gridmorph::kernels
