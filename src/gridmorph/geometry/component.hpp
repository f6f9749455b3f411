// Components of vectors by number.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph {

/// Along x, y or z: axis 0, 1 or 2.
inline double component(Vec3 const& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace gridmorph
