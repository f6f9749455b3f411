// First cell height and orthogonality at one node of a wall.
//
//   normal         n = t1 x t2 / |t1 x t2|, t1 and t2 the differences of wall nodes along the two grid directions of
//                  the wall: central inside a wall patch, one-sided on its edges
//   first height   |v . n|, v from the wall node to the next node on the grid line that leaves the wall
//   orthogonality  angle between v and the normal, arccos(|v . n| / |v|): 0 degrees for a perpendicular line
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

struct WallNode {
  double height = 0;
  double orthogonality_deg = 0;
  bool defined = false;  ///< false where the normal or the line vanishes (poles) or a node is not finite
};

/// The measures at a node of a wall. normal: of the wall, of any length; line: from the wall node to the first inner
/// node.
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

/// What is measured at a wall node, in a mesh and where it is asked for in its baseline.
struct WallNodePair {
  WallNode now, before;
};

/// A range of wall nodes of a zone of blocks: nodes first + p * stride[0] + q * stride[1], 0 <= p, q < extent.
struct WallGrid {
  Index first;
  Index extent[2];
  Index stride[2];
  Index inward;  ///< from a wall node to the next node on its line
  Index begin;   ///< number of its first node among those of all walls

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index size() const { return extent[0] * extent[1]; }
  [[nodiscard]] Index node(Index m) const { return first + m % extent[0] * stride[0] + m / extent[0] * stride[1]; }

  KOKKOS_INLINE_FUNCTION WallNode at(Field<double const> const& x, Index p, Index q) const {
    Index const node = first + p * stride[0] + q * stride[1];
    auto const difference = [&](Index number, int d) {
      return x[node + (number + 1 < extent[d] ? stride[d] : 0)] - x[node - (number > 0 ? stride[d] : 0)];
    };
    return wall_node(difference(p, 0), difference(q, 1), x[node + inward] - x[node]);
  }
};

/// All nodes of all walls: meshes have hundreds of small wall faces, and a launch each costs more than its work.
template <class MemorySpace>
struct MeasureWalls {
  Kokkos::View<WallGrid const*, MemorySpace> walls;
  Field<double const> now, before;
  bool against_baseline;  ///< whether there is a `before`
  Kokkos::View<WallNodePair*, MemorySpace> nodes;

  [[nodiscard]] Index size() const { return Index(nodes.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index m) const {
    WallGrid const wall = walls(wall_of(m));
    Index const p = (m - wall.begin) % wall.extent[0], q = (m - wall.begin) / wall.extent[0];
    WallNodePair pair;
    pair.now = wall.at(now, p, q);
    if (against_baseline) pair.before = wall.at(before, p, q);
    nodes(m) = pair;
  }

 private:
  KOKKOS_INLINE_FUNCTION Index wall_of(Index m) const {
    Index low = 0, high = Index(walls.extent(0)) - 1;
    while (low < high) {
      Index const middle = (low + high + 1) / 2;
      if (walls(middle).begin <= m)
        low = middle;
      else
        high = middle - 1;
    }
    return low;
  }
};

/// The nodes of one group of walls of elements: wall node, next node on its column, faces of the group around it (CSR)
/// and their nodes (CSR).
template <class MemorySpace>
struct ColumnWall {
  Kokkos::View<std::int32_t const*, MemorySpace> node, next;
  Kokkos::View<Index const*, MemorySpace> first_face;
  Kokkos::View<std::int32_t const*, MemorySpace> face;
  Kokkos::View<Index const*, MemorySpace> first_corner;  ///< per face, and one past the last
  Kokkos::View<std::int32_t const*, MemorySpace> corner;
  Vec3 plane_normal;  ///< of a 2-D mesh, whose faces are edges

  /// The normal is the sum of the area vectors of the faces around the node.
  KOKKOS_INLINE_FUNCTION WallNode at(Field<double const> const& x, Index m) const {
    Vec3 normal;
    for (Index k = first_face(m); k < first_face(m + 1); ++k) {
      std::int32_t const f = face(k);
      Index const begin = first_corner(f), end = first_corner(f + 1);
      Vec3 const origin = x[corner(begin)];
      if (end - begin == 2) normal += cross(x[corner(begin + 1)] - origin, plane_normal);
      for (Index n = begin + 2; n < end; ++n) normal += 0.5 * cross(x[corner(n - 1)] - origin, x[corner(n)] - origin);
    }
    return wall_node(normal, x[next(m)] - x[node(m)]);
  }
};

template <class MemorySpace>
struct MeasureColumnWall {
  ColumnWall<MemorySpace> wall;
  Field<double const> now, before;
  bool against_baseline;
  Kokkos::View<WallNodePair*, MemorySpace> nodes;

  [[nodiscard]] Index size() const { return Index(nodes.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index m) const {
    WallNodePair pair;
    pair.now = wall.at(now, m);
    if (against_baseline) pair.before = wall.at(before, m);
    nodes(m) = pair;
  }
};

template <class Exec>
void measure_walls(Exec const& exec, Kokkos::View<WallGrid const*, typename Exec::memory_space> const& walls,
                   Field<double const> const& now, Field<double const> const& before, bool against_baseline,
                   Kokkos::View<WallNodePair*, typename Exec::memory_space> const& nodes) {
  launch("gridmorph::wall_quality", exec,
         MeasureWalls<typename Exec::memory_space>{walls, now, before, against_baseline, nodes});
}
template <class Exec>
void measure_walls(Exec const& exec, ColumnWall<typename Exec::memory_space> const& wall,
                   Field<double const> const& now, Field<double const> const& before, bool against_baseline,
                   Kokkos::View<WallNodePair*, typename Exec::memory_space> const& nodes) {
  launch("gridmorph::wall_quality", exec,
         MeasureColumnWall<typename Exec::memory_space>{wall, now, before, against_baseline, nodes});
}

}  // namespace gridmorph::kernels
