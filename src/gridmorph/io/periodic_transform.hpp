// The transform that a file's periodicity stands for.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph::io {

/// Fills Periodic::declared: x_donor = R (x - center) + center + translation with R = Rz Ry Rx, in CGNS and SU2 files alike.
inline void set_declared(Periodic& periodic) {
  Vec3 const& angle = periodic.rotation_angle_rad;
  Mat3 const rotation =
      rotation_matrix({0, 0, 1}, angle.z) * (rotation_matrix({0, 1, 0}, angle.y) * rotation_matrix({1, 0, 0}, angle.x));
  Vec3 const& c = periodic.rotation_center;
  periodic.declared = {rotation, c - rotation * c + periodic.translation};
}

}  // namespace gridmorph::io
