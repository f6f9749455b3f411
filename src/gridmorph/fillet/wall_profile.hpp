// A wall cut across a root line: points and normals over the distance along it from the corner.
#pragma once

#include <gridmorph/geometry/facet_surface.hpp>

#include <array>
#include <optional>
#include <vector>

namespace gridmorph {

struct WallPoint {
  Vec3 point;   ///< from the corner
  Vec3 normal;  ///< unit, into the mesh
};

class WallProfile {
 public:
  WallProfile() = default;
  /// The profile along the surface, in the plane across `across`, from `root` in the direction `up`; `normal`: into the
  /// mesh at `root`, in the plane; all unit. Normals are those of the profile in its plane. Beyond rims it goes on in
  /// the tangent plane. Cost: some hundred feet.
  WallProfile(FacetSurface const& surface, Vec3 const& root, Vec3 const& across, Vec3 const& up, Vec3 const& normal,
              double length);

  [[nodiscard]] double length() const { return step_ * double(points_.size() - 1); }
  /// The point at a length along the profile; straight on beyond the end.
  [[nodiscard]] WallPoint at(double s) const;
  [[nodiscard]] std::vector<WallPoint> const& points() const { return points_; }
  /// How far along the profile its point nearest to p is; p from the corner. Cost O(points).
  [[nodiscard]] double nearest(Vec3 const& p) const;

 private:
  double step_ = 1;
  std::vector<WallPoint> points_;
};

/// A circle in the plane of two profiles, from the corner.
struct SectionCircle {
  Vec3 centre;
  Vec3 to_middle;  ///< of its arc, unit
  double half_angle_rad = 0;
  std::array<double, 2> contact{0, 0};  ///< along the profiles
};

/// The first circle of a radius that touches both profiles, c(s) = p(s) + r n(s) off the first at the distance r from
/// the second, s by bisection; nothing where there is none before the end.
std::optional<SectionCircle> circle_between(WallProfile const& first, WallProfile const& second, double radius);

}  // namespace gridmorph
