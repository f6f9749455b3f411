// Finds the surface of every patch that slips.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/motion.hpp>

#include <map>
#include <string>
#include <vector>

namespace gridmorph {

/// Nodes of a patch and the surface that they slide on, a number in SlipSurfaces::surfaces.
struct SlipPiece {
  int surface = -1;
  std::vector<Index> nodes;
};

/// The surfaces of all slip rules and constrained free rules, shared between the patches that lie on one surface: a hub
/// split over several zones is one profile, while hub and case under one rule are two.
struct SlipSurfaces {
  std::vector<SlipSurface> surfaces;
  std::vector<int>
      of_patch;  ///< per Mesh::patches, -1 for patches that do not slip; of those in pieces the first one's
  std::map<int, std::vector<SlipPiece>>
      pieces;  ///< of patches that lie on several planes, such as both sides of a channel under one name

  /// Throws one MotionError that names every patch without a usable surface. Cost O(n log n) in the patches' nodes.
  SlipSurfaces(Boundary const& boundary, ResolvedMotion const& motion, std::vector<std::string>& notes);
};

}  // namespace gridmorph
