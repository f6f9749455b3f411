// A morph's transpose against its derivative forwards.
#pragma once

#include "support/every_space.hpp"
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
  for (Index k = 0; k < c.size(); ++k) c.set(k, values[k]);
  return c;
}

/// A Morpher at one displacement of the boundary, with velocity and transpose.
template <class Exec>
struct LinearisedMorph {
  using Field = DeviceField<typename Exec::memory_space>;  // on the host the arrays themselves
  Field baseline;
  Morpher<Exec> morpher;
  Coordinates boundary;
  Index n_nodes;

  template <class AnyPlan>
  LinearisedMorph(AnyPlan const& plan, Coordinates const& x, std::vector<Vec3> const& at,
                  std::shared_ptr<SmoothingMap const> const& smoothing = nullptr)
      : baseline(x),
        morpher(
            MorpherAccess::of(Exec(), plan, baseline, {.velocity = true, .smoothing = smoothing, .transpose = true})),
        boundary(coordinates_of(at)),
        n_nodes(x.size()) {}

  [[nodiscard]] Coordinates displacements() const {
    Field const at(boundary), u{Coordinates(n_nodes)};
    morpher.displacements(Exec(), at, u);
    return finished(u);
  }
  [[nodiscard]] Coordinates forwards(Coordinates const& rate) const {
    Field const at(boundary), dt(rate), v{Coordinates(n_nodes)};
    morpher.velocities(Exec(), at, dt, v);
    return finished(v);
  }
  [[nodiscard]] Coordinates backwards(Coordinates const& gradient) const {
    Field const at(boundary), dJ_du(gradient), dJ_db{Coordinates(boundary.size())};
    morpher.transpose(Exec(), at, dJ_du, dJ_db);
    return finished(dJ_db);
  }

 private:
  static Coordinates finished(Field const& field) {
    Exec().fence();
    return field.host_copy();
  }
};

/// Of the morph that linearised(exec) makes: displacements, derivative and transpose on all execution spaces against
/// those on the host's default.
template <class Linearised>
void expect_same_derivatives(Linearised const& linearised, Coordinates const& rate, Coordinates const& gradient) {
  auto const reference = linearised(Kokkos::DefaultHostExecutionSpace());
  Coordinates const u = reference.displacements(), v = reference.forwards(rate), g = reference.backwards(gradient);
  on_every_space([&](auto const& exec, char const*) {
    auto const at = linearised(exec);
    expect_same_on(exec, at.displacements(), u, 1e-13 * std::max(1.0, largest_component(u)));
    expect_same_on(exec, at.forwards(rate), v, 1e-12 * largest_component(v));
    expect_same_on(exec, at.backwards(gradient), g, 1e-12 * largest_component(g));
  });
}

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
