// How exactly the coordinates of a mesh are known: what every tolerance that compares places or displacements refers to.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph {

/// One unit in the last place of a zone's largest coordinates [length]. That of single precision where the file keeps them so, or where
/// a file of double precision holds nothing else (converted ones); that of the last decimal where a text file has 6 to 12 digits;
/// of double precision otherwise. Looks at some two hundred nodes.
double coordinate_resolution(Mesh const& mesh, int zone);
/// Of every zone, single precision relative to the whole mesh.
std::vector<double> coordinate_resolutions(Mesh const& mesh);
/// The coarsest of all zones.
double coordinate_resolution(Mesh const& mesh);

/// How far apart nodes may be that are one: `share` of a size, or what rounding makes of it where that is more. Both nodes are rounded,
/// and the transform between periodic ones is fitted to rounded nodes.
inline double place_tolerance(double share, double size, double resolution) {
  constexpr double roundings = 9;
  return std::max(share * size, roundings * resolution);
}

/// How close nodes must be to count as one by default: 1e-8 of the mesh size; 1.1e-6 in single precision.
inline double coincidence_tolerance(double mesh_size, double resolution) {
  return place_tolerance(1e-8, mesh_size, resolution);
}

/// How much displacements may differ that one rule gives one place: it is asked at rounded places, and displacements of neighbours
/// differ by no more than their distance or little more.
inline double displacement_tolerance(double share, double mesh_size, double resolution) {
  constexpr double roundings = 4;
  return std::max(share * mesh_size, roundings * resolution);
}

}  // namespace gridmorph
