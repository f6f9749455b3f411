// The step of one point towards the shapes that its corners have in the baseline; points of blocks and of elements
// share it.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/relative_shape.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph::detail {

/// How delta follows the sweeps, in eighths of them: 0.1, then 0.6 times as much each, as long as a corner has lost 98
/// % of its volume, else 0. `gradual`: growing evenly as that volume falls from 2 % to nothing, so that it does not
/// jump with the motion.
class UntanglingSchedule {
 public:
  explicit UntanglingSchedule(int sweeps, bool gradual = false) : sweeps_(sweeps), gradual_(gradual) {}

  /// smallest_volume(): smallest d of all corners, asked once per eighth.
  template <class SmallestVolume>
  [[nodiscard]] double delta(int sweep, SmallestVolume const& smallest_volume) {
    constexpr int eighths = 8;
    constexpr double shrink = 0.6, enough_volume = 0.02;
    if (int const now = sweep * eighths / sweeps_; now != eighth_) {
      if (eighth_ >= 0) smoothing_ *= shrink;
      eighth_ = now;
      double const lacking = 1 - smallest_volume() / enough_volume;
      delta_ = smoothing_ * (gradual_ ? std::clamp(lacking, 0.0, 1.0) : lacking > 0 ? 1.0 : 0.0);
    }
    return delta_;
  }

 private:
  int sweeps_, eighth_ = -1;
  bool gradual_;
  double smoothing_ = 0.1, delta_ = 0;
};

/// Moves a point at u by `relaxation` times descent_step(), halved up to six times until the sum of f over its corners
/// falls; else not at all. restrict(sum): leaves the directions that are allowed; allowed(u): the nearest place that
/// is; place(u).
template <class Restrict, class Allowed, class Place>
void make_shape_step(std::vector<kernels::CornerChange> const& corners, Vec3 const& u, double delta, double relaxation,
                     Restrict const& restrict, Allowed const& allowed, Place const& place) {
  constexpr int most_halvings = 6;
  kernels::ShapeSum sum;
  for (kernels::CornerChange const& c : corners) sum.add(c, delta);
  restrict(sum);
  Vec3 step = relaxation * descent_step(sum);
  for (int n = 0; n <= most_halvings; ++n, step = 0.5 * step) {
    Vec3 const there = allowed(u + step);
    double value = 0;
    for (kernels::CornerChange const& c : corners)
      value += kernels::relative_shape(c.n_after(there - u), c.d_after(there - u), delta);
    if (value < sum.value) return place(there);
  }
}

/// move(point, room for its corners) for all points of a colour, which do not see one another.
template <class Move>
void sweep_colour(HostInstance const& host, char const* label, std::vector<Index32> const& colour, Move const& move) {
  constexpr Index part = 32, few_parts = 2;  // points that one core takes at a time; what one core does alone
  Index const count = Index(colour.size()), parts = (count + part - 1) / part;
  auto const move_part = [&](Index n) {
    std::vector<kernels::CornerChange> corners;
    for (Index at = n * part; at < std::min(count, (n + 1) * part); ++at) move(colour[at], corners);
  };
  if (parts > few_parts)
    for_all_parts(host, label, parts, move_part);
  else  // threads would wait for one another longer than they work
    for (Index n = 0; n < parts; ++n) move_part(n);
}

}  // namespace gridmorph::detail
