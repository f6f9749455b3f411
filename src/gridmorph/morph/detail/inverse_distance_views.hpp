// Layers of rows and scattered fields on an execution space. Internal to unstructured.
#pragma once

#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/plan/inverse_distance_field.hpp>
#include <gridmorph/plan/layers.hpp>

#include <Kokkos_Core.hpp>

#include <vector>

namespace gridmorph::detail {

template <class MemorySpace, class T>
using View = Kokkos::View<T*, MemorySpace>;

template <class Exec, class Kernel>
void launch(char const* label, Exec const& exec, Index begin, Index end, Kernel const& kernel) {
  if (begin < end)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, begin, end), kernel);
}

/// Layers of rows, as many launches: the host keeps where each begins.
template <class MemorySpace>
struct LayerViews {
  InterpolationViews<MemorySpace> rows;
  std::vector<Index> level;

  LayerViews() = default;
  explicit LayerViews(LayerRows const& from) : rows(from.rows), level(from.level) {}

  template <class Exec>
  void run(Exec const& exec, View<MemorySpace, Vec3> const& value) const {
    for (std::size_t l = 0; l + 1 < level.size(); ++l) gather(exec, rows, level[l], level[l + 1], value, value);
  }
};

/// Displacement around a place: u + gradient (x - place).
struct AffineMotion {
  Vec3 u;
  Mat3 gradient;
};

KOKKOS_INLINE_FUNCTION AffineMotion operator-(AffineMotion const& a, AffineMotion const& b) {
  AffineMotion c{a.u - b.u, {}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.gradient.m[i][j] = a.gradient.m[i][j] - b.gradient.m[i][j];
  return c;
}

/// a + w b
KOKKOS_INLINE_FUNCTION AffineMotion plus(AffineMotion const& a, double w, AffineMotion const& b) {
  AffineMotion c{a.u + w * b.u, {}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.gradient.m[i][j] = a.gradient.m[i][j] + w * b.gradient.m[i][j];
  return c;
}
KOKKOS_INLINE_FUNCTION Vec3 plus(Vec3 const& a, double w, Vec3 const& b) { return a + w * b; }

/// What a group at `centre` gives at x.
KOKKOS_INLINE_FUNCTION Vec3 value_at(AffineMotion const& motion, Vec3 const& centre, Vec3 const& x) {
  return motion.u + motion.gradient * (x - centre);
}
KOKKOS_INLINE_FUNCTION Vec3 value_at(Vec3 const& u, Vec3 const&, Vec3 const&) { return u; }

/// Means of values of type Value; rows of InterpolationOperator, see gather().
template <class MemorySpace, class Value>
struct GatherValues {
  InterpolationViews<MemorySpace> rows;
  View<MemorySpace, Value> source, value;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    Value const base = source(rows.item(from));
    Value sum = base;
    for (Index k = from + 1; k < to; ++k) sum = plus(sum, double(rows.weight(k)), source(rows.item(k)) - base);
    value(rows.target(r)) = sum;
  }
};

template <class MemorySpace, class Value>
struct GatherAtLattice {
  InterpolationViews<MemorySpace> rows;
  UniformLattice shape;
  View<MemorySpace, Vec3> centre;
  View<MemorySpace, Value> group;
  View<MemorySpace, Vec3> value;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    Vec3 const x = shape.position(rows.target(r));
    auto const at = [&](Index k) { return value_at(group(rows.item(k)), centre(rows.item(k)), x); };
    Vec3 const base = at(from);
    Vec3 sum;
    for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (at(k) - base);
    value(rows.target(r)) = base + sum;
  }
};

/// A InverseDistanceField: values of its boundary nodes in, displacements on the lattice out. Value: Vec3, or AffineMotion where
/// walls turn: what a rigid wall says is then the same rigid motion everywhere.
template <class MemorySpace, class Value>
struct InverseDistanceViews {
  InterpolationViews<MemorySpace> leaves;
  LayerViews<MemorySpace> groups;
  InterpolationViews<MemorySpace> rows;
  UniformLattice shape;
  View<MemorySpace, Vec3> centre;
  View<MemorySpace, Value> group_value;
  View<MemorySpace, Vec3> value;

  explicit InverseDistanceViews(InverseDistanceField const& from)
      : leaves(from.leaves),
        groups(from.groups),
        rows(from.lattice),
        shape(from.shape),
        centre(copy_of<MemorySpace>(from.centre, "gridmorph::InverseDistanceViews::centre")),
        group_value("gridmorph::InverseDistanceViews::group_value", std::size_t(from.n_groups)),
        value("gridmorph::InverseDistanceViews::value", std::size_t(from.lattice.size())) {}

  [[nodiscard]] bool empty() const { return value.extent(0) == 0; }

  /// given (boundary nodes in their order). Per boundary node and lattice row a few groups each.
  template <class Exec>
  void run(Exec const& exec, View<MemorySpace, Value> const& given) const {
    launch("gridmorph::scatter::leaves", exec, 0, leaves.size(),
           GatherValues<MemorySpace, Value>{leaves, given, group_value});
    for (std::size_t l = 0; l + 1 < groups.level.size(); ++l)
      launch("gridmorph::scatter::groups", exec, groups.level[l], groups.level[l + 1],
             GatherValues<MemorySpace, Value>{groups.rows, group_value, group_value});
    launch("gridmorph::scatter::lattice", exec, 0, rows.size(),
           GatherAtLattice<MemorySpace, Value>{rows, shape, centre, group_value, value});
  }
};

}  // namespace gridmorph::detail
