// Curves through points, over their arc length.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <vector>

namespace gridmorph {

/// A C1 cubic through points over the length s of their polygon, with slopes of the parabola through three of them;
/// straight on beyond its ends. Two points at least, no two neighbours the same.
class ArcCurve {
 public:
  explicit ArcCurve(std::vector<Vec3> points);

  [[nodiscard]] double length() const { return arc_.back(); }
  [[nodiscard]] double arc(std::size_t k) const { return arc_[k]; }
  [[nodiscard]] std::size_t size() const { return arc_.size(); }
  [[nodiscard]] Vec3 const& point(std::size_t k) const { return points_[k]; }

  /// The place at the arc length s; exactly a point at that point. Cost O(log n).
  [[nodiscard]] Vec3 at(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;

 private:
  [[nodiscard]] std::size_t piece(double s) const;

  std::vector<Vec3> points_, slope_;
  std::vector<double> arc_;
};

}  // namespace gridmorph
