// Making a wrap simple.
#pragma once

#include <gridmorph/plan/elements/wrap.hpp>

namespace gridmorph::detail {

/// Closes gaps of one cell, fills dents and enclosed hollows and joins cells that touch only along an edge or at a
/// corner, by adding cells. What no node of the mesh lies in and nothing but the limits of the mesh opens counts as
/// enclosed: the inside of a body that stands on a plane of symmetry. `coordinates`: of all nodes, in the chart.
void fill(Coordinates const& coordinates, LatticeBox const& domain, Wrap& wrap);

}  // namespace gridmorph::detail
