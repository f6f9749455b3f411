// Gradients through the rotation that a fan of neighbours gives a wall node, written out: the transposes of
// rotation.hpp's formulas, of twist_about() (wall_turn.hpp) and of share_that_keeps_height() (kept_height.hpp). g is
// the gradient of what each gives; those of what it takes are returned or added.
//
// Cost: arms are read three times, 5, 50 and 40 flops each; 500 flops besides.
#pragma once

#include <gridmorph/kernels/rotation_gradient.hpp>
#include <gridmorph/kernels/wall_turn.hpp>

namespace gridmorph::kernels {

/// The gradient of r from that of other_way(r), g.
KOKKOS_INLINE_FUNCTION Vec3 other_way_gradient(Vec3 const& r, Vec3 const& g) {
  double const square = dot(r, r);
  return (-1 / square) * g + (2 * dot(g, r) / (square * square)) * r;
}
/// The gradient of r from that of canonical(r), or of way_near(r, to), g.
KOKKOS_INLINE_FUNCTION Vec3 canonical_gradient(Vec3 const& r, Vec3 const& g) {
  return canonical(r) == r ? g : other_way_gradient(r, g);
}
KOKKOS_INLINE_FUNCTION Vec3 way_near_gradient(Vec3 const& r, Vec3 const& to, Vec3 const& g) {
  return way_near(r, to) == r ? g : other_way_gradient(r, g);
}

/// The gradient of `after` from that of turn_between(before, after), g.
KOKKOS_INLINE_FUNCTION Vec3 turn_between_gradient(Vec3 const& before, Vec3 const& after, Vec3 const& g) {
  using std::sqrt;
  Vec3 const c = cross(before, after);
  double const length = norm(after), size = norm(before) * length, square = dot(c, c), cosine = dot(before, after);
  if (!(size > 0) || (cosine < 0 && !(square > 1e-16 * (size * size)))) return {};
  double const rest = size - cosine, real = cosine > 0 ? size + cosine : square / rest;
  double const root = sqrt(real * real + square), whole = real + root;
  double const of_whole = -dot(g, c) / (whole * whole), of_real = of_whole * (1 + real / root);
  double of_square = of_whole / (2 * root), of_size = of_real, of_cosine = of_real;
  if (!(cosine > 0)) {
    of_square += of_real / rest;
    of_size = -of_real * real / rest;
    of_cosine = -of_size;
  }
  Vec3 const of_c = (1 / whole) * g + (2 * of_square) * c;
  return (of_size * norm(before) / length) * after + of_cosine * before + cross(of_c, before);
}

/// Adds the gradients of both rotations in their product, which has been turned round if sign is -1, from that of the
/// rotation that it is.
KOKKOS_INLINE_FUNCTION void add_product(TurnProduct<Vec3> const& product, double sign, Vec3 const& first,
                                        Vec3 const& next, Vec3 const& of_r, Vec3& of_first, Vec3& of_next) {
  double const a = dot(first, first), b = dot(next, next), p = 1 - a, q = 1 - b, size = product.size + product.real;
  Vec3 const of_imaginary = (sign / size) * of_r;
  double const of_size = -dot(of_r, product.rotation()) / size, of_real = sign * of_size;
  double const of_p = of_real * q + 2 * dot(of_imaginary, next), of_q = of_real * p + 2 * dot(of_imaginary, first);
  double const of_a = of_size * (1 + b) - of_p, of_b = of_size * (1 + a) - of_q;
  of_first += (2 * of_a) * first + (2 * q) * of_imaginary + (-4 * of_real) * next + 4 * cross(of_imaginary, next);
  of_next += (2 * of_b) * next + (2 * p) * of_imaginary + (-4 * of_real) * first + 4 * cross(first, of_imaginary);
}
/// Adds the gradients of both rotations in turn_then(first, next).
KOKKOS_INLINE_FUNCTION void add_turn_then(Vec3 const& first, Vec3 const& next, Vec3 const& g, Vec3& of_first,
                                          Vec3& of_next) {
  TurnProduct<Vec3> product(first, next);
  bool const round = product.real < 0;
  if (round) product.turn_round();
  add_product(product, round ? -1 : 1, first, next, canonical_gradient(product.rotation(), g), of_first, of_next);
}
/// Adds the gradients of both rotations in turn_on(first, correction).
KOKKOS_INLINE_FUNCTION void add_turn_on(Vec3 const& first, Vec3 const& correction, Vec3 const& g, Vec3& of_first,
                                        Vec3& of_correction) {
  if (!keeps_its_way(first)) return add_turn_then(first, correction, g, of_first, of_correction);
  TurnProduct<Vec3> product(first, correction);
  bool const round = product.real < longest_way * product.size;
  if (round) product.turn_round();
  add_product(product, round ? -1 : 1, first, correction, g, of_first, of_correction);
}

/// The gradient of v from that of v / |v|, g.
KOKKOS_INLINE_FUNCTION Vec3 unit_gradient(Vec3 const& v, Vec3 const& g) {
  double const size = norm(v);
  Vec3 const u = (1 / size) * v;
  return (1 / size) * (g - dot(g, u) * u);
}

/// Sums over the arms p of a fan before and q after, with their weights w.
struct FanMoments {
  Mat3 before{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, after = before;  ///< of w p p^T and w q p^T

  KOKKOS_INLINE_FUNCTION void add(double w, Vec3 const& p, Vec3 const& q) {
    add_product(before, w, p, p);
    add_product(after, w, q, p);
  }

 private:
  KOKKOS_INLINE_FUNCTION static void add_product(Mat3& to, double w, Vec3 const& a, Vec3 const& b) {
    double const left[3] = {a.x, a.y, a.z}, right[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) to.m[i][j] += w * (left[i] * right[j]);
  }
};

/// The gradient of what twist_about() takes: of axis and swing, and of each arm after, linear in that before times its
/// weight.
struct TwistGradient {
  Vec3 axis, swing;
  Vec3 t1, t2, by1, by2;
  KOKKOS_INLINE_FUNCTION Vec3 after(Vec3 const& weighed) const {
    return dot(by1, weighed) * t1 + dot(by2, weighed) * t2;
  }
};

/// twist_about() of a fan and its gradients, from sums over the fan alone: with t1, t2 across the axis and T1, T2 the
/// same turned back by the swing, all that it sums up are components of the moments along these.
struct FanTwist {
  Vec3 axis, swing;
  FanMoments sums;

  KOKKOS_FORCEINLINE_FUNCTION FanTwist(Vec3 const& axis_, Vec3 const& swing_, FanMoments const& sums_)
      : axis(axis_), swing(swing_), sums(sums_) {
    double const x = axis.x < 0 ? -axis.x : axis.x, y = axis.y < 0 ? -axis.y : axis.y,
                 z = axis.z < 0 ? -axis.z : axis.z;
    least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    across = least - dot(least, axis) * axis;
    t1 = (1 / norm(across)) * across;
    t2 = cross(axis, t1);
    turn = quaternion_of(swing);
    Quaternion<Vec3> const back = turn.back();
    T1 = t1 + back.turned(t1);
    T2 = t2 + back.turned(t2);
    P1 = sums.before * T1;
    P2 = sums.before * T2;
    Q1 = sums.after * T1;
    Q2 = sums.after * T2;
    c11 = dot(T1, P1);
    c12 = dot(T1, P2);
    c22 = dot(T2, P2);
    b11 = dot(t1, Q1);
    b12 = dot(t1, Q2);
    b21 = dot(t2, Q1);
    b22 = dot(t2, Q2);
    double const size = c11 + c22;
    on_a_line = !((c11 * c22 - c12 * c12 - 1e-12 * (size * size)) > 0);
    sine = on_a_line ? b21 - b12 : b21 * c22 - b22 * c12 - b12 * c11 + b11 * c12;
    cosine = on_a_line ? b11 + b22 : b11 * c22 - b12 * c12 + b22 * c11 - b21 * c12;
    twist = quarter_tangent(sine, cosine);
  }

  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Vec3 rotation() const { return twist * axis; }
  /// The gradient of what the twist takes from that of rotation(), g.
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION TwistGradient gradient(Vec3 const& g) const {
    TwistGradient of;
    double const whole = sine * sine + cosine * cosine;
    if (!(whole > 0)) return of;
    double const of_angle = dot(g, axis) * (1 + twist * twist) / 4;
    double const of_sine = of_angle * cosine / whole, of_cosine = -of_angle * sine / whole;
    double of_c11 = 0, of_c12 = 0, of_c22 = 0, of_b11 = of_cosine, of_b12 = -of_sine, of_b21 = of_sine,
           of_b22 = of_cosine;
    if (!on_a_line) {
      of_c11 = -of_sine * b12 + of_cosine * b22;
      of_c22 = of_sine * b21 + of_cosine * b11;
      of_c12 = of_sine * (b11 - b22) - of_cosine * (b12 + b21);
      of_b11 = of_sine * c12 + of_cosine * c22;
      of_b12 = -of_sine * c11 - of_cosine * c12;
      of_b21 = of_sine * c22 - of_cosine * c12;
      of_b22 = -of_sine * c12 + of_cosine * c11;
    }
    Mat3 const back = transpose(sums.after);
    Vec3 const m1 = (2 * of_c11) * P1 + of_c12 * P2 + back * (of_b11 * t1 + of_b21 * t2);
    Vec3 const m2 = (2 * of_c22) * P2 + of_c12 * P1 + back * (of_b12 * t1 + of_b22 * t2);
    Vec3 const of_t2 = m2 + turn.turned(m2) + of_b21 * Q1 + of_b22 * Q2;
    Vec3 const of_t1 = m1 + turn.turned(m1) + of_b11 * Q1 + of_b12 * Q2 + cross(of_t2, axis);
    Vec3 const of_across = unit_gradient(across, of_t1);
    of.axis = twist * g + cross(t1, of_t2) - dot(least, axis) * of_across - dot(of_across, axis) * least;
    TurnedGradient of_turn = turned_gradient(turn, m1, t1);
    of_turn.add(1, turned_gradient(turn, m2, t2));
    of.swing = rotation_gradient(swing, of_turn);
    of.t1 = t1;
    of.t2 = t2;
    of.by1 = of_b11 * T1 + of_b12 * T2;
    of.by2 = of_b21 * T1 + of_b22 * T2;
    return of;
  }

 private:
  Quaternion<Vec3> turn;
  Vec3 least, across, t1, t2, T1, T2, P1, P2, Q1, Q2;
  double c11, c12, c22, b11, b12, b21, b22, sine, cosine, twist;
  bool on_a_line;
};

/// The gradient of the turn in share_that_keeps_height(), and of the face that decides, where one does.
struct KeptHeightGradient {
  Vec3 turn, moved;
  Index face = -1;
};
/// The gradient from that of the share, g. before, after: as in share_that_keeps_height().
template <class Before, class After>
KOKKOS_INLINE_FUNCTION KeptHeightGradient kept_height_gradient(Vec3 const& line, Vec3 const& turn, Index n_faces,
                                                               Before const& before, After const& after, double g) {
  Vec3 const change = turned_by(turn, line);
  KeptHeightGradient out;
  double share = 1, loss = 0;
  for (Index k = 0; k < n_faces; ++k) {
    Vec3 const face = before(k), moved = after(k);
    double const height = dot(face, line), size = norm(moved);
    if (!(height > 0.05 * norm(face) && size > 0)) continue;
    double const unit = norm(face) / (size * height), sine = height / norm(face), keep = 1.2 - 1.4 * sine * sine;
    double const lost = -unit * dot(moved, change), room = unit * dot(moved, line) - (keep < 0.99 ? keep : 0.99);
    if (!(lost - room > 0)) continue;
    if (!(room > 0)) {
      if (lost > 0) return {};  // nothing of the turn is left
      continue;
    }
    if (room / lost < share) {
      share = room / lost;
      loss = lost;
      out.face = k;
    }
  }
  if (out.face < 0) return out;
  Vec3 const face = before(out.face), moved = after(out.face);
  double const size = norm(moved), unit = norm(face) / (size * dot(face, line));
  double const of_room = g / loss, of_loss = -g * share / loss;
  double const along = dot(moved, line), gained = dot(moved, change);
  double const of_size = -(of_room * along - of_loss * gained) * unit / size;
  out.moved = (of_room * unit) * line + (-of_loss * unit) * change + (of_size / size) * moved;
  out.turn = turned_by_gradient(turn, line, (-of_loss * unit) * moved);
  return out;
}

/// Rotation of a fan, its swing from one normal to the other and its twist, and the gradients of what it takes.
class FanTurn {
 public:
  /// The turn of a fan whose normal goes from `normal` to `moved`, which is not zero.
  KOKKOS_FORCEINLINE_FUNCTION FanTurn(Vec3 const& normal, Vec3 const& moved, FanMoments const& sums)
      : normal_(normal), moved_(moved), twist_((1 / norm(moved)) * moved, turn_between(normal, moved), sums) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 rotation() const { return turn_then(twist_.swing, twist_.rotation()); }

  struct Gradient {
    Vec3 moved;           ///< of the normal after
    TwistGradient twist;  ///< of arms
  };
  /// The gradient of what the turn takes from that of rotation(), g.
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Gradient gradient(Vec3 const& g) const {
    Vec3 of_swing, of_twist;
    add_turn_then(twist_.swing, twist_.rotation(), g, of_swing, of_twist);
    Gradient of{{}, twist_.gradient(of_twist)};
    of.moved = turn_between_gradient(normal_, moved_, of_swing + of.twist.swing) + unit_gradient(moved_, of.twist.axis);
    return of;
  }

 private:
  Vec3 normal_, moved_;
  FanTwist twist_;
};

/// The gradient of the normal after from that of as_long_as(), g.
KOKKOS_INLINE_FUNCTION Vec3 as_long_as_gradient(Vec3 const& before, Vec3 const& after, Vec3 const& g) {
  double const square = dot(after, after);
  if (!(square > 0)) return {};
  return (norm(before) / norm(after)) * (g - (dot(after, g) / square) * after);
}

}  // namespace gridmorph::kernels
