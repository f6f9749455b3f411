// A sequence of meshes over time from one plan.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/terminal.hpp>

namespace gridmorph::cli {

/// Morphs every step of [sequence] from the baseline, measures it, writes it, prints a table of the steps and the quality
/// of the worst one, and writes the report. Nothing is written when a step has cells inverted that were not in the baseline,
/// unless the case file says so. Returns done or falls_short; throws ConfigError before any work when an output cannot be
/// written where it should.
int morph_sequence(CaseFile const& case_file, Terminal& terminal);
/// The same for an unstructured mesh, with one file per step.
int morph_unstructured_sequence(CaseFile const& case_file, Terminal& terminal);

}  // namespace gridmorph::cli
