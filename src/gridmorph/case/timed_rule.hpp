// Rules of a case file at a time of a sequence, and shares of them.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <functional>

namespace gridmorph {

/// A step of a sequence. Without one: its beginning.
struct Moment {
  double periods = 0;  ///< time over period
  double time = 0;     ///< [time]
  int step = 1;        ///< 1, 2, ...
};

/// A rule as it is at a moment, times `share`: rigid motions by their parameters (make_rigid_steps), sections by their
/// tables, formulas and fields by their displacement, targets and contours by the way to the surface, inflated surfaces
/// by the height, lattices by the displacement of their control points.
using RuleAt = std::function<Rule(double share, Moment const& when)>;

/// What a case file says of a rule beside what it is at the beginning.
struct TimedRule {
  RuleAt at;                                            ///< empty for rules without a displacement of their own
  std::function<double(Moment const& when)> amplitude;  ///< empty: 1
  bool changes = false;                                 ///< over time, by its amplitude or by itself
  bool end_wall = false;                                ///< moves the walls between which the blades stand
};

}  // namespace gridmorph
