// Gradients through slip surfaces: of the displacement u of a node, from that of what its surfaces make of it
// (slip_surface.hpp, slip_edge.hpp). With D the derivative that constrain_rate() applies, D^T g; of one surface written
// out,
//
//   plane, axial   g - (n.g) n
//   revolution     g - (m.g) ((1 - e / r) m - p' n) - (e / r) (g - (n.g) n),
//                  m the radial direction, e too far off, p' the slope
//   meridional     g - (k.g) a - e ((t.g) c + (k_r / r) (g - (n.g) n - (m.g) m)),
//                  k the normal, a the gradient of the distance along it, t the tangent, c t . q' the rate at which the
//                  normal turns
//
// of facets and where several surfaces meet by exact rates along three axes.
//
// Cost: one surface as its projection; otherwise three rates.
#pragma once

#include <gridmorph/kernels/slip_edge.hpp>

namespace gridmorph::kernels {

/// rate(direction) . g along the three axes.
template <class Rate>
KOKKOS_INLINE_FUNCTION Vec3 gradient_by_rates(Vec3 const& g, Rate const& rate) {
  return {dot(rate(Vec3{1, 0, 0}), g), dot(rate(Vec3{0, 1, 0}), g), dot(rate(Vec3{0, 0, 1}), g)};
}

/// Kind meridional; `outwards`: the radial direction at distance r from the axis.
KOKKOS_INLINE_FUNCTION Vec3 meridional_gradient(SlipSurfaceView const& s, double axial, double r, Vec3 const& outwards,
                                                double own, Vec3 const& g) {
  using std::sqrt;
  MeridionalFoot const f = s.foot(axial, r);
  Vec3 const normal = f.axial * s.direction + f.radial * outwards;
  Vec3 of_away = normal, of_turn;
  if (s.frame.inclined()) {
    double const metric = 1 + f.slope * f.slope, curvature = f.bend / (metric * sqrt(metric));
    Vec3 const tangent = f.radial * s.direction + (-f.axial) * outwards;
    of_turn = (-curvature * dot(tangent, g) / (1 - curvature * f.away)) * tangent;
  } else {
    of_away = of_away - f.slope * (s.frame.abscissa(1, 0) * s.direction + s.frame.abscissa(0, 1) * outwards);
  }
  Vec3 const around = g - dot(s.direction, g) * s.direction - dot(outwards, g) * outwards;
  return g - dot(normal, g) * of_away - (f.away - own) * (of_turn + (f.radial / r) * around);
}

/// Transpose of SlipSurfaceView::constrain_rate().
KOKKOS_INLINE_FUNCTION Vec3 slip_gradient(SlipSurfaceView const& s, Vec3 const& baseline, double own, Vec3 const& u,
                                          Vec3 const& g) {
  Vec3 const& n = s.direction;
  if (s.kind == SlipKind::facets) {
    auto const foot = s.facets.closest_point(baseline + u);
    return gradient_by_rates(g, [&](Vec3 const& rate) { return s.facets.foot_rate(foot, baseline + u, rate); });
  }
  if (s.kind != SlipKind::revolution && s.kind != SlipKind::meridional) return g - dot(n, g) * n;
  Vec3 const d = baseline - s.origin;
  double const a = dot(d, n), du = dot(u, n);
  Vec3 const moved = (d - a * n) + (u - du * n);
  double const r = norm(moved);
  if (!(r > 0)) return s.lies_across() ? g - dot(n, g) * n : g;
  Vec3 const outwards = (1 / r) * moved;
  if (s.kind == SlipKind::meridional) return meridional_gradient(s, a + du, r, outwards, own, g);
  ProfileSample const wall = s.profile.sample(a + du);
  double const share = (r - (wall.value + own)) / r;
  Vec3 const of_excess = (1 - share) * outwards - wall.slope * n;
  return g - dot(outwards, g) * of_excess - share * (g - dot(n, g) * n);
}

/// Transpose of the rate of constrain_to_all().
template <class Surfaces, class Offsets>
KOKKOS_INLINE_FUNCTION Vec3 constrained_gradient(int count, Surfaces const& surface, Offsets const& own,
                                                 Vec3 const& baseline, Vec3 const& u, Vec3 const& g) {
  if (count == 1) return slip_gradient(surface(0), baseline, own(0), u, g);
  return gradient_by_rates(g, [&](Vec3 const& direction) {
    Vec3 wanted = u, rate = direction;
    constrain_to_all<true>(count, surface, own, baseline, wanted, rate);
    return rate;
  });
}

}  // namespace gridmorph::kernels
