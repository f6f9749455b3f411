// Fillets on real meshes: H meshes, whose corners go on beyond the blade.
#include "support/scramble.hpp"
#include "support/shared_mesh.hpp"

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

struct RealFillet {
  std::string name, file, blade;
  std::vector<std::string> walls;
  double radius, least_determinant;
};

class RealFillets : public ::testing::TestWithParam<RealFillet> {};
INSTANTIATE_TEST_SUITE_P(
    Meshes, RealFillets,
    ::testing::Values(RealFillet{"StageVane", "axial_turbine_stage_H.cgns", "BLADE1", {"HUB", "SHROUD"}, 0.004, 0.3},
                      RealFillet{"StageRotor", "axial_turbine_stage_H.cgns", "BLADE2", {"HUB"}, 0.004, 0.3},
                      RealFillet{"WaterTurbine", "water_turbine.cgns", "BLADE_RU", {"HUB"}, 0.006, 0.3},
                      RealFillet{"SevenBlocks", "axialTurbine_7blk.cgns", "BLADE_RU", {"HUB"}, 0.006, 0.3}),
    [](auto const& info) { return info.param.name; });

TEST_P(RealFillets, AreConformalAndValidAndRunOutAtTheEdges) {
  RealFillet const& of = GetParam();
  std::string const file = test::shared_mesh(of.file);
  if (file.empty()) GTEST_SKIP() << of.file << " is not at hand";
  Mesh mesh = read_mesh(file);
  Links const links = connect_and_check(mesh, {});
  FilletOptions options;
  options.blade = select_patches(mesh, {of.blade});
  options.end_wall = select_patches(mesh, of.walls);
  options.radius = [&](Vec3 const&) { return of.radius; };
  FilletResult const result = make_fillet(mesh, links, options);
  Mesh const& made = result.split.mesh;

  auto const wrong = test::flaws(made, 1e-7 * made.size());
  EXPECT_TRUE(wrong.empty()) << wrong.front();
  Mesh checked = made;
  EXPECT_NO_THROW((void)connect_and_check(checked, {}));
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(made.coordinates);
  QualityReport const quality = measure_quality(Kokkos::DefaultHostExecutionSpace(), made, input);
  EXPECT_EQ(quality.far_field.inverted, 0);
  EXPECT_GT(quality.far_field[Measure::determinant_3x3x3].min, of.least_determinant);
  EXPECT_EQ(result.open_ends, 4 * int(of.walls.size()));
  EXPECT_LT(result.smallest_radius, 0.2 * of.radius);
  EXPECT_LT(result.wall_deviation, 1e-6 * mesh.size());
}

}  // namespace
}  // namespace gridmorph
