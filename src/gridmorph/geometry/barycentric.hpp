// Places in triangles.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>

namespace gridmorph {

/// Weights of the corners of a triangle that give a point of its plane. Of a triangle without area those on its longer
/// side.
inline std::array<double, 3> barycentric(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  Vec3 const ab = b - a, ac = c - a, ap = p - a;
  double const d00 = dot(ab, ab), d01 = dot(ab, ac), d11 = dot(ac, ac), d20 = dot(ap, ab), d21 = dot(ap, ac);
  double const area = d00 * d11 - d01 * d01;
  if (!(area > 0)) {  // a segment, or a point
    double const along = d00 >= d11 ? (d00 > 0 ? d20 / d00 : 0) : d21 / d11;
    return d00 >= d11 ? std::array<double, 3>{1 - along, along, 0} : std::array<double, 3>{1 - along, 0, along};
  }
  double const v = (d11 * d20 - d01 * d21) / area, w = (d00 * d21 - d01 * d20) / area;
  return {1 - v - w, v, w};
}

}  // namespace gridmorph
