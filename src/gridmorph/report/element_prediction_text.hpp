// What a plan is predicted to make of elements, for people and programs.
#pragma once

#include <gridmorph/morph/element_prediction.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// A line about all elements looked at, then one about each region, that which loses most first.
std::string describe(Mesh const& mesh, ElementPrediction const& prediction);

/// What to be warned of: elements that would be inverted, and relative displacements above the paper's 0.25.
std::vector<std::string> prediction_warnings(Mesh const& mesh, ElementPrediction const& prediction);

/// {"every", "of", "elements", "inverted", "determinant_3x3x3": {"value", "baseline", "element"}, "kept",
/// "minimum_angle_deg", "relative_displacement", "regions": [{"name", ... as above}]}; elements as users know them.
nlohmann::json prediction_json(Mesh const& mesh, ElementPrediction const& prediction);

}  // namespace gridmorph
