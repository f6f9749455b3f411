// What sequences of structured and of unstructured meshes say of their steps.
#pragma once

#include <gridmorph/casefile/case_file.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

struct StepResult {
  double time = 0;
  double largest_displacement = 0;
  double determinant = 0;  ///< smallest 3x3x3
  std::string place;       ///< of it, for people; empty when nothing was measured
  std::string zone;
  std::vector<int> cell;  ///< 1-based indices; of an unstructured mesh the element's number
  Index newly_inverted = 0;
};

StepResult step_result(double time, Coordinates const& before, Coordinates const& after, QualityReport const& quality);

/// The step with the smallest determinant.
std::size_t worst_of(std::vector<StepResult> const& steps);

/// Throws ConfigError when an output or the report cannot be written where it should.
void check_sequence_outputs(CaseFile const& case_file);

/// One row per step, of long sequences evenly spaced ones and the worst.
std::string steps_table(std::vector<StepResult> const& steps, std::size_t worst);
nlohmann::json steps_json(std::vector<StepResult> const& steps, std::size_t worst, SequenceOptions const& options);

/// "wrote step_1.cgns ... step_8.cgns" or "wrote series.cgns (8 steps)".
std::string wrote_text(SequenceOptions const& options);
/// Why nothing was written.
std::string refusal_text(SequenceOptions const& options, std::string const& what_to_change);

}  // namespace gridmorph::cli
