// Three-component vectors and 3x3 matrices that work on host and device.
//
// Deliberately tiny: what the mesh kernels need and nothing else. All operations are plain sums in a fixed
// order, so that every execution space rounds alike.
#pragma once

#include <Kokkos_Core.hpp>

#include <cmath>

// The linker keeps one copy of each inline function that two sources compile. What rounds has another name in sources
// of the library than in those of its users, so that its results do not depend on the compiler options of theirs.
#ifndef GRIDMORPH_ARITHMETIC
#define GRIDMORPH_ARITHMETIC arithmetic_of_the_user
#endif

namespace gridmorph::kernels {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  KOKKOS_INLINE_FUNCTION Vec3& operator+=(Vec3 const& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
};

/// Along x, y or z: axis 0, 1 or 2.
KOKKOS_FORCEINLINE_FUNCTION double component(Vec3 const& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Row-major 3x3 matrix.
struct Mat3 {
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

inline namespace GRIDMORPH_ARITHMETIC {

KOKKOS_INLINE_FUNCTION Vec3 operator+(Vec3 const& a, Vec3 const& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 const& a, Vec3 const& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator-(Vec3 const& a) { return {-a.x, -a.y, -a.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator*(double s, Vec3 const& a) { return {s * a.x, s * a.y, s * a.z}; }
KOKKOS_INLINE_FUNCTION Vec3 operator*(Vec3 const& a, double s) { return s * a; }
KOKKOS_INLINE_FUNCTION bool operator==(Vec3 const& a, Vec3 const& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

KOKKOS_INLINE_FUNCTION double dot(Vec3 const& a, Vec3 const& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
KOKKOS_INLINE_FUNCTION Vec3 cross(Vec3 const& a, Vec3 const& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
KOKKOS_INLINE_FUNCTION double norm(Vec3 const& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
KOKKOS_INLINE_FUNCTION double distance(Vec3 const& a, Vec3 const& b) { return norm(a - b); }

KOKKOS_INLINE_FUNCTION Vec3 operator*(Mat3 const& a, Vec3 const& v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}

KOKKOS_INLINE_FUNCTION Mat3 operator*(Mat3 const& a, Mat3 const& b) {
  Mat3 c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
  return c;
}

KOKKOS_INLINE_FUNCTION Mat3 transpose(Mat3 const& a) {
  Mat3 t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a.m[j][i];
  return t;
}

}  // namespace GRIDMORPH_ARITHMETIC

}  // namespace gridmorph::kernels

// Vectors are what the whole library speaks, so they have their short names in it. Everything else of the kernels is
// named with its namespace: kernels::Facet.
namespace gridmorph {
using kernels::dot, kernels::cross, kernels::norm, kernels::distance, kernels::transpose;
using kernels::Vec3, kernels::Mat3;
}  // namespace gridmorph
