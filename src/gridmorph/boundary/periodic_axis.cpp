#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

constexpr double smallest_angle = 1e-4;  // rad; a smaller turn is a translation
constexpr double line = 1e-9;            // of the mesh size: points that near to a line lie on it

Vec3 mean(std::vector<Vec3> const& points) {
  Vec3 sum;
  for (auto const& p : points) sum += p;
  return (1 / double(points.size())) * sum;
}

/// A unit vector across the line on which all points lie; nothing where they span a plane. Points in one place lie on
/// any line.
std::optional<Vec3> across_line(std::vector<Vec3> const& points, double size) {
  Vec3 const centre = mean(points);
  auto const far = *std::max_element(points.begin(), points.end(), [&](Vec3 const& a, Vec3 const& b) {
    return distance(a, centre) < distance(b, centre);
  });
  double const length = distance(far, centre);
  Vec3 const along = length > line * size ? (1 / length) * (far - centre) : Vec3{1, 0, 0};
  for (auto const& p : points)
    if (norm(cross(p - centre, along)) > line * size) return std::nullopt;
  Vec3 const other = std::fabs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 const across = cross(along, other);
  return (1 / norm(across)) * across;
}

}  // namespace

std::optional<AxisTurn> as_turn(RigidTransform const& t, double tolerance) {
  Vec3 const turn = rotation_vector(t.rotation);
  AxisTurn out;
  out.angle_rad = norm(turn);
  if (out.angle_rad < smallest_angle) return std::nullopt;
  out.direction = (1 / out.angle_rad) * turn;
  double const along = dot(t.translation, out.direction);
  if (std::fabs(along) > tolerance) return std::nullopt;
  Vec3 const across = t.translation - along * out.direction;
  double const half = 0.5 * out.angle_rad;
  out.origin = 0.5 * (across + (std::cos(half) / std::sin(half)) * cross(out.direction, across));
  return out;
}

RigidTransform fit_periodic(Periodic const& declared, std::vector<Vec3> const& from, std::vector<Vec3> const& to,
                            double size) {
  if (from.empty()) return declared.declared;
  if (norm(declared.rotation_angle_rad) > 0) {
    RigidTransform fit;
    if (auto const across = across_line(from, size)) {
      // A second line beside the first one, carried as declared, leaves the fit no choice.
      std::vector<Vec3> own = from, donor = to;
      double const reach = std::max(distance(from.front(), from.back()), line * size);
      Vec3 const image = declared.declared.rotation * *across;
      for (std::size_t n = 0; n < from.size(); ++n) {
        own.push_back(from[n] + reach * *across);
        donor.push_back(to[n] + reach * image);
      }
      fit = fit_rigid_transform(own, donor);
    } else {
      fit = fit_rigid_transform(from, to);
    }
    // An axis through the origin is the rule; drop the round-off of the fit there.
    if (norm(fit.translation) < 1e-13 * size) fit.translation = {};
    return fit;
  }
  Vec3 way;
  for (std::size_t n = 0; n < from.size(); ++n) way += to[n] - from[n];
  return {Mat3{}, (1 / double(from.size())) * way};
}

bool are_alike(RigidTransform const& a, RigidTransform const& b, double size) {
  double difference = distance(a.translation, b.translation);
  for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    difference += size * distance(a.rotation * e, b.rotation * e);
  return difference < 1e-4 * size;
}

}  // namespace gridmorph
