#include <gridmorph/geometry/plane_fit.hpp>

#include <gridmorph/geometry/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

double deviation_from_plane(std::span<Vec3 const> points, Vec3 const& origin, Vec3 const& normal) {
  double worst = 0;
  for (Vec3 const& p : points) worst = std::max(worst, std::abs(dot(p - origin, normal)));
  return worst;
}

PlaneFit fit_plane(std::span<Vec3 const> points) {
  PlaneFit fit;
  // Offsets from the first point, so that a coordinate all points share drops out exactly.
  for (Vec3 const& p : points) fit.origin += p - points.front();
  fit.origin = points.front() + (1.0 / double(points.size())) * fit.origin;

  Moments moments;
  for (Vec3 const& p : points) {
    moments.add(1, p - fit.origin);
    fit.extent = std::max(fit.extent, norm(p - fit.origin));
  }
  auto const [moment, direction] = PrincipalAxes(moments);
  fit.normal = (1 / norm(direction[2])) * direction[2];
  fit.deviation = deviation_from_plane(points, fit.origin, fit.normal);
  // The middle moment measures the width across the longest direction: 1e-6 of the length is a line.
  fit.determined = moment[1] > 1e-12 * moment[0] && fit.extent > 0;
  return fit;
}

}  // namespace gridmorph
