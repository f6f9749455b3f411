// Interpolation in a lattice of equal cells against functions that are linear in each coordinate.
#include "support/random.hpp"

#include <gridmorph/kernels/lattice_field.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::LatticeReader;
using kernels::UniformLattice;

/// Lattices in space, in each plane and along each axis; odd sizes.
std::vector<UniformLattice> lattices() {
  std::vector<UniformLattice> out;
  for (int flat = 0; flat < 8; ++flat) {
    UniformLattice lattice{{-1, 2, 0.5}, 0.3, {5, 2, 8}};
    for (int a = 0; a < 3; ++a)
      if (flat >> a & 1) lattice.nodes[a] = 1;
    out.push_back(lattice);
  }
  return out;
}

Vec3 trilinear(Vec3 const& x) {
  return {1 + x.x - 2 * x.y + 3 * x.z, x.x * x.y - x.z, 0.2 * x.x * x.y * x.z + x.y * x.z};
}

std::vector<Vec3> on_nodes(UniformLattice const& lattice, Vec3 (*f)(Vec3 const&)) {
  std::vector<Vec3> value;
  for (std::int64_t n = 0; n < lattice.size(); ++n) value.push_back(f(lattice.position(n)));
  return value;
}

/// The point of the lattice's box nearest to x.
Vec3 into_box(UniformLattice const& lattice, Vec3 const& x) {
  Vec3 const high = lattice.position(lattice.size() - 1);
  return {std::clamp(x.x, lattice.low.x, high.x), std::clamp(x.y, lattice.low.y, high.y),
          std::clamp(x.z, lattice.low.z, high.z)};
}

TEST(UniformLattice, ReproducesTrilinearFieldsAndTakesTheNearestPointOutside) {
  Random random(1);
  for (UniformLattice const& lattice : lattices()) {
    auto const value = on_nodes(lattice, trilinear);
    LatticeReader<Vec3> const read(lattice);
    for (int trial = 0; trial < 200; ++trial) {
      Vec3 const x = lattice.low + Vec3{0.6, 0.2, 1} + random.vector(2);
      EXPECT_LT(distance(read.at(value.data(), x), trilinear(into_box(lattice, x))), 2e-14);
    }
  }
}

TEST(UniformLattice, HasItsValuesOnItsNodesAndConstantsBitForBit) {
  Random random(2);
  for (UniformLattice const& lattice : lattices()) {
    auto const value = on_nodes(lattice, trilinear);
    auto const constant = on_nodes(lattice, [](Vec3 const&) { return Vec3{0.1, -1. / 3, 7e5}; });
    LatticeReader<Vec3> const read(lattice);
    for (std::int64_t n = 0; n < lattice.size(); ++n) {
      EXPECT_LT(distance(read.at(value.data(), lattice.position(n)), value[n]), 2e-14);
      EXPECT_EQ(read.at(constant.data(), lattice.position(n) + random.vector(1)), constant.front());
    }
  }
}

#ifdef GRIDMORPH_WIDE_VECTORS
TEST(UniformLattice, HasThePlacesAndValuesOfVec3BitForBitByVectorsOfOneRegister) {
  Random random(3);
  for (UniformLattice const& lattice : lattices()) {
    std::vector<kernels::PackedVec3> value;
    for (Vec3 const& v : on_nodes(lattice, trilinear)) value.push_back({v.x, v.y, v.z});
    LatticeReader<Vec3> const read(lattice);
    LatticeReader<kernels::WideVec3> const read_wide(lattice);
    auto const at_all = [&](Vec3 const& x) {
      auto const expected = read.place(x);
      auto const place = read_wide.place(kernels::as<kernels::WideVec3>(x));
      Vec3 cell, t, v;
      kernels::put(cell, place.cell);
      kernels::put(t, place.t);
      kernels::put(v, read_wide.at(value.data(), kernels::as<kernels::WideVec3>(x)));
      EXPECT_EQ(cell, expected.cell);
      EXPECT_EQ(t, expected.t);
      EXPECT_EQ(v, read.at(value.data(), x));
    };
    for (int trial = 0; trial < 200; ++trial) at_all(lattice.low + Vec3{0.6, 0.2, 1} + random.vector(2));
    for (std::int64_t n = 0; n < lattice.size(); ++n) at_all(lattice.position(n));
  }
}
#endif

}  // namespace
}  // namespace gridmorph::test
