#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/report/target_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gridmorph {

std::string describe_reach(Mesh const& mesh, TargetReach const& reach) {
  if (reach.nodes == 0) return reach.description + ": no nodes to measure";
  std::string const from = reach.mapping == TargetRule::Mapping::nodes      ? "their points"
                           : reach.mapping == TargetRule::Mapping::sections ? "the flat facets between target sections"
                                                                            : "the target's facets";
  return fmt::format("{}: {} nodes ended {:.3g} from {} at most (rms {:.3g}), farthest {}", reach.description,
                     reach.nodes, reach.max, from, reach.rms, describe_node(mesh, reach.worst_node));
}

nlohmann::json targets_json(Mesh const& mesh, std::vector<TargetReach> const& targets) {
  nlohmann::json list = nlohmann::json::array();
  for (TargetReach const& reach : targets) {
    nlohmann::json worst = nullptr;
    if (reach.worst_node >= 0) {
      Zone const& zone = mesh.zones[mesh.zone_of(reach.worst_node)];
      worst = {{"zone", zone.name}};
      if (zone.is_block()) {
        Index3 const p = zone.index(reach.worst_node);
        worst["node"] = {p[0] + 1, p[1] + 1, p[2] + 1};
      } else {
        worst["node"] = node_number_in_file(mesh, reach.worst_node);
      }
    }
    list.push_back({{"rule", reach.description},
                    {"mapping", std::string(to_string(reach.mapping))},
                    {"nodes", reach.nodes},
                    {"distance", {{"max", reach.max}, {"rms", reach.rms}, {"worst", worst}}}});
  }
  return list;
}

}  // namespace gridmorph
