// Lattices of equal cells. lattice_field.hpp interpolates in them.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>

namespace gridmorph::kernels {

struct UniformLattice {
  Vec3 low;                           ///< node (0, 0, 0)
  double spacing = 1;                 ///< of nodes, along all axes
  std::int32_t nodes[3] = {1, 1, 1};  ///< along each axis, i fastest; 1: the lattice is flat

  KOKKOS_INLINE_FUNCTION std::int64_t size() const { return std::int64_t(nodes[0]) * nodes[1] * nodes[2]; }
  KOKKOS_INLINE_FUNCTION Vec3 position(std::int64_t n) const {
    std::int64_t const i = n % nodes[0], j = n / nodes[0] % nodes[1], k = n / (std::int64_t(nodes[0]) * nodes[1]);
    return low + spacing * Vec3{double(i), double(j), double(k)};
  }
};

}  // namespace gridmorph::kernels
