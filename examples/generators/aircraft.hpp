// A transport aircraft, one half of it beside its symmetry plane, in several hundred blocks: the kind of mesh of the
// paper's Figure 9.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

struct AircraftOptions {
  Index nodes = 500'000;     ///< about as many, those on the faces of zones counted in each of them (100'000 to 1e9)
  double first_cell = 2e-4;  ///< height of the first cell on walls, in metres (1e-6 to 0.02)
  bool oriented =
      false;  ///< all zones with i, j, k as they were made, instead of turned and mirrored each in its own way
};

/// The mesh: x to the rear, y along the right wing, z up, in metres; fuselage of 36.3, half span 17.1, far field about
/// 170 away. Every zone face is joined with others, or has a patch with one of the families fuselage, wing, aileron,
/// htail, vtail, nacelle (BCWallViscous), symmetry (y = 0) and farfield.
///
/// A lattice of 10 x 8 x 9 cells, each of them a block with straight edges (H), from which cells are left out for the
/// bodies. Between what was left out and the body inside there is a layer of blocks (O), one for each face of a cell
/// left out; its lines are straight from the body to the lattice, gathered at the body. Bodies are given as the
/// surfaces of boxes: caps and tips are round like the faces of a cube projected onto a ball, so that where three
/// blocks meet on a wall their angles are about 120 degrees. Throws ConfigError when options are out of range. Few
/// nodes with thin first cells give layers that grow fast. n log n in the nodes on faces of zones, linear in the
/// others.
Mesh make_aircraft(AircraftOptions const& options);

}  // namespace gridmorph
