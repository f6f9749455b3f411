// The wrecking ball: a ball on a rope that hangs from the jib of a crane, in a box. A hybrid mesh of our own: layers of
// prisms or hexahedra on ball and rope, tetrahedra elsewhere.
//
//        +-----------------------------------------+
//        |                                         |      z up; the end of the rope is at z = rope end, ball centre
//        |            +--------------------+       |      at [0, 0, 0]
//        |            |  crane             |       |
//        |            +-------+-------+    |       |      walls: ball, rope, crane (BCWallViscous)
//        |                    | rope  |    |       |      box_x_min, box_x_max, box_y_min, box_y_max, box_z_max
//        |                    |       |    |       |      (BCFarfield), box_z_min, the ground (BCSymmetryPlane)
//        |                  ( ball )  |    |       |
//        |                            |    |       |      x to the mast of the crane
//        +----------------------------+----+-------+
//
// Around ball and rope lies a tube of square section, wide as 1.8 radii to each side, from 1.8 radii below the ball's
// centre to the jib. Its cells stand on the wall: on lines off the wall through the layers, on curves from there to the
// tube's sides. Lower half of the ball: a cubed sphere; above: rings. The rest of the box is a graded lattice. All
// cells beyond the layers are then cut into tetrahedra, and their nodes shifted. Ball nodes lie on the sphere and rope
// nodes on the cylinder to round-off. Memory and time are linear in the elements.
#pragma once

#include <generators/hybrid_mesh.hpp>

namespace gridmorph {

struct BallOptions {
  Index elements = 500'000;  ///< wanted; met within a few percent (30,000 to 50 million)
  double radius = 1;         ///< of the ball: the unit of all the lengths below
  double rope_radius = 0.15;
  double rope_length = 5;     ///< from the north pole of the ball to the jib
  double jib_height = 1.5;    ///< of the jib's section; it is as wide as the tube
  double mast_distance = 12;  ///< from the rope's axis to the near side of the mast
  double mast_width = 2;      ///< along x
  double behind = 8;          ///< from the rope's axis to box_x_min
  double beyond = 4;          ///< from the far side of the mast to box_x_max
  double beside = 7;          ///< from the rope's axis to box_y_min and box_y_max
  double below = 5;           ///< from the ball's centre to the ground
  double above = 3;           ///< from the top of the jib to box_z_max
  double first_cell = 1e-4;   ///< height of the first cell off ball and rope
  double growth = 1.25;       ///< of a layer over the one below
  int layers = 0;             ///< 0: until they are 0.4 times as high as the ball's faces are long, or 0.2 radii thick
  LayerElements layer_elements = LayerElements::mixed;
  double jitter = 0.12;  ///< of tetrahedra's nodes, in shortest edges at the node; 0 to 0.3
  bool shuffle = true;   ///< numbers nodes and elements at random
};

/// Where the rope hangs from the jib: [0, 0, z]. Lengths times the radius.
double rope_end(BallOptions const& options);

/// The mesh: one zone, patches as above with families of the same names. Throws ConfigError when the options make no
/// such mesh, naming every option that is wrong.
Mesh make_ball(BallOptions const& options);

}  // namespace gridmorph
