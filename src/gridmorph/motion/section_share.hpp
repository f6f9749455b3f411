// A redesign by sections, more or less of it.
#pragma once

#include <gridmorph/motion/motion.hpp>

namespace gridmorph {

/// The redesign of a rule with the values of all its tables times `share`: half of a chord that is 10 % shorter is one
/// that is 5 % shorter, half of a twist a twist by half the angle. resolve() refuses values beyond their limits.
SectionsRule share_of(SectionsRule rule, double share);

}  // namespace gridmorph
