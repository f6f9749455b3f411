// One blade row: hub and case with the coordinates between them, the motion of the blade's camber surface, tabulated
// over span and chord, and how inlet, exit and periodics take up the motion of the blade.
#pragma once

#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/turbomachinery/blade_surface.hpp>
#include <gridmorph/motion/turbomachinery/span_table.hpp>
#include <gridmorph/motion/turbomachinery/wall_curve.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Mid-camber motion: the mean of the motions of the blade's sides at equal span fraction and axial chord fraction.
///
/// Sections are taken at evenly spaced span fractions, split at their edges into sides, and each side is tabulated over
/// the chord angle phi, chord fraction = (1 - cos phi) / 2: a rounded leading edge is smooth in phi, while the chord
/// fraction would see a square root. Between table entries: cubic convolution (Keys 1981), C1, third order, exact for
/// zero and linear data.
///
/// An edge is the line where the sides of an H mesh end: there the motion of its nodes is reproduced, so that periodics
/// that meet the blade in that line agree with it to round-off. Where a surface goes around the edge (O and C meshes),
/// it is the most upstream or downstream point of the section, found between grid lines by a parabola.
class BladeSections {
 public:
  /// `motion`: of the nodes, in the components of Annulus. Throws MotionError when the sections have no axial chord or
  /// the spanwise lines have no span in common.
  BladeSections(BladeSurface const& blade, std::vector<CylindricalMotion> const& motion);

  /// Axial positions of leading and trailing edge. Beyond the first and last section: theirs.
  [[nodiscard]] double leading(double span) const { return leading_.at(span)[0]; }
  [[nodiscard]] double trailing(double span) const { return trailing_.at(span)[0]; }

  /// Chord fraction 0 is the leading edge, 1 the trailing edge; clamped to these.
  [[nodiscard]] CylindricalMotion motion(double span, double chord_fraction) const;

  /// How far the motions of the contours' edges are from their mean, which the edges of the row get: nothing but
  /// rounding for one blade, and for copies that move alike; what blunt edges make of two sides.
  struct EdgeSpread {
    double length = 0;  ///< along the flow or the span, in chords
    double angle_rad = 0;
  };
  [[nodiscard]] EdgeSpread edge_spread() const { return edge_spread_; }

  /// The value of BladeSurface::sliced: whether lines were made by cutting facets.
  [[nodiscard]] bool sliced() const { return sliced_; }
  [[nodiscard]] double first_span() const { return span_lo_; }
  [[nodiscard]] double last_span() const { return span_hi_; }
  /// How far any of its lines reaches: beyond the sections where lines end apart, as beside a groove.
  [[nodiscard]] double lowest_span() const { return lowest_; }
  [[nodiscard]] double highest_span() const { return highest_; }
  /// Smallest leading and largest trailing edge position: the blade's axial range.
  [[nodiscard]] double most_upstream() const;
  [[nodiscard]] double most_downstream() const;

 private:
  using Components = std::array<double, 3>;  ///< axial, radial, angle

  [[nodiscard]] Components tabulated(double span, double chord_fraction) const;

  bool sliced_ = false;
  EdgeSpread edge_spread_;
  double span_lo_ = 0, span_hi_ = 0, lowest_ = 0, highest_ = 0;
  int n_sections_ = 0;
  std::vector<Components> motion_;  ///< (n_sections, n_chord), chord fastest
  SpanTable leading_, trailing_;
};

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
  /// The same row where its blades displace by something else: annulus, lines of the blades and ends of the row are
  /// shared. Cost O(nodes of the blades).
  RowMotion(RowMotion const& other, Boundary const& boundary, PatchDisplacement const& displacement);

  [[nodiscard]] CylindricalFrame const& frame() const { return row_->frame; }

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
  /// A blade, whatever it does.
  struct Blade {
    std::vector<int> patches;
    BladeSurface surface;
  };
  /// Where the taper ends: the inlet or the exit.
  struct End {
    std::optional<RevolutionProfile> m_of_span;  ///< "radius" is the position along the flow, "axial" the span fraction
    double m = 0;                                ///< when there is no such function
    bool slides = false;
    std::optional<Blade> slides_with;  ///< another blade of the row; nothing: this one
    [[nodiscard]] double at(double span) const { return m_of_span ? (*m_of_span)(span) : m; }
  };
  /// What of a row does not depend on what its blades do.
  struct Row {
    std::vector<int> blades;  ///< ascending
    CylindricalFrame frame;
    std::vector<bool> zones;
    Annulus annulus;
    Blade blade;
    double middle = 0;          ///< of the blade along the flow: what lies before it is upstream
    std::array<End, 2> ends{};  ///< inlet and exit

    /// With its ends still to be found, by the sections of the blade.
    Row(Boundary const& boundary, ResolvedMotion const& motion, std::vector<int> const& of,
        SlipSurfaces const& surfaces, std::vector<std::string>& notes);
    [[nodiscard]] Blade stitched(Boundary const& boundary, std::vector<int> const& patches,
                                 std::vector<std::string>& notes) const;
    [[nodiscard]] BladeSections sections(Boundary const& boundary, Blade const& blade,
                                         PatchDisplacement const& displacement) const;
    [[nodiscard]] End find_end(Boundary const& boundary, ResolvedMotion const& motion, BladeSections const& sections,
                               int side) const;
    /// Whether blades belong to the row: the same patches or some of them, or others beside them (splitters).
    [[nodiscard]] bool has(Boundary const& boundary, BladeSections const& sections,
                           std::vector<int> const& others) const;
    /// The outermost position along the flow of any node of the row.
    [[nodiscard]] double outermost(Boundary const& boundary, int side) const;
  };

  [[nodiscard]] CylindricalMotion taper(int side, FlowPosition const& at, double edge_m, double chord_fraction) const;
  /// Components of the motion (see Annulus::components).
  [[nodiscard]] CylindricalMotion follow_motion(FlowPosition const& at) const;
  /// The motion of the camber line at a span fraction (of the nearest section, beyond the blade), tapered beyond its
  /// edges.
  [[nodiscard]] CylindricalMotion along_camber(FlowPosition const& at) const;
  /// How much of what leads off its span fraction is left between the end of a blade and a wall that it does not reach:
  /// falls to nothing at the wall.
  [[nodiscard]] double share_over_gap(double h) const;

  void move_ends(Boundary const& boundary, PatchDisplacement const& displacement);

  std::shared_ptr<Row const> row_;
  std::optional<BladeSections> sections_;
  std::array<std::optional<BladeSections>, 2> slides_with_;  ///< of the ends that slide with another blade
};

}  // namespace gridmorph
