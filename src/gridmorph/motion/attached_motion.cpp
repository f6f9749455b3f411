#include <gridmorph/motion/along_walls.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <limits>
#include <string>

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
    faces_ = WallFaces(boundary, patches, displacement);
    return;
  }
  std::vector<Vec3> before, after;
  double nearest = std::numeric_limits<double>::infinity();
  for (int const p : patches) {
    std::vector<Vec3> points;
    for (Index const n : boundary.surface(p).nodes) {
      Vec3 const x = boundary.coordinates()[n];
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

Vec3 AttachedMotion::displacement(Vec3 const& point) const {
  if (!faces_.empty()) return faces_.nearest(point).displacement;
  return gridmorph::displacement(fit_, point);
}

}  // namespace gridmorph
