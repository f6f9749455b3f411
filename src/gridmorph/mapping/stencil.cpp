#include <gridmorph/mapping/stencil.hpp>

#include <cmath>

namespace gridmorph {

Vec3 apply(Stencil const& stencil, std::span<Vec3 const> displacement, std::span<Vec3 const> rotation) {
  Vec3 const u0 = displacement[stencil.reference];
  if (stencil.terms.empty()) return u0;
  Vec3 sum{0, 0, 0}, w{0, 0, 0};
  for (auto const& term : stencil.terms) {
    sum += term.weight * (displacement[term.node] - u0);
    if (!rotation.empty()) w += term.turn * rotation[term.node];
  }
  Vec3 const u = u0 + sum;
  double const angle = norm(w);
  if (angle == 0) return u;
  // Rodrigues' formula for R - I: sin(a) k x l + (1 - cos(a)) k x (k x l).
  Vec3 const k = (1 / angle) * w, across = cross(k, stencil.lever);
  double const half = std::sin(angle / 2);
  return u + std::sin(angle) * across + (2 * half * half) * cross(k, across);
}

}  // namespace gridmorph
