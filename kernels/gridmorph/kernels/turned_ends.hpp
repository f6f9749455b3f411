// Rotations at the ends of lines made ready for the nodes between (turned_line.hpp): M = R - I and b = -M p.
//
// A line of the near field has both about its wall node p: M0 = s R(inner) - I and M1 = R(outer) - I (root_turn.hpp). The stretch s
// keeps the height l.n of its first node above the wall, n' = R(raw) n the wall's normal after:
//
//   f0 s n'.R(inner) l + (1 - f0) n'.R(outer) l = n.l,   f0 = (1 - t)^3 at that node
#pragma once

#include <gridmorph/kernels/root_turn.hpp>
#include <gridmorph/kernels/turned_line.hpp>

namespace gridmorph::kernels {

/// One line of the near field; vectors in the chain's frame.
struct NearFieldLine {
  Index lower, upper;   ///< its line ends
  std::int32_t root;    ///< in RootTable
  std::int32_t matrix;  ///< frame of the root's slot -> chain frame, -1: the same
  Vec3 normal;          ///< of the wall, unit
  Vec3 edge;            ///< from the wall to the first node
  double f0;            ///< there
};

template <class V>
struct TurnColumns {
  V x, y, z;
  KOKKOS_INLINE_FUNCTION V operator*(Vec3 const& p) const { return p.x * x + p.y * y + p.z * z; }
};
/// R - I.
template <class V>
KOKKOS_INLINE_FUNCTION TurnColumns<V> columns_of(V const& turn) {
  return {turned_by(turn, 1, V{Vec3{1, 0, 0}}), turned_by(turn, 1, V{Vec3{0, 1, 0}}),
          turned_by(turn, 1, V{Vec3{0, 0, 1}})};
}
template <class V>
KOKKOS_INLINE_FUNCTION void set_end(TurnedEnds<double> const& ends, Index at, TurnColumns<V> const& m, Vec3 const& p) {
  ends.set(at, written(m.x), written(m.y), written(m.z), written(-(m * p)));
}

/// Ends of chains from their rotation vectors.
template <class V>
struct TurnEnds {
  VectorsWithRates<V> turn;
  Field<double const> position;  ///< baseline, chain frame
  TurnedEnds<double> ends;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { set_end(ends, n, columns_of(turn[n]), position[n]); }
};

/// Lines of the near field.
template <class MemorySpace, class V>
struct TurnNearField {
  Kokkos::View<NearFieldLine const*, MemorySpace> lines;
  RootTable<MemorySpace> table;
  VectorsWithRates<V> inner, raw, outer;  ///< per slot; per root
  Field<double const> position;           ///< of line ends
  Field<double> turn;                     ///< of line ends
  TurnedEnds<double> ends;

  [[nodiscard]] Index size() const { return Index(lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    NearFieldLine const& line = lines(n);
    Index const slot = table.roots(line.root).slot;
    V const in = table.in_frame(line.matrix, inner[slot]), out = table.in_frame(line.matrix, outer[line.root]);
    turn.set(line.lower, written(in));
    turn.set(line.upper, written(out));
    TurnColumns<V> m0 = columns_of(in);
    TurnColumns<V> const m1 = columns_of(out);
    auto const s = stretch(line, table.in_frame(line.matrix, raw[line.root]), m0 * line.edge, m1 * line.edge);
    m0.x = m0.x + s * (V{Vec3{1, 0, 0}} + m0.x);
    m0.y = m0.y + s * (V{Vec3{0, 1, 0}} + m0.y);
    m0.z = m0.z + s * (V{Vec3{0, 0, 1}} + m0.z);
    set_end(ends, line.lower, m0, position[line.lower]);
    set_end(ends, line.upper, m1, position[line.lower]);
  }

 private:
  /// s - 1, by differences: zero where nothing turns.
  KOKKOS_INLINE_FUNCTION auto stretch(NearFieldLine const& line, V const& wall, V const& in, V const& out) const {
    V const change = turned_by(wall, 1, V{line.normal}), normal = V{line.normal} + change;
    auto const inner_height = dot(normal, V{line.edge} + in);
    auto const missing = -dot(change, V{line.edge}) - dot(normal, line.f0 * in + (1 - line.f0) * out);
    double const height = dot(line.normal, line.edge);
    // Lines along the wall have no height to keep, and a near field of one cell has none to give.
    bool const none = !(line.f0 > 0.1) || !(height * height > 0.01 * dot(line.edge, line.edge)) ||
                      !(height * inner_height > 0.1 * height * height);
    using Scalar = std::decay_t<decltype(inner_height)>;
    if (none) return Scalar{};
    return missing / (line.f0 * inner_height);
  }
};

}  // namespace gridmorph::kernels
