#include <gridmorph/core/text.hpp>
#include <gridmorph/plan/trim_note.hpp>

#include <unordered_map>
#include <unordered_set>

namespace gridmorph {

std::optional<std::string> trim_note(Mesh const& mesh, Plan const& plan, std::vector<Vec3> const& boundary) {
  std::unordered_map<Index, std::size_t> slot_of;
  for (std::size_t n = 0; n < plan.boundary_nodes.size(); ++n) slot_of.emplace(plan.boundary_nodes[n], n);
  std::unordered_set<Index> off;
  double worst = 0;
  Index where = 0;
  for (SpreadPass const& pass : plan.spreads)
    for (kernels::SlipEnd const& end : pass.ends) {
      auto const slot = slot_of.find(end.node);
      if (end.tolerance == 0 || slot == slot_of.end()) continue;
      Vec3 const given = boundary[slot->second];
      for (int const s : end.surface) {
        if (s < 0) continue;
        double const d = distance(plan.surfaces[s].view().constrain(mesh.coordinates[end.node], given), given);
        if (d <= end.tolerance) continue;
        off.insert(end.node);
        if (d > worst) {
          worst = d;
          where = end.node;
        }
      }
    }
  if (off.empty()) return std::nullopt;
  return "the given displacement takes " + std::to_string(off.size()) + " nodes off their slip surfaces, most " +
         describe_node(mesh, where) + ", by " + to_text(worst, 3) +
         "; they are put back, and the correction is spread along the span";
}

}  // namespace gridmorph
