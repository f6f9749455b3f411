// The O-type background mesh around a tube.
#pragma once

#include <gridmorph/plan/elements/background.hpp>

namespace gridmorph::detail {

/// Blocks between a tube and a box: four around it from end to end; at both ends four more that go on to the box's end
/// face, and within these the core and the four blocks around it (a butterfly) in front of the tube's flat end.
/// `box`: planes of the outer box. Throws MeshError when a cell would be inside out.
Mesh o_type_mesh(Tube const& tube, std::array<std::vector<double>, 3> const& box, double growth);

}  // namespace gridmorph::detail
