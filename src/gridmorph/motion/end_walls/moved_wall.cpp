#include <gridmorph/motion/end_walls/extended_blades.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace gridmorph {

MovedWall::MovedWall(Boundary const& boundary, std::vector<int> patches, Displacement displacement, bool anywhere,
                     std::string const& name)
    : patches_(std::move(patches)),
      rule_(std::move(displacement)),
      anywhere_(anywhere),
      surface_(boundary, patches_),
      displacement_(surface_.points.size()) {
  rule_(surface_.points, displacement_);
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  auto const facets = surface_.facets();
  auto const add = [&](RigidTransform const& copy) {
    int const first = int(points.size());
    for (std::size_t v = 0; v < surface_.points.size(); ++v)
      points.push_back(copy(surface_.points[v] + displacement_[v]));
    auto const take = [&](int a, int b, int c) {  // planes need an area
      std::array<int, 3> const t{first + a, first + b, first + c};
      Vec3 const &p = points[t[0]], &q = points[t[1]], &r = points[t[2]];
      if (norm(cross(q - p, r - p)) > 0) triangles.push_back(t);
    };
    for (GridFacet const& f : facets) {
      take(f[0], f[1], f[2]);
      if (f[3] >= 0) take(f[0], f[2], f[3]);
    }
  };
  add({});
  for (RigidTransform const& t : boundary.periodic_transforms(patches_)) {
    add(t);
    add(t.inverse());
  }
  if (triangles.empty()) throw MotionError(name + ": the walls that it names have no faces to extend blades to");
  moved_ = TargetTree(std::move(points), std::move(triangles));
}

bool MovedWall::moves() const {
  return std::any_of(displacement_.begin(), displacement_.end(), [](Vec3 const& u) { return u != Vec3{}; });
}

Vec3 MovedWall::displaced(int v, Vec3 const& shift) const {
  Vec3 const& own = displacement_[v];
  if (shift == Vec3{}) return own;
  Vec3 const& p = surface_.points[v];
  if (!anywhere_) {
    // Onto the plane of the nearest facet: what was inside of a blade has no facets.
    Vec3 const x = p + own + shift;
    TargetTree::Hit const hit = moved_.closest(x);
    Vec3 const area = moved_.normal(hit.triangle), n = (1 / norm(area)) * area;
    return own + shift - dot(x - hit.point, n) * n;
  }
  return shift + at(p + shift);
}

Vec3 MovedWall::at(Vec3 const& point) const {
  Vec3 out;
  rule_({&point, 1}, {&out, 1});
  return out;
}

Vec3 MovedWall::shift_to(int v, Vec3 const& u, std::string const& name) const {
  Vec3 const& p = surface_.points[v];
  Vec3 shift = u - displacement_[v];
  if (!anywhere_ || shift == Vec3{}) return shift;
  for (int step = 0; step < 100; ++step) {
    Vec3 const next = u - at(p + shift);
    double const change = distance(next, shift);
    shift = next;
    if (change <= 1e-14 * surface_.size) return shift;
  }
  throw MotionError(
      name + ": around " + to_text(p, 9) +
      " the displacement of the wall changes so fast from place to place that nodes beside a blade that is "
      "extended cannot go along; make its bumps flatter");
}

}  // namespace gridmorph
