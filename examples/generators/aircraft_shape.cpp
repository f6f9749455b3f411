#include <generators/aircraft_shape.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::aircraft {

namespace {

constexpr double quarter = std::numbers::pi / 2;

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Half the thickness of the symmetric NACA section of four digits over its chord; what makes the trailing edge blunt
/// added.
double half_thickness(double thickness, double x) {
  return 5 * thickness * (0.2969 * std::sqrt(x) + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1015 * x)))) + 0.003 * x;
}

constexpr double nose_length = 0.1;  ///< share of the chord

}  // namespace

double Fuselage::radius_at(double x) const {
  double const t = std::clamp((x - taper) / (end - taper), 0.0, 1.0);
  return radius + (end_radius - radius) * t * t;
}

double Fuselage::centre_at(double x) const {
  double const t = std::clamp((x - taper) / (end - taper), 0.0, 1.0);
  return rise * t * t;
}

Vec3 Fuselage::at(double q, double angle) const {
  double x = q, r = radius_at(q);
  if (q < nose) {
    x = nose - nose * std::cos(quarter * q / nose);
    r = radius * std::sin(quarter * q / nose);
  } else if (q > end) {
    double const turned = quarter * (q - end) / rounding;
    x = end + rounding * std::sin(turned);
    r = end_radius * std::cos(turned);
  }
  return {x, r * std::cos(angle), centre_at(x) + r * std::sin(angle)};
}

double Fuselage::side(double x, double z) const {
  double const r = radius_at(x), height = z - centre_at(x);
  return std::sqrt(r * r - height * height);
}

double Fuselage::top(double x, double y) const {
  double const r = radius_at(x);
  return centre_at(x) + std::sqrt(r * r - y * y);
}

double Fuselage::station_of_nose(double angle) const { return nose * angle / quarter; }
double Fuselage::station_of_end(double angle) const { return end + rounding * (1 - angle / quarter); }

Vec3 Nacelle::at(Vec3 const& direction) const {
  double const n = norm(direction);
  return centre + Vec3{half_length * direction.x / n, radius * direction.y / n, radius * direction.z / n};
}

double LiftingSurface::front(double u, double v) {
  return nose_length * (1 - 1 / std::sqrt(1 + u * u + v * v));  // the cosine of the angle off the chord
}

Vec3 LiftingSurface::at_nose(double s, double u, double v) const { return at(s, front(u, v), u, v); }

Vec3 LiftingSurface::at(double s, double x, double u, double v) const {
  double const chord = (1 - s) * root_chord + s * tip_chord;
  double const half = chord * half_thickness((1 - s) * root_thickness + s * tip_thickness, x);
  // Round sections of the tip at the nose, square ones at the trailing edge.
  double const round = 1 - smooth((x - 0.05) / 0.9), off = std::hypot(u, v);
  double const share = off > 0 ? round / off + (1 - round) : 0;
  return (1 - s) * root + s * tip + Vec3{x * chord, 0, 0} + (half * share * u) * span + (half * share * v) * normal;
}

}  // namespace gridmorph::aircraft
