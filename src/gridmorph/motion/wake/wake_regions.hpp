// Regions that are wakes, found from the blades before them.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/motion/motion.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The regions, with `holds` for those that are wakes: 0 <= behind <= length and |across| <= width / 2 of WakePlaces.
/// `motion`: what rules say of the patches of the mesh, with or without regions. `notes` gets what is found on the way.
/// Throws MotionError naming every region whose walls have no sections. Cost O(nodes of the walls, log).
std::vector<InnerRegion> locate_wakes(std::shared_ptr<Boundary const> const& boundary, ResolvedMotion const& motion,
                                      std::span<InnerRegion const> regions, std::vector<std::string>& notes);

/// Whether any of them is a wake.
bool have_wakes(std::span<InnerRegion const> regions);

/// The motion without regions, and without what its rules say of them alone: what can be resolved before regions are
/// patches of the mesh.
Motion without_regions(NamedBoundary const& boundary, Motion motion);

}  // namespace gridmorph
