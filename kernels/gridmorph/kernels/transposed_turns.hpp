// Gradients through rotations of line ends: the transposes of turned_line.hpp, turned_ends.hpp and root_turn.hpp,
// linearised where the walls are.
//
// The rotation of a wall node hands its gradient to its neighbours, and lines of the near field and end walls theirs to
// the rotations that they depend on; what end walls make of slip surfaces is taken by exact rates (dual.hpp) along the
// three axes of what it depends on. Every sum is made by one work item in one order.
//
// Cost: about 100 flops per node and end that turns; per wall node about twice its rotation.
#pragma once

#include <gridmorph/kernels/transposed_turned_row.hpp>
#include <gridmorph/kernels/transposed_wall_turn.hpp>
#include <gridmorph/kernels/turned_ends.hpp>

namespace gridmorph::kernels {

/// Adds to the gradients of the two ends those of what turned_between() gives a node at x, whose gradient is g.
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

/// Which targets depend on which vectors: the dependents of target n are those from first(n) on.
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

/// gradient(target) += sum of of(dependent, target) over what depends on it: gradients by way of one dependent. One
/// item per target.
template <class MemorySpace, class Function>
struct PullBack {
  Dependents<MemorySpace> on;
  Function of;
  Field<double> gradient;

  [[nodiscard]] Index size() const { return Index(on.target.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const target = on.target(n);
    Vec3 sum = gradient[target];
    for (Index m = on.first(n); m < on.first(n + 1); ++m) sum += of(on.dependent(m), target);
    gradient.set(target, sum);
  }
};
template <class Exec, class Function>
void pull_back(char const* label, Exec const& exec, Dependents<typename Exec::memory_space> const& on,
               Function const& of, Field<double> const& gradient) {
  launch(label, exec, PullBack<typename Exec::memory_space, Function>{on, of, gradient});
}

/// Transpose of FreeRootTurn and RawRootTurn: gradients of the displacements of a root's neighbours, at their places in
/// the table in the frame of the root's slot, and after those of all roots that of its centre.
template <class MemorySpace>
struct RawRootTurnBack {
  RootTable<MemorySpace> table;
  Field<double const> u, raw;  ///< displacements; gradients
  Field<double const> mean;    ///< rotations of bodies
  Field<double> parts;

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Root const& root = table.roots(r);
    Vec3 const g = raw[r];
    Index const own = Index(table.neighbours.extent(0)) + r;
    if (g == Vec3{}) return clear(root, own);
    Fan const fan{table, root, u, u[root.centre]};
    ArmWeights const weight(root.n_neighbours, [&](Index k) { return table.neighbours(root.first_neighbour + k).arm; });
    FanMoments sums;
    Vec3 normal, moved;
    double area = 0;
    fan.for_faces(false, [&](Arms const& face, double, Index) {
      Vec3 const before = cross(face.before[0], face.before[1]);
      area += norm(before);
      normal += before;
      for (int m = 0; m < 2; ++m) sums.add(weight(face.before[m]), face.before[m], face.after[m]);
    });
    double const sharp = sharpness(normal, area);
    bool const folded = !(norm(normal) > folded_walls * area);
    normal = {};
    fan.for_faces(folded, [&](Arms const& face, double side, Index) {
      Vec3 const before = cross(face.before[0], face.before[1]);
      normal += side * before;
      moved += side * counted(sharp, before, cross(face.after[0], face.after[1]));
    });
    if (!(norm(moved) > 0)) return clear(root, own);
    FanTurn const turn(normal, moved, sums);
    KeptHeightGradient kept;
    FanTurn::Gradient const of = turn.gradient(of_free_turn(root, fan, turn.rotation(), g, kept));
    Vec3 sum;
    fan.for_faces(folded, [&](Arms const& face, double side, Index k) {
      Vec3 const before = cross(face.before[0], face.before[1]), after = cross(face.after[0], face.after[1]),
                 of_counted = side * of.moved;
      Vec3 of_face = of_counted;
      if (sharp > 0) of_face += sharp * (as_long_as_gradient(before, after, of_counted) - of_counted);
      if (k == 2 * kept.face) of_face += kept.moved;
      Vec3 const first = of.twist.after(weight(face.before[0]) * face.before[0]) + cross(face.after[1], of_face);
      Vec3 const next = of.twist.after(weight(face.before[1]) * face.before[1]) + cross(of_face, face.after[0]);
      parts.set(root.first_neighbour + k, first);
      parts.set(root.first_neighbour + k + 1, next);
      sum = sum - first - next;
    });
    parts.set(own, sum);
  }

 private:
  /// The arms of a face of the wall, to two neighbours of its root.
  struct Arms {
    Vec3 before[2], after[2];
  };
  struct Fan {
    RootTable<MemorySpace> const& table;
    Root const& root;
    Field<double const> const& u;
    Vec3 here;

    KOKKOS_INLINE_FUNCTION Arms face(Index k) const {
      RootNeighbour const &a = table.neighbours(root.first_neighbour + k),
                          &b = table.neighbours(root.first_neighbour + k + 1);
      return {{a.arm, b.arm}, {after(a), after(b)}};
    }
    [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 after(RootNeighbour const& other) const {
      return other.arm + (table.in_frame(other.matrix, u[other.slot]) - here);
    }
    /// visit(its arms, 1 or -1, k), the sign as RawRootTurn counts faces.
    template <class Visit>
    KOKKOS_INLINE_FUNCTION void for_faces(bool folded, Visit const& visit) const {
      Vec3 normal;
      for (Index k = 0; k < root.n_neighbours; k += 2) {
        Arms const arms = face(k);
        double side = 1;
        if (folded) {
          Vec3 const n = cross(arms.before[0], arms.before[1]);
          side = dot(n, normal) < 0 ? -1 : 1;
          normal += side * n;
        }
        visit(arms, side, k);
      }
    }
  };

  KOKKOS_INLINE_FUNCTION void clear(Root const& root, Index own) const {
    for (Index k = 0; k < root.n_neighbours; ++k) parts.set(root.first_neighbour + k, {});
    parts.set(own, {});
  }
  KOKKOS_INLINE_FUNCTION Vec3 of_free_turn(Root const& root, Fan const& fan, Vec3 const& free, Vec3 const& g,
                                           KeptHeightGradient& kept) const {
    if (root.body < 0) return through_line(root, fan, free, g, kept);
    Vec3 const to = mean[root.body];
    return way_near_gradient(free, to, through_line(root, fan, way_near(free, to), g, kept));
  }
  /// The gradient of the turn before the line at an edge of the wall held it back; `kept`: that of the face that did.
  KOKKOS_INLINE_FUNCTION static Vec3 through_line(Root const& root, Fan const& fan, Vec3 const& turn, Vec3 const& g,
                                                  KeptHeightGradient& kept) {
    if (!(dot(root.line, root.line) > 0)) return g;
    auto const face_before = [&](Index k) {
      Arms const face = fan.face(2 * k);
      return cross(face.before[0], face.before[1]);
    };
    auto const face_after = [&](Index k) {
      Arms const face = fan.face(2 * k);
      return cross(face.after[0], face.after[1]);
    };
    Index const n_faces = root.n_neighbours / 2;
    double const share = share_that_keeps_height(root.line, turn, n_faces, face_before, face_after);
    double const square = dot(turn, turn), held = held_back(square), along = dot(g, turn);
    kept = kept_height_gradient(root.line, turn, n_faces, face_before, face_after, held * along);
    return (1 - held * (1 - share)) * g + kept.turn + (-2 * held_back_slope(square) * (1 - share) * along) * turn;
  }
};

/// End wall e by the displacement of a slot (raw == false), or by the rotation of a root.
template <class MemorySpace, bool by_raw>
struct EndWallTurnBy {
  EndWallTurn<MemorySpace, DualVec3> turn;
  Field<double const> u, raw;
  Field<double const> at_end;  ///< gradients, 3 per end wall
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index e, Index target) const {
    return {along(e, target, {1, 0, 0}), along(e, target, {0, 1, 0}), along(e, target, {0, 0, 1})};
  }

 private:
  KOKKOS_INLINE_FUNCTION double along(Index e, Index target, Vec3 const& direction) const {
    auto const found = turn.at(e, SeededVectors{u, by_raw ? -1 : target, direction},
                               SeededVectors{raw, by_raw ? target : -1, direction});
    return dot(found.alpha.rate, at_end[3 * e]) + dot(found.before.rate, at_end[3 * e + 1]) +
           dot(found.after.rate, at_end[3 * e + 2]);
  }
};

/// Transpose of NearFieldTurn: raw(r) is added to; what end walls are handed is left in `parts`, four vectors per root
/// in the frame of its slot: of alpha and of the normal after, end by end.
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
    bool corrected = false;
    for (RootEnd const& end : ends.end)
      if (end.end >= 0 && end.share > 0) {
        correction = correction + end.share * table.in_frame(end.to_root, at_end.alpha(end.end));
        corrected = true;
      }
    Vec3 const of_outer = root.turn * outer[r];
    bool const has_section = runs_between_surfaces(ends);
    Vec3 const of_inner = has_section ? inner[root.slot] : inner[root.slot] + of_outer;
    if (corrected)
      add_turn_on(own, correction, of_inner, of_own, of_correction);
    else
      of_own = of_inner;
    for (int m = 0; m < 2; ++m)
      if (ends.end[m].end >= 0 && ends.end[m].share > 0) parts.set(4 * r + 2 * m, ends.end[m].share * of_correction);
    if (has_section && root.turn != 0) add_section(r, ends, own, of_outer, of_own);
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
    add_turn_on(own, turn_between(carried, after), g, of_own, of_swing);
    // The other way round it is the same rotation backwards.
    of_own += turned_by_gradient(own, before, turn_between_gradient(after, carried, -of_swing));
    Vec3 const of_after = turn_between_gradient(carried, after, of_swing);
    for (int m = 0; m < 2; ++m) parts.set(4 * r + 2 * m + 1, share[m] * of_after);
  }
};

/// Transpose of TurnNearField, root by root: the rotations that lines of the near field begin and end with, and what
/// keeps their heights.
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
/// Clears the gradients of the ends of the near field's lines alone.
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
