// Morphing a case file and writing its results, shared by `morph` and `demo`.
#pragma once

#include <gridmorph/app/cli/terminal.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph::cli {

/// "determinant_2x2x2" -> "Determinant2x2x2", as solution fields of CGNS files are called.
std::string field_name(Measure measure);
FieldUnit field_unit(Measure measure);
/// What [output] adds to the output mesh.
OutputFields output_fields(CaseFile const& case_file, MorphResult const& result);
/// The report, less the name of the output.
nlohmann::json report_json(CaseFile const& case_file, MorphResult const& result);
/// Stages, quality tables and times for the terminal.
std::string format_result(CaseFile const& case_file, MorphResult const& result);
/// Cells turned inside out that were sound in the baseline.
Index newly_inverted(QualityReport const& quality);

/// Morphs, writes mesh and report, prints the quality table. Returns done or falls_short. Throws ConfigError before any
/// work when an output cannot be written where it should.
int morph_and_write(CaseFile const& case_file, Terminal& terminal);

}  // namespace gridmorph::cli
