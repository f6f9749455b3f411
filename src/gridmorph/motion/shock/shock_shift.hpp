// How far a shock goes from one flow solution to another.
#pragma once

#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/motion/shock/shock_cells.hpp>

#include <vector>

namespace gridmorph {

/// A shock is seen as a sheet over the plane across a direction d: at a place t of that plane it stands at the height
/// h(t) of the linear function that fits the heights x . d of its points x within a radius r of t best (least squares),
/// each with its weight times (1 - s^2 / r^2)^2, s its distance from t in the plane. Where two solutions have the shock
/// at h0 and h1, it goes by
///
///     v = (h1(t) - h0(t)) d
///
/// at the points of the first, as far as the second covers them: the mean place of its points there is within r / 2 of
/// t. From there v is spread by the weighted mean; a place further than r from all of them takes that of the nearest.
/// The heights are exact for a plane sheet and a profile that is symmetric about the shock. Folded sheets (a bow shock
/// seen from the side) are not told apart: take a region of each part.
class ShockShift {
 public:
  /// `direction`: length 1; `radius` > 0. Throws MotionError where the second shock covers no point of the first. Cost
  /// O(n log n) points, times those within a radius.
  ShockShift(std::vector<ShockPoint> const& from, std::vector<ShockPoint> const& to, Vec3 const& direction,
             double radius);

  /// The shift v at a place; the height of the place does not matter. Cost O(log n), and the points within the radius.
  [[nodiscard]] Vec3 at(Vec3 const& place) const;
  /// The least and the greatest v . d at points of the first shock.
  [[nodiscard]] double least() const { return least_; }
  [[nodiscard]] double greatest() const { return greatest_; }

 private:
  /// Values at places of the plane, with their weights.
  struct Sheet {
    std::vector<Vec3> place;
    std::vector<double> value, weight;
    FacetBoxes boxes;

    void add(Vec3 const& p, double v, double w);
    void finish();
    struct Mean {
      double weight = 0, value = 0;  ///< weight 0: nothing within the radius
      Vec3 place;                    ///< mean of the places
    };
    [[nodiscard]] Mean mean(Vec3 const& at, double radius) const;
    /// The linear function at a place, from its mean there.
    [[nodiscard]] double linear(Vec3 const& at, double radius, Mean const& mean) const;
    [[nodiscard]] std::size_t nearest(Vec3 const& at) const;
  };
  [[nodiscard]] Vec3 in_plane(Vec3 const& x) const { return x - dot(x, direction_) * direction_; }
  [[nodiscard]] Sheet heights(std::vector<ShockPoint> const& points) const;

  Vec3 direction_;
  double radius_;
  Sheet shift_;
  double least_ = 0, greatest_ = 0;
};

/// The diagonal of what points extend to across a direction.
double extent_across(std::vector<ShockPoint> const& points, Vec3 const& direction);

}  // namespace gridmorph
