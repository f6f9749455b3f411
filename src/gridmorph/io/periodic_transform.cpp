#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/io/periodic_transform.hpp>

#include <algorithm>
#include <cstddef>

namespace gridmorph::io {

std::optional<Periodic> periodic_of(RigidTransform const& transform, double allowed) {
  if (auto const turn = as_turn(transform, allowed))
    return periodic_rotation(turn->origin, turn->direction, turn->angle_rad);
  if (norm(rotation_vector(transform.rotation)) > 0 && !(transform.rotation * Vec3{1, 1, 1} == Vec3{1, 1, 1}))
    return std::nullopt;
  return periodic_translation(transform.translation);
}

std::optional<Periodic> periodic_between(std::vector<Vec3> from, std::vector<Vec3> to, double allowed, bool flat) {
  std::size_t const n_points = from.size();
  if (n_points == 0) return std::nullopt;
  Vec3 shift;
  for (std::size_t n = 0; n < n_points; ++n) shift += (1 / double(n_points)) * (to[n] - from[n]);
  auto const fits = [&](RigidTransform const& t) {
    for (std::size_t n = 0; n < n_points; ++n)
      if (distance(t(from[n]), to[n]) > allowed) return false;
    return true;
  };
  if (Periodic const p = periodic_translation(shift); fits(p.declared)) return p;
  if (flat) {  // points on a line turn about any axis, points on both sides of a strip about z alone
    double reach = 0;
    for (Vec3 const& p : from) reach = std::max(reach, distance(p, from.front()));
    for (std::size_t n = 0; n < n_points; ++n) {
      from.push_back(from[n] + Vec3{0, 0, reach});
      to.push_back(to[n] + Vec3{0, 0, reach});
    }
  }
  auto const turn = as_turn(fit_rigid_transform(from, to), allowed);
  if (!turn) return std::nullopt;
  Periodic const p = periodic_rotation(turn->origin, turn->direction, turn->angle_rad);
  return fits(p.declared) ? std::optional(p) : std::nullopt;
}

}  // namespace gridmorph::io
