#include "hybrid_checks.hpp"

#include "support/temporary_folder.hpp"

#include <generators/ball_demo.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace {

using namespace hybrid_checks;

BallOptions small_ball() {
  BallOptions options;
  options.elements = 50'000;
  options.radius = 2;
  return options;
}

/// Displacement of the ball's and the rope's nodes by the first rule of a case file.
std::vector<Vec3> by_formula(CaseFile const& case_file, std::vector<Vec3> const& points) {
  std::vector<Vec3> displacement(points.size());
  std::get<FunctionRule>(case_file.motion.rules.at(0).rule).function(points, displacement);
  return displacement;
}

class BallSwings : public testing::TestWithParam<double> {
 protected:
  BallOptions options = small_ball();
  BallSwing swing{GetParam(), 1.5};
  Mesh mesh = make_ball(options);

  [[nodiscard]] std::vector<Vec3> points_of(std::string const& name) const {
    std::vector<Vec3> points;
    for (Index32 const n : patch_nodes(patch(mesh, name))) points.push_back(mesh.coordinates[n]);
    return points;
  }
  [[nodiscard]] Vec3 moved(Vec3 const& p) const { return p + ball_displacement(options, swing, p); }
};

TEST_P(BallSwings, NothingMovesAtTheJib) {
  int at_the_jib = 0;
  for (Vec3 const& p : points_of("rope"))
    if (p.z == rope_end(options)) {
      ++at_the_jib;
      ASSERT_EQ(norm(ball_displacement(options, swing, p)), 0);
    }
  EXPECT_GT(at_the_jib, 2);
}

TEST_P(BallSwings, BallTurnsByTheAngleAsARigidBody) {
  double const angle = swing.angle_deg * std::numbers::pi / 180;
  Vec3 const centre = moved({0, 0, 0});
  for (Vec3 const& p : points_of("ball")) {
    Vec3 const expected{centre.x + p.x * std::cos(angle) - p.z * std::sin(angle), p.y,
                        centre.z + p.x * std::sin(angle) + p.z * std::cos(angle)};
    ASSERT_LT(distance(moved(p), expected), 1e-13 * options.radius);
  }
}

TEST_P(BallSwings, RopeKeepsItsLengthAndItsSections) {
  double const top = rope_end(options), step = 1e-4;
  for (double z = options.radius; z < top - step; z += 0.01) {
    Vec3 const here = moved({0, 0, z}), above = moved({0, 0, z + step});
    ASSERT_NEAR(distance(here, above), step, 1e-6 * step);
    double const r = options.rope_radius * options.radius;
    Vec3 const across = moved({r, 0, z}) - here;
    ASSERT_NEAR(norm(across), r, 1e-13);
    ASSERT_NEAR(dot(across, above - here) / (r * step), 0, 1e-4);
    ASSERT_NEAR(distance(moved({0, r, z}), here), r, 1e-13);
  }
}

TEST_P(BallSwings, GoesTowardsTheMastForPositiveAngles) {
  double const x = moved({0, 0, 0}).x;
  EXPECT_EQ(x > 0, swing.angle_deg > 0);
  EXPECT_EQ(x < 0, swing.angle_deg < 0);
}

TEST_P(BallSwings, CaseFileGivesTheSameDisplacement) {
  CaseFile const case_file =
      parse_case_file(ball_case_file(options, swing, {"ball.cgns", "swing.toml", "ball_swing.cgns"}), "swing.toml");
  EXPECT_EQ(case_file.input, "ball.cgns");
  EXPECT_EQ(case_file.output, "ball_swing.cgns");
  ASSERT_EQ(case_file.motion.rules.size(), 2U);
  EXPECT_EQ(case_file.motion.rules[0].patches, (std::vector<std::string>{"ball", "rope"}));
  if (swing.angle_deg == 0) {
    EXPECT_TRUE(std::holds_alternative<FixedRule>(case_file.motion.rules[0].rule));
    return;
  }
  for (auto const* name : {"ball", "rope"}) {
    auto const points = points_of(name);
    auto const given = by_formula(case_file, points);
    for (std::size_t n = 0; n < points.size(); ++n)
      ASSERT_LT(distance(given[n], ball_displacement(options, swing, points[n])), 1e-13 * options.radius);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, BallSwings, testing::Values(30.0, 45.0, -20.0, 1e-3, 0.0));

TEST(BallDemo, WritesAMeshThatReadsBackBitForBit) {
  test::TemporaryFolder const folder;
  BallOptions const options = small_ball();
  BallFiles const files = write_ball_demo(folder / "new", options, {});
  Mesh const mesh = make_ball(options), back = read_mesh(files.mesh.string());
  EXPECT_TRUE(same_coordinates(mesh, back));
  EXPECT_EQ(count_types(mesh), count_types(back));
  EXPECT_TRUE(same_lists(mesh.elements.nodes, back.elements.nodes));
  ASSERT_EQ(back.patches.size(), mesh.patches.size());
  for (auto const& p : mesh.patches) {
    auto const& other = patch(back, p.name);
    EXPECT_EQ(other.kind, p.kind) << p.name;
    EXPECT_EQ(other.families, p.families) << p.name;
    EXPECT_TRUE(same_lists(other.faces, p.faces)) << p.name;
  }
  CaseFile const case_file = read_case_file(files.case_file);
  EXPECT_EQ(case_file.input, files.mesh);
  EXPECT_EQ(case_file.output, files.morphed);
  EXPECT_FALSE(std::filesystem::exists(files.morphed));
}

TEST(BallDemo, RefusesSwingsIntoTheCraneAndOutOfTheBox) {
  test::TemporaryFolder const folder;
  for (BallSwing const& swing :
       {BallSwing{95, 2}, BallSwing{-110, 2}, BallSwing{200, 2}, BallSwing{30, 9}, BallSwing{30, 0}})
    EXPECT_THROW(write_ball_demo(folder / "none", small_ball(), swing), ConfigError) << swing.angle_deg;
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
