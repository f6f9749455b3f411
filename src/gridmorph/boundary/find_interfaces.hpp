// Finds 1-to-1 interfaces and periodicity by matching points, for meshes whose files have none.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct MatchOptions {
  /// Largest distance between nodes that count as the same one, relative to the smallest edge of the face cells they
  /// belong to (0 < tolerance <= 0.25). Round-off of the coordinates, in the precision of their file, is always
  /// allowed.
  double tolerance = 0.01;
  bool periodic = true;  ///< also look for copies that a translation or rotation maps onto each other
};

struct FoundInterfaces {
  std::vector<Interface1to1> interfaces;  ///< each stored from one side; rectangles, in a fixed order
  std::vector<std::string> notes;         ///< what was decided on the way
  double mismatch = 0;                    ///< largest distance of matched nodes, after the periodic transform [length]
};

/// Matches the face cells that no patch and no interface claims, cell against cell: four corners within the tolerance,
/// in any of the eight orientations, and zones on opposite sides. What matches becomes rectangles with one index map
/// each, so interfaces on parts of faces, of a zone with itself and across collapsed edges come out as they are; cells
/// collapsed to lines are left open.
///
/// Periodicity: the corners of what is still open propose translations, then rotations (from the largest piece around
/// them that is congruent cell by cell, fitted by least squares); a proposal is a remark, or a pair where it is
/// plausible for a machine: whole, sizeable sides at the two ends of the passage, a whole number of sectors about one
/// axis, no translation between planes while other faces are open (the rules are in detail/periodic_faces.hpp). Two
/// planes of a mesh of one cell layer are never taken as periodic. Where a rotation is taken, translations are not.
///
/// Cost: O(surface cells) for interfaces, the same again for each proposal that is tried.
FoundInterfaces find_interfaces(Mesh const& mesh, MatchOptions const& options = {});

}  // namespace gridmorph
