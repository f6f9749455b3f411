// Finds the surface of every patch that slips.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/motion.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// The surfaces of all slip rules and constrained free rules, shared between the patches that lie on one surface: a hub
/// split over several zones is one profile, while hub and case under one rule are two.
struct SlipSurfaces {
  std::vector<SlipSurface> surfaces;
  std::vector<int> of_patch;  ///< per Mesh::patches, -1 for patches that do not slip

  /// Throws one MotionError that names every patch without a usable surface. Cost O(n log n) in the patches' nodes.
  SlipSurfaces(Boundary const& boundary, ResolvedMotion const& motion, std::vector<std::string>& notes);
};

}  // namespace gridmorph
