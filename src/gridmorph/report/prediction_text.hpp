// What a morph is predicted to make of cells, for people and programs.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/morph/prediction.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// A line about all cells looked at, then one about each chain or region, those that come out worst first, ten at most.
std::string describe(Mesh const& mesh, Prediction const& prediction);

/// What to be warned of: cells that would be inverted, and relative displacements above the paper's 0.25.
std::vector<std::string> prediction_warnings(Mesh const& mesh, Prediction const& prediction);

/// {"every", "of", "cells", "inverted", "scaled_jacobian": {"value", "baseline", "zone", "cell": [i, j, k]},
/// "determinant_3x3x3": {"value", "baseline", ... }, "kept", "minimum_angle_deg", "relative_displacement": {"i", "j",
/// "k"}, "chains": [{"stage", "chain", ... as above}]}; cells 1-based. Of elements "elements" for "cells", nothing of
/// the scaled Jacobian, one relative displacement, "regions": [{"name", ...}], and {"value", "element"} with the
/// element as users know it.
nlohmann::json prediction_json(Mesh const& mesh, Prediction const& prediction);

}  // namespace gridmorph
