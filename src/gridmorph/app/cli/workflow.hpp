// One case file from mesh file to morphed mesh and quality.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/engine.hpp>
#include <gridmorph/app/cli/terminal.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct MorphResult {
  Mesh mesh;  ///< baseline
  Coordinates morphed;
  QualityReport before;  ///< without cells where only a verdict was asked for
  QualityReport after;
  std::vector<Shortfall> shortfalls;  ///< against [guard]
  std::vector<StageResult> stages;    ///< smallest determinant of each
  std::vector<std::string> notes;     ///< defaults taken, mapping distances, facts found on the way
  std::vector<TargetReach> targets;   ///< how far nodes of target rules ended from their target
  StepTimes times;                    ///< read to quality, in order
};

/// A result that has the mesh of the case file and nothing else yet.
MorphResult read_baseline(CaseFile const& case_file);

/// How far the nodes were from the models of `field` rules, and what was left out of these.
void add_mapping_notes(CaseFile const& case_file, std::vector<std::string>& notes);

/// Quality of a mesh before and after a morph: the walls and the near field of a case file.
class QualityMeter {
 public:
  /// `mesh` must outlive the meter.
  QualityMeter(Mesh const& mesh, CaseFile const& case_file, Engine const& engine);
  /// A report without cells where a verdict does: what that needs of the baseline it measures itself.
  [[nodiscard]] QualityReport baseline() const;
  [[nodiscard]] QualityReport morphed(Coordinates const& morphed) const;

 private:
  Mesh const& mesh_;
  QualityInput<Kokkos::HostSpace> input_;
};

/// Reads the mesh, plans, morphs and measures. Throws the errors of all of these; writes nothing.
MorphResult run_morph(CaseFile const& case_file, Terminal& terminal);

/// The kind of the case file's mesh, once no key of the case file is without effect on such a mesh. Throws ConfigError.
MeshKind check_keys(CaseFile const& case_file);

/// Plans and prints the stages and chains of a case file, notes first; as text or as JSON.
void print_plan(CaseFile const& case_file, Terminal& terminal);

/// Quality of a mesh as it is, without a near field, at all its wall patches.
QualityReport measure_mesh(Mesh const& mesh);

/// Patches whose first cells are measured: all walls, and those with a near field.
std::vector<int> measured_walls(Mesh const& mesh, CaseFile const& case_file);

/// A mask of cells as quality takes it.
Kokkos::View<std::uint8_t const*, Kokkos::HostSpace> mask_view(std::vector<unsigned char> const& mask);

/// [guard] as thresholds of the quality report.
QualityThresholds thresholds_of(CaseFile const& case_file);

/// Whether a verdict is all that is wanted of the quality of so many cells.
bool wants_verdict(CaseFile const& case_file, Index cells);

/// "auto", "full" or "fast" of the command line takes the place of the case file's.
void set_quality(CaseFile& case_file, std::optional<std::string> const& mode);

}  // namespace gridmorph::cli
