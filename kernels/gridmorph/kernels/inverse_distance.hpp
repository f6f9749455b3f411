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
// groups. Cost per boundary node and lattice node a few dozen groups, 8 bytes each and the group's value (24 bytes,
// motion: 96) from cache.
#pragma once

#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/uniform_lattice.hpp>
#include <gridmorph/kernels/vector_array.hpp>

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

/// The value at x of the motion of a group at `centre`.
KOKKOS_INLINE_FUNCTION Vec3 value_at(AffineMotion const& motion, Vec3 const& centre, Vec3 const& x) {
  return motion.u + motion.gradient * (x - centre);
}
KOKKOS_INLINE_FUNCTION Vec3 value_at(Vec3 const& u, Vec3 const&, Vec3 const&) { return u; }

template <class MemorySpace>
struct InverseDistanceTable {
  InterpolationTable<MemorySpace> leaves;         ///< boundary nodes -> groups
  LayerTable<MemorySpace> groups;                 ///< groups -> groups
  InterpolationTable<MemorySpace> lattice;        ///< groups -> lattice nodes
  Kokkos::View<Vec3 const*, MemorySpace> centre;  ///< of each group
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
  Kokkos::View<Vec3 const*, MemorySpace> centre;
  Value const* group;
  Vec3* value;

  [[nodiscard]] Index size() const { return rows.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    Vec3 const x = shape.position(rows.target(r));
    auto const at = [&](Index k) { return value_at(group[rows.item(k)], centre(rows.item(k)), x); };
    Vec3 const base = at(from);
    Vec3 sum;
    for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (at(k) - base);
    value[rows.target(r)] = base + sum;
  }
};

/// Evaluates the field on its lattice. given: what the boundary nodes say, in the order of the plan. group: one per
/// group, workspace. value: one per lattice node.
template <class Exec, class Value>
void spread_to_lattice(Exec const& exec, InverseDistanceTable<typename Exec::memory_space> const& table,
                       Value const* given, Value* group, Vec3* value) {
  interpolate("gridmorph::scatter::leaves", exec, table.leaves, given, group);
  interpolate_layers("gridmorph::scatter::groups", exec, table.groups, group);
  launch("gridmorph::scatter::lattice", exec,
         LatticeFromGroups<typename Exec::memory_space, Value>{table.lattice, table.shape, table.centre, group, value});
}

}  // namespace gridmorph::kernels
