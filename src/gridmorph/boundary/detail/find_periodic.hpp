// Rigid transforms that map open face cells onto open face cells. Internal to topology.
#pragma once

#include <gridmorph/boundary/detail/match_cells.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::topology {

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

}  // namespace gridmorph::topology
