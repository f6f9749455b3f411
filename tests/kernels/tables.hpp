// Tables of kernels written by hand.
#pragma once

#include <gridmorph/kernels/field.hpp>

#include <Kokkos_Core.hpp>

#include <vector>

namespace gridmorph::test {

using Host = Kokkos::HostSpace;
using kernels::Index;

template <class T>
Kokkos::View<T*, Host> view(std::vector<T> const& values) {
  Kokkos::View<T*, Host> v("test::table", values.size());
  for (std::size_t n = 0; n < values.size(); ++n) v(n) = values[n];
  return v;
}

/// Arrays of three components.
struct Arrays {
  std::vector<double> x, y, z;
  explicit Arrays(std::size_t n, double value = 0) : x(n, value), y(n, value), z(n, value) {}
  kernels::Field<double> field() { return {x.data(), y.data(), z.data()}; }
  kernels::Field<double const> read() const { return {x.data(), y.data(), z.data()}; }
};

}  // namespace gridmorph::test
