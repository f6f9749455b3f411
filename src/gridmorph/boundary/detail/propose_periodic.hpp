// Rigid transforms that may map open face cells onto open face cells. Internal to boundary.
#pragma once

#include <gridmorph/boundary/detail/congruent_piece.hpp>
#include <gridmorph/kernels/box_tree.hpp>

#include <string>
#include <vector>

namespace gridmorph::topology {

/// Corners of the open parts of faces, by their smallest edge; of very many the largest parts', with a note.
std::vector<Seed> find_seeds(SurfaceCells const& cells, std::vector<std::string>& notes);

/// Translations that lay a seed on another, a few dozen at most: those that most pairs of seeds agree on first. `box`
/// holds the mesh.
std::vector<RigidTransform> propose_translations(SurfaceCells const& cells, std::vector<Seed> const& seeds,
                                                 Box const& box, double relative);

/// Rotations that lay a piece of the open faces around a seed on one around another, likewise.
std::vector<RigidTransform> propose_rotations(SurfaceCells const& cells, std::vector<Seed> const& seeds, Box const& box,
                                              double relative, std::vector<std::string>& notes);

}  // namespace gridmorph::topology
