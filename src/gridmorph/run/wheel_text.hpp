// What `gridmorph wheel` prints and reports.
#pragma once

#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/report/tip_clearance.hpp>
#include <gridmorph/run/recipe.hpp>
#include <gridmorph/run/wheel_setup.hpp>
#include <gridmorph/wheel/seams.hpp>

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

struct PassageResult {
  std::vector<std::string> blades;  ///< per periodic row that has this passage; "" for what [[motion]] says
  double largest_displacement = 0;  ///< of the boundary
  QualityReport quality;
  std::vector<Shortfall> shortfalls;
  std::vector<TipClearance> clearances = {};  ///< of the rows that have this passage; places as the wheel has them
};

/// The passage whose cells came out worst.
struct WorstPassage {
  int passage = -1;  ///< none yet
  Badness badness;
  Coordinates morphed;  ///< where the sector is
};

/// A wheel at one time.
struct WheelMade {
  std::vector<PassageResult> passages;
  QualityReport whole;  ///< of the wheel as it is written: certificate and zone names, nothing else
  SeamGap gap;          ///< the largest of all rows
  std::vector<std::string> notes;
  std::optional<WorstPassage> worst = {};  ///< where it was kept
};

struct WheelResult : WheelMade {
  QualityReport baseline;
  StepTimes times;
  Index nodes = 0;  ///< of the wheel
};

/// What one passage comes to at one step.
struct PassageStep {
  double largest_displacement = 0;
  double determinant = 0;  ///< smallest 3x3x3
  double angle_deg = 0;    ///< smallest
  Index newly_inverted = 0;
  std::string place;           ///< of the smallest determinant
  std::string zone = {};       ///< that it is in; empty where nothing was measured
  std::vector<int> cell = {};  ///< 1-based indices; of elements the number
  std::vector<TipClearance> clearances = {};

  /// Which of two is the worse one: inverted cells first.
  [[nodiscard]] bool worse_than(PassageStep const& other) const {
    return std::pair(-newly_inverted, determinant) < std::pair(-other.newly_inverted, other.determinant);
  }
};

/// A wheel at one step of several.
struct WheelStep {
  double time = 0;
  std::vector<PassageStep> passages;
  std::vector<std::string> failures;
  std::size_t worst = 0;  ///< number of the worst passage

  [[nodiscard]] double largest_displacement() const;
  /// Cells of all passages.
  [[nodiscard]] Index newly_inverted() const;
  /// By the worst passages.
  [[nodiscard]] bool worse_than(WheelStep const& other) const {
    return passages[worst].worse_than(other.passages[other.worst]);
  }
};
WheelStep wheel_step(double time, WheelMade const& made);
/// Number of the worst step.
std::size_t worst_step(std::vector<WheelStep> const& steps);

/// "passage 3: ...", of all passages.
std::vector<std::string> failures_of(WheelMade const& made);

/// One line per row: its zones, how many passages of how many.
std::string describe_rows(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup);
/// One line per passage: blades, displacement, worst cells; near and far field together.
std::string passage_table(WheelResult const& result);
/// One line per passage and tip with its clearances, and which is the smallest of all; empty without any.
std::string wheel_clearances(WheelMade const& made);
/// The same of many steps: the smallest of all steps, and the steps they are in.
std::string wheel_clearances(std::vector<WheelStep> const& steps);
/// One line per step with its worst passage; of long sequences evenly spaced steps and the worst.
std::string wheel_steps_table(std::vector<WheelStep> const& steps);
/// One line per passage: the largest displacement and the worst of all steps.
std::string passages_over_time(std::vector<WheelStep> const& steps, WheelMade const& made);
/// Every passage of every step.
nlohmann::json wheel_steps_json(std::vector<WheelStep> const& steps);
nlohmann::json wheel_json(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup, WheelResult const& result);

}  // namespace gridmorph::cli
