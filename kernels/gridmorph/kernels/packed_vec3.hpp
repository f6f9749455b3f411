// Vectors in space in half a cache line each, and computed with as one where registers hold four doubles.
//
// Kernels that are templates on their type of vectors V compile for V = Vec3 and for V = WideVec3 from one source.
// Components are rounded as doubles are, whichever it is.
#pragma once

#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>
#include <type_traits>

namespace gridmorph::kernels {

/// A vector in half a cache line, for those that are read from all over an array: x, y and z come at once.
struct alignas(32) PackedVec3 {
  double x = 0, y = 0, z = 0;
  double nothing = 0;  ///< a number all the same, since it is computed with
};

inline namespace GRIDMORPH_ARITHMETIC {

/// Component by component: a / s; the smaller and the larger; what is left without its fraction, of components that an
/// std::int32_t holds.
KOKKOS_INLINE_FUNCTION Vec3 over(Vec3 const& a, double s) { return {a.x / s, a.y / s, a.z / s}; }
KOKKOS_INLINE_FUNCTION Vec3 smaller_parts(Vec3 const& a, Vec3 const& b) {
  return {smaller(a.x, b.x), smaller(a.y, b.y), smaller(a.z, b.z)};
}
KOKKOS_INLINE_FUNCTION Vec3 larger_parts(Vec3 const& a, Vec3 const& b) {
  return {larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)};
}
KOKKOS_INLINE_FUNCTION Vec3 whole_parts(Vec3 const& a) {
  auto const whole = [](double c) { return double(std::int32_t(c)); };
  return {whole(a.x), whole(a.y), whole(a.z)};
}

}  // namespace GRIDMORPH_ARITHMETIC

#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#define GRIDMORPH_WIDE_VECTORS 1
/// One register of four doubles; the last is a number that nobody asks for. Copies are constructed by a function, so
/// that calls are the same whichever instruction set a caller is compiled for.
class WideVec3 {
 public:
  using Four = Lanes<4>;

  WideVec3() : four_{} {}
  explicit WideVec3(Four const& four) : four_(four) {}
  explicit WideVec3(Vec3 const& v) : four_{v.x, v.y, v.z, 0} {}
  explicit WideVec3(PackedVec3 const& v) : four_(load_lanes<Four>(&v.x)) {}
  WideVec3(WideVec3 const& v) : four_(v.four_) {}
  WideVec3& operator=(WideVec3 const& v) {
    four_ = v.four_;
    return *this;
  }

  [[nodiscard]] Four const& four() const { return four_; }
  [[nodiscard]] double operator[](int axis) const { return four_[axis]; }

  WideVec3& operator+=(WideVec3 const& b) {
    four_ += b.four_;
    return *this;
  }

 private:
  Four four_;
};

inline namespace GRIDMORPH_ARITHMETIC {

inline WideVec3 operator+(WideVec3 const& a, WideVec3 const& b) { return WideVec3(a.four() + b.four()); }
inline WideVec3 operator-(WideVec3 const& a, WideVec3 const& b) { return WideVec3(a.four() - b.four()); }
inline WideVec3 operator*(double s, WideVec3 const& a) { return WideVec3(s * a.four()); }
inline double dot(WideVec3 const& a, WideVec3 const& b) {
  WideVec3::Four const p = a.four() * b.four();
  return p[0] + p[1] + p[2];
}
inline WideVec3 over(WideVec3 const& a, double s) { return WideVec3(a.four() / s); }
inline WideVec3 smaller_parts(WideVec3 const& a, WideVec3 const& b) { return WideVec3(smaller(a.four(), b.four())); }
inline WideVec3 larger_parts(WideVec3 const& a, WideVec3 const& b) { return WideVec3(larger(a.four(), b.four())); }
inline WideVec3 whole_parts(WideVec3 const& a) {
  using Whole [[gnu::vector_size(4 * sizeof(std::int32_t))]] = std::int32_t;
  return WideVec3(__builtin_convertvector(__builtin_convertvector(a.four(), Whole), WideVec3::Four));
}

}  // namespace GRIDMORPH_ARITHMETIC

/// What this build computes with where it is not asked for more.
using NativeVec3 = std::conditional_t<(native_lanes >= 4), WideVec3, Vec3>;
#else
using NativeVec3 = Vec3;
#endif

/// What is read from memory, to be computed with: vectors as V, anything else as it is.
template <class V, class T>
KOKKOS_FORCEINLINE_FUNCTION T const& as(T const& value) {
  return value;
}
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V as(Vec3 const& v) {
  return V(v);
}
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V as(PackedVec3 const& v) {
  if constexpr (std::is_same_v<V, Vec3>)
    return {v.x, v.y, v.z};
  else
    return V(v);
}
/// And back.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void put(T& to, T const& value) {
  to = value;
}
KOKKOS_FORCEINLINE_FUNCTION void put(PackedVec3& to, Vec3 const& v) { to = {v.x, v.y, v.z}; }

#ifdef GRIDMORPH_WIDE_VECTORS
inline void put(Vec3& to, WideVec3 const& v) { to = {v[0], v[1], v[2]}; }
inline void put(PackedVec3& to, WideVec3 const& v) { store_lanes(&to.x, v.four()); }
inline double component(WideVec3 const& v, int axis) { return v[axis]; }
#endif

}  // namespace gridmorph::kernels
