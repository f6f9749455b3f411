// Directions of vectors.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph {

/// The unit vector v / |v|.
inline Vec3 unit(Vec3 const& v) { return (1 / norm(v)) * v; }

}  // namespace gridmorph
