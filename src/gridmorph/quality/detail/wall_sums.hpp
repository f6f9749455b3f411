// Sums of what is measured at wall nodes; internal to the quality part.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/wall_quality.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::detail {

/// Running sums over nodes in order, so that they do not depend on threads.
struct WallSums {
  WallQuality quality;
  double heights = 0, angles = 0;

  void add(kernels::WallNodePair const& w, NodeLocation const& where, bool against_baseline) {
    if (!w.now.defined) return;
    double const height = w.now.height, angle = w.now.orthogonality_deg;
    bool const first = quality.nodes == 0;
    quality.first_height_min = first ? height : std::min(quality.first_height_min, height);
    quality.first_height_max = std::max(quality.first_height_max, height);
    if (first || angle > quality.orthogonality_deg_max) {
      quality.orthogonality_deg_max = angle;
      quality.orthogonality_worst = where;
    }
    heights += height;
    angles += angle;
    ++quality.nodes;
    if (!against_baseline || !w.before.defined) return;
    double const height_change = w.before.height > 0 ? std::abs(height / w.before.height - 1)
                                 : height > 0        ? kernels::unbounded
                                                     : 0;
    double const angle_change = std::abs(angle - w.before.orthogonality_deg);
    if (height_change > quality.height_change_max) {
      quality.height_change_max = height_change;
      quality.height_change_worst = where;
    }
    if (angle_change > quality.orthogonality_change_deg_max) {
      quality.orthogonality_change_deg_max = angle_change;
      quality.orthogonality_change_worst = where;
    }
  }

  [[nodiscard]] WallQuality result() const {
    WallQuality q = quality;
    if (q.nodes > 0) {
      q.first_height_mean = heights / double(q.nodes);
      q.orthogonality_deg_mean = angles / double(q.nodes);
    }
    return q;
  }
};

}  // namespace gridmorph::detail
