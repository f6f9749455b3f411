// Gradients through rotations of line ends: the transposes of turned_line.hpp, turned_ends.hpp and root_turn.hpp, linearised where the
// walls are.
//
// The rotation of a wall node hands its gradient to its neighbours, and lines of the near field and end walls theirs to the rotations that they
// depend on; what end walls make of slip surfaces is taken by exact rates (dual.hpp) along the three axes of what it depends on. Every sum is
// made by one work item in one order.
//
// Cost: about 100 flops per node and end that turns; per wall node about twice its rotation.
#pragma once

#include <gridmorph/kernels/rotation_gradient.hpp>
#include <gridmorph/kernels/transposed_wall_turn.hpp>
#include <gridmorph/kernels/turned_ends.hpp>

namespace gridmorph::kernels {

/// Of line ends: arrays as those of TurnedEnds, pivots unused.
struct TurnedEndGradients {
  TurnedEnds<double> at;

  KOKKOS_INLINE_FUNCTION void set(Index end, TurnedGradient const& g) const {
    at.set(end, {{g.imaginary, g.less}, {}, g.stretch});
  }
  KOKKOS_INLINE_FUNCTION TurnedGradient operator[](Index end) const {
    TurnedEnd<Vec3> const e = TurnedEnds<double const>{at.first, at.n}[end];
    return {e.q.imaginary, e.q.less, e.stretch};
  }
  KOKKOS_INLINE_FUNCTION void add(Index end, double f, TurnedGradient const& g) const {
    TurnedGradient sum = (*this)[end];
    sum.add(f, g);
    set(end, sum);
  }
};

/// Of what turned_between() gives a node at x, whose gradient is g: added to those of the two ends.
KOKKOS_INLINE_FUNCTION void turned_gradient(TurnedEnds<double const> const& ends, Chain const& chain, Index lower,
                                            Index upper, double t, Vec3 const& x, Vec3 const& g, TurnedGradient& first,
                                            TurnedGradient& last) {
  using Q = Quaternion<Vec3>;
  TurnWeights const f = turn_weights(chain, t);
  if (turns_as_one(chain)) {
    TurnedEnd<Vec3> const wall = ends[lower];
    bool const outer = (chain.turned_ends & 2u) != 0;
    Q const q = outer ? Q::between(ends[upper].q, wall.q, f.lower) : Q::share(wall.q, f.lower);
    Vec3 const arm = x - wall.pivot;
    TurnedGradient const of_q = turned_gradient(q, arm, (1 + f.lower * wall.stretch) * g);
    first.add(f.lower, of_q);
    if (outer) last.add(1 - f.lower, of_q);
    first.stretch += f.lower * dot(g, arm + q.turned(arm));
    return;
  }
  auto const add = [&](Index end, double share, TurnedGradient& to) {
    TurnedEnd<Vec3> const e = ends[end];
    to.add(share, turned_gradient(Q::share(e.q, share), x - e.pivot, g));
  };
  if (chain.turned_ends & 1u) add(lower, f.lower, first);
  if (chain.turned_ends & 2u) add(upper, f.upper, last);
}

/// Transpose of TurnEnds: gradients of rotations, from those of what was made of them.
struct TurnEndsBack {
  Field<double const> turn;             ///< rotations
  Field<double const> position, pivot;  ///< baseline, chain frame
  Field<double const> u;                ///< gradients of displacements of ends
  TurnedEndGradients turned;
  Field<double> turns;  ///< gradients of rotations
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Vec3 const arm = position[n] - pivot[n];
    TurnedGradient g = turned[n];
    if (dot(arm, arm) > 0) g.add(-1, turned_gradient(quaternion_of(turn[n]), arm, u[n]));
    turns.set(n, turns[n] + rotation_gradient(turn[n], g));
  }
};

/// What depends on what: of target n those dependents from first(n) on.
template <class MemorySpace>
struct Dependents {
  Kokkos::View<Index const*, MemorySpace> target, first, dependent;
};

/// One vector of a list that changes along a direction while the others stay.
struct SeededVectors {
  Field<double const> values;
  Index seeded = -1;
  Vec3 direction;
  KOKKOS_INLINE_FUNCTION DualVec3 operator[](Index n) const { return {values[n], n == seeded ? direction : Vec3{}}; }
};

/// gradient(target) += sum over what depends on it; of(dependent, target, direction): rate of J by way of one dependent where the target
/// changes along a direction. One item per target.
template <class MemorySpace, class Function>
struct PullBack {
  Dependents<MemorySpace> on;
  Function of;
  Field<double> gradient;

  [[nodiscard]] Index size() const { return Index(on.target.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const target = on.target(n);
    Vec3 sum = gradient[target];
    for (Index m = on.first(n); m < on.first(n + 1); ++m) {
      Index const d = on.dependent(m);
      sum += {of(d, target, Vec3{1, 0, 0}), of(d, target, Vec3{0, 1, 0}), of(d, target, Vec3{0, 0, 1})};
    }
    gradient.set(target, sum);
  }
};
template <class Exec, class Function>
void pull_back(char const* label, Exec const& exec, Dependents<typename Exec::memory_space> const& on,
               Function const& of, Field<double> const& gradient) {
  launch(label, exec, PullBack<typename Exec::memory_space, Function>{on, of, gradient});
}

/// Transpose of RawRootTurn: gradients of the displacements of a root's neighbours, at their places in the table in the frame of the
/// root's slot, and after those of all roots that of its own slot.
template <class MemorySpace>
struct RawRootTurnBack {
  RootTable<MemorySpace> table;
  Field<double const> u, raw;  ///< displacements; gradients
  Field<double> parts;

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Root const& root = table.roots(r);
    Vec3 const g = raw[r];
    Index const own = Index(table.neighbours.extent(0)) + r;
    for (Index k = 0; k < root.n_neighbours; ++k) parts.set(root.first_neighbour + k, {});
    parts.set(own, {});
    if (g == Vec3{}) return;
    Fan const fan{table, root, u, u[root.slot]};
    auto const before = [&](Index k) { return fan.before(k); };
    auto const after = [&](Index k) { return fan.after(k); };
    auto const add = [&](Index k, Vec3 const& of) {
      Index const at = root.first_neighbour + k;
      parts.set(at, parts[at] + of);
    };
    auto const add_face = [&](Index k, Vec3 const& of) {  // of after(k) x after(k + 1)
      add(k, cross(after(k + 1), of));
      add(k + 1, cross(of, after(k)));
    };
    Vec3 normal, moved;
    fan.for_faces([&](Index k, Vec3 const& face, double side) {
      normal += side * face;
      moved += side * cross(after(k), after(k + 1));
    });
    Vec3 of_turn = g;
    if (double const size = norm(moved); dot(root.line, root.line) > 0 && size > 0) {
      Vec3 const swing = turn_between(normal, moved), axis = (1 / size) * moved;
      Vec3 const free = turn_then(swing, twist_about(axis, swing, root.n_neighbours, before, after));
      auto const face_before = [&](Index k) { return cross(before(2 * k), before(2 * k + 1)); };
      auto const face_after = [&](Index k) { return cross(after(2 * k), after(2 * k + 1)); };
      double const share = share_that_keeps_height(root.line, free, root.n_neighbours / 2, face_before, face_after);
      auto const kept =
          kept_height_gradient(root.line, free, root.n_neighbours / 2, face_before, face_after, dot(g, free));
      of_turn = share * g + kept.turn;
      if (kept.face >= 0) add_face(2 * kept.face, kept.moved);
    }
    Vec3 const of_moved = fan_turn_gradient(normal, moved, root.n_neighbours, before, after, of_turn, add);
    fan.for_faces([&](Index k, Vec3 const&, double side) { add_face(k, side * of_moved); });
    Vec3 of_own;
    for (Index k = 0; k < root.n_neighbours; ++k) of_own = of_own - parts[root.first_neighbour + k];
    parts.set(own, of_own);
  }

 private:
  /// The arms of a root before and after.
  struct Fan {
    RootTable<MemorySpace> const& table;
    Root const& root;
    Field<double const> const& u;
    Vec3 here;

    KOKKOS_INLINE_FUNCTION Vec3 before(Index k) const { return table.neighbours(root.first_neighbour + k).arm; }
    KOKKOS_INLINE_FUNCTION Vec3 after(Index k) const {
      RootNeighbour const& other = table.neighbours(root.first_neighbour + k);
      return other.arm + (table.in_frame(other.matrix, u[other.slot]) - here);
    }
    /// visit(k, face before, 1 or -1), the sign as RawRootTurn counts faces that lie on one another.
    template <class Visit>
    KOKKOS_INLINE_FUNCTION void for_faces(Visit const& visit) const {
      Vec3 normal;
      double area = 0;
      for (Index k = 0; k < root.n_neighbours; k += 2) {
        Vec3 const face = cross(before(k), before(k + 1));
        normal += face;
        area += norm(face);
      }
      bool const folded = !(norm(normal) > folded_walls * area);
      normal = {};
      for (Index k = 0; k < root.n_neighbours; k += 2) {
        Vec3 const face = cross(before(k), before(k + 1));
        double const side = folded && dot(face, normal) < 0 ? -1 : 1;
        normal += side * face;
        visit(k, face, side);
      }
    }
  };
};

/// End wall e by the displacement of a slot (raw == false), or by the rotation of a root.
template <class MemorySpace, bool by_raw>
struct EndWallTurnBy {
  EndWallTurn<MemorySpace, DualVec3> turn;
  Field<double const> u, raw;
  Field<double const> at_end;  ///< gradients, 3 per end wall
  KOKKOS_INLINE_FUNCTION double operator()(Index e, Index target, Vec3 const& direction) const {
    auto const found = turn.at(e, SeededVectors{u, by_raw ? -1 : target, direction},
                               SeededVectors{raw, by_raw ? target : -1, direction});
    return dot(found.alpha.rate, at_end[3 * e]) + dot(found.before.rate, at_end[3 * e + 1]) +
           dot(found.after.rate, at_end[3 * e + 2]);
  }
};

/// Transpose of NearFieldTurn: raw(r) is added to; what end walls are handed is left in `parts`, four vectors per root in the frame of its
/// slot: of alpha and of the normal after, end by end.
template <class MemorySpace>
struct NearFieldTurnBack {
  RootTable<MemorySpace> table;
  Field<double const> raw_turn;
  EndWallVectors<Field<double const>> at_end;
  Field<double const> inner, outer;  ///< gradients, per slot and root
  Field<double> raw, parts;

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    for (Index k = 0; k < 4; ++k) parts.set(4 * r + k, {});
    Root const& root = table.roots(r);
    if (root.stands == 0) return;
    RootEnds const& ends = table.ends(r);
    Vec3 const own = raw_turn[r];
    Vec3 correction, of_own, of_correction;
    for (RootEnd const& end : ends.end)
      if (end.end >= 0 && end.share > 0)
        correction = correction + end.share * table.in_frame(end.to_root, at_end.alpha(end.end));
    Vec3 const of_outer = root.turn * outer[r];
    bool const has_section = runs_between_surfaces(ends);
    add_turn_then(own, correction, has_section ? inner[root.slot] : inner[root.slot] + of_outer, of_own, of_correction);
    for (int m = 0; m < 2; ++m)
      if (ends.end[m].end >= 0 && ends.end[m].share > 0) parts.set(4 * r + 2 * m, ends.end[m].share * of_correction);
    if (has_section) add_section(r, ends, own, of_outer, of_own);
    raw.set(r, raw[r] + of_own);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool runs_between_surfaces(RootEnds const& ends) const {
    return ends.fraction >= 0 && table.end_walls(ends.end[0].end).surface >= 0 &&
           table.end_walls(ends.end[1].end).surface >= 0;
  }
  KOKKOS_INLINE_FUNCTION void add_section(Index r, RootEnds const& ends, Vec3 const& own, Vec3 const& g,
                                          Vec3& of_own) const {
    Vec3 before, after;
    double share[2];
    for (int m = 0; m < 2; ++m) {
      Vec3 const n = table.in_frame(ends.end[m].to_root, at_end.normal(ends.end[m].end));
      share[m] = m == 0 ? 1 - ends.fraction : ends.fraction;
      if (m == 1 && dot(n, before) < 0) share[m] = -share[m];
      before += share[m] * n;
      after += share[m] * table.in_frame(ends.end[m].to_root, at_end.moved(ends.end[m].end));
    }
    Vec3 const carried = before + turned_by(own, before);
    Vec3 of_swing;
    add_turn_then(own, turn_between(carried, after), g, of_own, of_swing);
    // The other way round it is the same rotation backwards.
    of_own += turned_by_gradient(own, before, turn_between_gradient(after, carried, -of_swing));
    Vec3 const of_after = turn_between_gradient(carried, after, of_swing);
    for (int m = 0; m < 2; ++m) parts.set(4 * r + 2 * m + 1, share[m] * of_after);
  }
};

/// Transpose of TurnNearField, root by root: the rotations that lines of the near field begin and end with, and what keeps their heights.
template <class MemorySpace>
struct NearFieldLinesBack {
  Dependents<MemorySpace> lines_of_root;
  TurnNearField<MemorySpace, Vec3> turn;
  Field<double const> turns;  ///< gradients of rotations of ends
  TurnedEndGradients turned;
  Field<double> inner, raw, outer;  ///< gradients, added to

  [[nodiscard]] Index size() const { return Index(lines_of_root.target.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const r = lines_of_root.target(n), slot = turn.table.roots(r).slot;
    Vec3 of_inner = inner[slot], of_raw = raw[r], of_outer = outer[r];
    for (Index k = lines_of_root.first(n); k < lines_of_root.first(n + 1); ++k)
      add(turn.lines(lines_of_root.dependent(k)), of_inner, of_raw, of_outer);
    inner.set(slot, of_inner);
    raw.set(r, of_raw);
    outer.set(r, of_outer);
  }

 private:
  KOKKOS_INLINE_FUNCTION void add(NearFieldLine const& line, Vec3& of_inner, Vec3& of_raw, Vec3& of_outer) const {
    auto const found = turn.at(line, turn.inner, turn.raw, turn.outer);
    TurnedGradient wall = turned[line.lower], edge = turned[line.upper];
    auto const first = Quaternion<Vec3>::between(found.upper.q, found.lower.q, line.f0);
    Vec3 const rotation = turn.table.in_frame(line.matrix, turn.raw[line.root]);
    Vec3 const normal = line.normal + turned_by(rotation, line.normal), moved = first.turned(line.edge);
    double const height = dot(normal, line.edge + moved);
    if (turn.keeps_height(line, height)) {
      double const of_missing = wall.stretch / (line.f0 * height);
      double const of_height = -wall.stretch * found.lower.stretch / height;
      Vec3 const of_normal = of_height * (line.edge + moved) + (-of_missing) * moved;
      of_raw += turn.table.back(line.matrix,
                                turned_by_gradient(rotation, line.normal, of_normal + (-of_missing) * line.edge));
      TurnedGradient const of_first = turned_gradient(first, line.edge, (of_height - of_missing) * normal);
      wall.add(line.f0, of_first);
      edge.add(1 - line.f0, of_first);
    }
    // The other sign of the edge's quaternion, where that is nearer to the wall's.
    if (turn.edge_is_turned_round(found)) edge = {-edge.imaginary, -edge.less, 0};
    of_inner += turn.table.back(line.matrix, turns[line.lower] + rotation_gradient(found.in, wall));
    of_outer += turn.table.back(line.matrix, turns[line.upper] + rotation_gradient(found.out, edge));
  }
};

/// Gradients of line ends that have been handed on, or are about to be added to.
struct ClearEndGradients {
  Field<double> turns;
  TurnedEndGradients turned;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    turns.set(n, {});
    turned.set(n, {});
  }
};
/// The same for ends of the lines of the near field alone.
template <class MemorySpace>
struct ClearLineGradients {
  Kokkos::View<NearFieldLine const*, MemorySpace> lines;
  ClearEndGradients clear;
  [[nodiscard]] Index size() const { return Index(lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    clear(lines(n).lower);
    clear(lines(n).upper);
  }
};

}  // namespace gridmorph::kernels
