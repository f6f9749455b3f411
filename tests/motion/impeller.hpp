// Surface meshes of a radial impeller, made from formulas that the tests use as their oracle.
//
// Hub and case are quarter circles about one centre in the meridional plane: the flow enters along the axis and leaves
// along the radius. So (fraction of the arc length, span fraction) are polar coordinates about that centre. The row has
// main blades and splitter blades half a pitch beside them.
#pragma once

#include "annulus.hpp"

namespace gridmorph::test::impeller {

constexpr double centre_radius = 1.1, hub_bend = 0.8, case_bend = 0.5;
constexpr double pitch = 0.5;

/// Position along the flow (0 at the inlet, 1 at the exit), span fraction, angle about the axis.
struct Place {
  double s = 0, h = 0, theta = 0;
};

inline Vec3 point(Place const& p) {
  double const bend = hub_bend + p.h * (case_bend - hub_bend), phi = 0.5 * std::numbers::pi * p.s;
  return cylindrical(bend * std::sin(phi), centre_radius - bend * std::cos(phi), p.theta);
}

inline Place place_of(Vec3 const& p) {
  double const inwards = centre_radius - radius_of(p);
  return {std::atan2(p.x, inwards) / (0.5 * std::numbers::pi),
          (hub_bend - std::hypot(p.x, inwards)) / (hub_bend - case_bend), angle_of(p)};
}

/// Distance from the centre of the bends.
inline double bend_of(Vec3 const& p) { return std::hypot(p.x, centre_radius - radius_of(p)); }

/// One of the two kinds of blades.
struct BladeShape {
  double leading_hub, sweep, chord_hub, chord_change, shift;
  [[nodiscard]] double leading(double h) const { return leading_hub + sweep * h * (1 - h); }
  [[nodiscard]] double chord(double h) const { return chord_hub + chord_change * h; }
  [[nodiscard]] double trailing(double h) const { return leading(h) + chord(h); }
  [[nodiscard]] double fraction(Place const& p) const { return (p.s - leading(p.h)) / chord(p.h); }
  /// Lean, wrap angle; c = 0 ... 1 from leading to trailing edge.
  [[nodiscard]] double camber(double c, double h) const { return 0.1 * h + (0.4 + 0.1 * h) * c * c + shift; }
};
constexpr BladeShape main_blade{0.2, 0.06, 0.6, -0.05, 0};
constexpr BladeShape splitter{0.45, 0.04, 0.35, -0.02, 0.5 * pitch};
constexpr double half_thickness = 0.03;

inline Vec3 blade_point(BladeShape const& b, double phi, double h, double shift = 0) {
  double const c = 0.5 * (1 - std::cos(phi));
  return point({b.leading(h) + c * b.chord(h), h, b.camber(c, h) + half_thickness * std::sin(phi) + shift});
}

/// Moves blade nodes: `axial` of BladeMotion is the change of the position along the flow; span fraction kept.
inline FunctionRule blade_rule(BladeShape const& b, BladeMotion const& motion) {
  return {"impeller blade", [b, motion](std::span<Vec3 const> points, std::span<Vec3> out) {
            for (std::size_t n = 0; n < points.size(); ++n) {
              Place const p = place_of(points[n]);
              double const c = b.fraction(p);
              double const off = std::remainder(p.theta - b.camber(c, p.h), pitch) / half_thickness;
              out[n] =
                  point({p.s + motion.axial(c, p.h), p.h, p.theta + motion.angle(c, p.h) + motion.difference * off}) -
                  points[n];
            }
          }};
}

inline Surface o_blade(std::string name, BladeShape const& b, int around, int spanwise) {
  return {std::move(name),
          PatchKind::wall,
          {around, spanwise},
          [=](double s, double t) { return blade_point(b, 2 * std::numbers::pi * (s == 1 ? 0 : s), t); },
          {}};
}

inline Surface h_side(std::string name, BladeShape const& b, bool suction, int along, int spanwise) {
  return {std::move(name),
          PatchKind::wall,
          {along, spanwise},
          [=](double s, double t) {
            double const phi = std::numbers::pi * s;
            return blade_point(b, suction ? phi : -phi, t, suction ? 0 : pitch);
          },
          {}};
}

/// Between two positions along the flow.
inline Surface end_wall(std::string name, double h, int along, int around, double from = 0, double to = 1) {
  return {std::move(name),
          PatchKind::wall,
          {along, around},
          [=](double s, double t) {
            double const at = from + s * (to - from);
            return point({at, h, 0.2 * at + pitch * t});
          },
          {}};
}

inline Surface end_plane(std::string name, PatchKind kind, double s, int spanwise, int around) {
  return {std::move(name),
          kind,
          {spanwise, around},
          [=](double h, double t) {
            return point({s, h, 0.2 * s + pitch * t});
          },
          {}};
}

inline Surface periodic() {
  return {"periodic", PatchKind::other, {61, 31}, [](double s, double h) { return point({s, h, 0.2 * s}); }, {}};
}

}  // namespace gridmorph::test::impeller
