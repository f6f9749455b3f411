// One look at all coordinates of a mesh: the box they fill, and whether they are numbers.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Larger coordinates are damage, or marks of nodes that were left out: squares of their distances leave the range of
/// numbers.
inline constexpr double coordinate_limit = 1e100;

struct MeshExtent {
  Vec3 low, high;      ///< corners of the bounding box; of the finite values only
  bool finite = true;  ///< every x + y + z is finite (coordinates so large that their sum is not are of no use either)

  /// Whether every coordinate can be computed with: finite, and no larger than coordinate_limit.
  [[nodiscard]] bool usable() const;
  /// Diagonal of the box; 0 for a mesh without nodes.
  [[nodiscard]] double size() const;
};

/// Whether a point can be computed with, as MeshExtent::usable() says it.
bool is_usable(Vec3 const& p);

/// One pass at memory speed (24 bytes per node); the result does not depend on the number of threads.
MeshExtent extent_of(HostInstance const& host, Coordinates const& coordinates);
inline MeshExtent extent_of(Coordinates const& coordinates) { return extent_of(HostInstance(), coordinates); }

}  // namespace gridmorph
