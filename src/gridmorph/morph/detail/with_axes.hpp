// Vectors of a plane mesh across x or y, seen as those of one across z.
#pragma once

#include <gridmorph/mesh/vector_view.hpp>

#include <array>

namespace gridmorph::detail {

/// The caller's vectors with their components axes[0], axes[1] and axes[2] as x, y and z; of one list: ConfigError for
/// zones apart.
template <class Memory, bool ReadOnly>
BasicVectorView<Memory, ReadOnly> with_axes(BasicVectorView<Memory, ReadOnly> const& v,
                                            std::array<int, 3> const& axes) {
  if (axes == std::array<int, 3>{0, 1, 2}) return v;
  kernels::VectorArray const& of = v.array();
  if (of.zones != nullptr)
    refuse_vectors("a plane mesh across x or y has its vectors in one list, not in zones apart; give them so");
  std::array<void*, 3> const all{of.x, of.y, of.z};
  auto const seen = [&]<class Real>(Real*) {
    Kokkos::LayoutStride const layout(std::size_t(v.size()), std::size_t(of.stride));
    auto const view = [&](int k) {
      return Kokkos::View<Real*, Kokkos::LayoutStride, Memory>(
          static_cast<Real*>(all[std::size_t(axes[std::size_t(k)])]), layout);
    };
    return BasicVectorView<Memory, ReadOnly>(view(0), view(1), view(2));
  };
  return of.single ? seen(static_cast<float*>(nullptr)) : seen(static_cast<double*>(nullptr));
}

}  // namespace gridmorph::detail
