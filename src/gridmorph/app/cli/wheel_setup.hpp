// From [wheel] of a case file to the motions of the blades and the places they stand in.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/wheel/wheel_motion.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

struct WheelSetup {
  std::vector<Motion> motions;         ///< of the different blades
  std::vector<std::string> names;      ///< of the motions: "A", "A x 0.98"; "" for what [[motion]] says
  std::vector<WheelRowBlades> blades;  ///< per row of the mesh

  [[nodiscard]] std::vector<int> passages() const;
};

/// Throws ConfigError that names every problem with its line: zones that are not there, more passages than the wheel has, sequences
/// that do not go round it, rules of a blade that replace none of [[motion]].
WheelSetup wheel_setup(CaseFile const& case_file, Mesh const& mesh, WheelRows const& rows);

}  // namespace gridmorph::cli
