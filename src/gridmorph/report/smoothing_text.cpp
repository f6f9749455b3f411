#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/report/smoothing_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gridmorph {

std::string describe(SmoothingMap const& map) {
  if (map.n_modes == 0) return "the guard moved no node: there is nothing to freeze into the plan";
  return fmt::format(
      "the guard is frozen into the plan: {} nodes move by a linear function of the boundary's displacement, {} of {} "
      "displacements, by {:.3g} at most and within {:.3g} of where the guard had them",
      map.n_moved(), map.n_modes == 1 ? "one mode" : fmt::format("{} modes", map.n_modes), map.n_records,
      map.largest_shift, map.misfit);
}

nlohmann::json frozen_guard_json(SmoothingMap const& map) {
  return {{"displacements", map.n_records},
          {"modes", map.n_modes},
          {"nodes", map.n_moved()},
          {"largest_shift", map.largest_shift},
          {"largest_distance", map.misfit}};
}

}  // namespace gridmorph
