// Numbers and vectors with their rates of change (dual numbers, forward differentiation): a kernel that is written for
// a type V of vectors gives its values for V = Vec3 and, from the same source, values and exact rates for V = DualVec3.
//
//   (a + a' e)(b + b' e) = a b + (a' b + a b') e,   f(a + a' e) = f(a) + f'(a) a' e
//
// Values are rounded as those of double and Vec3 are. A root or a norm of zero has the rate zero: formulas that divide
// by one look first.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph::kernels {

struct Dual {
  double value = 0, rate = 0;
};

KOKKOS_INLINE_FUNCTION Dual operator+(Dual const& a, Dual const& b) { return {a.value + b.value, a.rate + b.rate}; }
KOKKOS_INLINE_FUNCTION Dual operator-(Dual const& a, Dual const& b) { return {a.value - b.value, a.rate - b.rate}; }
KOKKOS_INLINE_FUNCTION Dual operator-(Dual const& a) { return {-a.value, -a.rate}; }
KOKKOS_INLINE_FUNCTION Dual operator*(Dual const& a, Dual const& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate};
}
KOKKOS_INLINE_FUNCTION Dual operator*(double a, Dual const& b) { return {a * b.value, a * b.rate}; }
KOKKOS_INLINE_FUNCTION Dual operator/(Dual const& a, Dual const& b) {
  double const q = a.value / b.value;
  return {q, (a.rate - q * b.rate) / b.value};
}
KOKKOS_INLINE_FUNCTION Dual operator/(double a, Dual const& b) { return Dual{a} / b; }
KOKKOS_INLINE_FUNCTION double value_of(double a) { return a; }
KOKKOS_INLINE_FUNCTION double value_of(Dual const& a) { return a.value; }
KOKKOS_INLINE_FUNCTION bool operator>(Dual const& a, double b) { return a.value > b; }
KOKKOS_INLINE_FUNCTION bool operator<(Dual const& a, double b) { return a.value < b; }
KOKKOS_INLINE_FUNCTION Dual sqrt(Dual const& a) {
  using std::sqrt;
  double const root = sqrt(a.value);
  return {root, root > 0 ? a.rate / (2 * root) : 0};
}

struct DualVec3 {
  Vec3 value{}, rate{};
};

KOKKOS_INLINE_FUNCTION Vec3 value_of(Vec3 const& v) { return v; }
KOKKOS_INLINE_FUNCTION Vec3 value_of(DualVec3 const& v) { return v.value; }

/// What a kernel writes of a V: its rate, where it has one.
KOKKOS_INLINE_FUNCTION Vec3 written(Vec3 const& v) { return v; }
KOKKOS_INLINE_FUNCTION Vec3 written(DualVec3 const& v) { return v.rate; }

KOKKOS_INLINE_FUNCTION DualVec3 operator+(DualVec3 const& a, DualVec3 const& b) {
  return {a.value + b.value, a.rate + b.rate};
}
KOKKOS_INLINE_FUNCTION DualVec3 operator-(DualVec3 const& a, DualVec3 const& b) {
  return {a.value - b.value, a.rate - b.rate};
}
KOKKOS_INLINE_FUNCTION DualVec3 operator-(DualVec3 const& a) { return {-a.value, -a.rate}; }
KOKKOS_INLINE_FUNCTION DualVec3 operator*(Dual const& s, DualVec3 const& a) {
  return {s.value * a.value, s.rate * a.value + s.value * a.rate};
}
KOKKOS_INLINE_FUNCTION DualVec3 operator*(double s, DualVec3 const& a) { return {s * a.value, s * a.rate}; }
KOKKOS_INLINE_FUNCTION Dual dot(DualVec3 const& a, DualVec3 const& b) {
  return {dot(a.value, b.value), dot(a.rate, b.value) + dot(a.value, b.rate)};
}
KOKKOS_INLINE_FUNCTION DualVec3 cross(DualVec3 const& a, DualVec3 const& b) {
  return {cross(a.value, b.value), cross(a.rate, b.value) + cross(a.value, b.rate)};
}
KOKKOS_INLINE_FUNCTION Dual norm(DualVec3 const& a) {
  double const n = norm(a.value);
  return {n, n > 0 ? dot(a.value, a.rate) / n : 0};
}

}  // namespace gridmorph::kernels
