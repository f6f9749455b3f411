#include <gridmorph/io/extrude.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::cgns {

namespace {

/// Spread along an axis, relative to the mesh size, below which the mesh counts as constant there.
constexpr double constant_tolerance = 1e-6;
/// Length of the sum of cell normals over the sum of their lengths, below which a surface has no missing direction.
constexpr double closed_surface = 0.1;

struct Surface {
  Vec3 low{1, 1, 1}, high{-1, -1, -1};  // bounding box
  Vec3 normal_sum;
  double area = 0;
  Index cells = 0;
};

Surface measure(Layout const& layout, Mesh const& mesh) {
  Surface s;
  auto const& x = mesh.coordinates;
  constexpr double huge = std::numeric_limits<double>::max();
  s.low = {huge, huge, huge};
  s.high = {-huge, -huge, -huge};
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    auto const& zone = mesh.zones[z];
    auto const p = plane_steps(zone, layout.zones[z].flat_axis);
    for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
      for (int a = 0; a < zone.extent[p.axis[0]]; ++a) {
        Index const n = zone.first_node + a * p.step[0] + b * p.step[1];
        Vec3 const q = x[n];
        s.low = {std::min(s.low.x, q.x), std::min(s.low.y, q.y), std::min(s.low.z, q.z)};
        s.high = {std::max(s.high.x, q.x), std::max(s.high.y, q.y), std::max(s.high.z, q.z)};
        if (a + 1 == zone.extent[p.axis[0]] || b + 1 == zone.extent[p.axis[1]]) continue;
        Vec3 const diagonal_1 = x[n + p.step[0] + p.step[1]] - q;
        Vec3 const diagonal_2 = x[n + p.step[1]] - x[n + p.step[0]];
        Vec3 const normal = 0.5 * cross(diagonal_1, diagonal_2);
        s.normal_sum += normal;
        s.area += norm(normal);
        ++s.cells;
      }
  }
  return s;
}

}  // namespace

PlaneSteps plane_steps(Zone const& zone, int flat_axis) {
  auto const strides = zone.strides();
  int const a = flat_axis == 0 ? 1 : 0;
  int const b = flat_axis == 2 ? 1 : 2;
  return {{a, b}, {strides[a], strides[b]}, strides[flat_axis]};
}

void add_second_planes(Layout const& layout, Mesh& mesh, Problems& problems) {
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    int const axis = layout.zones[z].flat_axis;
    for (int side = 0; side < 2; ++side) {
      IndexRange range{{0, 0, 0}, mesh.zones[z].extent};
      range.begin[axis] = side;
      range.end[axis] = side + 1;
      mesh.patches.push_back(
          {std::string(plane_patch_name), "BCSymmetryPlane", PatchKind::symmetry, {}, int(z), range});
    }
  }
  if (mesh.coordinates.size() == 0) return;

  Surface const s = measure(layout, mesh);
  if (!(s.area > 0)) return problems.add(mesh.source + ": the 2-D mesh has no area");
  Vec3 const spread = s.high - s.low;
  double const tolerance = constant_tolerance * norm(spread);
  Vec3 direction;
  if (spread.z <= tolerance)
    direction = {0, 0, 1};
  else if (spread.y <= tolerance)
    direction = {0, 1, 0};
  else if (spread.x <= tolerance)
    direction = {1, 0, 0};
  else if (norm(s.normal_sum) > closed_surface * s.area)
    direction = (1 / norm(s.normal_sum)) * s.normal_sum;
  else
    return problems.add(
        mesh.source +
        ": the 2-D mesh is a surface that closes on itself; no direction is left to give it a second plane");
  double const thickness = std::sqrt(s.area / double(s.cells));
  Vec3 const shift = thickness * direction;
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    auto const& zone = mesh.zones[z];
    auto const p = plane_steps(zone, layout.zones[z].flat_axis);
    for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
      for (int a = 0; a < zone.extent[p.axis[0]]; ++a) {
        Index const n = zone.first_node + a * p.step[0] + b * p.step[1];
        mesh.coordinates.set(n + p.across, mesh.coordinates[n] + shift);
      }
  }
  mesh.notes.push_back(mesh.source + ": 2-D mesh given a second node plane at a distance of " +
                       std::to_string(thickness));
}

}  // namespace gridmorph::cgns
