// Poles: faces collapsed to a line, that no rule moves. All nodes that coincide on such a face must move as one.
#pragma once

#include <gridmorph/plan/blocks/boundary.hpp>

#include <optional>

namespace gridmorph {

/// A stage that gives pole faces their displacement before any volume line ends on them: linear in arc length along the
/// pole between its known ends, constant from the only known end. Poles without a known end stay where they are
/// (boundary nodes that no rule asks for: displacement zero) and are listed in plan.notes. Nothing when the mesh has no
/// such faces.
std::optional<Stage> pole_stage(PlanContext const& context, ResolvedMotion const& motion,
                                std::vector<std::string> const& kind_order, Known& known, Plan& plan);

}  // namespace gridmorph
