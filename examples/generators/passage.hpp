// The demo passage: one blade-to-blade passage of an axial machine with an O4H mesh, made from analytic geometry.
//
//        periodic (upper)
//   +----------+----------------+----------+      12 pieces in every blade-to-blade section: a ring of four around the
//   |  inlet   |     upper      |  outlet  |      blade, one H piece on each of its sides, four H pieces in the corners.
//   |  upper   |                |  upper   |
//   +---------- \  ring_upper  / ----------+      axial ->  i      (ring: i runs round the blade, clockwise,
//   |  inlet    ring_le    ring_te outlet  |      span     j              k from the wall outwards)
//   |  middle   /  ring_lower  \   middle  |      pitch up k
//   +----------+ -------------- +----------+
//   |  inlet   |     lower      |  outlet  |
//   |  lower   |                |  lower   |
//   +----------+----------------+----------+
//        periodic (lower)
//
// Families: blade, hub, case (BCWallViscous), inlet (BCInflow), outlet (BCOutflow). The axis of the machine is x, moved
// by PassageOptions::placement. The mesh generator is algebraic: cost and memory are linear in the nodes.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>

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

/// One airfoil section in the developed surface (axial, R theta), R(h) the radius of the stacking axis at span fraction h.
/// Circular-arc camber; half thickness sin(phi)/2 (a + b u + c u (1 - u)) with u = (1 - cos phi) / 2 along the camber
/// line: one analytic closed curve with round leading and trailing edge.
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
  int span = 0;
};

struct PassageOptions {
  enum class Layout {
    whole_faces,  ///< 12 zones: every zone face is one boundary or one interface
    five_zones    ///< ring (closing on itself), inlet, outlet, upper, lower: interfaces on parts of faces
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
  double end_wall_first_cell = 2e-4;
  double end_wall_max_growth = 1.25;
  Layout layout = Layout::whole_faces;
  /// Mirrors the index system (j from case to hub), not the geometry.
  bool left_handed = false;
  /// Puts the machine, built about the x axis, where it is wanted.
  RigidTransform placement;
};

/// Cells in every direction for the wanted number of nodes. Throws ConfigError when the options make no passage.
PassageCounts passage_counts(PassageOptions const& options);

/// The mesh. Coincident nodes of different zones are bit-identical; the upper periodic nodes are the lower ones,
/// rotated; hub and case nodes lie on their surface to round-off. Right-handed unless asked otherwise.
/// Throws ConfigError when the options make no passage, naming every option that is wrong.
Mesh make_passage(PassageOptions const& options);

}  // namespace gridmorph
