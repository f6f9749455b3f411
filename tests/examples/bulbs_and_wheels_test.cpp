// Leading-edge bulbs and a wheel of different blades: the examples of local and of system changes.
#include "example_run.hpp"
#include "support/reduced.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace gridmorph::test {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Bulb {
  double swell, size, height, hub, centre, angle, twist;

  /// Motion away from the centre, written with distance and direction instead of components.
  [[nodiscard]] Cylindrical operator()(Cylindrical const& x) const {
    double const a = x.axial - centre, b = wrapped(x.theta - angle - twist * (x.r - hub));
    double const distance = std::hypot(a, x.r * b) / size, above = std::clamp((x.r - hub) / height, 0.0, 1.0);
    double const bump = distance < 1 ? std::pow(1 - distance * distance, 3) : 0;
    double const share = swell * bump * (1 - above * above * (3 - 2 * above));
    return {share * a, 0, share * b};
  }
};

TEST_F(Example, BulbSwellsTheNoseOfThePassagesBlade) {
  ASSERT_NO_FATAL_FAILURE(morph("bulb_passage", "passage.cgns"));
  Bulb const bulb{1, 0.024, 0.06, 0.446, -0.048, -0.0255, -0.13};
  double largest = 0, forward = 0;
  for_patch("blade", "", [&](Index n) {
    Cylindrical const x = cylindrical(before.coordinates[n], 0), u = motion(n, 0), wanted = bulb(x);
    largest = std::max(largest, std::abs(wanted.axial));
    forward = std::min(forward, u.axial);
    // What puts the foot back on the hub is radial, and the rest of the span takes its share.
    EXPECT_NEAR(u.axial, wanted.axial, 1e-6);
    EXPECT_NEAR(x.r * u.theta, x.r * wanted.theta, 1e-5);
    EXPECT_NEAR(u.r, 0, 1e-3);
  });
  EXPECT_GT(largest, 4e-3);
  EXPECT_LT(forward, -2e-3);  // the nose comes forward by 2 % of the chord
  for (std::string const fixed : {"inlet", "outlet"}) expect_fixed(fixed);
}

TEST_F(Example, SquealerGrowsTowardsTheCaseUntwistsAndLeansAndTheGapOverItClosesByThreeQuarters) {
  ASSERT_NO_FATAL_FAILURE(morph("squealer_tip", "passage.cgns"));
  auto const wanted = [](Cylindrical const& x) {
    double const h = (x.r - 0.455) / 0.205, untwist = 3 * pi / 180 * std::max(h, 0.0);
    return Cylindrical{untwist * x.r * x.theta, 0.0023 * std::max(h, 0.0), (0.004 * h * h - untwist * x.axial) / x.r};
  };
  auto const place = [](Cylindrical const& x, Cylindrical const& u) {
    double const r = x.r + u.r, theta = x.theta + u.theta;
    return Vec3{x.axial + u.axial, r * std::cos(theta), r * std::sin(theta)};
  };
  double highest = 0;
  for (std::string const part : {"tip", "squealer"})
    for_patch(part, "", [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 0);
      EXPECT_LT(distance(after.coordinates[n], place(x, wanted(x))), 1e-14) << part;
      highest = std::max(highest, motion(n, 0).r);
    });
  EXPECT_GT(highest, 0.0022);
  for_patch("blade", "", [&](Index n) {
    Cylindrical const x = cylindrical(before.coordinates[n], 0), u = motion(n, 0);
    // What puts the foot back on the hub is radial, and falls to nothing at the tip.
    EXPECT_NEAR(u.axial, wanted(x).axial, 1e-6);
    EXPECT_NEAR(x.r * u.theta, x.r * wanted(x).theta, 1e-6);
    double const height = (x.r - 0.455) / 0.205;
    EXPECT_NEAR(u.r, wanted(x).r, 1e-6 + 1e-3 * std::max(0.0, 1 - height));
  });
  expect_periodic_copies_move_alike(0);

  auto const report = nlohmann::json::parse(contents(path("squealer_tip/squealer_tip.json")));
  auto const& clearance = report["clearances"][0];
  EXPECT_NEAR(double(clearance["before"]["smallest"]), 0.0030, 0.0001);
  EXPECT_NEAR(double(clearance["by_rule"]["smallest"]), 0.00058, 0.00001);
  EXPECT_NEAR(double(clearance["after"]["smallest"]), double(clearance["by_rule"]["smallest"]), 1e-9);
  for (std::string const region : {"near_field", "far_field"})
    EXPECT_GT(double(report["morphed"][region]["measures"]["determinant_3x3x3"]["min"]),
              0.99 * double(report["baseline"][region]["measures"]["determinant_3x3x3"]["min"]))
        << region;
}

TEST_F(Example, BulbSwellsTheNosesOfTheVanesAndOfNothingElse) {
  if (test::reduced()) GTEST_SKIP() << "the stage takes long, and other tests have it";
  ASSERT_NO_FATAL_FAILURE(morph("bulb_vane", "axial_turbine_stage_H.cgns"));
  expect_periodic_copies_move_alike(0);
  double largest = 0;
  for (auto const& [side, angle] :
       std::map<std::string, double>{{"blade_ps", 1.4817}, {"blade_ss", 1.4817 - 2 * pi / 70}}) {
    Bulb const bulb{0.9, 0.035, 0.045, 0.945, 0.012, angle, 0};
    for_patch(side, "row1", [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 0), u = motion(n, 0), wanted = bulb(x);
      largest = std::max(largest, std::abs(wanted.axial));
      EXPECT_NEAR(u.axial, wanted.axial, 1e-6);
      EXPECT_NEAR(x.r * u.theta, x.r * wanted.theta, 1e-5);
    });
  }
  EXPECT_GT(largest, 5e-3);
  for (std::string const fixed : {"INLET", "OUTLET", "MIXING", "BLADE2"}) expect_fixed(fixed);
}

using WheelExample = StandInTest<Example>;
INSTANTIATE_TEST_SUITE_P(Meshes, WheelExample, ::testing::Bool(), stand_in_or_not);

TEST_P(WheelExample, KaplanWheelClosesAndItsThirdRunnerBladeOpensLess) {
  int const status = shell(run_command(meshes_, "kaplan_wheel"));
  ASSERT_EQ(status, 0) << contents(path("out")) << contents(path("err")) << contents(path("kaplan_wheel/log.txt"));
  before = read_mesh(path("kaplan_wheel/water_turbine.cgns"));
  Mesh const wheel = read_mesh(path("kaplan_wheel/kaplan_wheel_morphed.cgns"));
  ASSERT_EQ(wheel.zones.size(), 5 * before.zones.size());
  Index pairs = 0;
  for (auto const& face : wheel.interfaces) {
    EXPECT_FALSE(face.periodic) << face.name;
    for_nodes(wheel.zones[face.zone], face.range, [&](Index own, Index3 const& p) {
      ++pairs;
      EXPECT_TRUE(wheel.coordinates[own] == wheel.coordinates[wheel.zones[face.donor_zone].node(face.to_donor(p))]);
    });
  }
  EXPECT_GT(pairs, 5'000);

  // The angle by which the ends of each runner blade's pressure side have turned against each other.
  std::map<std::string, int> number;
  for (int z = 0; z < int(wheel.zones.size()); ++z) number[wheel.zones[z].name] = z;
  std::array<double, 5> turned{};
  for (int p = 0; p < 5; ++p) {
    double sum = 0;
    for (auto const& patch : before.patches) {
      if (patch.name != "ps" || before.zones[patch.zone].name != "RU_blade") continue;
      Zone const& zone = wheel.zones[number.at("RU_blade_P0" + std::to_string(p + 1))];
      for_nodes(before.zones[patch.zone], patch.range, [&](Index n, Index3 const& i) {
        Cylindrical const x = cylindrical(before.coordinates[n], 2),
                          y = cylindrical(wheel.coordinates[zone.node(i)], 2);
        sum += x.axial * wrapped(y.theta - x.theta - 2 * pi / 5 * p) * x.r;  // a turn is a shear to first order
      });
    }
    turned[p] = sum;
  }
  int less = 0;
  double const most = *std::max_element(turned.begin(), turned.end());
  for (double const t : turned) less += t < 0.5 * most ? 1 : 0;
  EXPECT_EQ(less, 1);
}

}  // namespace
}  // namespace gridmorph::test
