// Which chart a mesh's outer boundary asks for.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/elements/chart.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph::detail {

/// Area of a boundary face, as triangles around its first corner; in 2-D the length of an edge.
double boundary_face_size(Mesh const& mesh, BoundaryFaces const& faces, Index face);

/// A chart with the share of the outer boundary's area that lies on its sides, to 2 % of their distance.
struct FittedDomain {
  ChartedDomain domain;  ///< sides the mesh ends on `stand`
  double share = 0;
  std::vector<std::int8_t> side_of_face;  ///< per boundary face 2 coordinate + (1: high side); -1: on none
};

/// The box along x, y and z, unless less than four fifths of the outer boundary lie on its sides and a fifth more on
/// those of another chart: a box between surfaces, each coordinate in its turn the one that others limit, or an annular
/// sector between hub and case about one of `axes`, a disc, its half or quarter across x, y or z. A side of the plain
/// box counts where half of it is boundary. `moving`: per boundary face, whether it is of a moving wall: these count
/// only where they lie on sides. No sector is taken that holds its axis or goes most of the way round it, and no chart
/// whose sides come nearer to one another than two fifths of what is usual at more than 4 % of its knots; at so few
/// (ends of the mesh that are no planes cut sides off there) they are taken to be as far apart as beside them. Cost:
/// linear in boundary faces.
FittedDomain fit_domain(HostInstance const& host, Mesh const& mesh, BoundaryFaces const& boundary,
                        std::span<std::uint8_t const> moving, std::span<Axis const> axes);

}  // namespace gridmorph::detail
