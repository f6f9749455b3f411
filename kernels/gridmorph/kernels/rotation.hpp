// Rotations without trigonometry. A rotation by the angle a about the unit vector k is the vector
//
//   r = k tan(a / 4)
//
// (modified Rodrigues parameters; H. Schaub, J. L. Junkins, J. Astronaut. Sci. 44 (1996) 1): zero for none, of length
// one for half a turn, which is one rotation with r and -r, and smooth between. -r / |r|^2 is the same rotation, a -
// 360 degrees the other way round: formulas give the shorter of the two, and where a body turns by about half a turn
// its rotations are all taken the way round that is nearer to their mean (way_near()), up to 240 degrees. So what lies
// between them and no rotation goes one way round the body. For small angles r is a quarter of axis times angle; a
// share f of it is f r, whose angle is f a to 2 degrees up to a right angle, to 16 up to half a turn. By square roots
// and quotients, which every machine rounds alike.
//
//   R y - y = (4 (1 - r.r) r x y + 8 r x (r x y)) / (1 + r.r)^2
//
// as a unit quaternion (cos(a / 2), k sin(a / 2)) = (1 - r.r, 2 r) / (1 + r.r). All formulas are written for V = Vec3,
// or V = DualVec3 for their exact rates (dual.hpp), also where nothing turns yet.
#pragma once

#include <gridmorph/kernels/dual.hpp>

#include <cmath>
#include <type_traits>

namespace gridmorph::kernels {

template <class V>
inline constexpr bool has_rate = std::is_same_v<V, DualVec3>;

/// A unit vector across v, which is not zero.
KOKKOS_INLINE_FUNCTION Vec3 across(Vec3 const& v) {
  bool const x_is_least = v.x * v.x <= v.y * v.y && v.x * v.x <= v.z * v.z;
  Vec3 const other = x_is_least ? Vec3{1, 0, 0} : v.y * v.y <= v.z * v.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  Vec3 const c = cross(v, other);
  return (1 / norm(c)) * c;
}

/// The smallest rotation that takes direction `before` to `after`; zero where either is zero and where they are the
/// same; about `half_turn_axis` (unit, across them), with no rate, where they are opposite to round-off.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_between(V const& before, V const& after, Vec3 const& half_turn_axis) {
  using std::sqrt;
  V const c = cross(before, after);
  auto const size = norm(before) * norm(after), square = dot(c, c), cosine = dot(before, after);
  if (!(size > 0)) return {};
  if (cosine < 0 && !((square - 1e-16 * (size * size)) > 0)) return V{half_turn_axis};
  // size times 1 + cos(a), and below 2 cos(a / 2) times that; 1 + cos(a) is sin(a)^2 / (1 - cos(a)).
  auto const real = cosine > 0 ? size + cosine : square / (size - cosine);
  return (1 / (real + sqrt(real * real + square))) * c;
}

/// The smallest rotation that takes direction `before` to `after`; about some axis across them where they are opposite.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_between(V const& before, V const& after) {
  Vec3 const v = value_of(before);
  return turn_between(before, after, dot(v, v) > 0 ? across(v) : Vec3{});
}

/// tan(a / 4) of the angle a with sine and cosine in the ratio of these two, from -1 to 1; 0 where both are.
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar quarter_tangent(Scalar const& sine, Scalar const& cosine) {
  using std::sqrt;
  auto const size = sqrt(sine * sine + cosine * cosine);
  if (!(size > 0)) return {};
  auto const real = cosine > 0 ? size + cosine : (sine * sine) / (size - cosine);
  auto const whole = real + sqrt(real * real + sine * sine);
  return whole > 0 ? sine / whole : Scalar{1};
}

/// What the rotation by r adds to y, R y - y: exactly zero where r is.
template <class V>
KOKKOS_INLINE_FUNCTION V turned_by(V const& r, V const& y) {
  using Scalar = std::decay_t<decltype(dot(r, r))>;
  auto const square = dot(r, r), whole = Scalar{1} + square;
  V const across = cross(r, y);
  return (4 / (whole * whole)) * ((Scalar{1} - square) * across + 2 * cross(r, across));
}

KOKKOS_INLINE_FUNCTION Vec3 unit_vector(int a) { return {a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0}; }
KOKKOS_INLINE_FUNCTION Vec3 column_of(Mat3 const& m, int j) { return {m.m[0][j], m.m[1][j], m.m[2][j]}; }

/// The matrix of a linear map Vec3 -> Vec3.
template <class Map>
KOKKOS_INLINE_FUNCTION Mat3 matrix_of_map(Map const& map) {
  Vec3 const x = map(Vec3{1, 0, 0}), y = map(Vec3{0, 1, 0}), z = map(Vec3{0, 0, 1});
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

/// The rotation r the other way round.
template <class V>
KOKKOS_INLINE_FUNCTION V other_way(V const& r) {
  return (1 / dot(r, r)) * -r;
}

/// |r|^2 of 120 degrees: rotations beyond that may go the longer way round.
inline constexpr double longer_ways = 1.0 / 3;

/// Rotation r the way round that is nearer to rotation `to`, if it is beyond 120 degrees: by the sign of the product of
/// their quaternions. As it is where neither is nearer, whatever round-off says.
template <class V>
KOKKOS_INLINE_FUNCTION V way_near(V const& r, Vec3 const& to) {
  Vec3 const v = value_of(r);
  double const a = dot(v, v), b = dot(to, to);
  return a > longer_ways && (1 - a) * (1 - b) + 4 * dot(v, to) < -1e-5 ? other_way(r) : r;
}

/// Neighbours that blend their half turns have to agree on one of r and -r, whatever round-off says of each: the
/// direction along which z, else y, else x rises.
template <class V>
KOKKOS_INLINE_FUNCTION V canonical(V const& r) {
  auto const square = dot(r, r);
  if (!(square > 1 - 3e-6)) return r;
  Vec3 const v = value_of(r);
  auto const counts = [](double c) { return c > 0.3 || c < -0.3; };
  double const along = counts(v.z) ? v.z : counts(v.y) ? v.y : v.x;
  return along < 0 ? other_way(r) : r;
}

/// First one rotation, then the other: the product of their quaternions, times `size`.
template <class V>
struct TurnProduct {
  using Scalar = std::decay_t<decltype(dot(V{}, V{}))>;
  V imaginary;
  Scalar real, size;

  KOKKOS_INLINE_FUNCTION TurnProduct(V const& first, V const& next) {
    auto const a = dot(first, first), b = dot(next, next);
    auto const p = Scalar{1} - a, q = Scalar{1} - b;
    real = p * q - 4 * dot(first, next);
    imaginary = (2 * p) * next + (2 * q) * first + 4 * cross(next, first);
    size = (Scalar{1} + a) * (Scalar{1} + b);
  }
  /// Turns the product the other way round, which is the same rotation.
  KOKKOS_INLINE_FUNCTION void turn_round() {
    real = -real;
    imaginary = -imaginary;
  }
  KOKKOS_INLINE_FUNCTION V rotation() const { return (1 / (size + real)) * imaginary; }
};

/// The rotation that is first one, then the other, the shorter way round; zero where both are.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_then(V const& first, V const& next) {
  TurnProduct<V> product(first, next);
  if (product.real < 0) product.turn_round();
  return canonical(product.rotation());
}

/// A rotation that is corrected keeps its way round if it is beyond 120 degrees, up to 270.
inline constexpr double longest_way = -0.70710678118654752;  // cos(135 degrees), of half the angle
KOKKOS_INLINE_FUNCTION bool keeps_its_way(Vec3 const& first) { return dot(first, first) > longer_ways; }
template <class V>
KOKKOS_INLINE_FUNCTION V turn_on(V const& first, V const& correction) {
  if (!keeps_its_way(value_of(first))) return turn_then(first, correction);
  TurnProduct<V> product(first, correction);
  if (value_of(product.real) < longest_way * value_of(product.size)) product.turn_round();
  return product.rotation();
}

/// A quaternion whose size does not matter; `less` is what its real part is less than one, exactly zero for no
/// rotation.
template <class V>
struct Quaternion {
  using Scalar = std::decay_t<decltype(dot(V{}, V{}))>;
  V imaginary{};
  Scalar less{};

  /// The quaternion at the share f of the way from b to a.
  KOKKOS_FORCEINLINE_FUNCTION static Quaternion between(Quaternion const& b, Quaternion const& a, double f) {
    return {b.imaginary + f * (a.imaginary - b.imaginary), b.less + f * (a.less - b.less)};
  }
  KOKKOS_FORCEINLINE_FUNCTION static Quaternion share(Quaternion const& a, double f) {
    return {f * a.imaginary, f * a.less};
  }
  /// The rotation the other way round.
  KOKKOS_FORCEINLINE_FUNCTION Quaternion back() const { return {-imaginary, less}; }
  /// What the rotation R adds to y: R y - y.
  KOKKOS_FORCEINLINE_FUNCTION V turned(V const& y) const {
    Scalar const real = Scalar{1} - less;
    V const across = cross(imaginary, y);
    return (2 / (real * real + dot(imaginary, imaginary))) * (real * across + cross(imaginary, across));
  }
};

/// The unit quaternion of a rotation.
template <class V>
KOKKOS_INLINE_FUNCTION Quaternion<V> quaternion_of(V const& r) {
  using Scalar = typename Quaternion<V>::Scalar;
  auto const square = dot(r, r), share = 2 / (Scalar{1} + square);
  return {share * r, share * square};
}

}  // namespace gridmorph::kernels
