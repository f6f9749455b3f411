// The quality report as text for terminals; plain ASCII, no colours, at most 100 columns but for zone names.
#pragma once

#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>

#include <optional>
#include <string>

namespace gridmorph {

/// Near and far field, baseline and (if given) morphed side by side; walls; worst cells; what falls short of the
/// thresholds. A near field or a baseline without cells gets no columns, what was not measured no rows.
std::string format_table(QualityReport const& baseline, std::optional<QualityReport> const& morphed = {},
                         QualityThresholds const& thresholds = {});

/// One line: of how many cells the Jacobian is not positive everywhere, and which is the first that was sound in the
/// baseline. The report must have a certificate.
std::string certificate_text(QualityReport const& report);
/// One line: how many cells were flat in the baseline and are inverted by so little that they count as flat, the worst
/// of them; nothing where there are none.
std::string flat_text(QualityReport const& report);

/// The short table of the paper's Figure 14: largest aspect ratio and smallest 3x3x3 determinant.
std::string format_short_table(QualityReport const& baseline, std::optional<QualityReport> const& morphed = {});

}  // namespace gridmorph
