// Rules that take their displacement from walls that other rules move.
#pragma once

#include <gridmorph/motion/motion.hpp>

namespace gridmorph {

/// Whether a rule has no displacement of its own but one that follows from those of walls.
inline bool goes_along(Rule const& rule) {
  return std::holds_alternative<CircumferentialSlideRule>(rule) || std::holds_alternative<FollowRule>(rule) ||
         std::holds_alternative<AttachedRule>(rule) || std::holds_alternative<WakeRule>(rule) ||
         std::holds_alternative<ExtendRule>(rule) || std::holds_alternative<CarryRule>(rule);
}

}  // namespace gridmorph
