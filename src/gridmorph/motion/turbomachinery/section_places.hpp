// Where points of a blade or wing are on its sections.
#pragma once

#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/turbomachinery/section_geometry.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

/// The sections of the patches of one rule, and what a point is to them. A function of the position alone.
class SectionPlaces {
 public:
  /// Kind, span and flow of `rule` count, its tables do not. Throws MotionError when the sections cannot be made. Cost
  /// O(nodes log nodes).
  SectionPlaces(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
                std::vector<int> const& patches, SlipSurfaces const& surfaces, std::vector<std::string>& notes);

  /// The blade whose camber line is nearest, and the point as that blade sees it.
  struct Nearest {
    SectionGeometry const* blade = nullptr;
    ChordLine line;
    ChordPoint point;
  };
  /// The blade nearest to a point. Cost: O(log sections), times the blades of the rule.
  [[nodiscard]] Nearest nearest(SectionPoint const& p) const;

  [[nodiscard]] SectionFrame const& frame() const { return *frame_; }
  /// Whether both sides of every blade are there.
  [[nodiscard]] bool have_camber() const;

  /// The place of a point on the sections. Cost as nearest().
  [[nodiscard]] SurfacePlace at(Vec3 const& point) const;

 private:
  std::unique_ptr<SectionFrame> frame_;
  std::vector<SectionGeometry> blades_;
};

}  // namespace gridmorph
