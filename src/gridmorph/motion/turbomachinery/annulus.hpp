// Hub and case of a row, and the coordinates between them: along the flow path, across it.
#pragma once

#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/turbomachinery/wall_curve.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace gridmorph {

/// Where the flow path is axial all along the blade, the coordinates are axial position and radial fraction between hub
/// and case. Where its walls turn towards the radius, they are FlowCoordinates between the curves of hub and case.
class Annulus {
 public:
  /// The end walls of the row, each between the ends of what the row has of it.
  using Walls = std::function<std::vector<WallPiece>()>;

  /// The annulus of a row, from the slip surfaces of revolution in its zones when there are some inside and some
  /// outside of the blade; otherwise from the blade's own range of radii. Keeps pointers to `surfaces`. `walls` is
  /// asked when the flow path turns; without it, the whole candidates are the walls.
  Annulus(SlipSurfaces const& surfaces, std::vector<int> const& candidates, std::vector<MeridionalPoint> const& blade,
          Walls const& walls = {});

  /// Whether both end walls are known: then nodes can be kept on them.
  [[nodiscard]] bool has_walls() const { return turning_ || (!inner_.empty() && !outer_.empty()); }
  /// Whether the flow path turns from axial to radial.
  [[nodiscard]] bool turns() const { return turning_.has_value(); }
  [[nodiscard]] FlowPosition position(MeridionalPoint const& p) const;
  /// position(p).m, also where there is no span, beyond the ends of hub and case.
  [[nodiscard]] double along(MeridionalPoint const& p) const { return turning_ ? turning_->position(p).m : p.axial; }
  /// The span fraction of a point: 0 at the hub, 1 at the case.
  [[nodiscard]] double span(MeridionalPoint const& p) const { return position(p).h; }
  /// Distance from hub to case through p.
  [[nodiscard]] double height(MeridionalPoint const& p) const;

  /// What a displacement of a point at p is for points at other span fractions and along the flow: how far it goes
  /// along the flow path, how far it departs from its span fraction (a length where the path is axial, a fraction where
  /// it turns), and its angle. Exactly zero for zero.
  [[nodiscard]] CylindricalMotion components(MeridionalPoint const& p, CylindricalMotion const& motion) const;
  /// The inverse of components().
  [[nodiscard]] CylindricalMotion motion(MeridionalPoint const& p, CylindricalMotion const& components) const;

 private:
  using Profiles = std::vector<RevolutionProfile const*>;
  /// The profile whose axial range holds the position, or comes nearest.
  static RevolutionProfile const& at(Profiles const& profiles, double axial);
  /// Makes FlowCoordinates of the walls, and checks that the blade lies between them.
  void turn(std::vector<WallPiece> pieces, std::vector<MeridionalPoint> const& blade);
  /// Whether hub or case run across the axis more than along it (a slope of 2) over the blade, or somewhere along it
  /// when the other ends there.
  [[nodiscard]] bool is_steep_along(std::vector<MeridionalPoint> const& blade) const;
  /// Whether the profiles over the axial position of both hub and case reach from end to end of the blade.
  [[nodiscard]] bool spans(std::vector<MeridionalPoint> const& blade) const;
  /// How much the radius changes when the axial position does and the span fraction does not. Exactly zero for zero,
  /// and where the end walls are not known.
  [[nodiscard]] double radius_change(MeridionalPoint const& p, double axial) const;

  Profiles inner_, outer_;
  double r_lo_ = 0, r_hi_ = 0;
  std::optional<FlowCoordinates> turning_;
};

/// Whether patches of this kind are the inlet, the exit or a mixing plane of a row: never its hub or case, also where
/// they slip on a surface of revolution.
bool ends_row(PatchKind kind);

/// Parts of the slip surfaces of end walls that the row's zones have: revolution, meridional, and walls on planes
/// across the axis.
std::vector<WallPiece> walls_of_row(Boundary const& boundary, SlipSurfaces const& surfaces,
                                    std::vector<bool> const& in_row, CylindricalFrame const& frame);

}  // namespace gridmorph
