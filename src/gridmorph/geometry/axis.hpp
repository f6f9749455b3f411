// The line that a machine turns about.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph {

/// Axis of the machine (or any axis of rotation); direction need not be normalised.
struct Axis {
  Vec3 origin{0, 0, 0};
  Vec3 direction{1, 0, 0};
};

}  // namespace gridmorph
