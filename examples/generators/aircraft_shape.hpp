// Bodies of the generated aircraft, as surfaces with parameters. Internal to it; metres.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph::aircraft {

/// A body along x whose sections are circles: an ellipsoid's half as nose, a cylinder, a taper that rises, a small
/// rounding. A point is given by the station q, which is x between nose and rounding and the angle about their centres
/// in them, and by the angle from y towards z.
struct Fuselage {
  double nose = 5, taper = 24, end = 35.5, rounding = 0.8, radius = 2, end_radius = 0.5, rise = 0.9;

  [[nodiscard]] double radius_at(double x) const;
  [[nodiscard]] double centre_at(double x) const;
  [[nodiscard]] Vec3 at(double q, double angle) const;
  /// y of the surface beside (x, z), z of it above (x, y); x between nose and rounding.
  [[nodiscard]] double side(double x, double z) const;
  [[nodiscard]] double top(double x, double y) const;
  /// Stations from the angle off the axis at the nose and at the other end.
  [[nodiscard]] double station_of_nose(double angle) const;
  [[nodiscard]] double station_of_end(double angle) const;
};

/// An ellipsoid.
struct Nacelle {
  Vec3 centre{11.5, 6, -3.3};
  double half_length = 2.1, radius = 1.05;

  [[nodiscard]] Vec3 at(Vec3 const& direction) const;
};

/// Wing or tail surface: straight between two sections, with a round nose, a thin blunt trailing edge and, beyond the
/// tip section, a rounding of half circles. The face of the box that surrounds it is the front (nose), the back (base)
/// or one of the sides; u and v are places on the faces of a cube, u along the span (0 up to the tip section, up to 1
/// in the rounding), v across (-1 to 1).
struct LiftingSurface {
  Vec3 root, tip;  ///< leading edges
  double root_chord, tip_chord, root_thickness, tip_thickness;
  Vec3 span, normal;

  /// Share of the chord at which sides begin.
  [[nodiscard]] static double front(double u, double v);
  /// s: share of the span; x: of the chord, of no use at the nose.
  [[nodiscard]] Vec3 at_nose(double s, double u, double v) const;
  [[nodiscard]] Vec3 at(double s, double x, double u, double v) const;
};

struct Shape {
  Fuselage fuselage;
  Nacelle nacelle;
  LiftingSurface wing{{12.5, 2, -0.7}, {20.14, 17, 0.612}, 6.6, 1.7, 0.13, 0.10, {0, 1, 0}, {0, 0, 1}};
  LiftingSurface htail{{31.2, 0.8, 0.75}, {34, 6.2, 1.182}, 3.6, 1.5, 0.10, 0.09, {0, 1, 0}, {0, 0, 1}};
  LiftingSurface vtail{{29.5, 0, 1.6}, {34.3, 0, 7.8}, 5.6, 2, 0.10, 0.09, {0, 0, 1}, {0, 1, 0}};
  static constexpr double hinge = 0.75;  ///< share of the wing's chord
};

}  // namespace gridmorph::aircraft
