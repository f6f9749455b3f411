// Gradients through the formulas of rotations (rotation.hpp): of quaternions and of rotations, from those of what they turn.
//
// What a displacement asks of the quaternion q = (1 - l, v) that turns an arm y: with A = v x y, B = (1 - l) A + v x A,
// N = (1 - l)^2 + v.v, c = 2 B / N and the gradient g of c,
//
//   G = 2 g / N,  n = -(g.c) / N,  a = (1 - l) G + G x v
//   dJ/dv = A x G + y x a + 2 n v,  dJ/dl = -(G.A + 2 (1 - l) n)
//
// Cost: about 100 flops.
#pragma once

#include <gridmorph/kernels/rotation.hpp>

namespace gridmorph::kernels {

/// Of a quaternion, and of the stretch of a line end (turned_line.hpp).
struct TurnedGradient {
  Vec3 imaginary;
  double less = 0, stretch = 0;

  KOKKOS_INLINE_FUNCTION void add(double f, TurnedGradient const& g) {
    imaginary += f * g.imaginary;
    less += f * g.less;
    stretch += f * g.stretch;
  }
};

/// Of q.turned(y), whose gradient is g.
KOKKOS_INLINE_FUNCTION TurnedGradient turned_gradient(Quaternion<Vec3> const& q, Vec3 const& y, Vec3 const& g) {
  Vec3 const& v = q.imaginary;
  double const real = 1 - q.less, size = real * real + dot(v, v);
  Vec3 const A = cross(v, y), c = (2 / size) * (real * A + cross(v, A));
  Vec3 const G = (2 / size) * g;
  double const n = -dot(g, c) / size;
  Vec3 const a = real * G + cross(G, v);
  return {cross(A, G) + cross(y, a) + (2 * n) * v, -(dot(G, A) + 2 * real * n), 0};
}

/// Of quaternion_of(r).
KOKKOS_INLINE_FUNCTION Vec3 rotation_gradient(Vec3 const& r, TurnedGradient const& g) {
  double const square = dot(r, r), share = 2 / (1 + square);
  double const of_share = dot(g.imaginary, r) + g.less * square;
  double const of_square = g.less * share - 0.5 * of_share * share * share;
  return share * g.imaginary + (2 * of_square) * r;
}

/// Of turned_by(r, y), whose gradient is g.
KOKKOS_INLINE_FUNCTION Vec3 turned_by_gradient(Vec3 const& r, Vec3 const& y, Vec3 const& g) {
  return rotation_gradient(r, turned_gradient(quaternion_of(r), y, g));
}
}  // namespace gridmorph::kernels
