// From [wheel] of a case file to the motions of the blades and the places they stand in.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/wheel/wheel_motion.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

/// One of the different blades of a wheel, over time.
struct WheelBladeMotion {
  Motion motion;  ///< of the case file, with the blade's own rules in place, as they stand
  std::vector<TimedRule> timed;
  double factor = 1;
  double ahead = 0;  ///< of the first passage in a travelling wave [period], 0 <= ahead < 1
  int same_rules = -1;
  std::string name;  ///< "A", "A x 0.98", "A 120 deg"; "" for what [[motion]] says
};

struct WheelSetup {
  std::vector<WheelBladeMotion> motions;
  std::vector<WheelRowBlades> blades;  ///< per row of the mesh
  std::vector<Moment> moments;         ///< of the steps; without [sequence] one
  double period = 1;                   ///< [time]
  RowPitch pitch;                      ///< in whose components factors multiply

  [[nodiscard]] std::vector<int> passages() const;
  [[nodiscard]] SameRules same_rules() const;
  /// All motions at a moment. Throws MotionError where an amplitude is not finite.
  [[nodiscard]] std::vector<Motion> at(Moment const& when) const;
  [[nodiscard]] Motion at(int motion, Moment const& when) const;
  /// Whether blades move in a wave.
  [[nodiscard]] bool has_wave() const;
};

/// Throws ConfigError that names every problem with its line: zones that are
/// not there, more passages than the wheel has, straight rows without a number,
/// sequences that do not go round it, rules of a blade that replace none of
/// [[motion]], nodal diameters that so many blades have not.
WheelSetup wheel_setup(CaseFile const& case_file, Mesh const& mesh, WheelRows const& rows);

}  // namespace gridmorph::cli
