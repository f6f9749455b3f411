// The check for time loops against the measures of the report.
#include "quality/test_meshes.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Moved so far that some cells are inverted.
Coordinates crumpled(Mesh const& mesh) {
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    x.set(n, p + Vec3{0.1 * std::sin(20 * p.y * p.x), 0.08 * std::sin(25 * p.z), 0.05 * std::cos(30 * p.x)});
  }
  return x;
}

Validity check(ValidityCheck<Exec> const& validity, ConstVectorView<Kokkos::HostSpace> const& x) {
  Exec const exec;
  auto const result = validity(exec, x);
  exec.fence();
  return result();
}

/// The smallest determinant of the report, and how many are negative.
Validity expected(Mesh const& mesh, Coordinates const& x) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(x);
  input.handedness = zone_handedness(Exec(), mesh, views(mesh.coordinates));
  std::array<Measure, 1> const measures{Measure::determinant_3x3x3};
  auto const determinant = cell_fields(Exec(), mesh, input, measures).front();
  Validity out;
  for (std::size_t c = 0; c < determinant.extent(0); ++c) {
    out.smallest_determinant = std::min(out.smallest_determinant, determinant(c));
    out.inverted += determinant(c) < 0 ? 1 : 0;
  }
  return out;
}

TEST(Validity, AgreesWithTheReportBitForBit) {
  Mesh const mesh = two_handed_zones();
  ValidityCheck<Exec> const validity(Exec(), mesh);
  Coordinates const moved = crumpled(mesh);
  for (Coordinates const& x : {mesh.coordinates, moved, mesh.coordinates}) {
    Validity const found = check(validity, x), wanted = expected(mesh, x);
    EXPECT_EQ(found.smallest_determinant, wanted.smallest_determinant);
    EXPECT_EQ(found.inverted, wanted.inverted);
  }
  EXPECT_EQ(check(validity, mesh.coordinates).inverted, 0);
  EXPECT_GT(check(validity, moved).inverted, 10);
}

TEST(Validity, ReadsCoordinatesInAnyLayout) {
  Mesh const mesh = two_handed_zones();
  ValidityCheck<Exec> const validity(Exec(), mesh);
  Coordinates const moved = crumpled(mesh);
  std::vector<Kokkos::View<double****, Kokkos::LayoutRight, Kokkos::HostSpace>> zones;
  for (Zone const& zone : mesh.zones) {
    zones.emplace_back("test::zone", zone.extent[0], zone.extent[1], zone.extent[2], 3);
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      auto const [i, j, k] = zone.index(n);
      zones.back()(i, j, k, 0) = moved.x(n);
      zones.back()(i, j, k, 1) = moved.y(n);
      zones.back()(i, j, k, 2) = moved.z(n);
    }
  }
  Validity const found = check(validity, {Exec(), mesh, zones}), wanted = check(validity, moved);
  EXPECT_EQ(found.smallest_determinant, wanted.smallest_determinant);
  EXPECT_EQ(found.inverted, wanted.inverted);
}

TEST(Validity, OfElementsIsThatOfTheSameCells) {
  Mesh const mesh = two_handed_zones();
  Mesh const elements = as_hexahedra(mesh);
  ValidityCheck<Exec> const validity(Exec(), elements, make_topology(elements));
  for (Coordinates const& x : {mesh.coordinates, crumpled(mesh)}) {
    Validity const found = check(validity, x), wanted = expected(mesh, x);
    EXPECT_NEAR(found.smallest_determinant, wanted.smallest_determinant, 1e-13);
    EXPECT_EQ(found.inverted, wanted.inverted);
  }
}

TEST(Validity, CountsCellsWithoutNumbersAndRefusesOtherMeshes) {
  Mesh const mesh = two_handed_zones();
  ValidityCheck<Exec> const validity(Exec(), mesh);
  Coordinates x = crumpled(mesh);
  Kokkos::deep_copy(x.x, mesh.coordinates.x);
  Kokkos::deep_copy(x.y, mesh.coordinates.y);
  Kokkos::deep_copy(x.z, mesh.coordinates.z);
  x.y(mesh.zones[0].node({5, 5, 5})) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check(validity, x).inverted, 8);
  EXPECT_EQ(check(validity, x).smallest_determinant, -1);
  expect_all_in(message_of<ConfigError>([&] { (void)check(validity, Coordinates(5)); }),
                {"5 nodes", std::to_string(mesh.n_nodes())});
}

}  // namespace
}  // namespace gridmorph::test
