// The near field of a plan as one number per cell.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/plan/plan.hpp>

#include <vector>

namespace gridmorph::cli {

/// Nonzero in the near field of moving walls; cells zone after zone, i fastest.
std::vector<unsigned char> near_field_mask(Mesh const& mesh, Plan const& plan);

}  // namespace gridmorph::cli
