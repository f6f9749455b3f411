// Coloured Gauss-Seidel sweeps over the points of a region.
#pragma once

#include <gridmorph/guard/detail/shape_region.hpp>

namespace gridmorph::detail {

/// `sweeps` times every free point in turn, colour by colour: the step of descent_step(), `relaxation` times as long at
/// first, halved up to six times until the sum of f over the point's corners falls, else none. delta is 0.1 times 0.6
/// per eighth of the sweeps, as long as the smallest d of the region is below 0.02, then 0. Nodes get baseline +
/// rotation * displacement of their point. `gradual`: delta grows evenly as d falls from 0.02 to 0 instead.
void smooth_region(HostInstance const& host, BlockPoints const& points, ShapeRegion const& region, int sweeps,
                   double relaxation, Coordinates& x, bool gradual = false);

}  // namespace gridmorph::detail
