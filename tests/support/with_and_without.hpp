// A plan with a frozen guard and the same plan without it.
#pragma once

#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/plan/smoothing_map.hpp>

#include <algorithm>
#include <memory>
#include <vector>

namespace gridmorph::test {

using Vectors = std::vector<Vec3>;
using Frozen = std::shared_ptr<SmoothingMap const>;

inline Coordinates copy_of(Coordinates const& x) {
  Coordinates out(x.size());
  for (Index n = 0; n < x.size(); ++n) out.set(n, x[n]);
  return out;
}

inline double largest_distance(Coordinates const& a, Coordinates const& b) {
  double largest = 0;
  for (Index n = 0; n < a.size(); ++n) largest = std::max(largest, distance(a[n], b[n]));
  return largest;
}

inline Vectors scaled(double factor, Vectors const& u) {
  Vectors out;
  for (Vec3 const& v : u) out.push_back(factor * v);
  return out;
}
inline Vectors sum(Vectors const& a, Vectors const& b) {
  Vectors out;
  for (std::size_t n = 0; n < a.size(); ++n) out.push_back(a[n] + b[n]);
  return out;
}

/// One plan with and without what was frozen.
template <class Space = Kokkos::DefaultHostExecutionSpace>
struct Both {
  using View = Kokkos::View<Vec3 const*, Kokkos::HostSpace>;
  Coordinates baseline;
  Morpher<Space> plain, frozen;

  template <class AnyPlan>
  Both(AnyPlan const& plan, Coordinates const& x, Frozen const& map)
      : baseline(x),
        plain(MorpherAccess::of(Space(), plan, x, {1, true})),
        frozen(MorpherAccess::of(Space(), plan, x, {1, true, map})) {}

  static View view(Vectors const& v) { return View(v.data(), v.size()); }
  Coordinates run(auto const& call) const {
    Coordinates out(baseline.size());
    call(out);
    Space().fence();
    return out;
  }
  [[nodiscard]] Coordinates positions(Morpher<Space> const& m, Vectors const& b) const {
    return run([&](Coordinates& out) { m.positions(Space(), view(b), out); });
  }
  [[nodiscard]] Coordinates displacements(Morpher<Space> const& m, Vectors const& b) const {
    return run([&](Coordinates& out) { m.displacements(Space(), view(b), out); });
  }
  [[nodiscard]] Coordinates velocities(Vectors const& b, Vectors const& rate) const {
    return run([&](Coordinates& out) { frozen.velocities(Space(), view(b), view(rate), out); });
  }
  /// What is added to the plan's displacement.
  [[nodiscard]] Coordinates shifts(Vectors const& b) const {
    Coordinates const u = displacements(plain, b), v = displacements(frozen, b);
    Coordinates out(u.size());
    for (Index n = 0; n < u.size(); ++n) out.set(n, v[n] - u[n]);
    return out;
  }
};

}  // namespace gridmorph::test
