// The affine displacement nearest to given ones.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <span>

namespace gridmorph {

/// u(x) = gradient (x - centre) + mean.
struct AffineDisplacement {
  Vec3 centre, mean;
  Mat3 gradient{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};

  [[nodiscard]] Vec3 operator()(Vec3 const& x) const { return gradient * (x - centre) + mean; }
  /// A surface normal after the displacement, of any length: the cofactors of I + gradient times n.
  [[nodiscard]] Vec3 turned(Vec3 const& n) const;
};

/// The fit by least squares, for use on `region`. Directions in which the points do not extend (less than 1e-6 of their
/// size, or a third of what the region does: edges of a thin wing say nothing about its thickness) get no gradient of
/// their own: where it is one direction, what is across the others stays across them and as long as it was, as in a
/// rotation; where it is more, no gradient. Zero displacements give exactly zero. No points: zero.
AffineDisplacement fit_affine(std::span<Vec3 const> points, std::span<Vec3 const> displacement,
                              std::span<Vec3 const> region);

}  // namespace gridmorph
