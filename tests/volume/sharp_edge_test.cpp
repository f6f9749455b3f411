// Airfoils with a sharp trailing edge that bend: what stands on the edge goes along with both of its faces.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace gridmorph::test {
namespace {

constexpr double wedge_deg = 12;

/// An O grid around a Karman-Trefftz airfoil with a chord of about one: the image of circles, thin cells at the wall.
Mesh o_grid_around_a_foil() {
  using Complex = std::complex<double>;
  constexpr int around = 120, away = 50;
  double const power = 2 - wedge_deg / 180;
  Complex const centre(-0.1, 0.05);
  double const radius = std::abs(1.0 - centre), start = std::arg(1.0 - centre);
  auto const position = [=](Index3 const& p) {
    double const angle = start + 2 * std::numbers::pi * (p[0] % around) / around;
    double const r = radius + 1e-3 * (std::pow(1.18, p[1]) - 1) / 0.18;
    Complex const z = centre + std::polar(r, angle);
    // The trailing edge is where the map has its branch point.
    Complex const t = p[0] % around == 0 && p[1] == 0 ? 0 : std::pow((z - 1.0) / (z + 1.0), power);
    Complex const foil = power / 4 * (1.0 + t) / (1.0 - t);
    return Vec3{foil.real(), foil.imag(), 0.1 * p[2]};
  };
  MeshBuilder b("foil");
  Index3 const n{around + 1, away + 1, 3};
  int const zone = b.zone("foil", n, position);
  b.join(zone, {{0, 0, 0}, {1, n[1], n[2]}}, zone, {{around, 0, 0}, {n[0], n[1], n[2]}});
  b.patch("foil", PatchKind::wall, zone, 1, 0);
  b.patch("far", PatchKind::farfield, zone, 1, 1);
  for (int const side : {0, 1}) b.patch("sides", PatchKind::symmetry, zone, 2, side);
  return b.finish();
}

Index inverted_cells(Mesh const& mesh, Coordinates const& x) {
  return certify(Kokkos::DefaultHostExecutionSpace(), mesh, {views(x), views(mesh.coordinates)}).broken.cells;
}

TEST(SharpEdges, OfFoilsWhoseRearBendsInvertNothing) {
  Mesh const mesh = o_grid_around_a_foil();
  ASSERT_EQ(inverted_cells(mesh, mesh.coordinates), 0);
  for (double const rise : {-0.15, -0.05, 0.05, 0.1, 0.2}) {
    Motion const bent = motion({rule({"foil"}, function_rule([&](Vec3 const& p) {
                                       double const s = std::max(0.0, 2 * p.x);
                                       return Vec3{0, rise * s * s, 0};
                                     })),
                                rule({"far"}, FixedRule{}), rule({"sides"}, SlipRule{SlipRule::Surface::plane})});
    EXPECT_EQ(inverted_cells(mesh, morph(mesh, bent, {}).morphed.position), 0) << rise;
  }
}

}  // namespace
}  // namespace gridmorph::test
