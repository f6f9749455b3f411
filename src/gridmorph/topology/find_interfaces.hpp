// Finds 1-to-1 interfaces and periodicity by matching points, for meshes whose files have none.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct MatchOptions {
  /// Largest distance between nodes that count as the same one, relative to the smallest edge of the face cells they belong to
  /// (0 < tolerance <= 0.25). Round-off of the coordinates, in the precision of their file, is always allowed.
  double tolerance = 0.01;
  bool periodic = true;  ///< also look for copies that a translation or rotation maps onto each other
};

struct FoundInterfaces {
  std::vector<Interface1to1> interfaces;  ///< each stored from one side; rectangles, in a fixed order
  std::vector<std::string> notes;         ///< what was decided on the way
  double mismatch = 0;                    ///< largest distance of matched nodes, after the periodic transform [length]
};

/// Matches the face cells that no patch and no interface claims, cell against cell: four corners within the tolerance, in any of
/// the eight orientations, and zones on opposite sides. What matches becomes rectangles with one index map each, so
/// interfaces on parts of faces, of a zone with itself and across collapsed edges come out as they are; cells collapsed to lines are left open.
///
/// Periodicity: the corners of what is still open propose translations, then rotations (from the largest piece around them that is
/// congruent cell by cell, fitted by least squares); a proposal counts when it maps open cells onto open cells. Two
/// planes of a mesh of one cell layer are never taken as periodic. Geometry alone cannot tell a periodic pair from
/// an inlet and outlet of the same shape: where a rotation is found, translations are dropped with a note, otherwise they are the
/// user's to judge.
///
/// Cost: O(surface cells) for interfaces, the same again for each proposal that is tried.
FoundInterfaces find_interfaces(Mesh const& mesh, MatchOptions const& options = {});

}  // namespace gridmorph
