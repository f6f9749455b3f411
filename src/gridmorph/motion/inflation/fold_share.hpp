// How far a surface can be displaced before it folds.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <span>

namespace gridmorph {

/// Where a displaced surface loses a face first.
struct Fold {
  double share = 1;  ///< of the displacement; 1: the surface does not fold
  int vertex = -1;
};

/// The smallest share s of the displacements u of the vertices, up to 1, at which a corner of a face has less than a
/// hundredth of its baseline area, counted along the face's baseline normal n: with edges e, f from the corner, ((e + s
/// du) x (f + s dv)) . n =
/// ((e x f) . n) / 100, a quadratic in s. Of lines the same with their length. Cost O(faces).
Fold fold_share(PatchSurface const& surface, std::span<Vec3 const> displacement);

}  // namespace gridmorph
