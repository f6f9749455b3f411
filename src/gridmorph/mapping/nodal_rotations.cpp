#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/mapping/facet_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

struct Frame {
  Vec3 a, b, normal;  ///< tangents at the middle, unit normal
  double area = 0;
};

Frame frame_of(std::array<Vec3, 4> const& x, int corners) {
  Frame f;
  if (corners == 3) {
    f.a = x[1] - x[0];
    f.b = x[2] - x[0];
  } else {
    f.a = 0.5 * ((x[1] - x[0]) + (x[2] - x[3]));
    f.b = 0.5 * ((x[3] - x[0]) + (x[2] - x[1]));
  }
  Vec3 const n = cross(f.a, f.b);
  f.area = norm(n);
  if (f.area > 0) f.normal = (1 / f.area) * n;
  return f;
}

void add_product(Mat3& f, Vec3 const& to, Vec3 const& from) {
  double const t[3] = {to.x, to.y, to.z}, s[3] = {from.x, from.y, from.z};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) f.m[r][c] += t[r] * s[c];
}

}  // namespace

std::vector<Vec3> nodal_rotations(StructuralModel const& model, std::span<Vec3 const> displacement) {
  std::vector<Vec3> rotation(model.nodes.size());
  std::vector<double> weight(model.nodes.size(), 0.0);
  for (StructuralFacet const& facet : model.facets) {
    int const n = facet.corners();
    std::array<Vec3, 4> x{}, moved{}, u{};
    for (int c = 0; c < n; ++c) {
      x[c] = model.nodes.position[facet.node[c]];
      u[c] = displacement[facet.node[c]];
      moved[c] = x[c] + u[c];
    }
    Frame const before = frame_of(x, n), after = frame_of(moved, n);
    if (before.area == 0 || after.area == 0) continue;
    // I + H with H from differences, so that no displacement gives exactly the identity. The normal is that of the
    // moved element; the tangents' changes are the displacement's own differences.
    Frame const change = frame_of(u, n);
    bool const still = change.a == Vec3{0, 0, 0} && change.b == Vec3{0, 0, 0};
    Vec3 const turned = still ? Vec3{0, 0, 0} : after.normal - before.normal;
    Mat3 f;
    add_product(f, change.a, (1 / before.area) * cross(before.b, before.normal));
    add_product(f, change.b, (1 / before.area) * cross(before.normal, before.a));
    add_product(f, turned, before.normal);
    Vec3 const w = before.area * rotation_vector(nearest_rotation(f));
    for (int c = 0; c < n; ++c) {
      rotation[facet.node[c]] += w;
      weight[facet.node[c]] += before.area;
    }
  }
  for (std::size_t n = 0; n < rotation.size(); ++n)
    if (weight[n] > 0) rotation[n] = (1 / weight[n]) * rotation[n];
  return rotation;
}

}  // namespace gridmorph
