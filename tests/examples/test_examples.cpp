// Every example runs through and does what its case file says, measured with the formulas of the case files written anew.
#include "example_run.hpp"

namespace gridmorph::testing {
namespace {

constexpr double deg = 0.017453292519943295;

#define GRIDMORPH_NEEDS(mesh) \
  if (!mesh_is_there(mesh)) GTEST_SKIP() << "no " << mesh << " in " << meshes_ << "; set GRIDMORPH_MESHES to its folder"

TEST_F(ExampleTest, TurbineStageTurnsEachRowByItsOwnAngle) {
  GRIDMORPH_NEEDS("axial_turbine_stage_H.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("turbine_stage", "axial_turbine_stage_H.cgns"));
  auto const expect_turn = [&](std::string const& blade, double mid, double stagger, auto const& turn) {
    for_patch(blade, "", [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 0), u = motion(n, 0);
      double const wanted = (x.axial - mid) / x.r * (std::tan((stagger + turn(x.r)) * deg) - std::tan(stagger * deg));
      EXPECT_NEAR(u.theta, wanted, 1e-14);
      EXPECT_NEAR(u.axial, 0, 1e-15);
      EXPECT_NEAR(u.r, 0, 1e-15);
    });
  };
  expect_turn("BLADE1", 0.05, -41.5, [](double) { return 6.0; });
  expect_turn("BLADE2", 0.21, 38.6, [](double r) { return 3 + 4 * (r - 0.92) / 0.15; });
}

TEST_F(ExampleTest, TurbineStageStaysPeriodicAndOnItsEndWalls) {
  GRIDMORPH_NEEDS("axial_turbine_stage_H.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("turbine_stage", "axial_turbine_stage_H.cgns"));
  expect_periodic_copies_move_alike(0);
  // The motion is purely circumferential, so nodes on the end walls keep axial position and radius.
  for (std::string const wall : {"HUB", "SHROUD", "INLET", "OUTLET", "MIXING"})
    for_patch(wall, "", [&](Index n) {
      Cylindrical const u = motion(n, 0);
      EXPECT_NEAR(u.axial, 0, 1e-15) << wall;
      EXPECT_NEAR(u.r, 0, 2e-15) << wall;
    });
}

TEST_F(ExampleTest, TurbineStageSlidesBothSidesOfTheMixingPlaneApart) {
  GRIDMORPH_NEEDS("axial_turbine_stage_H.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("turbine_stage", "axial_turbine_stage_H.cgns"));
  double vane = 0, rotor = 0;
  for_patch("mixing_out", "row1", [&](Index n) { vane = std::max(vane, motion(n, 0).theta); });
  for_patch("mixing_in", "row2", [&](Index n) { rotor = std::min(rotor, motion(n, 0).theta); });
  EXPECT_GT(vane, 0.4 * deg);
  EXPECT_LT(rotor, -0.4 * deg);
}

TEST_F(ExampleTest, KaplanTurnsVanesAndRunnerAboutTheirSpindles) {
  GRIDMORPH_NEEDS("axialTurbine_7blk.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("kaplan_7_blocks", "axialTurbine_7blk.cgns"));
  auto const expect_turn = [&](std::string const& side, std::string const& zone, double spindle, double at,
                               double turn) {
    double const c = std::cos(turn * deg) - 1, s = std::sin(turn * deg);
    for_patch(side, zone, [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 2), u = motion(n, 2);
      double const a = x.axial - spindle, b = wrapped(x.theta - at * deg);
      // Periodic copies of the baseline are 1.5e-10 apart; one of them decides for both.
      EXPECT_NEAR(u.axial, a * c - x.r * b * s, 1e-10);
      EXPECT_NEAR(u.theta, a / x.r * s + b * c, 1e-9);
      EXPECT_NEAR(u.r, 0, 1e-11);
    });
  };
  expect_turn("ps", "GV_vane", 0.14, -43, -10);
  expect_turn("ss", "GV_vane", 0.14, 29, -10);
  expect_turn("ps", "RU_blade", 0, -54.7, 8);
  expect_turn("ss", "RU_blade", 0, 17.3, 8);
}

TEST_F(ExampleTest, KaplanStaysPeriodicOnItsCylindersAndOutOfTheDraftTube) {
  GRIDMORPH_NEEDS("axialTurbine_7blk.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("kaplan_7_blocks", "axialTurbine_7blk.cgns"));
  expect_periodic_copies_move_alike(2);
  for (std::string const wall : {"HUB", "SHROUD"})
    for_patch(wall, "", [&](Index n) { EXPECT_NEAR(motion(n, 2).r, 0, 1e-11) << wall; });
  for (std::string const plane : {"INLET", "OUTLET", "MIXING"})
    for_patch(plane, "", [&](Index n) { EXPECT_NEAR(motion(n, 2).axial, 0, 1e-15) << plane; });
  Zone const* tube = nullptr;
  for (auto const& zone : before.zones) tube = zone.name == "DT" ? &zone : tube;
  ASSERT_NE(tube, nullptr);
  for (Index n = tube->first_node; n < tube->first_node + tube->size(); ++n)
    EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]);
}

TEST_F(ExampleTest, SlatMovesRigidlyAndTheOtherElementsKeepTheirFirstCells) {
  GRIDMORPH_NEEDS("multi.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("slat", "multi.cgns"));
  double const c = std::cos(-10 * deg), s = std::sin(-10 * deg);
  expect_motion("Klo_Seg   2", "Zone   3", [&](Vec3 const& p) {
    double const x = p.x - 0.0272575, z = p.z - 0.0204985;
    return Vec3{c * x + s * z - x - 0.02, 0, -s * x + c * z - z + 0.01};
  });
  for (std::string const zone : {"Zone   1", "Zone   2"}) {
    for (auto const& patch : before.patches) {
      if (patch.name != "Klo_Seg   2" || before.zones[patch.zone].name != zone) continue;
      IndexRange layers = patch.range;
      layers.end[2] = 17;  // 16 cells off the wall
      for_nodes(before.zones[patch.zone], layers,
                [&](Index n, Index3 const&) { EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]); });
    }
  }
}

TEST_F(ExampleTest, SlatKeepsTheMeshTwoDimensional) {
  GRIDMORPH_NEEDS("multi.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("slat", "multi.cgns"));
  for (auto const& zone : before.zones)
    for_nodes(zone, {{0, 0, 0}, {1, zone.extent[1], zone.extent[2]}}, [&](Index n, Index3 const&) {
      EXPECT_EQ(after.coordinates.y(n), before.coordinates.y(n));
      EXPECT_EQ(after.coordinates.y(n + 1), before.coordinates.y(n + 1));
      EXPECT_EQ(after.coordinates.x(n + 1) - after.coordinates.x(n), 0);
      EXPECT_EQ(after.coordinates.z(n + 1) - after.coordinates.z(n), 0);
    });
}

TEST_F(ExampleTest, WingBendsAndTwistsAsItsFormulaSays) {
  GRIDMORPH_NEEDS("mdo_tutorial_000_vol.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("wing_38_blocks", "mdo_tutorial_000_vol.cgns"));
  expect_motion("wall", "", [](Vec3 const& p) {
    double const t = p.z / 14, angle = -5 * deg * t * t, x = p.x - 1.25 - 0.473 * p.z;
    double const c = std::cos(angle), s = std::sin(angle);
    return Vec3{x * c - p.y * s - x, x * s + p.y * c - p.y + 2.1 * t * t, 0};
  });
  expect_fixed("far");
  for_patch("sym", "", [&](Index n) { EXPECT_EQ(after.coordinates.z(n), before.coordinates.z(n)); });
}

TEST_F(ExampleTest, WingletCantsAndTheWingInboardStays) {
  GRIDMORPH_NEEDS("717_wl_L2.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("winglet", "717_wl_L2.cgns"));
  Index inboard = 0;
  expect_motion("wall", "", [&](Vec3 const& p) {
    double const t = std::clamp((p.z - 9) / 2.2, 0.0, 1.0), angle = -10 * deg * t * t * (3 - 2 * t);
    double const y = p.y - 0.1, z = p.z - 10;
    inboard += p.z < 9 ? 1 : 0;
    return Vec3{0, y * std::cos(angle) + z * std::sin(angle) - y, z * std::cos(angle) - y * std::sin(angle) - z};
  });
  EXPECT_GT(inboard, 0);
  expect_fixed("Far");
  for_patch("Sym", "",
            [&](Index n) { EXPECT_NEAR(after.coordinates.z(n), before.coordinates.z(n), 1e-10 * before.size()); });
}

TEST_F(ExampleTest, RotorstatorIsRefusedInterfaceByInterfaceWithoutATolerance) {
  GRIDMORPH_NEEDS("rotorstator.cgns");
  std::filesystem::create_symlink(std::filesystem::absolute(meshes_ / "rotorstator.cgns"), path("rotorstator.cgns"));
  std::string const morph_without = "sed '/^matching_tolerance/d' '" GRIDMORPH_EXAMPLES "/rotorstator.toml' >'" +
                                    path("case.toml") + "' && '" GRIDMORPH_EXECUTABLE "' morph '" + path("case.toml") +
                                    "'";
  EXPECT_EQ(shell(morph_without), 2);
  std::string const message = contents(path("err"));
  for (std::string const name : {"b8a", "b9a", "b10a", "b11a", "b12a", "b13a", "b14a"})
    EXPECT_NE(message.find("interface '" + name + "'"), std::string::npos) << name << " not in " << message;
  EXPECT_NE(message.find("matching_tolerance"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("rotorstator_morphed.cgns")));
}

TEST_F(ExampleTest, RotorstatorIsRefusedFaceByFaceWithoutOpenFaces) {
  GRIDMORPH_NEEDS("rotorstator.cgns");
  std::filesystem::create_symlink(std::filesystem::absolute(meshes_ / "rotorstator.cgns"), path("rotorstator.cgns"));
  std::string const morph_without =
      "sed -e '/^open_faces/d' -e 's/, \"open\"//' '" GRIDMORPH_EXAMPLES "/rotorstator.toml' >'" + path("case.toml") +
      "' && '" GRIDMORPH_EXECUTABLE "' morph '" + path("case.toml") + "'";
  EXPECT_EQ(shell(morph_without), 2);
  std::string const message = contents(path("err"));
  for (int block = 1; block <= 14; ++block)
    EXPECT_NE(message.find("zone 'blk" + std::to_string(block) + "'"), std::string::npos)
        << block << " not in " << message;
  EXPECT_NE(message.find("open_faces"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("rotorstator_morphed.cgns")));
}

TEST_F(ExampleTest, RotorstatorMovesAllRotorBladesTogether) {
  GRIDMORPH_NEEDS("rotorstator.cgns");
  ASSERT_NO_FATAL_FAILURE(morph("rotorstator", "rotorstator.cgns"));
  for (std::string const zone : {"blk8", "blk10", "blk12", "blk14"})
    expect_motion("K0_1_bc2004", zone, [](Vec3 const&) { return Vec3{0, 0.606, 0}; });
  for (std::string const zone : {"blk2", "blk4", "blk6"}) expect_fixed("K0_1_bc2004", zone);
}

TEST_F(ExampleTest, ScriptSaysSoWhenThereAreNoMeshes) {
  EXPECT_EQ(shell(run_command(folder_.string(), "slat winglet")), 2);
  EXPECT_NE(contents(path("out")).find("skipped: no multi.cgns"), std::string::npos);
  EXPECT_NE(contents(path("err")).find("none of the meshes"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::testing
