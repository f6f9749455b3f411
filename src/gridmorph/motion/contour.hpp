// End walls that move onto a new profile of revolution.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Moves nodes onto the surface of revolution about `axis` through a profile of (axial, radius) points, which is drawn
/// as a slip surface's is (TurnedProfile): radially where the profile is a function of the axial position, along the
/// axis where the wall stands across it, and to the nearest point of the meridional plane where it turns. The angle
/// about the axis stays, so periodic copies stay copies. `share` of the way: 1 puts nodes on the profile.
///
/// Throws MotionError when the points are no profile. The rule throws MotionError, which begins with `where`, for
/// points beyond the ends of the profile by more than 1e-6 of its length, and for points on the axis that the profile
/// does not pass through there. Cost: O(n log n) for the profile, O(1) per point.
FunctionRule make_contour(std::vector<std::pair<double, double>> const& profile, Axis const& axis,
                          std::string const& where, double share = 1);

}  // namespace gridmorph
