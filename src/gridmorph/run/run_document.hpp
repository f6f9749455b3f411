// What came out of a run: one document, filled once, that reports, tables and pages print.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

/// A stage of blocks and the worst of the cells that it morphs.
struct StageOutcome {
  std::string stage;
  CellValue determinant;
  std::string zone;  ///< empty where no cell was measured
};

/// What became of the plan's stages and targets.
struct PlanOutcome {
  std::string headline;                             ///< CasePlan::headline()
  nlohmann::json plan;                              ///< of elements: CasePlan::json()
  std::optional<std::vector<StageOutcome>> stages;  ///< of blocks
  nlohmann::json targets;
  std::vector<std::string> notes;  ///< how far targets were missed
};

/// What a motion is predicted to make of cells.
struct PlanPrediction {
  std::string text;
  std::vector<std::string> warnings;
  nlohmann::json json;
};

/// A motion that is planned and not made.
struct PlannedMotion {
  std::string text;     ///< CasePlan::text()
  nlohmann::json json;  ///< CasePlan::json()
  PlanPrediction prediction;
};

/// What one mesh, or one passage of a wheel, comes to at one step of several.
struct MorphedStep {
  double largest_displacement = 0;
  double determinant = 0;  ///< smallest 3x3x3
  double inversion = 0;    ///< smallest FallenCells::worst of inverted cells: which of two at -1 is the worse one
  double angle_deg = 0;    ///< smallest
  Index newly_inverted = 0;
  std::string place;      ///< of the smallest determinant, for people; empty when nothing was measured
  std::string zone;       ///< that it is in
  std::vector<int> cell;  ///< 1-based indices; of elements the number
  std::vector<TipClearance> clearances;
};
MorphedStep morphed_step(double largest_displacement, QualityReport const& quality,
                         std::vector<TipClearance> clearances);

/// One step of several.
struct SequenceStep {
  double time = 0;
  std::vector<MorphedStep> passages = {};  ///< of a wheel; otherwise the mesh alone
  std::vector<std::string> failures = {};
  std::size_t worst = 0;  ///< number of the worst passage
  bool left_out = false;  ///< a design that is not written

  [[nodiscard]] double largest_displacement() const;
  /// Cells of all passages.
  [[nodiscard]] Index newly_inverted() const;
};

struct MorphedSequence {
  SequenceOptions options;
  std::vector<SequenceStep> steps;
  std::size_t worst = 0;  ///< number of the worst step
};

/// A mesh, of several steps that of the worst one.
struct MorphedMesh {
  QualityReport quality;
  std::vector<Shortfall> of_motion;  ///< whatever became of cells
  PlanOutcome plan;
  std::vector<TipClearance> clearances = {};
};

/// Zones of a wheel that belong together, and how many of their passages were made.
struct RowOfPassages {
  std::vector<std::string> zones;
  int passages = 0, passages_of_wheel = 0;  ///< WheelRow::passages
  std::optional<Vec3> pitch;                ///< of a straight row
};

struct PassageResult {
  std::vector<std::string> blades;  ///< per periodic row that has this passage; "" for what [[motion]] says
  double largest_displacement = 0;  ///< of the boundary
  QualityReport quality;
  std::vector<Shortfall> shortfalls;
  std::vector<TipClearance> clearances = {};  ///< of the rows that have this passage; places as the wheel has them
};

/// A wheel, of several steps that of the worst one.
struct MorphedWheel {
  std::vector<RowOfPassages> rows;
  std::vector<PassageResult> passages;
  QualityReport whole;          ///< as it is written: certificate and zone names, nothing else
  double largest_seam_gap = 0;  ///< SeamGap::distance
};

struct RunDocument {
  std::string case_file, input;
  std::optional<std::string> output = {};  ///< where something is written
  Index nodes = 0;
  StepTimes times = {};
  std::vector<std::string> notes = {};
  std::vector<Parameter> parameters = {};
  nlohmann::json fields = nlohmann::json::array();    ///< of rules `field`: how they were mapped
  nlohmann::json guarded = nlohmann::json::object();  ///< Guarded::json
  QualityThresholds thresholds = {};
  QualityReport baseline = {};             ///< without cells where only a verdict was asked for
  std::optional<PlannedMotion> plan = {};  ///< one of these three
  std::optional<MorphedMesh> mesh = {};
  std::optional<MorphedWheel> wheel = {};
  std::optional<MorphedSequence> sequence = {};
};
/// What a case file itself says, and how the fields of its rules have been mapped so far.
RunDocument document_of(CaseFile const& case_file);

/// For programs: the report, and what --json prints.
nlohmann::json run_json(RunDocument const& document);
/// For people: notes and tables.
std::string run_text(RunDocument const& document);

/// The shortfalls of the mesh; of a wheel those of all passages, which they name.
std::vector<Shortfall> shortfalls_of(RunDocument const& document);
/// Whether any of them, or what falls short in any step, is a failure.
bool misses_thresholds(RunDocument const& document);
/// What no table says to those who see none: shortfalls; of wheels, which have no table of these, failures.
std::vector<std::string> warnings_of(RunDocument const& document);

}  // namespace gridmorph::cli
