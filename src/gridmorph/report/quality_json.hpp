// The quality report as JSON, with the formulas of what it reports.
#pragma once

#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/shortfalls.hpp>

#include <nlohmann/json_fwd.hpp>

#include <optional>

namespace gridmorph {

/// One report: {"near_field": {"cells", "inverted", ..., "measures": {"aspect_ratio": {"min", "mean", "max", "worst":
/// {"value", "zone", "cell": [i, j, k]}}, ...}}, "far_field": ..., "walls": {"nodes", "first_height", ..., "groups":
/// {name: the same per group}}}. Indices are 1-based; values without bound are null.
void to_json(nlohmann::json& json, QualityReport const& report);

/// What of it is said of the certificate, which it must have: {"cells", "zero", "negative", "undecided", "holds",
/// "broken": {"cells", "first"}}.
nlohmann::json certificate_json(QualityReport const& report);

/// The whole: "definitions" (formula of each measure), "baseline" (if it has cells), "morphed" (if given),
/// "thresholds", "shortfalls".
nlohmann::json quality_json(QualityReport const& baseline, std::optional<QualityReport> const& morphed,
                            QualityThresholds const& thresholds);

/// [{"severity": "failure" or "warning", "message"}, ...]
nlohmann::json shortfalls_json(std::vector<Shortfall> const& list);

}  // namespace gridmorph
