// Interfaces and patches of generated block-structured meshes. Internal to them.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>

namespace gridmorph::demo {

/// Joins a face range of a zone to that of a donor and stores both sides, as most files do. The inverse of a rotation
/// is the one about the same line by the opposite angle.
inline void join(Mesh& mesh, Interface1to1 const& face, std::string const& name_back,
                 std::optional<Periodic> const& periodic_back = std::nullopt) {
  mesh.interfaces.push_back(face);
  mesh.interfaces.push_back({name_back, face.families, face.donor_zone, face.zone, face.to_donor(face.range),
                             face.to_donor.inverse(), periodic_back});
}

/// One face of a zone, all its nodes.
inline IndexRange whole_face(Zone const& zone, int axis, int side) {
  IndexRange range{{0, 0, 0}, zone.extent};
  if (side == 0)
    range.end[axis] = 1;
  else
    range.begin[axis] = range.end[axis] - 1;
  return range;
}

}  // namespace gridmorph::demo
