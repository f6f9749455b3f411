#include "support/motions.hpp"

#include <cmath>

namespace gridmorph::test {

VectorField waves(double amplitude, double k) {
  return [=](Vec3 const& p) {
    return amplitude * Vec3{std::sin(k * (p.x + 0.7 * p.y)) + 0.3, std::cos(k * (p.y - 0.4 * p.z) + 0.5),
                            std::sin(k * (p.z + 0.3 * p.x * p.y) + 1)};
  };
}

VectorField turning_waves(Sector const& sector, double amplitude) {
  return [=](Vec3 const& p) {
    Vec3 const c = sector_coordinates(sector, p);
    double const lobe = c.y * c.y * std::cos(sector.copies * c.z);
    double const turn = amplitude * (0.5 + 0.3 * std::sin(c.x) + 0.2 * lobe);
    double const radius = c.y * (1 + amplitude * (0.4 * std::cos(c.x) + 0.1 * lobe));
    double const axial = c.x + amplitude * (0.3 * c.x + 0.2 * c.y * c.y);
    return sector_position(sector, axial, radius, c.z + turn) - p;
  };
}

VectorField layered_waves(double amplitude) {
  Vec3 const across = cross({0.1, 1, 0.05}, {0, 0.2, 1.2});
  return [=](Vec3 const& p) {
    double const s = dot(across, p);
    return amplitude * Vec3{std::sin(s) + 0.2, std::cos(2 * s), 0.5 + std::sin(3 * s)};
  };
}

VectorField turn_about_z(Vec3 const& centre, double angle_rad) {
  double const c = std::cos(angle_rad) - 1, s = std::sin(angle_rad);
  return [=](Vec3 const& p) {
    Vec3 const d = p - centre;
    return Vec3{c * d.x - s * d.y, s * d.x + c * d.y, 0};
  };
}

}  // namespace gridmorph::test
