#include <gridmorph/motion/wall_faces.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/barycentric.hpp>

#include <array>
#include <utility>

namespace gridmorph {

WallFaces::WallFaces(Boundary const& boundary, std::vector<int> const& patches, Displacement const& displacement) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (int const p : patches) {
    int const first = int(points.size());
    FacetList const list = boundary.facets({&p, 1});
    std::vector<Vec3> corners = list.points;
    for (auto const& f : list.facets) {
      triangles.push_back({first + f[0], first + f[1], first + f[2]});
      if (f[3] >= 0) triangles.push_back({first + f[0], first + f[2], first + f[3]});
    }
    if (boundary.is_plane()) {
      BoundarySurface const& lines = boundary.surface(p);
      corners.clear();
      for (Index const n : lines.nodes) corners.push_back(boundary.coordinates()[n]);
      for (GridFacet const& f : lines.faces) triangles.push_back({first + f[0], first + f[1], first + f[1]});
    }
    points.insert(points.end(), corners.begin(), corners.end());
    of_node_.resize(points.size());
    displacement(p, corners, std::span(of_node_).subspan(std::size_t(first)));
  }
  if (triangles.empty())
    throw MotionError("the nearest place of the walls is looked for on faces, of which they have none; take \"rigid\"");
  tree_ = TargetTree(std::move(points), std::move(triangles));
}

std::optional<WallFaces::Place> WallFaces::nearest_within(Vec3 const& point, double distance) const {
  TargetTree::Hit const hit = tree_.closest_within(point, distance);
  return hit.triangle < 0 ? std::nullopt : std::optional(place(hit));
}

WallFaces::Place WallFaces::place(TargetTree::Hit const& hit) const {
  auto const& corners = tree_.triangles()[hit.triangle];
  auto const x = [&](int c) { return tree_.points()[corners[c]]; };
  auto const u = [&](int c) { return of_node_[corners[c]]; };
  auto const weight = barycentric(hit.point, x(0), x(1), x(2));
  return {hit.point, u(0) + weight[1] * (u(1) - u(0)) + weight[2] * (u(2) - u(0))};
}

}  // namespace gridmorph
