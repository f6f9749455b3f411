// A plate with two blind holes, of blocks.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include "support/mesh_builders.hpp"

#include <algorithm>
#include <cmath>

namespace gridmorph::test {

/// The flow over [0, 16] x [0, 10] x [0, 3] in seven zones, its wall of family "plate", and below it two round holes of
/// radius 1 and depth 2 around (5, 5) and (11, 5), each a zone with its walls and floor of family "hole_1" or "hole_2".
/// Sides "u_min" ... "w_max".
inline Mesh plate_with_holes() {
  Bricks b;
  b.name = "plate";
  b.extent = {33, 21, 6};
  auto const brick = [&](int i0, int i1, int j0, int j1, int k0, int k1) {
    b.zones.push_back({{i0, j0, k0}, {i1 + 1, j1 + 1, k1 + 1}});
  };
  brick(0, 32, 0, 8, 2, 5);
  brick(0, 32, 12, 20, 2, 5);
  for (int const i : {0, 12, 24}) brick(i, i + 8, 8, 12, 2, 5);
  for (int const k : {2, 0})
    for (int const i : {8, 20}) brick(i, i + 4, 8, 12, k, k == 2 ? 5 : 2);
  b.position = [](Vec3 const& q) {
    Vec3 p{16 * q.x, 10 * q.y, 5 * q.z - 2};
    // Squares around the middle of a hole are circles at its wall, and squares again at twice its radius.
    for (double const middle : {5.0, 11.0}) {
      Vec3 const d = p - Vec3{middle, 5, p.z};
      double const square = std::max(std::abs(d.x), std::abs(d.y)), share = square < 1 ? square : 2 - square;
      if (square > 0 && share > 0) p = p - (share * (1 - square / norm(d))) * d;
    }
    return p;
  };
  Mesh mesh = make(b);
  for (Patch& patch : mesh.patches) {
    bool const step = patch.families.front() == "step";
    if (patch.zone >= 7) patch.families = {patch.zone == 7 ? "hole_1" : "hole_2"};
    if (patch.zone < 7 && step) patch.families = {"plate"};
    patch.name = patch.families.front();
  }
  return mesh;
}

}  // namespace gridmorph::test
