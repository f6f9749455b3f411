// How far nodes ended from the surface that they were to reach.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <string>
#include <string_view>

namespace gridmorph {

/// Distances of the nodes of one target rule from their target, lengths in units of the mesh: from their own point
/// where the mapping is node for node, otherwise from the target's facets.
struct TargetReach {
  std::string description;  ///< of the rule
  TargetRule::Mapping mapping = TargetRule::Mapping::nodes;
  Index nodes = 0;
  double max = 0, rms = 0;
  Index worst_node = -1;  ///< where max is
};

/// The name of a mapping in case files and reports: "nodes", "sections", ...
std::string_view to_string(TargetRule::Mapping mapping);

}  // namespace gridmorph
