// What one position takes from the nodes of a model: the common result of mapping from points and from elements.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph {

/// u(q) = u_r + sum_i weight_i (u_i - u_r) + (R(sum_i turn_i w_i) - I) lever, where r is the reference node, u the
/// displacement of the nodes, w their rotation vectors and R(w) the rotation by |w| about w. The weights add up to 1.
struct Stencil {
  struct Term {
    std::int32_t node = 0;
    double weight = 0;
    double turn = 0;
  };
  std::int32_t reference = 0;
  std::vector<Term> terms;  ///< empty: u_r as it stands
  Vec3 lever;               ///< from the model's surface to the position; zero for points
  double distance = 0;      ///< to the nearest point, or to the surface of the elements [length]
  double beyond = 0;        ///< beyond the edge of the model; 0 inside [length]
  bool far_beyond = false;  ///< by more than two spacings of its points, or two of its elements, there
  bool far_off = false;     ///< farther than two spacings of its points from the nearest of them; of elements never
  bool coincident = false;
};

enum class Extrapolation {
  linear,  ///< the field goes on as it ends, within limits
  nearest  ///< the value at the edge
};

/// Displacement of the stencil's position. `rotation` (n) or empty: the lever is not turned. Zero displacement and zero
/// rotation give exactly zero, constants come out exactly.
Vec3 apply(Stencil const& stencil, std::span<Vec3 const> displacement, std::span<Vec3 const> rotation);

}  // namespace gridmorph
