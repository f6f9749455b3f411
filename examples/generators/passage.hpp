// The demo passage: one blade-to-blade passage of an axial machine with an O4H mesh, made from analytic geometry.
//
//        periodic (upper)
//   +----------+----------------+----------+      12 pieces in every blade-to-blade section: a ring of four
//   |  inlet   |     upper      |  outlet  |      around the blade, one H piece on each of its sides, four H
//   |  upper   |                |  upper   |      pieces in the corners.
//   +---------- \  ring_upper  / ----------+      axial ->  i      (ring: i runs round the blade, clockwise,
//   |  inlet    ring_le    ring_te outlet  |      span     j              k from the wall outwards)
//   |  middle   /  ring_lower  \   middle  |      pitch up k
//   +----------+ -------------- +----------+
//   |  inlet   |     lower      |  outlet  |
//   |  lower   |                |  lower   |
//   +----------+----------------+----------+
//        periodic (lower)
//
// With a tip gap (BladeTip) the ring goes on over the tip, and an O of four pieces round a core fills the section of
// the blade:
//
//   ring_upper       +-----------------------+       tip_upper      i: round the blade, as in the ring, or
//                   /  \      tip_upper    /  \                       axial in the core
//   ring_le        | tip_le+------------+tip_te |                   k: from the core outwards, or along the
//                  |       |  tip_core  |       |                      pitch in the core
//                   \      +------------+      /      squealer: the core is a pocket; the O is its rim
//   ring_lower       +-----------------------+        groove: tip_le, core and tip_te are one, open to the
//                                                     ring at both ends
//
// Families: blade, hub, case (BCWallViscous), inlet (BCInflow), outlet (BCOutflow); tip, and squealer
// or groove for the floor and the walls of what is cut into the tip. The axis of the machine is x, moved
// by PassageOptions::placement. The mesh generator is algebraic: cost and memory are linear in the nodes.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Radius of an end wall as a function of the axial fraction t (0 inlet, 1 outlet):
///   r(t) = r_inlet + (r_outlet - r_inlet) ((1 - curving) t + curving (3 t^2 - 2 t^3)) + bulge 16 t^2 (1 - t)^2
/// Equal radii: a cylinder; curving 0: a cone; curving 1: axial at both ends.
struct EndWall {
  double inlet_radius = 0.5;
  double outlet_radius = 0.5;
  double curving = 0;
  double bulge = 0;
};

/// One airfoil section in the developed surface (axial, R theta), R(h) the radius of the stacking axis at span fraction
/// h. Circular-arc camber; half thickness sin(phi)/2 (a + b u + c u (1 - u)) with u = (1 - cos phi) / 2 along the
/// camber line: one analytic closed curve with round leading and trailing edge.
struct BladeSection {
  double chord = 0.12;
  double inlet_angle_deg = 40;     ///< camber at the leading edge, from axial
  double outlet_angle_deg = 15;    ///< camber at the trailing edge
  double thickness = 0.08;         ///< at mid chord, in chords
  double leading_radius = 0.006;   ///< in chords
  double trailing_radius = 0.004;  ///< in chords
};

/// Cells along each direction of the topology.
struct PassageCounts {
  int leading_upper = 0, leading_lower = 0;    ///< ring, from the leading edge to the corner on either side
  int trailing_upper = 0, trailing_lower = 0;  ///< ring, from the corner on either side to the trailing edge
  int side = 0;                                ///< along the blade between the corners, the same on both sides
  int layers = 0;                              ///< ring, off the wall
  int upper = 0, lower = 0;                    ///< between ring and periodic
  int inlet = 0, outlet = 0;                   ///< axial
  int span = 0;                                ///< all of it, with the two that follow
  int gap = 0;                                 ///< between tip and case
  int cavity = 0;                              ///< between the floor of a squealer or groove and the tip
  int rim = 0;                                 ///< over the tip, from the core to the contour
};

/// The end of the blade at the case: it reaches it, or there is a gap over a tip that is flat, has a pocket with a rim
/// all round, or a groove between two rails, open at the leading and the trailing edge.
enum class BladeTip { none, flat, squealer, groove };
/// By name. Throws ConfigError that lists them.
BladeTip blade_tip(std::string const& name);
std::string_view name(BladeTip tip);
/// Families of the blade: its sides, its tip, and what is cut into that.
std::vector<std::string> blade_families(BladeTip tip);

struct PassageOptions {
  enum class Layout {
    whole_faces,  ///< 12 zones, with a tip gap 12 per layer and those over the tip: every zone face is one boundary or
                  ///< one interface
    five_zones    ///< ring (closing on itself), inlet, outlet, upper, lower, and five over the tip: interfaces on parts
                  ///< of faces
  };

  Index nodes = 200'000;  ///< wanted, all zones together; met within a few percent (at least 10,000)
  int blades = 36;        ///< in the wheel; the pitch is 2 pi / blades
  double inlet = -0.16;   ///< axial positions; the blade is stacked on mid chord at 0
  double outlet = 0.20;
  EndWall hub{0.44, 0.47, 1, 0};
  EndWall casing{0.67, 0.65, 1, 0};
  /// Sections at hub, mid span and case; quadratic in span fraction between them.
  std::array<BladeSection, 3> sections{{{0.115, 36, -2, 0.085}, {0.12, 42, 14, 0.070}, {0.125, 48, 30, 0.055}}};
  double ring_thickness = 0.05;  ///< in chords
  /// Height of the first cell off the blade, in chords, and off the end walls, in span. Made larger where the cells
  /// across would otherwise grow by more than these factors from one to the next (small meshes).
  double first_cell = 2e-5;
  double max_growth = 1.5;
  double end_wall_first_cell = 1e-5;
  double end_wall_max_growth = 1.25;
  BladeTip tip = BladeTip::none;
  double tip_gap = 0.015;   ///< in span
  double tip_depth = 0.03;  ///< of the pocket or groove, in span
  double tip_core =
      0.55;  ///< width of pocket or groove (of a flat tip: of the core of its mesh), in thicknesses of the blade
  Layout layout = Layout::whole_faces;
  /// Mirrors the index system (j from case to hub), not the geometry.
  bool left_handed = false;
  /// Puts the machine, built about the x axis, where it is wanted.
  RigidTransform placement;
};

/// First cells of walls and end walls as high as this share of the span, however fast cells then grow.
void set_first_cells(PassageOptions& options, double share_of_span);

/// Cells in every direction for the wanted number of nodes. Throws ConfigError when the options make no passage.
PassageCounts passage_counts(PassageOptions const& options);

/// The mesh. Coincident nodes of different zones are bit-identical; the upper periodic nodes are the lower ones,
/// rotated; hub and case nodes lie on their surface to round-off. With a gap, tip and floor lie at constant span
/// fraction. Right-handed unless asked otherwise. Throws ConfigError when the options make no passage, naming every
/// option that is wrong.
Mesh make_passage(PassageOptions const& options);

}  // namespace gridmorph
