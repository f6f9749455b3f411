// What all surfaces that a node slides on ask of its displacement, and sliding along the edge where several of them
// meet.
#pragma once

#include <gridmorph/kernels/slip_surface.hpp>

namespace gridmorph::kernels {

/// Surfaces or offsets in a list, as the functions here ask for them: for the host, whose lambdas no kernel calls.
template <class T>
struct Listed {
  T const* list;
  KOKKOS_INLINE_FUNCTION T const& operator()(int m) const { return list[m]; }
};

/// Directions across the edge where the node is: unit, at right angles to one another.
struct AcrossEdge {
  Vec3 direction[3];
  int count = 0;
};

/// Corrects the displacement u of a baseline node until the node is where all of `count` surfaces want it, by
/// Gauss-Newton steps: each the shortest that brings it onto the tangent planes of all surfaces at once. Quadratic
/// convergence, whatever the angle; putting the node on one surface after the other gains a factor cos^2 of the angle
/// per round. Surfaces that meet at less than 0.01 rad count as one. `surface(m)` is a SlipSurfaceView, `own(m)` the
/// node's own offset from it.
template <class Surfaces, class Offsets>
KOKKOS_INLINE_FUNCTION AcrossEdge slide_along_edge(int count, Surfaces const& surface, Offsets const& own,
                                                   Vec3 const& baseline, Vec3& u) {
  constexpr int max_steps = 20;
  double last = -1;
  for (int n = 0;; ++n) {
    // Gram-Schmidt: what a surface asks for is added across the surfaces before it, so they stay satisfied.
    AcrossEdge across;
    Vec3 step;
    for (int m = 0; m < count && across.count < 3; ++m) {
      Vec3 gradient;
      double const excess = surface(m).excess(baseline, own(m), u, gradient);
      Vec3 part = gradient;
      for (int k = 0; k < across.count; ++k) part = part - dot(part, across.direction[k]) * across.direction[k];
      double const share = dot(part, part);
      if (!(share > 1e-4 * dot(gradient, gradient))) continue;
      step = step - ((excess + dot(gradient, step)) / share) * part;
      across.direction[across.count++] = (1 / norm(part)) * part;
    }
    double const length = norm(step);
    bool const done = !(length > 1e-15 * surface(0).size) || (last >= 0 && !(length < 0.9 * last));
    if (!done) u += step;
    if (done || n + 1 == max_steps) return across;
    last = length;
  }
}

/// The displacement u of a baseline node, corrected for all of its `count` surfaces; with `Rate` also its rate of
/// change. surface(m), own(m): as above.
///
/// Surfaces are applied in turn; planes at right angles, and surfaces of revolution with planes across or along their
/// axis, are exact after one round. Where that does not converge in three rounds the node slides along their common
/// edge. The rate after that is the one before without its components across the edge: exact but for the curvature of
/// the surfaces over the length of the steps. A displacement that all surfaces leave as it is has a rate that they do
/// not: it goes through the same rounds, and along the edge.
template <bool Rate, class Surfaces, class Offsets>
KOKKOS_INLINE_FUNCTION void constrain_to_all(int count, Surfaces const& surface, Offsets const& own,
                                             Vec3 const& baseline, Vec3& u, Vec3& rate) {
  constexpr int max_rounds = 3;
  bool converged = false;
  for (int round = 0; round < (count > 1 ? max_rounds : 1); ++round) {
    // Each surface has to leave u as it is: two that put the node back along one line undo each other's step, round by
    // round.
    converged = true;
    for (int m = 0; m < count; ++m) {
      Vec3 const before = u;
      if constexpr (Rate) rate = surface(m).constrain_rate(baseline, own(m), u, rate);
      u = surface(m).constrain(baseline, own(m), u);
      converged = converged && u == before;
    }
    if (count < 2 || (converged && !Rate)) return;
  }
  Vec3 on_all = u;
  AcrossEdge const across = slide_along_edge(count, surface, own, baseline, on_all);
  if (!converged) u = on_all;
  if constexpr (Rate)
    for (int k = 0; k < across.count; ++k) rate = rate - dot(rate, across.direction[k]) * across.direction[k];
}

}  // namespace gridmorph::kernels
