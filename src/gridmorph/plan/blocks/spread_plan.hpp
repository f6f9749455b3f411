// Finalize, planned: which nodes are put back on their slip surfaces, and along which lines the correction is spread.
#pragma once

#include <gridmorph/plan/blocks/gaps.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>

namespace gridmorph {

/// Number of each patch's slip surface in `surfaces`, which it fills; -1 for patches that do not slip.
std::vector<int> slip_surface_numbers(std::size_t n_patches, BoundaryMotion const& motion,
                                      std::vector<SlipSurface>& surfaces);

/// Fills plan.spreads. Every block face on a slip patch starts a chain that runs through all blocks to
/// the opposite boundary, or as far as the chains of its rule stay side by side: what leaves the chains sideways into
/// other blocks must not move. Rules whose chains are the same from end to end (hub and case) share one pass; other
/// rules have passes of their own, in their order. Chains across gaps (gaps.hpp) end at the plane of the tip and share
/// the correction evenly, law linear; those from elsewhere end before a gap layer. `given`: entities whose displacement
/// the motion rules give.
void plan_spreads(PlanContext const& context, ResolvedMotion const& motion, std::vector<int> const& surface_of_patch,
                  Known const& given, Gaps const& gaps, Plan& plan);

}  // namespace gridmorph
