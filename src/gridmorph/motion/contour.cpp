#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/contour.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace gridmorph {

namespace {

class Contour {
 public:
  Contour(std::vector<std::pair<double, double>> const& profile, Axis const& axis, std::string where)
      : frame_(axis), where_(std::move(where)) {
    TurnedProfile fit = TurnedProfile::from_points(profile);
    surface_.kind = fit.frame == kernels::MeridionalFrame{} ? SlipKind::revolution : SlipKind::meridional;
    surface_.origin = frame_.origin();
    surface_.direction = frame_.direction();
    surface_.profile = std::move(fit.profile);
    surface_.frame = fit.frame;
    length_ = surface_.profile.knots.back().axial - surface_.profile.knots.front().axial;
  }

  [[nodiscard]] Vec3 displacement(Vec3 const& p) const {
    Vec3 const u = on_axis(p) ? along_axis(p) : surface_.view().project(p) - p;
    auto const [axial, radius] = frame_.meridional(p + u);
    double const at = surface_.frame.abscissa(axial, radius), first = surface_.profile.knots.front().axial,
                 last = surface_.profile.knots.back().axial, beyond = std::max(first - at, at - last);
    if (beyond > 1e-6 * length_)
      refuse(p, "lies beyond the ends of the profile by ", beyond, "; give a profile as long as the wall");
    return u;
  }

 private:
  [[nodiscard]] bool on_axis(Vec3 const& p) const { return frame_.meridional(p).radius == 0; }

  /// A point on the axis has no radial direction.
  [[nodiscard]] Vec3 along_axis(Vec3 const& p) const {
    double const axial = frame_.meridional(p).axial;
    if (surface_.kind == SlipKind::meridional && !surface_.frame.inclined()) {
      kernels::MeridionalFoot const foot = surface_.view().foot(axial, 0);
      return (-foot.away * foot.axial) * frame_.direction();
    }
    double const off =
        surface_.kind == SlipKind::revolution ? surface_.profile(axial) : surface_.view().foot(axial, 0).away;
    if (std::abs(off) > 1e-9 * length_)
      refuse(p, "lies on the axis, which the profile misses by ", std::abs(off), "; end the profile there");
    return {};
  }

  [[noreturn]] void refuse(Vec3 const& p, char const* what, double size, char const* what_to_do) const {
    auto const [axial, radius] = frame_.meridional(p);
    throw MotionError(where_ + ": contour: the node at " + to_text(p, 9) + ", axial " + to_text(axial, 6) +
                      ", radius " + to_text(radius, 6) + ", " + what + to_text(size, 3) + what_to_do);
  }

  CylindricalFrame frame_;
  std::string where_;
  SlipSurface surface_;
  double length_ = 0;
};

}  // namespace

FunctionRule make_contour(std::vector<std::pair<double, double>> const& profile, Axis const& axis,
                          std::string const& where, double share) {
  auto const contour = std::make_shared<Contour const>(profile, axis, where);
  return {"contour of " + std::to_string(profile.size()) + " points",
          [contour, share](std::span<Vec3 const> points, std::span<Vec3> out) {
            for (std::size_t n = 0; n < points.size(); ++n) {
              Vec3 const u = contour->displacement(points[n]);
              out[n] = share == 1 ? u : share * u;
            }
          }};
}

}  // namespace gridmorph
