// What documents of wheels print.
#pragma once

#include <gridmorph/run/run_document.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

/// One line per row of zones and per passage, the certificate, seams, clearances.
std::string wheel_text(MorphedWheel const& wheel, QualityReport const& baseline);
nlohmann::json wheel_json(MorphedWheel const& wheel);
/// One line per passage: the largest displacement and the worst of all steps; clearances. passages: their blades.
std::string passages_over_time_text(std::vector<SequenceStep> const& steps, std::vector<PassageResult> const& passages);
nlohmann::json passages_over_time_json(std::vector<SequenceStep> const& steps);

/// Passages with what is told of each; the worst one has most cells inverted, then the smallest determinant.
SequenceStep wheel_step(double time, std::vector<PassageResult> const& passages);
/// Which of two steps is the worse one, by their worst passages.
bool is_worse(SequenceStep const& a, SequenceStep const& b);
/// Number of the passage whose cells came out worst, by badness_of().
std::size_t worst_passage(std::vector<PassageResult> const& passages);

/// "passage 3: ...", of all passages.
std::vector<std::string> failures_of(std::vector<PassageResult> const& passages);
/// "step 3, passage 2: ...", of all steps, as far as one can read them.
std::vector<std::string> failures_of(std::vector<SequenceStep> const& steps);

}  // namespace gridmorph::cli
