// Analytic geometry of the demo passage: annulus and airfoil sections. Internal to the demo.
#pragma once

#include <generators/passage.hpp>

namespace gridmorph::passage {

/// A point or direction in the developed surface of one span fraction: axial position and R theta.
struct Point2 {
  double x = 0, y = 0;
};

inline Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
inline Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
inline Point2 operator*(double s, Point2 a) { return {s * a.x, s * a.y}; }
double length(Point2 a);
/// Unit vector at an angle from the axial direction, counter-clockwise.
Point2 direction(double angle_rad);

/// Throws ConfigError naming every option that is wrong.
void check(PassageOptions const& options);

/// The space between hub and case: (axial, span fraction) -> radius.
class Annulus {
 public:
  explicit Annulus(PassageOptions const& options);
  [[nodiscard]] double hub(double axial) const { return radius_of(hub_, axial); }
  [[nodiscard]] double casing(double axial) const { return radius_of(casing_, axial); }
  /// Exactly hub and case at span 0 and 1.
  [[nodiscard]] double radius(double axial, double span) const {
    return (1 - span) * hub(axial) + span * casing(axial);
  }
  [[nodiscard]] double span_fraction(double axial, double radius) const;
  /// Radius R that develops the section at a span fraction: y = R theta.
  [[nodiscard]] double section_radius(double span) const { return radius(0, span); }
  /// Point of the machine frame (axis x) of a developed point.
  [[nodiscard]] Vec3 unroll(Point2 p, double span, double section_radius) const;

 private:
  [[nodiscard]] double radius_of(EndWall const& wall, double axial) const;
  EndWall hub_, casing_;
  double inlet_, length_;
};

/// The airfoil at one span fraction. phi = 0 is the leading edge, pi the trailing edge, (0, pi) the upper side; phi
/// runs clockwise. Mid chord is the origin.
class Airfoil {
 public:
  Airfoil(PassageOptions const& options, double span);
  [[nodiscard]] double chord() const { return chord_; }
  [[nodiscard]] double stagger() const { return 0.5 * (inlet_angle_ + outlet_angle_); }
  [[nodiscard]] double inlet_angle() const { return inlet_angle_; }
  [[nodiscard]] double outlet_angle() const { return outlet_angle_; }
  [[nodiscard]] Point2 point(double phi) const;
  /// d point / d phi; never zero.
  [[nodiscard]] Point2 tangent(double phi) const;
  /// Signed: positive on the upper side.
  [[nodiscard]] double half_thickness(double phi) const;
  /// At a fraction of the arc of the camber line, so far off it towards the upper side.
  [[nodiscard]] Point2 off_camber(double u, double distance) const;
  /// Camber line, continued straight upstream and downstream of the blade.
  [[nodiscard]] double camber(double axial) const;

 private:
  [[nodiscard]] Point2 camber_point(double u) const;
  double chord_, inlet_angle_, outlet_angle_, arc_;
  double a_, b_, c_;  ///< thickness distribution
};

}  // namespace gridmorph::passage
