#include <gridmorph/plan/elements/facet_distance.hpp>

#include <gridmorph/kernels/symmetric_eigen.hpp>

#include <algorithm>
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
  // Boxes come before those that they hold, whose facets follow one another.
  std::vector<std::array<int, 2>> range(boxes_.boxes.size());
  tilted_.resize(range.size());
  for (std::size_t b = range.size(); b-- > 0;) {
    kernels::FacetBox const& box = boxes_.boxes[b];
    if (box.count > 0)
      range[b] = {box.first, box.first + box.count};
    else
      range[b] = {range[box.first][0], range[box.first + 1][1]};
    tilted_[b] = tilted(range[b][0], range[b][1]);
  }
}

FacetDistance::TiltedBox FacetDistance::tilted(int begin, int end) const {
  TiltedBox out;
  double const share = 1 / (3.0 * (end - begin));
  for (int k = begin; k < end; ++k)
    for (Vec3 const& p : triangles_[boxes_.order[k]]) out.centre += share * p;
  double moments[3][3] = {}, axis[3][3];
  for (int k = begin; k < end; ++k)
    for (Vec3 const& p : triangles_[boxes_.order[k]]) {
      Vec3 const d = p - out.centre;
      double const c[3] = {d.x, d.y, d.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) moments[i][j] += c[i] * c[j];
    }
  kernels::diagonalise(moments, axis);
  double size = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    out.axis[a] = {axis[a][0], axis[a][1], axis[a][2]};
    out.low[a] = std::numeric_limits<double>::infinity();
    out.high[a] = -out.low[a];
    for (int k = begin; k < end; ++k)
      for (Vec3 const& p : triangles_[boxes_.order[k]]) {
        double const at = dot(out.axis[a], p - out.centre);
        out.low[a] = std::min(out.low[a], at);
        out.high[a] = std::max(out.high[a], at);
        size = std::max(size, std::abs(at));
      }
  }
  // What rounding makes of these must not leave a facet out.
  double const slack = 1e-12 * (size + norm(out.centre));
  for (std::size_t a = 0; a < 3; ++a) {
    out.low[a] -= slack;
    out.high[a] += slack;
  }
  return out;
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
      [&](int t) {
        if (double const d = squared(triangles_[t], p); d < best) {
          best = d;
          start = t;
        }
      },
      [&] { return best; }, [&](int box) { return tilted_[box].distance2(p); });
  return std::sqrt(best);
}

double FacetDistance::at_least(Vec3 const& p) const {
  return empty() ? std::numeric_limits<double>::infinity() : std::sqrt(boxes_.boxes.front().distance2(p));
}

}  // namespace gridmorph
