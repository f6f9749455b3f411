#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/boundary/second_plane.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

SecondPlane::SecondPlane(BoundaryMesh const& mesh) {
  if (mesh.dimension != 2 || mesh.coordinates.size() == 0) return;
  double farthest = 0;
  for (Patch const& patch : mesh.patches) {
    Zone const& zone = mesh.zones[patch.zone];
    if (!zone.is_block() || patch.name != plane_patch_name) continue;
    int axis = -1;
    for (int a = 0; a < 3; ++a)
      if (patch.range.extent(a) == 1 && zone.extent[a] == 2) axis = a;
    if (axis < 0 || patch.range.begin[axis] != 0) continue;
    Index const across = zone.strides()[axis];
    for_each_node(zone, patch.range, [&](Index n) {
      Vec3 const x = mesh.coordinates[n];
      if (!shift_) {
        origin_ = x;
        shift_ = mesh.coordinates[n + across] - x;
      }
      farthest = std::max(farthest, std::fabs(dot(x - origin_, *shift_)));
    });
  }
  // A quarter of the way from one plane to the other leaves no doubt which is meant.
  if (shift_ && !(farthest < 0.25 * dot(*shift_, *shift_))) shift_.reset();
}

Vec3 SecondPlane::first(Vec3 const& p) const {
  if (!shift_) return p;
  double const share = dot(p - origin_, *shift_) / dot(*shift_, *shift_);
  return share > 0.5 ? p - share * *shift_ : p;
}

}  // namespace gridmorph
