// An unstructured mesh with its plan, on the way from a case file to results: what single morphs and sequences share.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/terminal.hpp>
#include <gridmorph/app/cli/unstructured_mesh.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct UnstructuredRun {
  LoadedMesh loaded;
  UnstructuredOptions options;
  std::optional<PreparedUnstructured> prepared;
  std::optional<Coordinates> background;  ///< morphed
  QualityReport before;                   ///< without cells where only a verdict was asked for
  std::vector<std::string> notes;
  StepTimes times;

  /// What depends on the morphed coordinates.
  struct Result {
    Coordinates morphed;
    QualityReport after;
    OutputFields fields;  ///< what [output] adds to the output mesh
    std::vector<Shortfall> shortfalls;
  } result;
};

/// Reads and plans; the offset of the wrap reckons with all steps of a sequence.
void read_and_plan(CaseFile const& case_file, Terminal& terminal, UnstructuredRun& out);

/// Regions and walls, for the morphed mesh or the baseline.
UnstructuredQualityInput<Kokkos::HostSpace> quality_of_baseline(UnstructuredRun const& run);
UnstructuredQualityInput<Kokkos::HostSpace> quality_of_morphed(UnstructuredRun const& run);
/// Unless a verdict is all that is wanted.
void measure_baseline(CaseFile const& case_file, UnstructuredRun& out);
/// Measures what the morphed coordinates give: quality, fields and what falls short of it, against the baseline measured before.
void measure_result(CaseFile const& case_file, UnstructuredRun& out);

/// What came of morphing in steps.
struct TriedSteps {
  std::string text;  ///< how many elements were inverted in one step, and in how many are left; empty: not tried
  std::vector<std::string> notes;  ///< numbers of steps that could not be planned
};

/// Where the result has elements inverted: the same displacement of the plan's known nodes in 2, 3, ... steps, up to [guard] steps,
/// until none is; the best stays the result. Not with a background mesh of the user's.
TriedSteps try_steps(CaseFile const& case_file, UnstructuredRun& out, std::vector<Vec3> const& displacement,
                     Terminal& terminal);

/// Near field, layers and background mesh as the report has them.
nlohmann::json plan_json(PreparedUnstructured const& prepared);
/// The report, less the name of the output.
nlohmann::json report_json(CaseFile const& case_file, UnstructuredRun const& run);
/// Near field, layers and background mesh in two lines.
std::string regions_text(PreparedUnstructured const& prepared);
/// Quality tables and times.
std::string format_result(CaseFile const& case_file, UnstructuredRun const& run);

}  // namespace gridmorph::cli
