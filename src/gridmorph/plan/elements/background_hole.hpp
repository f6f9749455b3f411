// What a background mesh of the user's leaves out: the place of the moving walls, which the wrap is otherwise made for.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/classify.hpp>

namespace gridmorph {

/// Near is what lies in the hole of a background mesh: within the box around its wrap (`wrap_nodes`, their positions),
/// but in none of its cells. Partially wrapped is what has a node there, or holds a node of the wrap. Cost: one search
/// in the background per node in that box, and one in the mesh per node of the wrap.
Classification classify_by_hole(HostInstance const& host, Mesh const& mesh, Background const& background,
                                std::vector<Vec3> const& wrap_nodes);

}  // namespace gridmorph
