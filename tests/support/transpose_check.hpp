// A morph's transpose against its derivative forwards.
#pragma once

#include "support/morph_run.hpp"
#include "support/random.hpp"

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/morph/morpher_access.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph::test {

inline Coordinates random_vectors(unsigned seed, Index n) {
  Random random(seed);
  Coordinates c(n);
  for (Index k = 0; k < n; ++k) c.set(k, random.vector(1));
  return c;
}
inline Coordinates coordinates_of(std::vector<Vec3> const& values) {
  Coordinates c(Index(values.size()));
  for (Index k = 0; k < c.size(); ++k) c.set(k, values[std::size_t(k)]);
  return c;
}

/// A Morpher on a host space at one displacement of the boundary, with velocity and transpose.
template <class Exec>
struct LinearisedMorph {
  Morpher<Exec> morpher;
  Coordinates boundary;
  Index n_nodes;

  template <class AnyPlan>
  LinearisedMorph(AnyPlan const& plan, Coordinates const& baseline, std::vector<Vec3> const& at,
                  std::shared_ptr<SmoothingMap const> const& smoothing = nullptr)
      : morpher(
            MorpherAccess::of(Exec(), plan, baseline, {.velocity = true, .smoothing = smoothing, .transpose = true})),
        boundary(coordinates_of(at)),
        n_nodes(baseline.size()) {}

  [[nodiscard]] Coordinates forwards(Coordinates const& rate) const {
    Coordinates v(n_nodes);
    morpher.velocities(Exec(), boundary, rate, v);
    Exec().fence();
    return v;
  }
  [[nodiscard]] Coordinates backwards(Coordinates const& gradient) const {
    Coordinates g(boundary.size());
    morpher.transpose(Exec(), boundary, gradient, g);
    Exec().fence();
    return g;
  }
};

/// Bits by which gradients differ where another displacement has gone through the Morpher since it was made; 0: a
/// transpose runs all that it is linearised at itself.
template <class Exec>
Index bits_left_by_others(LinearisedMorph<Exec> const& at) {
  Coordinates const g = random_vectors(8, at.n_nodes), fresh = at.backwards(g);
  Coordinates other(at.boundary.size()), u(at.n_nodes);
  for (Index k = 0; k < other.size(); ++k) other.set(k, -0.3 * at.boundary[k]);
  at.morpher.displacements(Exec(), other, u);
  Exec().fence();
  return different_bits(at.backwards(g), fresh);
}

/// Largest of |g . Jr - J^T g . r| over the sum of the sizes of both products' terms, for random g and r. Terms, not
/// sums: those of a random g cancel.
template <class Exec>
double product_error(LinearisedMorph<Exec> const& at, unsigned n_seeds = 2) {
  double worst = 0;
  for (unsigned seed = 1; seed <= n_seeds; ++seed) {
    Coordinates const rate = random_vectors(seed, at.boundary.size()), g = random_vectors(100 + seed, at.n_nodes);
    Coordinates const v = at.forwards(rate), b = at.backwards(g);
    double size = 0, difference = 0;
    auto const add = [&](double sign, Coordinates const& p, Coordinates const& q) {
      for (Index n = 0; n < p.size(); ++n) {
        Vec3 const s = p[n], t = q[n];
        difference += sign * dot(s, t);
        size += std::abs(s.x * t.x) + std::abs(s.y * t.y) + std::abs(s.z * t.z);
      }
    };
    add(1, g, v);
    add(-1, b, rate);
    worst = std::isfinite(difference) ? std::max(worst, std::abs(difference) / size) : HUGE_VAL;
  }
  return worst;
}

}  // namespace gridmorph::test
