// Morphs of blocks whose parts have motions in common, and what came of them.
#pragma once

#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/plan/common_parts.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph::test {

using Map = std::function<Vec3(Vec3 const&)>;

inline FunctionRule moves_as(Map const& map) {
  return function_rule([map](Vec3 const& p) { return map(p) - p; });
}

/// As MorphPlan prepares it.
inline PreparedMorph split(Mesh const& mesh, Motion const& motion, PlanOptions const& options = {}) {
  PreparedMorph prepared = prepare(mesh, motion, options);
  split_common_motions(prepared, [&] { return std::optional(prepared.boundary_displacement()); });
  return prepared;
}

inline Outcome morph_split(Mesh const& mesh, Motion const& motion, PlanOptions const& options = {}) {
  PreparedMorph prepared = split(mesh, motion, options);
  std::vector<Vec3> boundary = prepared.boundary_displacement();
  Morphed morphed = run_plan(Kokkos::DefaultHostExecutionSpace(), mesh, prepared.plan(), boundary);
  return {prepared.mesh, std::move(prepared), std::move(boundary), std::move(morphed)};
}

inline double size_of(Coordinates const& x) {
  Vec3 low = x[0], high = x[0];
  for (Index n = 0; n < x.size(); ++n) {
    low = {std::min(low.x, x[n].x), std::min(low.y, x[n].y), std::min(low.z, x[n].z)};
    high = {std::max(high.x, x[n].x), std::max(high.y, x[n].y), std::max(high.z, x[n].z)};
  }
  return distance(low, high);
}

/// How far nodes are from where a map takes them, in sizes of the mesh that it makes.
inline double distance_from(Outcome const& run, Map const& map) {
  double largest = 0;
  for (Index n = 0; n < run.mesh.n_nodes(); ++n) {
    double const d = distance(run.morphed.position[n], map(run.mesh.coordinates[n]));
    if (!(d <= largest)) largest = d;
  }
  return largest / size_of(run.morphed.position);
}

inline double smallest_determinant(Mesh const& mesh, Coordinates const& x) {
  Kokkos::DefaultHostExecutionSpace const exec;
  std::vector<CellBox> all;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 const n = mesh.zones[z].extent;
    all.push_back({z, {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}});
  }
  auto const baseline = views(mesh.coordinates);
  return min_determinant(exec, mesh, views(x), zone_handedness(exec, mesh, baseline), all).value;
}

inline Index given_changed(Outcome const& run) {
  Index count = 0;
  for (std::size_t k = 0; k < run.boundary.size(); ++k)
    count += same_bits(run.u(run.plan().boundary_nodes[k]), run.boundary[k]) ? 0 : 1;
  return count;
}

}  // namespace gridmorph::test
