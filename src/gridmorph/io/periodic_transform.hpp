// The transform that a file's periodicity stands for, or that nodes ask for where it says none.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <optional>
#include <vector>

namespace gridmorph::io {

/// Fills Periodic::declared: x_donor = R (x - center) + center + translation with R = Rz Ry Rx, in CGNS and SU2 files
/// alike.
inline void set_declared(Periodic& periodic) {
  Vec3 const& angle = periodic.rotation_angle_rad;
  Mat3 const rotation =
      rotation_matrix({0, 0, 1}, angle.z) * (rotation_matrix({0, 1, 0}, angle.y) * rotation_matrix({1, 0, 0}, angle.x));
  Vec3 const& c = periodic.rotation_center;
  periodic.declared = {rotation, c - rotation * c + periodic.translation};
}

/// The transform as a translation, or as a rotation about a line; nothing where it is neither, to within `allowed`
/// [length].
std::optional<Periodic> periodic_of(RigidTransform const& transform, double allowed);

/// The translation, or else the rotation, that takes from[n] to within `allowed` [length] of to[n]; nothing where none
/// does. As many points in both. `flat`: of a mesh in a plane z = const, so that rotations are about z.
std::optional<Periodic> periodic_between(std::vector<Vec3> from, std::vector<Vec3> to, double allowed,
                                         bool flat = false);

}  // namespace gridmorph::io
