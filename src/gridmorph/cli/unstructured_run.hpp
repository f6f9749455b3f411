// An unstructured mesh with its plan, on the way from a case file to results: what single morphs and sequences share.
#pragma once

#include <gridmorph/casefile/case_file.hpp>
#include <gridmorph/cli/terminal.hpp>
#include <gridmorph/cli/unstructured_mesh.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/unstructured/unstructured_plan.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

struct UnstructuredRun {
  LoadedMesh loaded;
  UnstructuredOptions options;
  std::optional<PreparedUnstructured> prepared;
  Coordinates morphed;
  std::optional<Coordinates> background;  ///< morphed
  QualityReport before, after;
  std::vector<CellField> quality_fields;  ///< of the morphed mesh, where [output] asks for them
  std::vector<Shortfall> shortfalls;
  std::vector<std::string> notes;
  StepTimes times;

  /// What depends on the morphed coordinates.
  struct Morphed {
    Coordinates morphed;
    QualityReport after;
    std::vector<CellField> quality_fields;
    std::vector<Shortfall> shortfalls;
  };
  [[nodiscard]] Morphed result() const { return {morphed, after, quality_fields, shortfalls}; }
  void take(Morphed r) {
    morphed = std::move(r.morphed);
    after = std::move(r.after);
    quality_fields = std::move(r.quality_fields);
    shortfalls = std::move(r.shortfalls);
  }
};

/// Reads and plans; the offset of the wrap reckons with all steps of a sequence.
void read_and_plan(CaseFile const& case_file, Terminal& terminal, UnstructuredRun& out);

/// Regions and walls, for the morphed mesh or the baseline.
UnstructuredQualityInput<Kokkos::HostSpace> quality_of_baseline(UnstructuredRun const& run);
UnstructuredQualityInput<Kokkos::HostSpace> quality_of_morphed(UnstructuredRun const& run);
/// Measures before and after, and what falls short.
void measure(CaseFile const& case_file, UnstructuredRun& out);
/// The second half, for other coordinates of the same mesh.
void measure_morphed(CaseFile const& case_file, UnstructuredRun& out);

/// What [output] adds to the output mesh; quality as measure() found it.
OutputFields output_fields(CaseFile const& case_file, UnstructuredRun const& run);
/// The report, less the name of the output.
nlohmann::json report_json(CaseFile const& case_file, UnstructuredRun const& run);
/// Near field, layers and background mesh in two lines.
std::string regions_text(PreparedUnstructured const& prepared);
/// Quality tables and times.
std::string format_result(CaseFile const& case_file, UnstructuredRun const& run);

}  // namespace gridmorph::cli
