// Periodic connections of open faces: pieces of these that are congruent, the rigid transforms that this proposes,
// which of them map open face cells onto open face cells, and which of those are the periodicity of a machine and not
// chance. Internal to boundary.
#pragma once

#include <gridmorph/boundary/detail/match_cells.hpp>
#include <gridmorph/kernels/box_tree.hpp>

#include <optional>
#include <string>
#include <vector>

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

/// Corners of the open parts of faces, by their smallest edge; of very many the largest parts', with a note.
std::vector<Seed> find_seeds(SurfaceCells const& cells, std::vector<std::string>& notes);

/// Translations that lay a seed on another, a few dozen at most: those that most pairs of seeds agree on first. `box`
/// holds the mesh.
std::vector<RigidTransform> propose_translations(SurfaceCells const& cells, std::vector<Seed> const& seeds,
                                                 Box const& box, double relative);

/// Rotations that lay a piece of the open faces around a seed on one around another, likewise.
std::vector<RigidTransform> propose_rotations(SurfaceCells const& cells, std::vector<Seed> const& seeds, Box const& box,
                                              double relative, std::vector<std::string>& notes);

struct PeriodicMatch {
  RigidTransform transform;  ///< from the cells to the others
  bool rotation = false;
  Vec3 direction, origin;  ///< of the axis of a rotation, unit direction
  double angle_rad = 0;    ///< right-handed about the direction, positive
  std::vector<CellPair> pairs;
};

/// Proposes and tries transforms, translations first; the cells of those that match are claimed. At most a few dozen
/// are tried.
std::vector<PeriodicMatch> find_periodic(SurfaceCells& cells, double relative, std::vector<std::string>& notes);

/// The transform as a rotation about an axis; nothing when it is a translation, or moves points along its axis by more
/// than `tolerance`.
std::optional<PeriodicMatch> as_rotation(RigidTransform const& t, double tolerance);

struct Judgement {
  bool taken = false;
  std::string why;  ///< not taken: the reason, for a remark
};

/// One per match. A pair of sides counts when
/// - it is sizeable: each side has a fiftieth of the open area or more, and few of its edges run through open surface
/// that goes
///   on smoothly (a part of a face is whole where it ends at a patch, an interface, a corner or along few lines);
/// - the sides lie on both ends of the passage: the way from one to the other leads into the mesh at the start and out
/// of it at
///   the end, and they are not parts of one plane;
/// - a rotation is a whole number of times in a full turn, and the mesh nowhere lies much nearer to the axis or further
/// away
///   than the sides do (a cube turns onto itself too); of several, those about the axis of the largest;
/// - a translation is not between planes, which inlets and outlets, end walls and far fields are too, unless the
/// boundary that is
///   declared leaves nothing else open.
/// The two planes of a mesh of one cell layer do not count as open area. `open`: for each cell whether it was open
/// before the matches took theirs. Cost: O(surface cells).
std::vector<Judgement> judge(SurfaceCells const& cells, std::vector<PeriodicMatch> const& matches,
                             std::vector<std::uint8_t> const& open);

}  // namespace gridmorph::topology
