// One look at all coordinates of a mesh: the box they fill, whether they are numbers, and whether all of them can
// belong to one mesh.
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

/// Where half of all nodes are.
struct MeshCore {
  Vec3 middle;        ///< median of each coordinate
  double radius = 0;  ///< median distance of nodes from there, of those that are not just there; 0: all are

  /// How many radii a node may be away. Far fields lie 1e3 to 1e5 chords away. What is closer than 1e-8 of a mesh's
  /// size counts as one place, so where a node lies further away than 1e8 radii, half of all nodes are one place.
  static constexpr double limit = 1e8;
  [[nodiscard]] bool is_far(Vec3 const& p) const { return radius > 0 && distance(p, middle) > limit * radius; }
  /// Whether a coordinate of this size is rounded by more than a thousandth of the radius.
  [[nodiscard]] bool is_rounded_away(double largest) const;
};

/// By some thousand nodes, all of which have to be usable.
MeshCore core_of(Coordinates const& coordinates);

/// One pass at memory speed (24 bytes per node); the result does not depend on the number of threads.
MeshExtent extent_of(HostInstance const& host, Coordinates const& coordinates);
inline MeshExtent extent_of(Coordinates const& coordinates) { return extent_of(HostInstance(), coordinates); }

}  // namespace gridmorph
