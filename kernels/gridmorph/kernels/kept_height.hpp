// How far a line that stands on a wall follows the wall's rotation where faces around its root turn differently.
#pragma once

#include <gridmorph/kernels/rotation.hpp>

#include <type_traits>

namespace gridmorph::kernels {

/// The share of a turn that keeps heights. With h(f) the height of the line's first node above a face after a share f
/// of the turn, over that before: the largest f, 1 at most, with h(f) >= min(k, h(0)) for all faces, h taken as linear.
/// k is 1/2 where the line stands half way between a face and its normal, and 0.99 where it leans to the face. (Heights
/// may grow: holding them back as well inverts cells further up a wing's trailing edge.) line: unit, on the side to
/// which the normals of the faces look. before(k), after(k): normal of face k, as long as the face is large, V each.
/// Cost: about 60 flops per face.
template <class V, class Before, class After>
KOKKOS_INLINE_FUNCTION auto share_that_keeps_height(Vec3 const& line, V const& turn, Index n_faces,
                                                    Before const& before, After const& after) {
  using Scalar = std::decay_t<decltype(dot(turn, turn))>;
  V const along{line}, change = turned_by(turn, along);
  Scalar share{1};
  for (Index k = 0; k < n_faces; ++k) {
    V const face = before(k), moved = after(k);
    auto const height = dot(face, along), size = norm(moved);
    bool const above = height > 0.05 * norm(value_of(face)) && size > 0;
    if (!above) continue;
    auto const unit = norm(face) / (size * height), stays = unit * dot(moved, along);
    double const sine = value_of(height / norm(face)), keep = 1.2 - 1.4 * sine * sine;
    auto const loss = -unit * dot(moved, change), room = stays - Scalar{keep < 0.99 ? keep : 0.99};
    if (!((loss - room) > 0)) continue;
    if (room > 0) {
      auto const most = room / loss;
      if ((share - most) > 0) share = most;
    } else if (loss > 0) {
      return Scalar{};
    }
  }
  return share;
}

/// How much a turn whose |r|^2 is `square` is held back for the sake of heights: wholly up to 120 degrees, not at all
/// beyond 150, where h(f) is far from linear, and a share of the turn that is to keep the last per cent of a height may
/// leave the line behind by a right angle.
inline constexpr double never_held_back = 0.58879070648;  // tan(37.5 degrees)^2
template <class Scalar>
KOKKOS_INLINE_FUNCTION Scalar held_back(Scalar const& square) {
  if (!(square > longer_ways)) return Scalar{1};
  Scalar const left = (1 / (never_held_back - longer_ways)) * (Scalar{never_held_back} - square);
  return left > 0 ? left * left * (Scalar{3} - 2 * left) : Scalar{};
}
KOKKOS_INLINE_FUNCTION double held_back_slope(double square) {
  double const left = (never_held_back - square) / (never_held_back - longer_ways);
  return left > 0 && left < 1 ? -6 * left * (1 - left) / (never_held_back - longer_ways) : 0;
}

}  // namespace gridmorph::kernels
