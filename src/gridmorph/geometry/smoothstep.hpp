// The C1 step.
#pragma once

#include <algorithm>

namespace gridmorph {

/// t^2 (3 - 2 t), 0 before t = 0 and 1 behind t = 1.
inline double smoothstep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace gridmorph
