#include <gridmorph/plan/elements/facet_distance.hpp>

#include <cmath>
#include <limits>

namespace gridmorph {

FacetDistance::FacetDistance(Coordinates const& coordinates, CsrGraph const& faces) {
  for (Index f = 0; f < faces.size(); ++f) {
    auto const face = faces[f];
    auto const corner = [&](std::size_t k) { return coordinates[face[k % face.size()]]; };
    if (face.size() <= 3) {
      triangles_.push_back({corner(0), corner(1), corner(face.size() - 1)});
      continue;
    }
    Vec3 sum;
    for (std::size_t k = 0; k < face.size(); ++k) sum += corner(k);
    Vec3 const middle = (1 / double(face.size())) * sum;
    for (std::size_t k = 0; k < face.size(); ++k) triangles_.push_back({corner(k), corner(k + 1), middle});
  }
  std::vector<Vec3> points;
  std::vector<std::array<int, 4>> corners;
  for (Triangle const& t : triangles_) {
    int const first = int(points.size());
    points.insert(points.end(), t.begin(), t.end());
    corners.push_back({first, first + 1, first + 2, -1});
  }
  boxes_ = FacetBoxes(points, corners);
}

double FacetDistance::squared(Triangle const& t, Vec3 const& p) {
  double to_b = 0, to_c = 0;
  kernels::nearest_on_triangle(p, t[0], t[1], t[2], to_b, to_c);
  Vec3 const d = (p - t[0]) - (to_b * (t[1] - t[0]) + to_c * (t[2] - t[0]));
  return dot(d, d);
}

double FacetDistance::operator()(Vec3 const& p, int& start) const {
  if (empty()) return std::numeric_limits<double>::infinity();
  if (start < 0 || std::size_t(start) >= triangles_.size()) start = 0;
  double best = squared(triangles_[start], p);
  boxes_.for_each_nearer(
      p,
      [&](int t) {
        if (double const d = squared(triangles_[t], p); d < best) {
          best = d;
          start = t;
        }
      },
      [&] { return best; });
  return std::sqrt(best);
}

double FacetDistance::at_least(Vec3 const& p) const {
  return empty() ? std::numeric_limits<double>::infinity() : std::sqrt(boxes_.boxes.front().distance2(p));
}

}  // namespace gridmorph
