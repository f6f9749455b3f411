// What is said of a guard that became a linear part of a plan.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph {

struct SmoothingMap;  ///< plan/smoothing_map.hpp

/// A sentence for people: how many nodes move by how many modes, and how far from where the guard had them.
std::string describe(SmoothingMap const& map);

/// "frozen_guard" of reports: {"displacements", "modes", "nodes", "largest_shift", "largest_distance"}.
nlohmann::json frozen_guard_json(SmoothingMap const& map);

}  // namespace gridmorph
