#include <gridmorph/motion/target/target_mappings.hpp>

#include <gridmorph/boundary/patch_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

constexpr double ends_within = 1e-6;   // of the size of the surface
constexpr double counts_as_on = 1e-9;  // of the size of the target: cuts beside a corner are that corner

/// Cuts a target: keeps what is at positive distances from a plane.
class Cut {
 public:
  Cut(TargetTree const& target, Vec3 const& origin, Vec3 const& normal, double tolerance)
      : target_(target), origin_(origin), normal_(normal), points_(target.points()) {
    for (Vec3 const& p : points_) {
      double const d = height(p);
      height_.push_back(std::abs(d) <= tolerance ? 0 : d);
    }
  }

  [[nodiscard]] bool cuts() const {
    return std::any_of(height_.begin(), height_.end(), [](double h) { return h < 0; });
  }

  TargetTree run() {
    std::vector<std::array<int, 3>> kept;
    std::vector<int> polygon;
    for (auto const& t : target_.triangles()) {
      polygon.clear();
      for (std::size_t k = 0; k < 3; ++k) {
        int const a = t[k], b = t[(k + 1) % 3];
        double const from = height_[std::size_t(a)], to = height_[std::size_t(b)];
        if (from >= 0) polygon.push_back(a);
        if ((from > 0 && to < 0) || (from < 0 && to > 0)) polygon.push_back(crossing(a, b));
      }
      // What only touches the plane is an edge or a corner of what is kept.
      bool const inside = std::any_of(t.begin(), t.end(), [&](int v) { return height_[std::size_t(v)] > 0; });
      bool const flat = std::all_of(t.begin(), t.end(), [&](int v) { return height_[std::size_t(v)] == 0; });
      if (!inside && !flat) continue;
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) kept.push_back({polygon[0], polygon[k], polygon[k + 1]});
    }
    if (kept.empty()) return target_;
    return with_used_points(kept);
  }

 private:
  [[nodiscard]] double height(Vec3 const& p) const { return dot(p - origin_, normal_); }

  /// Where the edge meets the plane: one point, whichever triangle asks.
  int crossing(int a, int b) {
    auto const [at, fresh] = crossings_.try_emplace(std::minmax(a, b), int(points_.size()));
    if (fresh) {
      auto const [first, second] = at->first;
      double const from = height(points_[std::size_t(first)]), to = height(points_[std::size_t(second)]);
      Vec3 const p = points_[std::size_t(first)] +
                     (from / (from - to)) * (points_[std::size_t(second)] - points_[std::size_t(first)]);
      points_.push_back(p - height(p) * normal_);
    }
    return at->second;
  }

  [[nodiscard]] TargetTree with_used_points(std::vector<std::array<int, 3>> triangles) const {
    std::vector<int> number(points_.size(), -1);
    std::vector<Vec3> points;
    for (auto& t : triangles)
      for (int& v : t) {
        int& own = number[std::size_t(v)];
        if (own < 0) {
          own = int(points.size());
          points.push_back(points_[std::size_t(v)]);
        }
        v = own;
      }
    return {std::move(points), std::move(triangles)};
  }

  TargetTree const& target_;
  Vec3 origin_, normal_;
  std::vector<Vec3> points_;
  std::vector<double> height_;  ///< of the points of the target; zero on the plane
  std::map<std::pair<int, int>, int> crossings_;
};

}  // namespace

TargetTree cut_at_sides(TargetTree target, std::vector<Vec3> const& surface, std::vector<SlipSurface> const& slides) {
  double const near = ends_within * box_diagonal(surface);
  for (SlipSurface const& side : slides) {
    if (side.kind != SlipSurface::Kind::plane) continue;
    double low = 0, high = 0;
    int on = 0;
    for (Vec3 const& p : surface) {
      double const d = dot(p - side.origin, side.direction);
      low = std::min(low, d);
      high = std::max(high, d);
      on += std::abs(d) <= near ? 1 : 0;
    }
    // Both nodes of an edge at least; a surface across the plane, or within it, does not end there.
    if (on < 2 || (low < -near) == (high > near)) continue;
    Vec3 const inward = high > near ? side.direction : -1.0 * side.direction;
    double beyond = 0;
    for (Vec3 const& p : target.points()) beyond = std::min(beyond, dot(p - side.origin, inward));
    if (beyond >= -near) continue;
    Cut cut(target, side.origin, inward, counts_as_on * box_diagonal(target.points()));
    target = cut.run();
  }
  return target;
}

}  // namespace gridmorph
