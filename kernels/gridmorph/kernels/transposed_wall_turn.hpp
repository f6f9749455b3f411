// Gradients through the rotation that a fan of neighbours gives a wall node, written out: the transposes of rotation.hpp's formulas, of
// twist_about() (wall_turn.hpp) and of share_that_keeps_height() (kept_height.hpp). g is the gradient of what each gives; those of what it
// takes are returned or added.
//
// Cost: about twice the rotation itself.
#pragma once

#include <gridmorph/kernels/rotation_gradient.hpp>
#include <gridmorph/kernels/wall_turn.hpp>

namespace gridmorph::kernels {

/// Of settled(r), r before.
KOKKOS_INLINE_FUNCTION Vec3 settled_gradient(Vec3 const& r, Vec3 const& g) {
  double const square = dot(r, r);
  Vec3 const s = settled(r);
  if (s == r) return g;
  return (-1 / square) * g + (2 * dot(g, r) / (square * square)) * r;
}

/// Of `after` in turn_between(before, after).
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

/// Of both rotations in turn_then(first, next): added.
KOKKOS_INLINE_FUNCTION void add_turn_then(Vec3 const& first, Vec3 const& next, Vec3 const& g, Vec3& of_first,
                                          Vec3& of_next) {
  double const a = dot(first, first), b = dot(next, next), p = 1 - a, q = 1 - b;
  double real = p * q - 4 * dot(first, next);
  double const sign = real < 0 ? -1 : 1;
  real *= sign;
  Vec3 const imaginary = sign * ((2 * p) * next + (2 * q) * first + 4 * cross(next, first));
  double const size = (1 + a) * (1 + b) + real;
  Vec3 const r = (1 / size) * imaginary, of_r = settled_gradient(r, g);
  Vec3 const of_imaginary = (sign / size) * of_r;
  double const of_size = -dot(of_r, r) / size, of_real = sign * of_size;
  double const of_p = of_real * q + 2 * dot(of_imaginary, next), of_q = of_real * p + 2 * dot(of_imaginary, first);
  double const of_a = of_size * (1 + b) - of_p, of_b = of_size * (1 + a) - of_q;
  of_first += (2 * of_a) * first + (2 * q) * of_imaginary + (-4 * of_real) * next + 4 * cross(of_imaginary, next);
  of_next += (2 * of_b) * next + (2 * p) * of_imaginary + (-4 * of_real) * first + 4 * cross(first, of_imaginary);
}

/// Of v in v / |v|.
KOKKOS_INLINE_FUNCTION Vec3 unit_gradient(Vec3 const& v, Vec3 const& g) {
  double const size = norm(v);
  Vec3 const u = (1 / size) * v;
  return (1 / size) * (g - dot(g, u) * u);
}

/// Of axis, swing and arms after in twist_about(): the first two are added to; add(k, gradient of after(k)).
template <class Before, class After, class Add>
KOKKOS_INLINE_FUNCTION void add_twist(Vec3 const& axis, Vec3 const& swing, Index n, Before const& before,
                                      After const& after, Vec3 const& g, Vec3& of_axis, Vec3& of_swing,
                                      Add const& add) {
  double const x = axis.x < 0 ? -axis.x : axis.x, y = axis.y < 0 ? -axis.y : axis.y, z = axis.z < 0 ? -axis.z : axis.z;
  Vec3 const least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  Vec3 const across = least - dot(least, axis) * axis;
  Vec3 const t1 = (1 / norm(across)) * across, t2 = cross(axis, t1);
  double c11 = 0, c12 = 0, c22 = 0, b11 = 0, b12 = 0, b21 = 0, b22 = 0;
  auto const turned_arm = [&](Index k) {
    Vec3 const arm = before(k);
    return arm + turned_by(swing, arm);
  };
  for (Index k = 0; k < n; ++k) {
    Vec3 const p = turned_arm(k), q = after(k);
    double const p1 = dot(p, t1), p2 = dot(p, t2), q1 = dot(q, t1), q2 = dot(q, t2);
    c11 += p1 * p1;
    c12 += p1 * p2;
    c22 += p2 * p2;
    b11 += q1 * p1;
    b12 += q1 * p2;
    b21 += q2 * p1;
    b22 += q2 * p2;
  }
  double const size = c11 + c22;
  bool const on_a_line = !((c11 * c22 - c12 * c12 - 1e-12 * (size * size)) > 0);
  double const sine = on_a_line ? b21 - b12 : b21 * c22 - b22 * c12 - b12 * c11 + b11 * c12;
  double const cosine = on_a_line ? b11 + b22 : b11 * c22 - b12 * c12 + b22 * c11 - b21 * c12;
  double const whole = sine * sine + cosine * cosine;
  if (!(whole > 0)) return;
  double const twist = quarter_tangent(sine, cosine);
  of_axis += twist * g;
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
  Vec3 of_t1, of_t2;
  for (Index k = 0; k < n; ++k) {
    Vec3 const p = turned_arm(k), q = after(k);
    double const p1 = dot(p, t1), p2 = dot(p, t2), q1 = dot(q, t1), q2 = dot(q, t2);
    double const of_p1 = 2 * of_c11 * p1 + of_c12 * p2 + of_b11 * q1 + of_b21 * q2;
    double const of_p2 = 2 * of_c22 * p2 + of_c12 * p1 + of_b12 * q1 + of_b22 * q2;
    double const of_q1 = of_b11 * p1 + of_b12 * p2, of_q2 = of_b21 * p1 + of_b22 * p2;
    of_t1 += of_p1 * p + of_q1 * q;
    of_t2 += of_p2 * p + of_q2 * q;
    of_swing += turned_by_gradient(swing, before(k), of_p1 * t1 + of_p2 * t2);
    add(k, of_q1 * t1 + of_q2 * t2);
  }
  of_t1 += cross(of_t2, axis);
  Vec3 const of_across = unit_gradient(across, of_t1);
  of_axis += cross(t1, of_t2) - dot(least, axis) * of_across - dot(of_across, axis) * least;
}

/// Of the turn in share_that_keeps_height() and of the face that decides, where one does.
struct KeptHeightGradient {
  Vec3 turn, moved;
  Index face = -1;
};
/// g: of the share. before, after: as there.
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

/// Of swing and twist of a fan: of its normal `moved` (returned) and of its arms (added).
template <class Before, class After, class Add>
KOKKOS_INLINE_FUNCTION Vec3 fan_turn_gradient(Vec3 const& normal, Vec3 const& moved, Index n, Before const& before,
                                              After const& after, Vec3 const& g, Add const& add) {
  Vec3 const swing = turn_between(normal, moved);
  double const size = norm(moved);
  if (!(size > 0)) return {};
  Vec3 const axis = (1 / size) * moved;
  Vec3 of_swing, of_twist, of_axis;
  add_turn_then(swing, twist_about(axis, swing, n, before, after), g, of_swing, of_twist);
  add_twist(axis, swing, n, before, after, of_twist, of_axis, of_swing, add);
  return turn_between_gradient(normal, moved, of_swing) + unit_gradient(moved, of_axis);
}

}  // namespace gridmorph::kernels
