// The gradient of values at scattered points.
#pragma once

#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <span>

namespace gridmorph {

/// The gradient of the linear function, zero at no offset, that fits values at offsets best (least squares), in the
/// directions that the offsets extend in: those whose squares add up to more than `flat` of the most. Cost: linear.
inline Vec3 fitted_gradient(std::span<Vec3 const> offset, std::span<double const> value, double flat) {
  SmallMatrix<3> moments{};
  Vec3 b;
  for (std::size_t n = 0; n < offset.size(); ++n) {
    std::array const d{offset[n].x, offset[n].y, offset[n].z};
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = 0; q < 3; ++q) moments[p][q] += d[p] * d[q];
    b += value[n] * offset[n];
  }
  auto const eigen = symmetric_eigen<3>(moments);
  Vec3 out;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(eigen.value[k] > flat * eigen.value[0])) break;
    Vec3 const v{eigen.vector[k][0], eigen.vector[k][1], eigen.vector[k][2]};
    out += (dot(v, b) / eigen.value[k]) * v;
  }
  return out;
}

}  // namespace gridmorph
