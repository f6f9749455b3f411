#include "hybrid_checks.hpp"

#include <generators/sphere.hpp>
#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace {

using namespace hybrid_checks;

struct SphereVariant {
  char const* name;
  SphereOptions options;
  double determinant;  ///< smallest: where layers end early, flat tetrahedra follow
};

std::vector<SphereVariant> sphere_variants() {
  std::vector<SphereVariant> all{
      {"prisms", {}, 0.05}, {"hexahedra", {}, 0.05}, {"mixed", {}, 0.05}, {"cube", {}, 0.03}, {"near", {}, 0.005}};
  for (auto& v : all) v.options.elements = 40'000;
  all[1].options.layer_elements = LayerElements::hexahedra;
  all[2].options.layer_elements = LayerElements::mixed;
  all[2].options.shuffle = false;
  all[3].options.outer = SphereOptions::Outer::cube;
  all[4].options.distance = 1;
  all[4].options.radius = 3;
  all[4].options.layers = 6;
  return all;
}

class Sphere : public testing::TestWithParam<SphereVariant> {
 protected:
  SphereOptions const& options = GetParam().options;
  Mesh mesh = make_sphere(options);
};

TEST_P(Sphere, FacesAreSharedByTwoElementsOrBelongToOnePatch) { expect_conforming_and_covered(mesh); }

TEST_P(Sphere, ElementsAreSoundAndFillTheBoundary) {
  Soundness const x = soundness(mesh);
  EXPECT_GT(x.smallest_volume, 0);
  EXPECT_GT(x.smallest_determinant, GetParam().determinant);
  EXPECT_NEAR(x.volume, enclosed_volume(mesh), 1e-9 * x.volume);
}

TEST_P(Sphere, HasNearlyAsManyElementsAsAskedFor) {
  EXPECT_NEAR(double(mesh.n_elements()), double(options.elements), 0.1 * double(options.elements));
}

TEST_P(Sphere, BoundariesAreWhereTheyWereAskedFor) {
  double const outer = options.radius * (1 + 2 * options.distance);
  for (Index32 const n : patch_nodes(patch(mesh, "sphere")))
    ASSERT_NEAR(norm(mesh.coordinates[n]), options.radius, 1e-14 * options.radius);
  for (Index32 const n : patch_nodes(patch(mesh, "outer"))) {
    Vec3 const p = mesh.coordinates[n];
    double const away = options.outer == SphereOptions::Outer::sphere
                            ? norm(p)
                            : std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    ASSERT_NEAR(away, outer, 1e-12 * outer);
  }
}

INSTANTIATE_TEST_SUITE_P(Options, Sphere, testing::ValuesIn(sphere_variants()),
                         [](testing::TestParamInfo<SphereVariant> const& info) {
                           return std::string(info.param.name);
                         });

TEST(SphereMesh, HasItsDefaultSizeAndFillsTheShell) {
  SphereOptions const options;
  Mesh const mesh = make_sphere(options);
  EXPECT_NEAR(double(mesh.n_elements()), 170'000, 10'000);
  auto const counts = count_types(mesh);
  EXPECT_GT(counts[std::size_t(ElementType::prism)], 20'000);
  EXPECT_GT(counts[std::size_t(ElementType::tetrahedron)], 50'000);
  double const outer = options.radius * (1 + 2 * options.distance);
  double const shell = 4.0 / 3 * std::numbers::pi * (std::pow(outer, 3) - std::pow(options.radius, 3));
  EXPECT_NEAR(soundness(mesh).volume, shell, 0.02 * shell);  // plane faces cut the sphere's caps off
}

TEST(SphereMesh, NamesEveryOptionThatIsWrong) {
  SphereOptions options;
  options.distance = -4;
  options.first_cell = 7;
  try {
    (void)make_sphere(options);
    FAIL() << "no error";
  } catch (ConfigError const& error) {
    std::string const message = error.what();
    EXPECT_NE(message.find("distance is -4"), std::string::npos) << message;
    EXPECT_NE(message.find("first_cell is 7"), std::string::npos) << message;
  }
}

}  // namespace
