#include <gridmorph/motion/attached_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/barycentric.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

Vec3 mean(std::vector<Vec3> const& points) {
  Vec3 sum;
  for (Vec3 const& p : points) sum += p;
  return (1.0 / double(points.size())) * sum;
}

}  // namespace

AttachedMotion::AttachedMotion(Boundary const& boundary, std::vector<int> const& patches, AttachedRule const& rule,
                               Displacement const& displacement) {
  if (rule.how == AttachedRule::How::nearest) {
    follow_faces(boundary, patches, displacement);
    return;
  }
  std::vector<Vec3> before, after;
  double nearest = std::numeric_limits<double>::infinity();
  for (int const p : patches) {
    std::vector<Vec3> points;
    for (Index const n : boundary.surface(p).nodes) {
      Vec3 const x = boundary.mesh().coordinates[n];
      double const d = rule.near ? distance(x, rule.near->first) : 0;
      nearest = std::min(nearest, d);
      if (!rule.near || d <= rule.near->second) points.push_back(x);
    }
    std::vector<Vec3> u(points.size());
    displacement(p, points, u);
    for (std::size_t n = 0; n < points.size(); ++n) after.push_back(points[n] + u[n]);
    before.insert(before.end(), points.begin(), points.end());
  }
  if (before.empty())
    throw MotionError(rule.near ? "no node of the walls is within " + std::to_string(rule.near->second) +
                                      " of the place " + to_text(rule.near->first, 6) +
                                      "; the nearest is at a distance of " + std::to_string(nearest)
                                : std::string("the walls have no nodes"));
  fit_ = {mean(before), mean(after), Mat3{}};
  if (rule.how == AttachedRule::How::shift) return;
  if (auto const fit = rigid_fit(before, after)) fit_ = *fit;
}

void AttachedMotion::follow_faces(Boundary const& boundary, std::vector<int> const& patches,
                                  Displacement const& displacement) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (int const p : patches) {
    FacetList const list = boundary.facets({&p, 1});
    int const first = int(points.size());
    points.insert(points.end(), list.points.begin(), list.points.end());
    of_node_.resize(points.size());
    displacement(p, list.points, std::span(of_node_).subspan(std::size_t(first)));
    for (auto const& f : list.facets) {
      triangles.push_back({first + f[0], first + f[1], first + f[2]});
      if (f[3] >= 0) triangles.push_back({first + f[0], first + f[2], first + f[3]});
    }
  }
  if (triangles.empty())
    throw MotionError("the nearest place of the walls is looked for on faces, of which they have none; take \"rigid\"");
  tree_ = TargetTree(std::move(points), std::move(triangles));
}

Vec3 AttachedMotion::displacement(Vec3 const& point) const {
  if (!tree_.empty()) {
    TargetTree::Hit const hit = tree_.closest(point);
    auto const& corners = tree_.triangles()[std::size_t(hit.triangle)];
    auto const x = [&](int c) { return tree_.points()[std::size_t(corners[std::size_t(c)])]; };
    auto const weight = barycentric(hit.point, x(0), x(1), x(2));
    // Equal corners give exactly their displacement.
    Vec3 const first = of_node_[std::size_t(corners[0])];
    return first + weight[1] * (of_node_[std::size_t(corners[1])] - first) +
           weight[2] * (of_node_[std::size_t(corners[2])] - first);
  }
  Vec3 const arm = point - fit_.from;
  return (fit_.rotation * arm - arm) + (fit_.to - fit_.from);
}

}  // namespace gridmorph
