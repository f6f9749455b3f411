#include <gridmorph/motion/detail/slip_correction.hpp>

namespace gridmorph {

double signed_distance(SlipSurface const& s, Vec3 const& p) {
  if (s.kind == SlipSurface::Kind::axial) return 0;
  if (s.kind == SlipSurface::Kind::facets) {
    kernels::FacetFoot const foot = s.facets.view().closest_point(p);
    return dot(p - foot.point, foot.normal);
  }
  Vec3 const d = p - s.origin;
  double const a = dot(d, s.direction);
  if (s.kind == SlipSurface::Kind::plane) return a;
  double const r = norm(d - a * s.direction);
  return s.kind == SlipSurface::Kind::revolution ? r - s.profile(a) : s.view().foot(a, r).away;
}

Vec3 slip_correction(SlipSurface const& s, Vec3 const& p, Vec3 const& u) {
  if (s.kind == SlipSurface::Kind::plane || s.kind == SlipSurface::Kind::axial)
    return -dot(u, s.direction) * s.direction;
  return s.view().constrain(p, signed_distance(s, p), u) - u;
}

Vec3 slip_normal(SlipSurface const& s, Vec3 const& p) {
  Vec3 gradient;
  static_cast<void>(s.view().excess(p, 0, {}, gradient));
  return (1 / norm(gradient)) * gradient;
}

}  // namespace gridmorph
