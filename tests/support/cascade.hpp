// One passage of a cascade of cambered blades, one H block: linear, or bent into an annulus.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph::test {

constexpr double cascade_pitch = 0.8, cascade_span = 0.5;

/// Axis x. Linear (radius 0): span y, pitch z. Annulus: the same at distance `radius` from the axis, z rolled up around
/// it. Patches of families inlet, outlet, hub, case and blade; its two sides are a pitch apart.
Mesh cascade(double radius = 0);

}  // namespace gridmorph::test
