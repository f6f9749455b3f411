// Along which coordinate a target of sections measures the span, and which way it points.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <optional>

namespace gridmorph {

class SpanCoordinate {
 public:
  /// The coordinate along TargetRule::span where there is one, otherwise the distance from the axis.
  SpanCoordinate(TargetRule const& rule, Axis const& axis)
      : origin_(axis.origin), axis_((1 / norm(axis.direction)) * axis.direction) {
    if (rule.span) direction_ = (1 / norm(*rule.span)) * *rule.span;
  }
  [[nodiscard]] bool straight() const { return direction_.has_value(); }
  [[nodiscard]] double operator()(Vec3 const& p) const { return direction_ ? dot(p, *direction_) : norm(radial(p)); }
  [[nodiscard]] Vec3 direction(Vec3 const& p) const { return direction_ ? *direction_ : radial(p); }
  /// The point at the same place across the span whose own coordinate is `span`.
  [[nodiscard]] Vec3 moved_to(double span, Vec3 const& p) const {
    Vec3 const d = direction(p);
    return p + ((span - (*this)(p)) / norm(d)) * d;
  }

 private:
  [[nodiscard]] Vec3 radial(Vec3 const& p) const {
    Vec3 const d = p - origin_;
    return d - dot(d, axis_) * axis_;
  }
  Vec3 origin_, axis_;
  std::optional<Vec3> direction_;
};

}  // namespace gridmorph
