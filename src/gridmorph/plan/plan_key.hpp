// What a plan was made for, as a few numbers: a kept plan is good for the same key only.
#pragma once

#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/options.hpp>

#include <cstdint>

namespace gridmorph {

/// Raised whenever the tables of a plan, their meaning, or what the planner makes of the same mesh and rules change.
inline constexpr std::uint32_t plan_format_version = 2;

/// Hashes are XXH64 over numbers as little-endian bytes, so they do not depend on the machine. They find accidents, not
/// forgeries.
struct PlanKey {
  std::uint32_t format = plan_format_version;
  std::uint64_t structure = 0;    ///< zones, patches, interfaces: names, families, kinds, ranges, periodicity
  std::uint64_t coordinates = 0;  ///< every bit of every node
  std::uint64_t rules = 0;        ///< motion rules without displacement values
  std::uint64_t options = 0;
  Index n_nodes = 0;

  friend bool operator==(PlanKey const&, PlanKey const&) = default;
};

/// Key of the plan that prepare() makes of these. Take it of the mesh as it is *before* prepare(), which completes the
/// patches of the mesh it is given; so the key is the same in the run that plans and in the run that loads.
///
/// Of the motion counts what a plan depends on: axis, selectors, kinds of rules, ranks, slip surfaces, constraints. How
/// far nodes move does not: a RigidRule counts by its name (rule_name()) without its matrix, a FunctionRule by its name
/// without its function and description. Neither do Motion::conformity_tolerance and MotionRule::where.
/// Cost: O(nodes), 24 bytes read per node.
PlanKey plan_key(Mesh const& mesh, Motion const& motion, PlanOptions const& options);

}  // namespace gridmorph
