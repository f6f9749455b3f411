// One blade row: how inlet, exit and periodics take up the motion of its blade.
#pragma once

#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/turbomachinery/annulus.hpp>
#include <gridmorph/motion/turbomachinery/blade_sections.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The frame of the row that holds the blades: about the axis, or that of a linear cascade where its periodic
/// connections are translations across the axis (one direction; where there are several, that of the connections which
/// follow a blade), towards the positive side of the coordinate that changes most; its flow goes along the axis, or,
/// where that stands on a plane mesh, across the pitch in the plane towards the positive side likewise. Without
/// translations such a mesh has its row in the plane, around the axis. Throws MotionError when a translation runs along
/// the axis or their directions differ.
CylindricalFrame frame_of_row(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& blades);

/// Hub, case and the coordinates between them of the row that holds the blades. Keeps pointers to `surfaces`.
Annulus annulus_of_row(Boundary const& boundary, SlipSurfaces const& surfaces, CylindricalFrame const& frame,
                       std::vector<int> const& blades);

/// Boundary::transform() of the periodic connections of its zones.
std::vector<RigidTransform> periodic_transforms_of_row(Boundary const& boundary, std::vector<int> const& blades);

/// Motion of the surfaces around one blade row. Only axial position and radius of a point enter, as position along the
/// flow path and across it (see Annulus), and the displacement is turned to the point: copies of a point, turned about
/// the axis, get copies of its displacement.
class RowMotion {
 public:
  /// Displacement of the nodes of a patch that has a direct rule, in patch_points order.
  using PatchDisplacement = std::function<void(int patch, std::span<Vec3 const>, std::span<Vec3>)>;

  /// Throws MotionError when the blade's sections cannot be made or a slide patch lies beside the blade.
  RowMotion(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& blades,
            SlipSurfaces const& surfaces, PatchDisplacement const& displacement, std::vector<std::string>& notes);

  /// What a node of inlet or exit is displaced by: turned by the angle of the leading edge (upstream of mid-chord) or
  /// trailing edge at this span.
  [[nodiscard]] Vec3 slide(Vec3 const& point) const;
  /// Whether a patch is of the blade, and its sections were cut from facets: then nodes of the blade have their motion
  /// from the blade's own rule, which the sections meet but for the facets.
  [[nodiscard]] bool gives_way_to(int patch) const;
  /// Whether a point lies before mid-chord, along the flow.
  [[nodiscard]] bool is_upstream(Vec3 const& point) const;
  /// What a node of periodic sides is displaced by: mid-camber motion between the edges, linear taper along the flow
  /// path to the ends of the row. Between known end walls the span fraction is kept as far as the blade keeps its own;
  /// where the blade leaves the walls, so do nodes on the walls, and finalize puts both back alike. Between the end of
  /// a blade and a wall that it does not reach, what leads off the span fraction falls to nothing at the wall.
  [[nodiscard]] Vec3 follow(Vec3 const& point) const;

 private:
  /// Where the taper ends: the inlet or the exit.
  struct End {
    std::optional<RevolutionProfile> m_of_span;  ///< "radius" is the position along the flow, "axial" the span fraction
    double m = 0;                                ///< when there is no such function
    bool slides = false;
    std::shared_ptr<BladeSections const> slides_with;  ///< another blade of the row; null: this one
    [[nodiscard]] double at(double span) const { return m_of_span ? (*m_of_span)(span) : m; }
  };

  [[nodiscard]] End find_end(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& blades,
                             int side, PatchDisplacement const& displacement) const;
  /// Whether blades belong to the row: the same patches or some of them, or others beside them (splitters).
  [[nodiscard]] bool is_same_row(Boundary const& boundary, std::vector<int> const& blades,
                                 std::vector<int> const& others) const;
  /// The outermost position along the flow of any node of the row.
  [[nodiscard]] double outermost(Boundary const& boundary, int side) const;
  [[nodiscard]] CylindricalMotion taper(End const& end, FlowPosition const& at, double edge_m,
                                        double chord_fraction) const;
  /// Components of the motion (see Annulus::components).
  [[nodiscard]] CylindricalMotion follow_motion(FlowPosition const& at) const;
  /// The motion of the camber line at a span fraction (of the nearest section, beyond the blade), tapered beyond its
  /// edges.
  [[nodiscard]] CylindricalMotion along_camber(FlowPosition const& at) const;
  /// How much of what leads off its span fraction is left between the end of a blade and a wall that it does not reach:
  /// falls to nothing at the wall.
  [[nodiscard]] double share_over_gap(double h) const;

  std::vector<int> blades_;  ///< ascending
  CylindricalFrame frame_;
  std::vector<bool> row_zones_;
  Annulus annulus_;
  BladeSections sections_;
  double middle_;  ///< of the blade along the flow: what lies before it is upstream
  End inlet_, exit_;
};

}  // namespace gridmorph
