// Several doubles computed at once: the vector type of the compiler on CPUs, one double where a GPU thread works alone.
//
// Kernels that are templates on their number type T compile for T = double and T = Lanes<W> from the same source. They
// must be free of branches: `c ? a : b` chooses per lane, with both sides computed. Each lane rounds exactly as a
// double does, so results do not depend on W. Square roots become one instruction only with -fno-math-errno.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/tile.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
template <int W>
struct LaneVector {
  using type [[gnu::vector_size(W * sizeof(double))]] = double;
};
#if defined(__AVX512F__)
constexpr int native_lanes = 8;
#elif defined(__AVX__)
constexpr int native_lanes = 4;
#else
constexpr int native_lanes = 2;
#endif
#else
template <int W>
struct LaneVector;  // compilers for GPUs need not know vector types, host code that they compile goes without
constexpr int native_lanes = 1;  ///< lanes that one register of the host holds
#endif
template <>
struct LaneVector<1> {
  using type = double;
};

/// W doubles, W = 1 or a power of two that the target has registers for.
template <int W>
using Lanes = typename LaneVector<W>::type;

template <class T>
inline constexpr int lane_count = int(sizeof(T) / sizeof(double));

template <class T>
KOKKOS_FORCEINLINE_FUNCTION T broadcast(double a) {
  return T{} + a;
}

/// The values at p[0], p[1], ..., wherever they lie.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T load_lanes(double const* p) {
  if constexpr (lane_count<T> == 1) {
    return *p;
  } else {
    T a;
    __builtin_memcpy(&a, p, sizeof(T));
    return a;
  }
}

/// The values at p[0], p[step], p[2 step], ...
template <class T, int step>
KOKKOS_FORCEINLINE_FUNCTION T load_lanes_by(Constant<step>, double const* p) {
  if constexpr (lane_count<T> == 1) {
    return *p;
  } else if constexpr (step == 0) {
    return *p - T{};  // takes no operation, and leaves the sign of zero
  } else if constexpr (step == 1) {
    return load_lanes<T>(p);
  } else {
    T a{};
    for (int n = 0; n < lane_count<T>; ++n) a[n] = p[n * step];
    return a;
  }
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION void store_lanes(double* p, T const& a) {
  if constexpr (lane_count<T> == 1)
    *p = a;
  else
    __builtin_memcpy(p, &a, sizeof(T));
}

/// The smaller of two values, and a where b is no number.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T smaller(T const& a, T const& b) {
  return b < a ? b : a;
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T larger(T const& a, T const& b) {
  return a < b ? b : a;
}

/// Whether any of some values lies outside an interval, asked for many at once.
template <class T>
struct AnyOutside {
  decltype(T{} < T{}) found{};

  /// A value that is no number lies in every interval.
  KOKKOS_FORCEINLINE_FUNCTION void add(T const& a, T const& from, T const& to) { found |= (a < from) | (a >= to); }
  KOKKOS_FORCEINLINE_FUNCTION bool any() const {
    if constexpr (lane_count<T> == 1) {
      return found;
    } else {
      auto sum = found[0];
      for (int n = 1; n < lane_count<T>; ++n) sum |= found[n];
      return sum != 0;
    }
  }
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION T square_root(T const& a) {
  using compat::math::sqrt;
  if constexpr (lane_count<T> == 1) {
    return sqrt(a);
  } else {
    T root;
    for (int n = 0; n < lane_count<T>; ++n) root[n] = sqrt(a[n]);
    return root;
  }
}

/// A vector in space per lane. Copies go component by component: compilers keep those in registers, while copies of a
/// whole struct of wide vectors go through memory.
template <class T>
struct LaneVec3 {
  T x, y, z;

  KOKKOS_FORCEINLINE_FUNCTION LaneVec3(T const& x_, T const& y_, T const& z_) : x(x_), y(y_), z(z_) {}
  KOKKOS_FORCEINLINE_FUNCTION LaneVec3(LaneVec3 const& a) : x(a.x), y(a.y), z(a.z) {}
  LaneVec3& operator=(LaneVec3 const&) = delete;
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> operator+(LaneVec3<T> const& a, LaneVec3<T> const& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> operator-(LaneVec3<T> const& a, LaneVec3<T> const& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> operator*(T const& s, LaneVec3<T> const& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T dot(LaneVec3<T> const& a, LaneVec3<T> const& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION LaneVec3<T> cross(LaneVec3<T> const& a, LaneVec3<T> const& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The smallest and the largest of some values.
template <class T>
struct Extremes {
  T min, max;

  KOKKOS_FORCEINLINE_FUNCTION Extremes(T const& min_, T const& max_) : min(min_), max(max_) {}
  KOKKOS_FORCEINLINE_FUNCTION Extremes(Extremes const& e) : min(e.min), max(e.max) {}
  Extremes& operator=(Extremes const&) = delete;
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> extremes(T const& a, T const& b, T const& c, T const& d) {
  return {smaller(smaller(a, b), smaller(c, d)), larger(larger(a, b), larger(c, d))};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> merged(Extremes<T> const& a, Extremes<T> const& b) {
  return {smaller(a.min, b.min), larger(a.max, b.max)};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Extremes<T> operator*(double s, Extremes<T> const& e) {
  return {s * e.min, s * e.max};
}

}  // namespace gridmorph::kernels
