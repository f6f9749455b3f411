// One inflate rule, evaluated: where each node of its patches goes.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/inflation/surface_offset.hpp>
#include <gridmorph/motion/motion.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class InflateMotion {
 public:
  /// Throws MotionError where the surface has no normal, the height is not finite or too large. `name` begins its
  /// messages and notes. Cost O(nodes log nodes).
  InflateMotion(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& patches,
                InflateRule const& rule, std::shared_ptr<SlipSurfaces const> const& slip, std::string const& name,
                std::vector<std::string>& notes);

  /// The motion by another height on the same surface. Cost O(nodes).
  InflateMotion(InflateMotion const& other, InflateRule const& rule, std::string const& name);

  /// Displacement of nodes of the patches, found by their baseline position. Throws MotionError for other points.
  void displacement(std::span<Vec3 const> points, std::span<Vec3> out) const;

 private:
  /// What does not depend on the height.
  struct Ground {
    std::shared_ptr<SlipSurfaces const> slip;
    PatchSurface surface;
    SurfaceOffset offset;
    std::vector<SurfacePlace> places;  ///< per vertex
  };
  void raise(InflateRule const& rule);

  std::shared_ptr<Ground const> ground_;
  std::string name_;
  std::vector<double> height_;      ///< per vertex
  std::vector<Vec3> displacement_;  ///< per vertex
};

}  // namespace gridmorph
