// How exactly the coordinates of a mesh are known: what every tolerance that compares places or displacements refers
// to.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph {

/// What keeps coordinates: floating-point numbers are known relative to their size, decimals of a text file by their
/// last one.
struct CoordinatePrecision {
  double relative = 0;      ///< one unit in the last place of 1
  double last_decimal = 0;  ///< [length]; 0: the file has many
  double extent = 0;        ///< largest coordinate, or what lies between coordinates where that is more [length]

  /// How exactly coordinates up to this size are known [length].
  [[nodiscard]] double at(double size) const { return std::max(relative * size, last_decimal); }
  [[nodiscard]] double resolution() const { return at(extent); }
};

/// The precision of the coordinates of every zone: single precision where the file keeps them so, or where a file of
/// double precision holds nothing else (converted ones); decimals where a text file has 6 to 12 digits; double
/// precision otherwise. `extent` is that of the whole mesh. Looks at some two hundred nodes of each.
std::vector<CoordinatePrecision> coordinate_precisions(Mesh const& mesh);
/// The coarsest precision of all zones.
CoordinatePrecision coordinate_precision(Mesh const& mesh);

/// One unit in the last place of the largest coordinates of the mesh [length], for the coarsest of its zones.
inline double coordinate_resolution(Mesh const& mesh) { return coordinate_precision(mesh).resolution(); }
/// One unit in the last place of the largest coordinates of one zone [length].
double coordinate_resolution(Mesh const& mesh, int zone);

/// How far apart nodes may be that are one: `share` of a size, or what rounding makes of it where that is more. Both
/// nodes are rounded, and the transform between periodic ones is fitted to rounded nodes.
inline double place_tolerance(double share, double size, double resolution) {
  constexpr double roundings = 9;
  return std::max(share * size, roundings * resolution);
}

/// How close nodes must be to count as one by default: 1e-8 of the mesh size; 1.1e-6 in single precision.
inline double coincidence_tolerance(double mesh_size, double resolution) {
  return place_tolerance(1e-8, mesh_size, resolution);
}

/// How much displacements may differ that one rule gives one place: it is asked at rounded places, and displacements of
/// neighbours differ by no more than their distance or little more.
inline double displacement_tolerance(double share, double mesh_size, double resolution) {
  constexpr double roundings = 4;
  return std::max(share * mesh_size, roundings * resolution);
}

}  // namespace gridmorph
