// First cell height and orthogonality at one node of a wall.
//
//   normal         n = t1 x t2 / |t1 x t2|, t1 and t2 the differences of wall nodes along the two grid directions of the
//                  wall: central inside a wall patch, one-sided on its edges
//   first height   |v . n|, v from the wall node to the next node on the grid line that leaves the wall
//   orthogonality  angle between v and the normal, arccos(|v . n| / |v|): 0 degrees for a perpendicular line
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

struct WallNode {
  double height = 0;
  double orthogonality_deg = 0;
  bool defined = false;  ///< false where the normal or the line vanishes (poles) or a node is not finite
};

/// normal: of the wall, of any length; line: from the wall node to the first inner node.
KOKKOS_INLINE_FUNCTION WallNode wall_node(Vec3 const& normal, Vec3 const& line) {
  using compat::math::acos;
  double const area = norm(normal), length = norm(line);
  WallNode w;
  if (!(area > 0) || !(length > 0) || area - area != 0 || length - length != 0) return w;
  double const projection = dot(line, normal) / area;
  w.height = projection < 0 ? -projection : projection;
  double const cosine = w.height / length;
  constexpr double degrees = 57.295779513082320877;
  w.orthogonality_deg = degrees * acos(cosine < 1 ? cosine : 1.0);
  w.defined = true;
  return w;
}

/// along1, along2: wall tangents of any length; line: from the wall node to the first inner node.
KOKKOS_INLINE_FUNCTION WallNode wall_node(Vec3 const& along1, Vec3 const& along2, Vec3 const& line) {
  return wall_node(cross(along1, along2), line);
}

}  // namespace gridmorph::kernels
