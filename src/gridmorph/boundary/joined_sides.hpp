// The sides of an H mesh's blade put together: they belong to neighbouring blades, a pitch apart.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <vector>

namespace gridmorph {

/// A surface whose pieces have been brought together by the periodic transforms of the mesh.
struct JoinedSides {
  PatchSurface surface;     ///< points that coincide after that are one vertex; `numbers` is empty
  std::vector<int> vertex;  ///< per vertex of the surface as it was: its vertex now
  std::vector<RigidTransform>
      turn;                  ///< per grid: its own position -> position in `surface`; exactly the identity at home
  std::vector<char> turned;  ///< per grid: not at home
};

/// Pieces are patches that hang together by common vertices. One that shares an edge (two vertices or more, within 1e-7
/// of the size) with another when turned by a periodic transform of the mesh or its inverse goes there; pieces that
/// nothing brings together stay where they are. Of the places where the whole may then be, that nearest to `near` is
/// taken. Cost O(vertices * transforms).
JoinedSides join_sides(Boundary const& boundary, PatchSurface const& surface, Vec3 const& near);

}  // namespace gridmorph
