// What sequences of structured and of unstructured meshes have in common: the loop over the steps, and what is said and written
// of them.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/step_files.hpp>
#include <gridmorph/app/cli/terminal.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct StepResult {
  double time = 0;
  double largest_displacement = 0;
  double determinant = 0;  ///< smallest 3x3x3
  double inversion = 0;    ///< smallest FallenCells::worst of inverted cells: which of two steps at -1 is the worse one
  std::string place;       ///< of it, for people; empty when nothing was measured
  std::string zone;
  std::vector<int> cell;  ///< 1-based indices; of an unstructured mesh the element's number
  Index newly_inverted = 0;
  std::string shortfall;  ///< the first of those that are failures
};

StepResult step_result(double time, Coordinates const& before, Coordinates const& after, QualityReport const& quality);

/// Throws ConfigError when an output or the report cannot be written where it should.
void check_sequence_outputs(CaseFile const& case_file);

/// What an engine does in a step.
struct StepWork {
  std::function<void(int step)> morph;
  std::function<QualityReport()> measure;
  std::function<OutputFields()> fields;  ///< what [output] adds to the step's file
  Coordinates const& before;
  Coordinates const& after;  ///< where morph() leaves the step
};

struct Steps {
  std::vector<StepResult> results;
  bool inverted = false;  ///< an element in some step that was not in the baseline
  StepTimes times;        ///< of all steps together

  /// "3 of 24 steps fall short, the first is step 7: ..."; empty where none does.
  [[nodiscard]] std::string shortfall() const;
  /// The step with the smallest determinant.
  [[nodiscard]] std::size_t worst() const;
};

/// Morphs, measures and writes step after step; the files become visible with finish_sequence().
Steps run_steps(CaseFile const& case_file, Terminal& terminal, StepFiles& files, StepWork const& work);

/// What is said of a sequence around its table of steps.
struct SequenceReport {
  std::function<nlohmann::json()> json;  ///< of the worst step; called when a report is wanted
  std::string head;                      ///< above the table
  std::string worst;                     ///< below it: quality of the worst step, times
  std::vector<Shortfall> const& shortfalls;
  std::string what_to_change;           ///< tables of the case file that may help where elements are inverted
  std::function<Diagnosis()> diagnose;  ///< of the worst step; called when nothing is written
};

/// Writes report and files, unless steps have inverted elements and the case file does not want those; says what was done. Returns
/// the exit status.
int finish_sequence(CaseFile const& case_file, Terminal& terminal, StepFiles& files, Steps const& steps,
                    SequenceReport const& report);

}  // namespace gridmorph::cli
