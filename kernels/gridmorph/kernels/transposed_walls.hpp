// Transposes of how walls of elements turn and what stands on them: wall_turn.hpp, column_motion.hpp,
// layer_motion.hpp's seeds; and of bodies that turn as wholes: body_turn.hpp. Rotations are linearised where the walls
// are.
//
// Cost: per column node as forwards; per wall node twice its rotation; per node and body that turns about
// 150 flops, 16 bytes of shares, 48 read.
#pragma once

#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/column_motion.hpp>
#include <gridmorph/kernels/rotation_gradient.hpp>
#include <gridmorph/kernels/transposed_rows.hpp>
#include <gridmorph/kernels/transposed_wall_turn.hpp>

namespace gridmorph::kernels {

/// Gradients of the rotation and the displacement of each wall node, from its columns and the motion around it.
template <class MemorySpace>
struct WallBack {
  ColumnTable<MemorySpace> columns;
  ColumnsOf<MemorySpace> of;
  Kokkos::View<std::int32_t const*, MemorySpace> wall;
  Vec3 const* turn;
  Field<double const> x;
  AffineMotion const* frame;
  Vec3 *u, *turn_gradient;

  [[nodiscard]] Index size() const { return Index(wall.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const w = wall(r);
    Vec3 of_turn, of_wall = u[w] + frame[r].u;
    for (int j = 0; j < 3; ++j) of_turn += turned_by_gradient(turn[r], unit_vector(j), column_of(frame[r].gradient, j));
    for (Index k = of.first(r); k < of.first(r + 1); ++k) {
      Index const c = of.column(k), n = columns.node(c);
      double const share = columns.share(c);
      of_wall += u[n];
      of_turn += share * turned_by_gradient(share * turn[r], x[n] - x[w], u[n]);
    }
    u[w] = of_wall;
    turn_gradient[r] = of_turn;
  }
};

/// Transpose of SeedMotions: places of walls and of columns, to the motion around each wall node and the columns'
/// displacement.
template <class MemorySpace>
struct SeedMotionsBack {
  ColumnTable<MemorySpace> columns;
  ColumnsOf<MemorySpace> of;
  Index n_walls;
  AffineMotion const* motion;  ///< gradients, of places
  AffineMotion* frame;
  Vec3* u;

  [[nodiscard]] Index size() const { return n_walls; }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    AffineMotion sum = frame[r] + motion[r];
    for (Index k = of.first(r); k < of.first(r + 1); ++k) {
      Index const c = of.column(k);
      AffineMotion const& g = motion[n_walls + c];
      u[columns.node(c)] += g.u;
      sum += double(columns.share(c)) * AffineMotion{{}, g.gradient};
    }
    frame[r] = sum;
  }
};

/// Transpose of WallTurn: gradients of the displacements of the nodes around each wall node, at their places in
/// WallTable::around, and after them all those of the wall nodes themselves.
template <class MemorySpace>
struct WallTurnBack {
  WallTable<MemorySpace> wall;
  Field<double const> x;
  Vec3 const *u, *turn_gradient;
  Vec3* parts;

  [[nodiscard]] Index size() const { return Index(wall.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const first = wall.first(r), n = wall.first(r + 1) - first, own = Index(wall.around.extent(0)) + r;
    for (Index k = first; k < first + n; ++k) parts[k] = {};
    parts[own] = {};
    Vec3 const g = turn_gradient[r];
    if (wall.turns(r) == 0 || g == Vec3{}) return;
    Index const here = wall.node(r);
    Vec3 const x_here = x[here], y_here = x_here + u[here];
    auto const before = [&](Index k) { return x[wall.around(first + k)] - x_here; };
    auto const after = [&](Index k) {
      Index const there = wall.around(first + k);
      return (x[there] + u[there]) - y_here;
    };
    auto const face_of = [&](Vec3 const& a, Vec3 const& b) {
      return wall.flat ? cross(b - a, wall.across) : cross(a, b);
    };
    auto const face_before = [&](Index f) { return face_of(before(2 * f), before(2 * f + 1)); };
    auto const face_after = [&](Index f) { return face_of(after(2 * f), after(2 * f + 1)); };
    Vec3 normal, moved;
    FanMoments sums;
    for (Index k = 0; k < n; k += 2) {
      Vec3 const p[2] = {before(k), before(k + 1)}, q[2] = {after(k), after(k + 1)};
      Vec3 const face = face_of(p[0], p[1]);
      normal += face;
      moved += as_long_as(face, face_of(q[0], q[1]));
      if (wall.flat) continue;
      for (int m = 0; m < 2; ++m) sums.add(1, p[m], q[m]);
    }
    if (!(norm(moved) > 0)) return;
    KeptHeightGradient kept;
    Vec3 of_moved;
    TwistGradient of_arms;
    if (wall.flat) {
      Vec3 const turn = turn_between(normal, moved, wall.across);
      of_moved = turn_between_gradient(
          normal, moved,
          canonical_gradient(turn, through_lines(r, n / 2, canonical(turn), g, face_before, face_after, kept)));
    } else {
      FanTurn const turn(normal, moved, sums);
      auto const of = turn.gradient(through_lines(r, n / 2, turn.rotation(), g, face_before, face_after, kept));
      of_moved = of.moved;
      of_arms = of.twist;
    }
    Vec3 sum;
    for (Index k = 0; k < n; k += 2) {
      Vec3 of_face = as_long_as_gradient(face_before(k / 2), face_after(k / 2), of_moved);
      if (k == 2 * kept.face) of_face += kept.moved;
      Vec3 const across = cross(wall.across, of_face);
      Vec3 const first_arm = wall.flat ? -across : of_arms.after(before(k)) + cross(after(k + 1), of_face);
      Vec3 const next_arm = wall.flat ? across : of_arms.after(before(k + 1)) + cross(of_face, after(k));
      parts[first + k] = first_arm;
      parts[first + k + 1] = next_arm;
      sum = sum - first_arm - next_arm;
    }
    parts[own] = sum;
  }

 private:
  /// The gradient of the turn before the lines on the node held it back, through that line which did so most. `kept`:
  /// that of the face that decided.
  template <class Before, class After>
  KOKKOS_INLINE_FUNCTION Vec3 through_lines(Index r, Index n_faces, Vec3 const& turn, Vec3 const& g,
                                            Before const& before, After const& after, KeptHeightGradient& kept) const {
    if (wall.lines.extent(0) == 0) return g;
    double least = norm(turn), share = 1;
    Index holds = -1;
    for (Index k = wall.first_line(r); k < wall.first_line(r + 1); ++k) {
      double const left = share_that_keeps_height(wall.lines(k), turn, n_faces, before, after),
                   size = norm(left * turn);
      if (!(least - size > 0)) continue;
      least = size;
      share = left;
      holds = k;
    }
    if (holds < 0) return g;
    kept = kept_height_gradient(wall.lines(holds), turn, n_faces, before, after, dot(g, turn));
    return share * g + kept.turn;
  }
};

/// The gradient of the quaternion of half a body's rotation, of its stretch, and of its shift.
struct BodyGradient {
  Vec3 imaginary;
  double less = 0;
  Vec3 shift;
  StretchMap stretch;
  KOKKOS_INLINE_FUNCTION BodyGradient& operator+=(BodyGradient const& g) {
    imaginary += g.imaginary;
    less += g.less;
    shift += g.shift;
    stretch += g.stretch;
    return *this;
  }
};

/// Adds the gradient of `half` from that of BodyTurnField::turned() with a share f of it, g.
KOKKOS_INLINE_FUNCTION void add_body_turn(Quaternion<Vec3> const& half, double f, Vec3 const& y, Vec3 const& g,
                                          BodyGradient& to) {
  auto const h = Quaternion<Vec3>::share(half, f);
  TurnedGradient const of = turned_gradient(twice(h), y, g);
  to.imaginary += f * ((2 - 2 * h.less) * of.imaginary + (2 * of.less) * h.imaginary);
  to.less += f * ((2 - 2 * h.less) * of.less - 2 * dot(h.imaginary, of.imaginary));
}

/// Adds the gradients of body b's rotation and stretch from that of BodyTurnField::moved(), g.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION void add_body_move(BodyTurnField<MemorySpace, Vec3> const& field, Index b, double f,
                                          Vec3 const& y, Vec3 const& g, BodyGradient& to) {
  if (field.stretch == nullptr) {
    add_body_turn(field.half[b], f, y, g, to);
    return;
  }
  add_body_turn(field.half[b], f, y + f * (field.stretch[b] * y), g, to);
  to.stretch.add(f * (g + twice(Quaternion<Vec3>::share(field.half[b], f)).back().turned(g)), y);
}

/// Nodes of a part of a list, in chunks of so many.
constexpr Index body_chunk = 1024;
KOKKOS_INLINE_FUNCTION constexpr Index body_chunks(Index n) { return (n + body_chunk - 1) / body_chunk; }

/// What bodies give to nodes as wholes, handed back to them: parts, (chunks, bodies). node: empty for
/// all of them.
template <class MemorySpace>
struct BodyPartsOfNodes {
  BodyTurnField<MemorySpace, Vec3> field;
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Index n;
  double sign;
  Vec3 const* u;
  BodyGradient* parts;

  [[nodiscard]] Index size() const { return body_chunks(n); }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Index const n_bodies = Index(field.centre.extent(0)), n_nodes = Index(field.shift_share.extent(0)) / n_bodies;
    BodyGradient* const of = parts + c * n_bodies;
    for (Index b = 0; b < n_bodies; ++b) of[b] = {};
    Index const end = (c + 1) * body_chunk < n ? (c + 1) * body_chunk : n;
    for (Index k = c * body_chunk; k < end; ++k) {
      Index const at = node.extent(0) > 0 ? node(k) : k;
      Vec3 const g = sign * u[at];
      for (Index b = 0; b < n_bodies; ++b) {
        if (double const f = field.share(b * n_nodes + at); f != 0)
          add_body_move(field, b, f, field.x[at] - field.centre(b), g, of[b]);
        if (double const s = field.shift_share(b * n_nodes + at); s != 0) of[b].shift += s * g;
      }
      for (Index m = n_bodies; m < Index(field.images.extent(0)); ++m)
        if (double const f = field.share(m * n_nodes + at); f != 0) {
          BodyImage const& image = field.images(m);
          Mat3 const back = transpose(image.rotation);
          add_body_move(field, image.body, f, back * (field.x[at] - image.translation) - field.centre(image.body),
                        back * g, of[image.body]);
        }
    }
  }
};
/// What bodies take off the motions around wall nodes, handed back to them: transpose of TakeTurnsFromFrames.
template <class MemorySpace>
struct BodyPartsOfFrames {
  BodyTurnField<MemorySpace, Vec3> field;
  Index n_bodies;
  Kokkos::View<std::int32_t const*, MemorySpace> node, body;
  StretchedColumns<MemorySpace> columns;
  Vec3* u;
  AffineMotion* frame;
  BodyGradient* parts;

  [[nodiscard]] Index size() const { return body_chunks(Index(node.extent(0))); }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    BodyGradient* const of = parts + c * n_bodies;
    for (Index b = 0; b < n_bodies; ++b) of[b] = {};
    Index const n = Index(node.extent(0)), end = (c + 1) * body_chunk < n ? (c + 1) * body_chunk : n;
    for (Index r = c * body_chunk; r < end; ++r) {
      Index const b = body(r);
      if (b < 0) continue;
      u[node(r)] += frame[r].u;
      frame[r].u = {};
      if (columns.of.first.extent(0) > 0) columns_back(r, b, of[b]);
      for (int j = 0; j < 3; ++j)
        add_body_turn(field.half[b], 1, unit_vector(j), -column_of(frame[r].gradient, j), of[b]);
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION void columns_back(Index r, Index b, BodyGradient& of) const {
    double const q = columns.limits(b).share;
    AffineMotion motion = (1 - q) * frame[r];
    auto const back = twice(field.half[b]).back();
    for (Index k = columns.of.first(r); k < columns.of.first(r + 1); ++k) {
      Index const column = columns.of.column(k);
      Vec3 const h = columns.arm(column), g = u[columns.node(column)];
      add_body_turn(field.half[b], 1, field.stretch[b] * h, g, of);
      of.stretch.add(g + back.turned(g), h);
      double const arm[3] = {-q * h.x, -q * h.y, -q * h.z}, value[3] = {g.x, g.y, g.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) motion.gradient.m[i][j] += value[i] * arm[j];
    }
    frame[r] = motion;
  }
};
/// The sum of the parts of each body, which is an item.
struct BodySums {
  BodyGradient const* parts;
  Index n_chunks, n_bodies;
  BodyGradient* sum;  ///< += the parts
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    BodyGradient s = sum[b];
    for (Index c = 0; c < n_chunks; ++c) s += parts[c * n_bodies + b];
    sum[b] = s;
  }
};

/// Transpose of StretchBodies: gradients of how bodies stretch become those of N, and what they are of the rotation is
/// added to its own.
template <class MemorySpace>
struct StretchBodiesBack {
  BodyWalls<MemorySpace> walls;
  Quaternion<Vec3> const* half;
  StretchMap const* sum;
  BodyGradient* of;

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    StretchMap const n = stretch_moments(walls, b, sum);
    StretchLimits const& limits = walls.limits(b);
    auto const whole = twice(half[b]);
    BodyGradient to = of[b];
    // That of a trace is the transpose of what becomes of it: the same.
    if (limits.even) to.stretch = evened(in_plane(to.stretch, walls.axis(b)), {});
    for (int a = 0; a < 3; ++a) {
      Vec3 const g = limits.share * to.stretch.column[a];
      // g . R^T v is R g . v.
      add_body_turn(half[b], 1, g, column_of(limits.span, a) + n.column[a], to);
      to.stretch.column[a] = g + whole.turned(g);
    }
    to.stretch = in_plane(to.stretch, walls.axis(b));
    of[b] = to;
  }
};

/// Transpose of TurnBodies: gradients of the sums over walls.
template <class MemorySpace>
struct TurnBodiesBack {
  BodyWalls<MemorySpace> walls;
  VectorMoments const* sum;
  BodyGradient const* of;
  VectorMoments* moments;  ///< per body

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    VectorMoments s;
    for (int i = 0; i < 3; ++i) s.m[i][i] = 1;
    for (Index c = walls.first_chunk(b); c < walls.first_chunk(b + 1); ++c) s += sum[c];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        VectorMoments rate;
        rate.m[i][j] = 1;
        auto const q = quaternion_of_half(best_turn<DualVec3>(s, rate, walls.axis(b)));
        moments[b].m[i][j] = dot(q.imaginary.rate, of[b].imaginary) + q.less.rate * of[b].less;
      }
  }
};
/// Transposes of SumBodyWalls, SumBodyShifts and SumBodyStretches: to the motions around wall nodes, and listed as
/// `slot` is. Item: a chunk.
template <class MemorySpace>
struct BodyWallsBack {
  BodyWalls<MemorySpace> walls;
  VectorMoments const* moments;
  BodyGradient const* of;
  AffineMotion* frame;
  Vec3* listed;

  [[nodiscard]] Index size() const { return Index(walls.first.extent(0)) - 1; }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Index const n_bodies = Index(walls.axis.extent(0));
    Index b = 0;
    while (b < n_bodies && walls.first_chunk(b + 1) <= c) ++b;
    Vec3 shift;
    if (b < n_bodies)
      shift = of[b].shift;
    else
      for (Index m = 0; m < n_bodies; ++m) shift = shift - of[m].shift;
    for (Index k = walls.first(c); k < walls.first(c + 1); ++k) {
      listed[k] = walls.weight(k) * shift;
      if (b == n_bodies) continue;
      if (walls.lever.extent(0) > 0) listed[k] += of[b].stretch * walls.lever(k);
      Mat3& g = frame[walls.wall(k)].gradient;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) g.m[j][i] += walls.weight(k) * moments[b].m[i][j];
    }
  }
};

}  // namespace gridmorph::kernels
