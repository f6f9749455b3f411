// The arc cosine without branches or calls, so that loops over cells vectorise and every execution space rounds alike.
//
// asin(s) = s + s R(s^2), R a rational function on [0, 1/4] (the minimax coefficients of fdlibm's e_acos.c, Sun
// Microsystems 1993); acos(x) = pi/2 - asin(|x|) up to |x| = 1/2 and 2 asin(sqrt((1 - |x|) / 2)) above, mirrored for
// negative x. Within 2 units in the last place of pi of the exact value. About 25 flops, 1 division, 1 square root.
#pragma once

#include <gridmorph/kernels/lanes.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// Angle in [0, pi] whose cosine is x. Arguments beyond -1 and 1, as round-off makes them, count as -1 and 1.
/// T: double or Lanes.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T arc_cosine(T const& x) {
  constexpr double pi = 3.141592653589793116;
  T const size = x < 0 ? -x : x;
  T const y = smaller(broadcast<T>(1), size);
  T const half_distance = 0.5 * (1 - y);
  T const root = square_root(half_distance);
  T const z = y > 0.5 ? half_distance : y * y;
  T const s = y > 0.5 ? root : y;
  T const p = z * (1.66666666666666657415e-01 +
                   z * (-3.25565818622400915405e-01 +
                        z * (2.01212532134862925881e-01 +
                             z * (-4.00555345006794114027e-02 +
                                  z * (7.91534994289814532176e-04 + z * 3.47933107596021167570e-05)))));
  T const q =
      1 + z * (-2.40339491173441421878e+00 +
               z * (2.02094576023350569471e+00 + z * (-6.88283971605453293030e-01 + z * 7.70381505559019352791e-02)));
  T const arc_sine = s + s * (p / q);
  T const angle = y > 0.5 ? 2 * arc_sine : 0.5 * pi - arc_sine;
  T const mirrored = pi - angle;
  return x < 0 ? mirrored : angle;
}

}  // namespace gridmorph::kernels
