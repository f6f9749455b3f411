// One element: where it is closest to a position, and its shape functions there. Internal.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>

namespace gridmorph::mapping {

/// A point of an element. Triangles: x = x0 + a (x1 - x0) + b (x2 - x0), a, b >= 0, a + b <= 1. Quadrilaterals:
/// bilinear in 0 <= a, b <= 1 from corner 0 along the side to corner 1 (a) and to corner 3 (b).
struct FacetPoint {
  double a = 0, b = 0;
  Vec3 position;
  double squared = 0;  ///< distance to the position asked for, squared
};

class FacetShape {
 public:
  /// The shape of an element; `corner` holds 3 or 4 positions.
  FacetShape(std::array<Vec3, 4> const& corner, int corners) : corner_(corner), corners_(corners) {}

  [[nodiscard]] FacetPoint closest(Vec3 const& q) const;
  [[nodiscard]] Vec3 at(double a, double b) const;
  /// Derivatives of the position with a and b.
  [[nodiscard]] std::array<Vec3, 2> tangents(double a, double b) const;
  /// Values of the shape functions, and their change for a step (da, db).
  [[nodiscard]] std::array<double, 4> shape(double a, double b) const;
  [[nodiscard]] std::array<double, 4> shape_change(double a, double b, double da, double db) const;
  /// Whether the point lies on the side from corner s to the next one.
  [[nodiscard]] bool on_side(FacetPoint const& p, int s) const;
  /// Twice the vector area of the element.
  [[nodiscard]] Vec3 area_vector() const;

 private:
  [[nodiscard]] FacetPoint closest_on_triangle(Vec3 const& q, int i, int j, int k) const;

  std::array<Vec3, 4> corner_;
  int corners_;
};

}  // namespace gridmorph::mapping
