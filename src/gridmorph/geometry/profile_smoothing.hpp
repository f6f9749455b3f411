// Profiles of revolution through points whose coordinates are rounded: smoother than the points are.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>

#include <utility>
#include <vector>

namespace gridmorph {

/// Puts the knots of a profile where many points around each of them say the wall is, so that rounding averages out:
/// a profile that passes through every point hands their rounding on, and between points of very different spacing
/// several times that much. `rounding`: how far points may be off the wall, at most, because of their rounding; 0
/// changes nothing. A knot stays as it is where points are further off every polynomial around it: at kinks, and where
/// they are too few for the shape of the wall. Cost: linear in points.
///
/// Each knot gets value, slope and second derivative of the polynomial that fits a window of points best (G. Forsythe
/// 1957: by orthogonal polynomials, no system of equations). The window is as wide as it can be: it grows until what it
/// says contradicts a narrower one by more than noise (O. Lepski 1990, intersection of confidence intervals).
void smooth(RevolutionProfile& profile, std::vector<std::pair<double, double>> points, double rounding);

}  // namespace gridmorph
