#include <gridmorph/mapping/detail/facet_shape.hpp>
#include <gridmorph/mapping/detail/point_clouds.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace gridmorph::mapping {

namespace {

constexpr int most_iterations = 200;

/// Whether a plane separates the origin from all points by the tolerance (E. G. Gilbert, "An iterative procedure for
/// computing the minimum of a quadratic form on a convex set", SIAM J. Control 4 (1966)).
bool is_outside(std::vector<Vec3> const& points, double tolerance) {
  Vec3 v = points.front();
  for (int n = 0; n < most_iterations; ++n) {
    double const length = norm(v);
    if (length <= tolerance) return false;
    Vec3 const support = *std::min_element(points.begin(), points.end(),
                                           [&](Vec3 const& a, Vec3 const& b) { return dot(a, v) < dot(b, v); });
    if (dot(support, v) > tolerance * length) return true;
    Vec3 const along = support - v;
    double const squared = dot(along, along);
    if (squared == 0) return true;
    v += std::clamp(-dot(v, along) / squared, 0.0, 1.0) * along;
  }
  return false;
}

}  // namespace

Vec3 closest_in_hull(std::vector<Vec3> const& points, double tolerance) {
  if (!is_outside(points, tolerance)) return {0, 0, 0};
  // From outside the closest point lies on a face, and faces are triangles between the points.
  Vec3 best;
  double smallest = std::numeric_limits<double>::max();
  std::size_t const n = points.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = std::min(a + 1, n - 1); b < n; ++b)
      for (std::size_t c = std::min(b + 1, n - 1); c < n; ++c) {
        auto const p = FacetShape({points[a], points[b], points[c], {}}, 3).closest({0, 0, 0});
        if (!(p.squared < smallest)) continue;  // also what points on one line make of it
        smallest = p.squared;
        best = p.position;
      }
  return best;
}

}  // namespace gridmorph::mapping
