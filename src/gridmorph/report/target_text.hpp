// How near nodes came to their target, for people and programs.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/target_reach.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// "rule 1 (...): 5248 nodes end on the target: distance rms ..., largest ... at ...".
std::string describe_reach(Mesh const& mesh, TargetReach const& reach);

/// [{"rule", "mapping", "nodes", "distance": {"max", "rms", "worst": {"zone", "node": [i, j, k]}}}], indices 1-based;
/// of elements the number of the node in its file.
nlohmann::json targets_json(Mesh const& mesh, std::vector<TargetReach> const& targets);

}  // namespace gridmorph
