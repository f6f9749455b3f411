// Three component arrays over all nodes of a mesh (structure of arrays): coordinates or displacements.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph::kernels {

/// Non-owning pointers to three arrays in one memory space; strides are in elements, so interleaved and strided solver
/// arrays work too. T is double or const double.
template <class T>
struct Field {
  T* x;
  T* y;
  T* z;
  Index stride = 1;

  KOKKOS_INLINE_FUNCTION Vec3 operator[](Index n) const { return {x[n * stride], y[n * stride], z[n * stride]}; }
  KOKKOS_INLINE_FUNCTION void set(Index n, Vec3 const& v) const {
    x[n * stride] = v.x;
    y[n * stride] = v.y;
    z[n * stride] = v.z;
  }
};

}  // namespace gridmorph::kernels
