// What `gridmorph wheel` prints and reports.
#pragma once

#include <gridmorph/app/cli/wheel_setup.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/wheel/seams.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

struct PassageResult {
  std::vector<std::string> blades;  ///< per periodic row that has this passage; "" for what [[motion]] says
  double largest_displacement = 0;  ///< of the boundary
  QualityReport quality;
  std::vector<Shortfall> shortfalls;
};

struct WheelResult {
  QualityReport baseline;
  std::vector<PassageResult> passages;
  QualityReport whole;  ///< of the wheel as it is written: certificate and zone names, nothing else
  SeamGap gap;          ///< the largest of all rows
  std::vector<std::string> notes;
  StepTimes times;
  Index nodes = 0;  ///< of the wheel
};

/// One line per row: its zones, how many passages of how many.
std::string describe_rows(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup);
/// One line per passage: blades, displacement, worst cells; near and far field together.
std::string passage_table(WheelResult const& result);
nlohmann::json wheel_json(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup, WheelResult const& result);

}  // namespace gridmorph::cli
