// Finalize, planned: which nodes are put back on their slip surfaces, and along which lines the correction is spread.
#pragma once

#include <gridmorph/plan/stage_builder.hpp>

namespace gridmorph {

/// Fills plan.surfaces and plan.spreads. Every block face on a slip patch starts (or ends) a chain that runs through all
/// blocks to the opposite boundary; chains that cross one another go into different passes. `given`: entities whose
/// displacement the motion rules give.
void plan_spreads(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion,
                  SurfaceMotion const& surface, Known const& given, RotationTable& rotations, Plan& plan);

}  // namespace gridmorph
