// One blade row: how inlet, exit and periodics take up the motion of its blade.
#pragma once

#include <gridmorph/motion/detail/blade_sections.hpp>
#include <gridmorph/motion/detail/cylindrical.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Hub and case of a row, and the span fraction between them.
class Annulus {
 public:
  /// From the slip surfaces of revolution in the row's zones when there are some inside and some outside of the blade;
  /// otherwise from the blade's own range of radii. Keeps pointers to `surfaces`.
  Annulus(SlipSurfaces const& surfaces, std::vector<int> const& candidates, std::vector<MeridionalPoint> const& blade);

  /// Whether both end walls are known: then nodes can be kept on them.
  [[nodiscard]] bool has_walls() const { return !inner_.empty() && !outer_.empty(); }
  /// 0 at the hub, 1 at the case.
  [[nodiscard]] double span(MeridionalPoint const& p) const;
  /// Distance from hub to case through p.
  [[nodiscard]] double height(MeridionalPoint const& p) const;
  /// How much the radius changes when the axial position does and the span fraction does not. Exactly zero for zero,
  /// and where the end walls are not known.
  [[nodiscard]] double radius_change(MeridionalPoint const& p, double axial) const;

 private:
  using Profiles = std::vector<RevolutionProfile const*>;
  /// The profile whose axial range holds the position, or comes nearest.
  static RevolutionProfile const& at(Profiles const& profiles, double axial);

  Profiles inner_, outer_;
  double r_lo_ = 0, r_hi_ = 0;
};

/// Hub, case and span fraction of the row that holds the blades. Keeps pointers to `surfaces`.
Annulus annulus_of_row(Mesh const& mesh, SlipSurfaces const& surfaces, CylindricalFrame const& frame,
                       std::vector<int> const& blades);

/// Motion of the surfaces around one blade row of an axial machine. Only axial position and radius of a point enter,
/// and the displacement is turned to the point: copies of a point, turned about the axis, get copies of its
/// displacement.
///
/// Everything is a function of the meridional position (along the flow path, across it); for machines with radial parts
/// the meridional coordinates and `Annulus` have to change, the rest stays.
class RowMotion {
 public:
  /// Displacement of the nodes of a patch that has a direct rule, in patch_points order.
  using PatchDisplacement = std::function<void(int patch, std::span<Vec3 const>, std::span<Vec3>)>;

  /// Throws MotionError when the blade's sections cannot be made or a slide patch lies beside the blade.
  RowMotion(Mesh const& mesh, ResolvedMotion const& motion, std::vector<int> const& blades,
            SlipSurfaces const& surfaces, PatchDisplacement const& displacement, std::vector<std::string>& notes);

  /// Inlet and exit: turned by the angle of the leading edge (upstream of mid-chord) or trailing edge at this span.
  [[nodiscard]] Vec3 slide(Vec3 const& point) const;
  /// Periodics: mid-camber motion between the edges, linear taper in axial distance to the ends of the row. Between
  /// known end walls the span fraction is kept as far as the blade keeps its own; where the blade leaves the walls, so do
  /// nodes on the walls, and finalize puts both back alike.
  [[nodiscard]] Vec3 follow(Vec3 const& point) const;

 private:
  /// Where the taper ends: the inlet or the exit.
  struct End {
    std::optional<RevolutionProfile> axial_of_span;  ///< "radius" is the axial position, "axial" the span fraction
    double axial = 0;                                ///< when there is no such function
    bool slides = false;
    [[nodiscard]] double at(double span) const { return axial_of_span ? (*axial_of_span)(span) : axial; }
  };

  [[nodiscard]] End find_end(Mesh const& mesh, ResolvedMotion const& motion, std::vector<int> const& blades,
                             int side) const;
  [[nodiscard]] CylindricalMotion taper(End const& end, double span, double axial, double edge_axial,
                                        CylindricalMotion const& edge) const;
  /// Motion at the axial position of p and span fraction h; its radial part is what goes beyond keeping h.
  [[nodiscard]] CylindricalMotion follow_motion(MeridionalPoint const& p, double h) const;

  CylindricalFrame frame_;
  std::vector<bool> row_zones_;
  Annulus annulus_;
  BladeSections sections_;
  double middle_;  ///< axial middle of the blade: what lies before it is upstream
  End inlet_, exit_;
};

}  // namespace gridmorph
