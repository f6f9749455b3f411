// Coordinates of a mesh as arrays of a benchmark's own, in any memory space.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph::bench {

template <class Memory>
struct NodeArrays {
  Kokkos::View<double*, Memory> x, y, z;

  /// A copy, also where the mesh is in the same memory space: benchmarks overwrite it.
  explicit NodeArrays(Coordinates const& c)
      : x("gridmorph::bench::x", c.x.extent(0)),
        y("gridmorph::bench::y", c.x.extent(0)),
        z("gridmorph::bench::z", c.x.extent(0)) {
    Kokkos::deep_copy(x, c.x);
    Kokkos::deep_copy(y, c.y);
    Kokkos::deep_copy(z, c.z);
  }
  [[nodiscard]] kernels::Field<double const> read() const { return {x.data(), y.data(), z.data()}; }
  [[nodiscard]] kernels::Field<double> write() const { return {x.data(), y.data(), z.data()}; }
};

}  // namespace gridmorph::bench
