// How long each step of a morph took, for the terminal and for JSON.
#pragma once

#include <gridmorph/core/index.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct StepTime {
  std::string step;  ///< "read", "topology", ...
  double seconds = 0;
  bool every_node = false;  ///< its work grows with the nodes of the volume, so nodes per second mean something
};

using StepTimes = std::vector<StepTime>;

/// One row per step and their sum: seconds, share of the sum, nodes per second where every node is touched.
std::string format_times(StepTimes const& times, Index nodes);

/// {"nodes": ..., "steps": [{"step", "seconds", "nodes_per_second" (null where it means nothing)}, ...],
/// "total_seconds":
/// ...}.
nlohmann::json times_json(StepTimes const& times, Index nodes);

}  // namespace gridmorph
