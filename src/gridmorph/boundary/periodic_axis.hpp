// What a periodic transform is: the line it turns about and by how much, or the way it goes.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// Rotation about the line through `origin` along `direction` (a unit vector), right-handed, 0 < angle_rad <= pi.
/// `origin` is the point of the line next to the coordinates' origin.
struct AxisTurn {
  Vec3 origin, direction;
  double angle_rad = 0;
};

/// The transform as a rotation about a line; nothing when it turns by less than 1e-4 rad, or moves points along the
/// line by more than `tolerance` [length].
std::optional<AxisTurn> as_turn(RigidTransform const& t, double tolerance);

/// The periodic transform that pairs of points ask for, from[n] onto to[n], by least squares: files declare angles in
/// single precision, or in a convention of their own. What the points leave open (a turn about the line on which all of
/// them lie) is as declared. Without points: as declared. `size`: of the mesh, for what counts as a line and as
/// nothing.
RigidTransform fit_periodic(Periodic const& declared, std::vector<Vec3> const& from, std::vector<Vec3> const& to,
                            double size);

/// Whether two transforms take the places of a mesh to the same ones, to within 1e-4 of its size: files declare the
/// periodicity of one passage in several connections.
bool are_alike(RigidTransform const& a, RigidTransform const& b, double size);

}  // namespace gridmorph
