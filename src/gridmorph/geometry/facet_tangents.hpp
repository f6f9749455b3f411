// Tangents at the ends of the edges of a discrete surface, and normals at the corners of its facets.
#pragma once

#include <gridmorph/geometry/facet_topology.hpp>

#include <array>
#include <vector>

namespace gridmorph {

struct FacetTangents {
  std::vector<Vec3> normals;  ///< unit; one for every fan: facets about a point without a rim or crease between them
  std::vector<std::array<int, 4>> normal_of_corner;  ///< per facet
  std::vector<Vec3>
      bends;  ///< [2 edge + end]: (length times tangent - chord) / 3, seen from that end (facet_patch.hpp)

  explicit FacetTangents(FacetTopology const& topology);
};

}  // namespace gridmorph
