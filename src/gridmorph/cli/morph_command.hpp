// Morphing a case file and writing its results, shared by `morph` and `demo`.
#pragma once

#include <gridmorph/cli/terminal.hpp>
#include <gridmorph/cli/workflow.hpp>

namespace gridmorph::cli {

/// Morphs, writes mesh and report, prints the quality table. Returns done or falls_short. Throws ConfigError before any
/// work when an output cannot be written where it should.
int morph_and_write(CaseFile const& case_file, Terminal& terminal);

}  // namespace gridmorph::cli
