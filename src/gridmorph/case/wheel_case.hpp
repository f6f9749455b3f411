// [wheel] of a case file: how many passages, and which blade stands in which of them.
#pragma once

#include <gridmorph/case/timed_rule.hpp>
#include <gridmorph/motion/motion.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// [[wheel.blade]]: a blade that differs from what [[motion]] says.
struct WheelBlade {
  std::string name;
  double factor = 1;              ///< multiplies what explicit rules do, see docs/wheel.md
  std::vector<MotionRule> rules;  ///< in place of the [[motion]] rules of the same patches
  std::vector<TimedRule> timed;   ///< of the same number
  std::string where;              ///< "case.toml:14"
};

/// [[wheel.row]], or the same keys in [wheel].
struct WheelRowCase {
  std::vector<std::string> zones;      ///< names or globs; empty: all zones
  int passages = 0;                    ///< 0: the whole wheel; straight rows have none
  std::vector<std::string> sequence;   ///< names of blades, first passage first, repeated round the
                                       ///< wheel; empty: as [[motion]] says
  std::optional<int> nodal_diameters;  ///< of the wave in which the blades move over time
  std::string where_diameters;
  std::vector<double> factors;  ///< on the displacement as WheelBlade::factor, repeated likewise; empty: 1
  std::string where;
};

struct WheelCase {
  std::filesystem::path output;  ///< empty when the case file names none
  bool suffix_families = false;
  std::vector<WheelBlade> blades;
  std::vector<WheelRowCase> rows;
};

}  // namespace gridmorph
