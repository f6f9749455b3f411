// Rotations at the ends of lines made ready for the nodes between (turned_line.hpp): quaternions, pivots, stretches.
//
// A line of the near field turns about its wall node, from the wall's R(inner) to R(outer) (root_turn.hpp). The stretch
// s keeps the height l.n of its first node above the wall, n' = R(raw) n the wall's normal after:
//
//   (1 + f0 (s - 1)) n'.R(f0) l = n.l,   f0 that of the node
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
  Vec3 edge;            ///< from the wall to the first node that coordinates resolve
  double f0;            ///< share f of the wall's rotation at that node
};

/// What is kept of an end: its value, or its rate. The pivot does not move.
KOKKOS_INLINE_FUNCTION TurnedEnd<Vec3> written(TurnedEnd<Vec3> const& e) { return e; }
KOKKOS_INLINE_FUNCTION TurnedEnd<Vec3> written(TurnedEnd<DualVec3> const& e) {
  return {{e.q.imaginary.rate, e.q.less.rate}, {}, e.stretch.rate};
}

/// Ends of chains from their rotations. What an end's turn about its pivot displaces the end itself by is taken off its
/// displacement: it comes back with the turn, and fades with it.
template <class V>
struct TurnEnds {
  VectorsWithRates<V> turn;
  Field<double const> position, pivot;  ///< baseline, chain frame
  TurnedEnds<double> ends;
  Field<double> u;  ///< of the ends
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Vec3 const arm = position[n] - pivot[n];
    TurnedEnd<V> const end{quaternion_of(turn[n]), pivot[n]};
    ends.set(n, written(end));
    if (dot(arm, arm) > 0) u.set(n, u[n] - written(end.q.turned(V{arm})));
  }
};

/// The rotations and ends of the lines of the near field.
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
    Found const found = at(line, inner, raw, outer);
    turn.set(line.lower, written(found.in));
    turn.set(line.upper, written(found.out));
    ends.set(line.lower, written(found.lower));
    ends.set(line.upper, written(found.upper));
  }

  struct Found {
    V in, out;  ///< rotations of its two ends
    TurnedEnd<V> lower, upper;
  };
  /// What the ends of a line do, by the rotations of its root.
  template <class Vectors>
  KOKKOS_INLINE_FUNCTION Found at(NearFieldLine const& line, Vectors const& inner, Vectors const& raw,
                                  Vectors const& outer) const {
    Index const slot = table.roots(line.root).slot;
    V const in = table.in_frame(line.matrix, inner[slot]), out = table.in_frame(line.matrix, outer[line.root]);
    Vec3 const pivot = position[line.lower];
    // The edge's rotation has been made from a longer one, and goes its way round.
    Quaternion<V> const wall = quaternion_of(in), own = quaternion_of(out),
                        edge = keeps_its_way(value_of(in)) ? own : nearer(wall, own);
    auto const s = stretch(line, table.in_frame(line.matrix, raw[line.root]), Q::between(edge, wall, line.f0));
    return {in, out, {wall, pivot, s}, {edge, pivot}};
  }

  /// Lines along the wall have no height to keep, and a near field of one cell has none to give. inner_height:
  /// (n'.R(f0) l) of the head of this file.
  KOKKOS_INLINE_FUNCTION static bool keeps_height(NearFieldLine const& line, double inner_height) {
    double const height = dot(line.normal, line.edge);
    return line.f0 > 0.1 && height * height > 0.01 * dot(line.edge, line.edge) &&
           height * inner_height > 0.1 * height * height;
  }
  /// Whether the quaternion of the upper end is that of its rotation with the other sign.
  KOKKOS_INLINE_FUNCTION static bool edge_is_turned_round(Found const& found) {
    Quaternion<V> const q = quaternion_of(found.out);
    return value_of(dot(q.imaginary, found.upper.q.imaginary)) +
               (1 - value_of(q.less)) * (1 - value_of(found.upper.q.less)) <
           0;
  }

 private:
  using Q = Quaternion<V>;

  /// Either q or -q, which are one rotation: the one that is nearer to `to`.
  KOKKOS_INLINE_FUNCTION static Q nearer(Q const& to, Q const& q) {
    auto const cosine = dot(to.imaginary, q.imaginary) + (Scalar{1} - to.less) * (Scalar{1} - q.less);
    return cosine < 0 ? Q{-q.imaginary, Scalar{2} - q.less} : q;
  }
  /// s - 1, by differences: zero where nothing turns.
  using Scalar = typename Q::Scalar;
  KOKKOS_INLINE_FUNCTION Scalar stretch(NearFieldLine const& line, V const& wall, Q const& first) const {
    V const change = turned_by(wall, V{line.normal}), normal = V{line.normal} + change;
    V const edge{line.edge}, moved = first.turned(edge);
    Scalar const inner_height = dot(normal, edge + moved), missing = -dot(change, edge) - dot(normal, moved);
    if (!keeps_height(line, value_of(inner_height))) return {};
    return missing / (line.f0 * inner_height);
  }
};

}  // namespace gridmorph::kernels
