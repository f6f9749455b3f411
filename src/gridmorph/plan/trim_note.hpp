// What finalize will do to given displacements that leave a slip surface.
#pragma once

#include <gridmorph/plan/plan.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// "the given displacement leaves slip surfaces at 47 nodes, most at zone ... by 0.0012; they are put back ...", or nothing
/// when all given displacements (per Plan::boundary_nodes) stay on the slip surfaces as build_spread() asks of them.
/// Cost: O(nodes on slip surfaces).
std::optional<std::string> trim_note(Mesh const& mesh, Plan const& plan, std::vector<Vec3> const& boundary);

}  // namespace gridmorph
