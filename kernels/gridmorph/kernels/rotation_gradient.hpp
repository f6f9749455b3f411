// Gradients through the formulas of rotations (rotation.hpp): of quaternions and of rotations, from those of what they
// turn.
//
// Of what the quaternion q = (r, v), r = 1 - l, turns an arm y by, with the gradient g of it: N = r^2 + v.v, k = 2 / N,
//
//   J = g.(R y - y) = k (r v.(y x g) + (g.v)(v.y) - (v.v)(g.y))
//   dJ/dv = k (r y x g + (v.y) g + (g.v) y - (2 g.y + J) v),  dJ/dl = k (r J - v.(y x g))
//
// Cost: about 70 flops with one division.
#pragma once

#include <gridmorph/kernels/rotation.hpp>

namespace gridmorph::kernels {

/// The gradient of a quaternion, and of the stretch of a line end (turned_line.hpp).
struct TurnedGradient {
  Vec3 imaginary;
  double less = 0, stretch = 0;

  KOKKOS_INLINE_FUNCTION void add(double f, TurnedGradient const& g) {
    imaginary += f * g.imaginary;
    less += f * g.less;
    stretch += f * g.stretch;
  }
};

/// The gradient of q from that of q.turned(y), g, without a factor, which becomes `scale`; `along`: g . q.turned(y).
KOKKOS_FORCEINLINE_FUNCTION TurnedGradient turned_gradient(Quaternion<Vec3> const& q, Vec3 const& y, Vec3 const& g,
                                                           double& scale, double& along) {
  Vec3 const& v = q.imaginary;
  double const real = 1 - q.less, square = dot(v, v);
  scale = 2 / (real * real + square);
  Vec3 const across = cross(y, g);
  double const triple = dot(v, across), v_y = dot(v, y), v_g = dot(v, g), y_g = dot(y, g);
  along = scale * (real * triple + v_g * v_y - square * y_g);
  return {real * across + v_y * g + v_g * y + (-2 * y_g - along) * v, real * along - triple, 0};
}
KOKKOS_INLINE_FUNCTION TurnedGradient turned_gradient(Quaternion<Vec3> const& q, Vec3 const& y, Vec3 const& g) {
  double scale = 0, along = 0;
  TurnedGradient const of = turned_gradient(q, y, g, scale, along);
  return {scale * of.imaginary, scale * of.less, 0};
}

/// The gradient of r from that of quaternion_of(r), g.
KOKKOS_INLINE_FUNCTION Vec3 rotation_gradient(Vec3 const& r, TurnedGradient const& g) {
  double const square = dot(r, r), share = 2 / (1 + square);
  double const of_share = dot(g.imaginary, r) + g.less * square;
  double const of_square = g.less * share - 0.5 * of_share * share * share;
  return share * g.imaginary + (2 * of_square) * r;
}

/// The gradient of r from that of turned_by(r, y), g.
KOKKOS_INLINE_FUNCTION Vec3 turned_by_gradient(Vec3 const& r, Vec3 const& y, Vec3 const& g) {
  return rotation_gradient(r, turned_gradient(quaternion_of(r), y, g));
}
}  // namespace gridmorph::kernels
