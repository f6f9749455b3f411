// Closest points on a surface of triangles, on the host.
#pragma once

#include <gridmorph/geometry/facet_boxes.hpp>

#include <array>
#include <functional>
#include <limits>
#include <vector>

namespace gridmorph {

/// The point of the triangle a, b, c nearest to p (nearest_on_triangle of the kernels); exactly a corner where that is
/// nearest.
Vec3 closest_on_triangle(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c);

/// The tree of boxes of surfaces of facets (FacetBoxes), around triangles, for searches among some of them too. Cost
/// O(n log n) to build, O(log n) per query near the surface.
class TargetTree {
 public:
  struct Hit {
    int triangle = -1;  ///< -1: no triangle passes the test
    Vec3 point;
    double distance = 0;
  };

  TargetTree() = default;
  /// Copies its arguments. Triangles without area are found like the segments they are.
  TargetTree(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }
  [[nodiscard]] std::vector<std::array<int, 3>> const& triangles() const { return triangles_; }
  /// Right-handed about the order of its corners, as long as twice its area.
  [[nodiscard]] Vec3 normal(int triangle) const;

  /// The nearest point; of equally near ones that of the triangle with the smaller number.
  [[nodiscard]] Hit closest(Vec3 const& p) const;
  /// The nearest point among those nearer than a distance; cheap where there is none.
  [[nodiscard]] Hit closest_within(Vec3 const& p, double distance) const;
  /// The nearest point on a triangle that `accept` says yes to.
  [[nodiscard]] Hit closest_of(Vec3 const& p, std::function<bool(int triangle)> const& accept) const;
  /// The nearest point on a triangle whose normal is less than a right angle from `direction`.
  [[nodiscard]] Hit closest_facing(Vec3 const& p, Vec3 const& direction) const;

 private:
  template <class Accept>
  [[nodiscard]] Hit search(Vec3 const& p, Accept const& accept,
                           double within = std::numeric_limits<double>::infinity()) const;

  std::vector<Vec3> points_;
  std::vector<std::array<int, 3>> triangles_;
  FacetBoxes tree_;
};

}  // namespace gridmorph
