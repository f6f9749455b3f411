// Pieces of the open faces that are congruent, and the transforms between them. Internal to boundary.
#pragma once

#include <gridmorph/boundary/detail/match_cells.hpp>

#include <optional>

namespace gridmorph::topology {

/// A corner of what is open, as the place to start comparing from.
struct Seed {
  Index cell;
  int face, a, b;
  CellShape shape;
  Index reach = 0;  ///< cells of the open rectangle that it is the corner of, along both directions
};

/// Whether one cell laid on another by a turn has all six distances between corners in common with it.
bool congruent(CellShape const& p, CellShape const& q, Turn turn, double relative);

/// The rigid transform between the largest congruent pieces that hold a pair of seeds, and lie on opposite sides of
/// them; or of parts of those. `budget` counts down the cells that are looked at; none is left: nothing is found any
/// more.
std::optional<RigidTransform> fit_congruent_piece(SurfaceCells const& cells, Seed const& p, Seed const& q, Turn turn,
                                                  double relative, Index& budget);

}  // namespace gridmorph::topology
