#include <gridmorph/motion/turbomachinery/section_geometry.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace gridmorph {

namespace {

/// A unit vector across the given one.
Vec3 across(Vec3 const& direction) {
  Vec3 const d{std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
  Vec3 const least = d.x <= d.y && d.x <= d.z ? Vec3{1, 0, 0} : (d.y <= d.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
  return unit(cross(direction, least));
}

class BladeFrame final : public SectionFrame {
 public:
  BladeFrame(CylindricalFrame const& frame, Annulus annulus, std::vector<Vec3> const& points)
      : frame_(frame),
        annulus_(std::move(annulus)),
        first_(across(frame.direction())),
        second_(cross(frame.direction(), first_)) {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (Vec3 const& p : points) {
      height_ += annulus_.height(frame_.meridional(p)) / double(points.size());
      double const x = dot(p, frame_.direction());
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
    chord_ = hi - lo;
  }

  [[nodiscard]] SectionPoint at(Vec3 const& point) const override {
    MeridionalPoint const m = frame_.meridional(point);
    Vec3 const d = point - frame_.origin();
    FlowPosition const at = annulus_.position(m);
    double const t = frame_.is_linear() ? dot(d, frame_.pitch()) : std::atan2(dot(d, second_), dot(d, first_));
    return {at.h, at.m, t, frame_.length_of_angle(point)};
  }
  [[nodiscard]] Vec3 displacement(Vec3 const& point, double ds, double dt) const override {
    return frame_.displacement(point, annulus_.motion(frame_.meridional(point), {ds, 0, dt}));
  }
  [[nodiscard]] Vec3 carried(Vec3 const& from, Vec3 const& displacement, Vec3 const& to) const override {
    CylindricalMotion const there = annulus_.components(frame_.meridional(from), frame_.motion(from, displacement));
    return frame_.displacement(to, annulus_.motion(frame_.meridional(to), there));
  }
  [[nodiscard]] double height() const override { return height_; }
  [[nodiscard]] double period() const override { return frame_.is_linear() ? 0 : 2 * std::numbers::pi; }
  [[nodiscard]] double scale_of_t() const override { return frame_.is_linear() ? chord_ : period(); }
  [[nodiscard]] BladeInput stitching() const override {
    return {frame_, [this](MeridionalPoint const& m) { return annulus_.position(m); },
            [this](MeridionalPoint const&) { return height_; },
            [this](Vec3 const& p) { return annulus_.along(frame_.meridional(p)); }};
  }

 private:
  CylindricalFrame frame_;
  Annulus annulus_;
  Vec3 first_, second_;  ///< with the axis, right-handed; angles count from the first towards the second
  double height_ = 0;
  double chord_ = 0;  ///< extent along the axis
};

class WingFrame final : public SectionFrame {
 public:
  WingFrame(Vec3 const& span, Vec3 const& flow, std::vector<Vec3> const& points)
      : span_(unit(span)), streamwise_(unit(flow - dot(flow, span_) * span_)), normal_(cross(span_, streamwise_)) {
    lo_ = std::numeric_limits<double>::infinity();
    hi_ = -lo_;
    for (Vec3 const& p : points) {
      lo_ = std::min(lo_, dot(p, span_));
      hi_ = std::max(hi_, dot(p, span_));
    }
    if (!(hi_ > lo_)) throw MotionError("the wing has no extent along its span direction; correct span");
  }

  [[nodiscard]] SectionPoint at(Vec3 const& p) const override {
    return {(dot(p, span_) - lo_) / (hi_ - lo_), dot(p, streamwise_), dot(p, normal_), 1};
  }
  [[nodiscard]] Vec3 displacement(Vec3 const&, double ds, double dt) const override {
    return ds * streamwise_ + dt * normal_;
  }
  [[nodiscard]] Vec3 carried(Vec3 const&, Vec3 const& displacement, Vec3 const&) const override { return displacement; }
  [[nodiscard]] double height() const override { return hi_ - lo_; }
  [[nodiscard]] double period() const override { return 0; }
  [[nodiscard]] BladeInput stitching() const override {
    // The position along an axis that runs spanwise is all that stitching asks for.
    return {CylindricalFrame(Axis{{0, 0, 0}, span_}),
            [this](MeridionalPoint const& m) {
              return FlowPosition{0, (m.axial - lo_) / (hi_ - lo_)};
            },
            [this](MeridionalPoint const&) { return hi_ - lo_; },
            [this](Vec3 const& p) { return dot(p, streamwise_); }};
  }

 private:
  Vec3 span_, streamwise_, normal_;
  double lo_, hi_;
};

/// Direction of the longest extent: of the two points farthest apart, as found by going to the farthest point twice.
Vec3 longest_extent(std::vector<Vec3> const& points) {
  auto const farthest = [&](Vec3 const& from) {
    return *std::max_element(points.begin(), points.end(),
                             [&](Vec3 const& a, Vec3 const& b) { return distance(from, a) < distance(from, b); });
  };
  Vec3 const one = farthest(points.front()), other = farthest(one);
  Vec3 const d = other - one, size{std::abs(d.x), std::abs(d.y), std::abs(d.z)};
  double const largest = size.x >= size.y && size.x >= size.z ? d.x : (size.y >= size.z ? d.y : d.z);
  return largest < 0 ? -d : d;
}

Vec3 span_direction(Boundary const& boundary, std::vector<int> const& patches, std::vector<Vec3> const& points) {
  if (boundary.is_plane()) return unit(boundary.across());
  auto const& all = boundary.patches();
  for (int q = 0; q < int(all.size()); ++q) {
    if (all[q].kind != PatchKind::symmetry) continue;
    if (std::none_of(patches.begin(), patches.end(), [&](int p) { return boundary.share_nodes(p, q); })) continue;
    PlaneFit const fit = fit_plane(boundary.points(q));
    if (!fit.determined) continue;
    double middle = 0;
    for (Vec3 const& p : points) middle += dot(p - fit.origin, fit.normal);
    return middle < 0 ? -fit.normal : fit.normal;
  }
  return longest_extent(points);
}

}  // namespace

std::unique_ptr<SectionFrame> blade_frame(Boundary const& boundary, ResolvedMotion const& motion,
                                          SlipSurfaces const& surfaces, std::vector<int> const& blades) {
  CylindricalFrame const frame = frame_of_row(boundary, motion, blades);
  return std::make_unique<BladeFrame>(frame, annulus_of_row(boundary, surfaces, frame, blades),
                                      boundary.points(blades));
}

std::unique_ptr<SectionFrame> wing_frame(Boundary const& boundary, SectionsRule const& rule,
                                         std::vector<int> const& patches) {
  std::vector<Vec3> const points = boundary.points(patches);
  Vec3 const span = rule.span ? *rule.span : span_direction(boundary, patches, points);
  if (norm(cross(span, rule.flow)) < 1e-3 * norm(span) * norm(rule.flow))
    throw MotionError("the flow direction runs along the span direction (" + std::to_string(span.x) + ", " +
                      std::to_string(span.y) + ", " + std::to_string(span.z) + "); give flow and span");
  return std::make_unique<WingFrame>(span, rule.flow, points);
}

}  // namespace gridmorph
