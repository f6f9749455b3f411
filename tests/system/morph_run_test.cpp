// Morphing from case file to mesh file.
#include "run_command.hpp"
#include "support/mesh_builders.hpp"
#include "support/shared_mesh.hpp"
#include "support/unstructured_meshes.hpp"
#include "support/with_keys.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <utility>

namespace gridmorph::test {
namespace {

using MorphRun = CommandTest;

TEST_F(MorphRun, WritesMeshAndReportAndPrintsTheTable) {
  Outcome const run = gridmorph("morph rotation.toml --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  for (std::string const word :
       {"near field", "far field", "determinant 3x3x3", "coincide with points", "passage_rotation.cgns"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word;
  auto const json = nlohmann::json::parse(contents(path("r.json")));
  EXPECT_EQ(json["morphed"]["near_field"]["inverted"], 0);
  EXPECT_FALSE(json["stages"].empty());
  EXPECT_EQ(json["fields"].at(0)["evaluated"], json["fields"].at(0)["coincident"]);
}

TEST_F(MorphRun, HonoursTheDisplacementFileExactly) {
  ASSERT_EQ(gridmorph("morph rotation.toml").status, 0);
  Mesh const before = read_mesh(path("passage.cgns").string());
  Mesh const after = read_mesh(path("passage_rotation.cgns").string());
  PassageOptions options;
  options.nodes = 10'000;
  Index moved = 0;
  for (auto const& patch : before.patches) {
    if (patch.families.empty() || patch.families.front() != "blade") continue;
    Zone const& zone = before.zones[patch.zone];
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const n = zone.node({i, j, k});
          Vec3 const x = before.coordinates[n];
          Vec3 const wanted = x + passage_displacement(options, rotated_sections(), x);
          // Hub and case nodes are put back on their surface.
          EXPECT_LT(distance(after.coordinates[n], wanted), 1e-10);
          moved += distance(x, wanted) > 1e-3 ? 1 : 0;
        }
  }
  EXPECT_GT(moved, 0);
}

TEST_F(MorphRun, ZeroMotionLeavesEveryCoordinateBitIdentical) {
  write_case("case.toml",
             "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndtheta = \"0*r\"\n"
             "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"circumferential-slide\"\nof = \"blade\"\n"
             "[[motion]]\npatches = [\"type:periodic\"]\nrule = \"follow\"\nof = \"blade\"\n"
             "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n");
  ASSERT_EQ(gridmorph("morph case.toml").status, 0);
  Mesh const before = read_mesh(path("passage.cgns").string()), after = read_mesh(path("out.cgns").string());
  for (Index n = 0; n < before.n_nodes(); ++n)
    ASSERT_EQ(before.coordinates[n], after.coordinates[n]) << describe_node(before, n);
}

TEST_F(MorphRun, ThreadsDoNotChangeTheResult) {
  ASSERT_EQ(gridmorph("morph rotation.toml -o out1.cgns --threads 1").status, 0);
  ASSERT_EQ(gridmorph("morph rotation.toml -o out2.cgns --threads 2").status, 0);
  Mesh const one = read_mesh(path("out1.cgns").string()), two = read_mesh(path("out2.cgns").string());
  for (Index n = 0; n < one.n_nodes(); ++n) ASSERT_EQ(one.coordinates[n], two.coordinates[n]) << describe_node(one, n);
}

/// inspect's case file moves every wall by zero through the whole engine: rules, chains, projection.
TEST_F(MorphRun, SuggestedCaseFilesLeaveRealMeshesBitIdentical) {
  for (std::string const name : {"axial_turbine_stage_H", "water_turbine", "slotted_airfoil", "axialTurbine_7blk",
                                 "multi", "mdo_tutorial_000_vol", "717_wl_L2"}) {
    auto const mesh = test::shared_mesh(name + ".cgns");
    if (mesh.empty()) continue;  // its stand-in is tried
    std::filesystem::copy(mesh, path(name + ".cgns"));
    Outcome const inspected = gridmorph("inspect --suggest suggested.toml " + name + ".cgns");
    ASSERT_EQ(inspected.status, 0) << inspected.err;
    Outcome const run = gridmorph("morph suggested.toml");
    EXPECT_EQ(run.status, 0) << name << ": " << run.err;
    Mesh const before = read_mesh(path(name + ".cgns").string()),
               after = read_mesh(path(name + "_morphed.cgns").string());
    for (Index n = 0; n < before.n_nodes(); ++n)
      ASSERT_EQ(before.coordinates[n], after.coordinates[n]) << name << ": " << describe_node(before, n);
  }
}

/// Its interfaces match to 5 % of a wall cell, and hundreds of faces belong to nothing: the suggestion deals with both.
TEST_F(MorphRun, SuggestedCaseFilesPlanOnMeshesWithGaps) {
  std::filesystem::copy(test::shared_mesh("rotorstator.cgns"), path("rotorstator.cgns"));
  Outcome const inspected = gridmorph("inspect rotorstator.cgns --suggest");
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("\nmatching_tolerance = "), std::string::npos);
  EXPECT_NE(inspected.out.find("\nopen_faces = "), std::string::npos);
  write("suggested.toml", inspected.out);
  EXPECT_EQ(gridmorph("plan suggested.toml").status, 0);
}

TEST_F(MorphRun, EveryStepIsTimedInTheOutputAndInTheReport) {
  Outcome const run = gridmorph("morph rotation.toml --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  auto const text = contents(path("r.json"));
  EXPECT_EQ(text.back(), '\n');
  EXPECT_NE(text.substr(text.size() - 2), "\n\n") << "room left for the time of writing is still there";
  auto const times = nlohmann::json::parse(text)["times"];
  std::vector<std::string> steps;
  double sum = 0;
  for (auto const& t : times["steps"]) {
    steps.push_back(t["step"]);
    EXPECT_GT(t["seconds"].get<double>(), 0) << steps.back();
    EXPECT_NE(run.out.find("\n" + steps.back() + " "), std::string::npos) << steps.back();
    sum += t["seconds"].get<double>();
  }
  EXPECT_EQ(steps,
            (std::vector<std::string>{"read", "topology", "rules", "plan", "boundary", "morph", "quality", "write"}));
  EXPECT_NEAR(times["total_seconds"].get<double>(), sum, 1e-12);
}

TEST_F(MorphRun, RegionsThatAreOnlyMeasuredChangeNoNode) {
  ASSERT_EQ(gridmorph("morph rotation.toml --report plain.json -o plain.cgns").status, 0);
  write("case.toml", contents(path("rotation.toml")) +
                         "\n[[region]]\nname = \"wake\"\naxial = [0.06, 0.15]\nonly_measured = true\n");
  Outcome const run = gridmorph("morph case.toml --report r.json -o measured.cgns");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const plain = read_mesh(path("plain.cgns").string()), measured = read_mesh(path("measured.cgns").string());
  for (Index n = 0; n < plain.n_nodes(); ++n) ASSERT_EQ(plain.coordinates[n], measured.coordinates[n]);
  EXPECT_NE(run.out.find("\nwake "), std::string::npos) << run.out;
  auto const json = nlohmann::json::parse(contents(path("r.json")));
  auto const before = nlohmann::json::parse(contents(path("plain.json")));
  EXPECT_FALSE(before["morphed"].contains("regions"));
  EXPECT_EQ(json["morphed"]["far_field"], before["morphed"]["far_field"]);
  auto const& wake = json["morphed"]["regions"]["wake"];
  EXPECT_GT(wake["cells"], 100);
  EXPECT_LT(wake["cells"], before["morphed"]["far_field"]["cells"]);
  for (std::string const name : {"relative_displacement_i", "relative_displacement_j", "relative_displacement_k",
                                 "growth_ratio", "face_area_ratio"}) {
    EXPECT_LE(wake["measures"][name]["max"].get<double>(),
              before["morphed"]["far_field"]["measures"][name]["max"].get<double>() * 1.0000001)
        << name;
    EXPECT_GE(wake["measures"][name]["max"].get<double>(), 0);
  }
  write("wrong.toml", contents(path("rotation.toml")) +
                          "\n[[region]]\nname = \"blade\"\naxial = [0.06, 0.15]\nonly_measured = true\n");
  EXPECT_EQ(gridmorph("morph wrong.toml").status, 2) << "the name of a family";
}

/// The meshes of the stages, in the order of stages.json.
std::vector<nlohmann::json> stages_in(std::filesystem::path const& folder) {
  return nlohmann::json::parse(contents(folder / "stages.json"))["stages"];
}

TEST_F(MorphRun, WritesTheMeshAfterEveryStage) {
  write("case.toml", contents(path("rotation.toml")) + "\n[output]\nstages = \"stages\"\n");
  std::filesystem::create_directory(path("stages"));
  write("stages/stage_99_left_over.cgns", "of another run");
  write("stages/mine.txt", "mine");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("the mesh after every stage"), std::string::npos);
  auto const stages = stages_in(path("stages"));
  ASSERT_GE(stages.size(), 4U);
  EXPECT_EQ(stages[0]["file"], "stage_00_boundary.cgns");
  EXPECT_EQ(stages[1]["file"], "stage_01_near_field.cgns");
  EXPECT_EQ(stages[2]["name"], "iteration 1");
  EXPECT_FALSE(stages[2]["chains"].empty());
  EXPECT_EQ(stages.back()["name"].get<std::string>().rfind("slip surfaces", 0), 0U);
  EXPECT_FALSE(std::filesystem::exists(path("stages/stage_99_left_over.cgns")));
  EXPECT_TRUE(std::filesystem::exists(path("stages/mine.txt")));
  Mesh const before = read_mesh(path("passage.cgns").string()),
             morphed = read_mesh(path("passage_rotation.cgns").string());
  Index moved_before = 0;
  for (auto const& stage : stages) {
    Mesh const mesh = read_mesh(path("stages/" + stage["file"].get<std::string>()).string());
    ASSERT_EQ(mesh.n_nodes(), before.n_nodes());
    EXPECT_EQ(mesh.patches.size(), before.patches.size());
    EXPECT_EQ(mesh.interfaces.size(), before.interfaces.size());
    Index moved = 0, left = 0;
    for (Index n = 0; n < before.n_nodes(); ++n) {
      moved += mesh.coordinates[n] == before.coordinates[n] ? 0 : 1;
      left += mesh.coordinates[n] == morphed.coordinates[n] ? 0 : 1;
    }
    EXPECT_GE(moved, moved_before) << stage["name"];
    moved_before = moved;
    EXPECT_EQ(left == 0, stage == stages.back()) << stage["name"] << ": the last stage is the morphed mesh";
  }
  std::string const last = contents(path("stages/" + stages.back()["file"].get<std::string>()));
  for (std::string const field : {"Stage", "Chain", "Direction", "DisplacementX"})
    EXPECT_NE(last.find(field), std::string::npos) << field;
}

TEST_F(MorphRun, StagesOfATwoDimensionalMeshAreTwoDimensional) {
  test::MeshBuilder builder("plane");
  int const zone = builder.zone("plane", {9, 6, 2}, [](Index3 const& p) {
    return Vec3{0.1 * p[0], 0.1 * p[1], 0.1 * p[2]};
  });
  builder.patch("floor", PatchKind::wall, zone, 1, 0);
  builder.patch("roof", PatchKind::farfield, zone, 1, 1);
  builder.patch("left", PatchKind::inflow, zone, 0, 0);
  builder.patch("right", PatchKind::outflow, zone, 0, 1);
  Mesh mesh = builder.finish();
  mesh.dimension = 2;
  write_mesh(path("plane.cgns").string(), mesh);
  write("case.toml",
        "[mesh]\ninput = \"plane.cgns\"\noutput = \"plane_moved.cgns\"\n[[motion]]\npatches = [\"floor\"]\nrule = "
        "\"formula\"\n"
        "dy = \"0.05 * sin(3.9269908169872414 * x)\"\n[output]\nstages = \"stages\"\n");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  auto const stages = stages_in(path("stages"));
  ASSERT_GE(stages.size(), 2U);
  Mesh const last = read_mesh(path("stages/" + stages.back()["file"].get<std::string>()).string());
  Mesh const moved = read_mesh(path("plane_moved.cgns").string());
  EXPECT_EQ(last.dimension, 2);
  ASSERT_EQ(last.n_nodes(), moved.n_nodes());
  for (Index n = 0; n < moved.n_nodes(); ++n) ASSERT_EQ(last.coordinates[n], moved.coordinates[n]);
}

TEST_F(MorphRun, WhatAGuardMovesIsTheLastStage) {
  write("case.toml", contents(path("rotation.toml")) +
                         "\n[guard]\nsmooth = true\nwrite_inverted = true\n[output]\nstages = \"stages\"\n");
  // Far enough that cells lose their shape.
  std::string text = contents(path("case.toml"));
  auto const at = text.find("file    = \"rotation.csv\"");
  ASSERT_NE(at, std::string::npos);
  write("case.toml", text.insert(at, "amplitude = 9\n"));
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_LE(run.status, 1) << run.err;
  auto const stages = stages_in(path("stages"));
  ASSERT_EQ(stages.back()["name"], "guard") << run.out;
  Mesh const morphed = read_mesh(path("passage_rotation.cgns").string());
  Mesh const last = read_mesh(path("stages/" + stages.back()["file"].get<std::string>()).string());
  for (Index n = 0; n < morphed.n_nodes(); ++n) ASSERT_EQ(last.coordinates[n], morphed.coordinates[n]);
}

TEST_F(MorphRun, QuietPrintsNothing) {
  Outcome const run = gridmorph("--quiet morph rotation.toml");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(MorphRun, DryRunPrintsThePlanAndWritesNothing) {
  Outcome const run = gridmorph("morph rotation.toml --dry-run --report out.json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("near field"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("passage_rotation.cgns")));
  expect_nothing_written();
}

TEST_F(MorphRun, AMeshThatInvertsIsWrittenOnlyWhenAskedFor) {
  std::string const torn =
      "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndtheta = \"0.2*sin(200*axial)\"\n"
      "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n[guard]\nretry = false\n";
  write_case("case.toml", torn);
  Outcome const refused = gridmorph("morph case.toml");
  EXPECT_EQ(refused.status, 4) << refused.err;
  for (auto const* words : {"is not written", "the worst is zone '", "now at (", "in the baseline at (", "from patch '",
                            "times the largest it had"})
    EXPECT_NE(refused.err.find(words), std::string::npos) << words << refused.err;
  EXPECT_FALSE(std::filesystem::exists(path("out.cgns")));
  write_case("case.toml", torn + "write_inverted = true\n");
  Outcome const written = gridmorph("morph case.toml");
  EXPECT_EQ(written.status, 1);
  EXPECT_EQ(written.out.find("valid up to"), std::string::npos) << "who wants it all does not wait for the share";
  EXPECT_TRUE(std::filesystem::exists(path("out.cgns")));
}

TEST_F(MorphRun, CellsThatWereFlatHaveALineOfTheirOwnAndBlockNoMorph) {
  // A wing whose tip is collapsed: 90 cells lie in its plane.
  Mesh tip = test::unit_box({10, 9, 6});
  for (Index n = 0; n < tip.n_nodes(); ++n)
    if (Vec3 const x = tip.coordinates[n]; x.z == 6) tip.coordinates.set(n, {x.x + 0.5, x.y, 5});
  bool blocks = false;
  auto const move_tip = [&](std::string const& rule) {
    std::filesystem::remove(path("out.cgns"));
    write("tip.toml", std::string(blocks ? "boundary_layer = false\n" : "") +
                          "[mesh]\ninput = \"tip.cgns\"\noutput = \"out.cgns\"\n[[motion]]\npatches = "
                          "[\"k_max\"]\n" +
                          rule + "[[motion]]\npatches = [\"i_*\", \"j_*\"]\nrule = \"free\"\n");
    return gridmorph("morph tip.toml --report r.json");
  };
  std::string const pitch = "rule = \"rigid\"\nrotation = { angle_deg = 0.01, axis = [0, 1, 0], origin = [5, 0, 5] }\n";
  auto const waves = [](char const* height) {  // every node of the tip the other way than those beside it
    return fmt::format("rule = \"formula\"\ndz = \"{} * sin(pi * x)\"\n", height);
  };
  auto const expect_flat = [&](std::string const& rule, int least) {
    Outcome const run = move_tip(rule);
    EXPECT_EQ(run.status, 0) << run.err << run.out;
    EXPECT_NE(run.out.find("flat before: "), std::string::npos) << run.out;
    for (auto const* words : {"valid up to", "smoothed", "falls short"})
      EXPECT_EQ((run.out + run.err).find(words), std::string::npos) << words << run.out;
    EXPECT_TRUE(std::filesystem::exists(path("out.cgns")));
    Outcome const plan = gridmorph("plan tip.toml");
    EXPECT_NE(plan.out.find(": 0 inverted"), std::string::npos) << plan.out;
    auto const report = nlohmann::json::parse(contents(path("r.json")))["morphed"];
    int flat = 0;
    for (auto const* region : {"near_field", "far_field"}) {
      EXPECT_EQ(report[region]["newly_inverted"], 0);
      EXPECT_EQ(report[region]["inverted"], 0);
      flat += report[region]["flat_before"]["cells"].get<int>();
    }
    EXPECT_GT(flat, least);
    EXPECT_EQ(report["certificate"]["holds"], true);
  };
  for (Mesh const& mesh : {test::to_prisms_and_tetrahedra(tip, 0), test::to_hexahedra(tip), tip}) {
    SCOPED_TRACE(mesh.n_elements());
    blocks = mesh.is_structured();
    write_mesh(path("tip.cgns").string(), mesh);
    expect_flat(waves("1e-4"), 40);
  }
  expect_flat(pitch, 0);
  // Nor has the guard anything to do.
  Coordinates const plain = read_mesh(path("out.cgns").string()).coordinates;
  expect_flat(pitch + "[guard]\nsmooth = true\n", 0);
  Coordinates const guarded = read_mesh(path("out.cgns").string()).coordinates;
  for (Index n = 0; n < plain.size(); ++n) ASSERT_EQ(plain[n], guarded[n]);
  Outcome const torn = move_tip(waves("0.01") + "[guard]\nretry = false\n");
  EXPECT_EQ(torn.status, 4) << torn.err << torn.out;
  std::size_t const at = torn.err.find("valid up to ");
  ASSERT_NE(at, std::string::npos) << torn.err;
  EXPECT_GT(std::stoi(torn.err.substr(at + 12)), 0) << "flat cells may turn by little";
}

TEST_F(MorphRun, WhereAMotionIsTooLargeItSaysHowMuchOfItIsValid) {
  write_case(
      "case.toml",
      "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndtheta = \"0.2*sin(200*axial)\"\n"
      "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n[guard]\nretry = false\n");
  Outcome const refused = gridmorph("morph case.toml");
  ASSERT_EQ(refused.status, 4) << refused.err;
  std::string const said = "valid up to ";
  std::size_t const at = refused.err.find(said);
  ASSERT_NE(at, std::string::npos) << refused.err;
  int const percent = std::stoi(refused.err.substr(at + said.size()));
  ASSERT_GT(percent, 0);
  ASSERT_LT(percent, 99);
  EXPECT_NE(refused.err.find(fmt::format("at {} % zone '", percent + 1)), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find(fmt::format("--fraction {:.2f}", percent / 100.0)), std::string::npos) << refused.err;
  auto const part = [&](int p) {
    return gridmorph(fmt::format("morph case.toml --fraction {} --report r.json", p / 100.0));
  };
  EXPECT_EQ(part(percent + 1).status, 4);
  EXPECT_FALSE(std::filesystem::exists(path("out.cgns")));
  EXPECT_LE(part(percent).status, 1);
  EXPECT_TRUE(std::filesystem::exists(path("out.cgns")));
  auto const certificate = nlohmann::json::parse(contents(path("r.json")))["morphed"]["certificate"];
  EXPECT_EQ(certificate["holds"], true);
  EXPECT_EQ(certificate["negative"], 0);
  EXPECT_GT(certificate["cells"], 5000);
}

TEST_F(MorphRun, AFractionOfAMotionIsThatOfEveryAmplitude) {
  std::string const blade =
      "[[motion]]\npatches = [\"blade\"]\nrule = \"rigid\"\nrotation = { angle_deg = 4, axis = [1, 0, 0], origin = [0, "
      "0, 0] }\n";
  std::string const slip = "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n";
  std::string const rules = blade + slip;
  write_case("whole.toml", rules);
  write_case("half.toml", blade + "amplitude = 0.5\n" + slip);
  ASSERT_LE(gridmorph("morph half.toml").status, 1);
  Mesh const half = read_mesh(path("out.cgns").string());
  ASSERT_LE(gridmorph("morph whole.toml --fraction 0.5").status, 1);
  Mesh const fraction = read_mesh(path("out.cgns").string());
  for (Index n = 0; n < half.n_nodes(); ++n) ASSERT_EQ(half.coordinates[n], fraction.coordinates[n]) << n;
  EXPECT_EQ(gridmorph("morph whole.toml --fraction 1.5").status, 2);
}

TEST_F(MorphRun, SmoothingLeavesSoundCellsAloneAndMendsLostOnes) {
  std::string const text = contents(path("rotation.toml"));
  auto const moved = [&](std::string const& toml, int status) {
    write("case.toml", toml);
    Outcome const run = gridmorph("morph case.toml");
    EXPECT_EQ(run.status, status) << run.err;
    return std::pair(run.out, read_mesh(path("passage_rotation.cgns").string()));
  };
  std::string const guard = "\n[guard]\nsmooth = true\nquality = \"full\"\n";
  auto const plain = moved(text, 0), smoothed = moved(text + guard, 0);
  for (Index n = 0; n < plain.second.n_nodes(); ++n)
    ASSERT_EQ(plain.second.coordinates[n], smoothed.second.coordinates[n]) << n;
  EXPECT_EQ(plain.first.find("\nguard "), std::string::npos);
  EXPECT_NE(smoothed.first.find("\nguard "), std::string::npos) << "the time of the guard";
  std::string large = text;
  std::string const file = "file    = \"rotation.csv\"";
  large.replace(large.find(file), file.size(), file + "\namplitude = -4");
  write("case.toml", large + "\n[guard]\nsmooth = true\nwrite_inverted = true\n");
  EXPECT_NE(gridmorph("morph case.toml").out.find("displacements around them are smoothed in"), std::string::npos);
}

TEST_F(MorphRun, AFrozenGuardGivesTheMeshThatTheGuardMade) {
  std::string large = contents(path("rotation.toml"));
  std::string const file = "file    = \"rotation.csv\"";
  large.replace(large.find(file), file.size(), file + "\namplitude = -4");
  auto const moved = [&](std::string const& guard) {
    write("case.toml", large + "\n[guard]\nsmooth = true\nwrite_inverted = true\n" + guard);
    Outcome const run = gridmorph("morph case.toml --report r.json");
    EXPECT_LE(run.status, 1) << run.err;
    return std::pair(read_mesh(path("passage_rotation.cgns").string()),
                     nlohmann::json::parse(contents(path("r.json"))));
  };
  auto const [smoothed, plain] = moved("");
  auto const [frozen, report] = moved("freeze = true\n");
  EXPECT_FALSE(plain.contains("frozen_guard"));
  EXPECT_EQ(report["frozen_guard"]["modes"], 1);
  EXPECT_EQ(report["frozen_guard"]["displacements"], 1);
  EXPECT_GT(report["frozen_guard"]["nodes"], 100);
  for (Index n = 0; n < frozen.n_nodes(); ++n)
    ASSERT_LT(distance(frozen.coordinates[n], smoothed.coordinates[n]), 1e-12 * frozen.size()) << n;
}

/// The rotation of the passage, ten times as large.
class Recipes : public MorphRun {
 protected:
  void SetUp() override {
    MorphRun::SetUp();
    large = contents(path("rotation.toml"));
    std::string const file = "file    = \"rotation.csv\"";
    large.replace(large.find(file), file.size(), file + "\namplitude = 10");
  }
  std::pair<Outcome, nlohmann::json> moved(std::string const& toml) {
    write("case.toml", toml);
    Outcome const run = gridmorph("morph case.toml --report r.json");
    return {run, nlohmann::json::parse(contents(path("r.json")))};
  }
  /// The keys that a report says are kept give its mesh, bit for bit, without any search.
  void expect_same_by_hand(Outcome const& run, nlohmann::json const& report) {
    auto const& retry = report["retry"];
    EXPECT_GT(retry["first"]["newly_inverted"], 0);
    std::string const kept = retry["kept"];
    EXPECT_NE(run.out.find(kept), std::string::npos) << "the keys are said";
    auto const tried = std::find_if(retry["tried"].begin(), retry["tried"].end(),
                                    [&](auto const& one) { return one["keys"] == kept; });
    ASSERT_NE(tried, retry["tried"].end());
    EXPECT_EQ((*tried)["newly_inverted"], 0);
    Mesh const best = read_mesh(path("passage_rotation.cgns").string());
    std::string const by_hand = test::with_keys(large + "\n[guard]\nretry = false\n", kept);
    auto const [again, same] = moved(by_hand);
    ASSERT_EQ(again.status, run.status) << again.err << by_hand;
    EXPECT_FALSE(same.contains("retry"));
    Mesh const repeated = read_mesh(path("passage_rotation.cgns").string());
    for (Index n = 0; n < best.n_nodes(); ++n) ASSERT_EQ(best.coordinates[n], repeated.coordinates[n]) << n << by_hand;
  }

  std::string large;
};

TEST_F(Recipes, AreTriedByThemselvesWhereCellsOfBlocksAreInverted) {
  auto const [run, report] = moved(large);
  ASSERT_LE(run.status, 1) << run.err;
  expect_same_by_hand(run, report);
}

TEST_F(Recipes, AreTriedForLimitsToWhereAskedFor) {
  auto const [run, report] = moved(large + "\n[guard]\nretry = true\n");
  ASSERT_LE(run.status, 1) << run.err;
  expect_same_by_hand(run, report);
  auto const [strict, tried] =
      moved(contents(path("rotation.toml")) + "\n[guard]\nretry = true\nmin_determinant = 0.99\n");
  EXPECT_EQ(strict.status, 1);
  EXPECT_TRUE(tried.contains("retry"));
  auto const [sound, untried] = moved(contents(path("rotation.toml")) + "\n[guard]\nretry = true\n");
  EXPECT_EQ(sound.status, 0);
  EXPECT_FALSE(untried.contains("retry")) << "nothing falls short";
}

TEST_F(Recipes, AreNotTriedWhereSomebodySaysSoOrTheyWouldNotHelp) {
  for (auto const& [key, status] : {std::pair("retry = false", 4), std::pair("write_inverted = true", 1)}) {
    auto const [run, report] = moved(large + "\n[guard]\n" + key + "\n");
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_FALSE(report.contains("retry")) << key;
  }
  write_case("case.toml",
             "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndx = \"20 * r\"\n"
             "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n");
  Outcome const run = gridmorph("morph case.toml --report r.json");
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_NE(run.err.find("likely cause"), std::string::npos) << run.err;
  EXPECT_FALSE(nlohmann::json::parse(contents(path("r.json"))).contains("retry")) << "another unit";
}

TEST_F(MorphRun, AThresholdThatIsNotMetGivesStatusOneAndTheMesh) {
  std::string text = contents(path("rotation.toml"));
  write("strict.toml", text + "\n[guard]\nmin_determinant = 0.99\n");
  EXPECT_EQ(gridmorph("morph strict.toml").status, 1);
  EXPECT_TRUE(std::filesystem::exists(path("passage_rotation.cgns")));
}

TEST_F(MorphRun, AnglesThatShearTakesAwayFallShort) {
  std::string const text = contents(path("rotation.toml"));
  write("strict.toml", text + "\n[guard]\nmin_angle_deg = 60\n");
  Outcome const angle = gridmorph("morph strict.toml");
  EXPECT_EQ(angle.status, 1) << angle.err;
  EXPECT_NE(angle.out.find("smallest angle is"), std::string::npos) << angle.out;
  write("strict.toml", text + "\n[guard]\nmax_loss = 0.05\n");
  Outcome const loss = gridmorph("morph strict.toml");
  EXPECT_EQ(loss.status, 1) << loss.err;
  EXPECT_NE(loss.out.find("lost more than 5 %"), std::string::npos) << loss.out;
  // Below a threshold in the baseline already: no shortfall of the morph.
  write("still.toml", text.substr(0, text.find("[[motion]]")) + "[[motion]]\npatches = [\"*\"]\nrule = \"fixed\"\n" +
                          "[guard]\nmin_angle_deg = 89\nmax_skewness = 0.01\nmin_determinant = 0.99\n");
  Outcome const still = gridmorph("morph still.toml");
  EXPECT_EQ(still.status, 0) << still.err << still.out;
  EXPECT_NE(still.out.find("was so in the baseline"), std::string::npos) << still.out;
}

TEST_F(MorphRun, AVerdictGivesTheStatusOfTheFullMeasurement) {
  for (std::string const guard : {"", "min_determinant = 0.99\n"}) {
    write("case.toml", contents(path("rotation.toml")) + "\n[guard]\n" + guard +
                           "quality = \"fast\"\n[output]\nreport = \"r.json\"\n");
    Outcome const fast = gridmorph("morph case.toml");
    EXPECT_EQ(fast.status, guard.empty() ? 0 : 1) << fast.err;
    auto const verdict = nlohmann::json::parse(contents(path("r.json")));
    EXPECT_FALSE(verdict.contains("baseline"));
    EXPECT_EQ(fast.out.find("aspect ratio"), std::string::npos) << fast.out;
    Outcome const full = gridmorph("morph case.toml --quality full");
    EXPECT_EQ(full.status, fast.status);
    auto const all = nlohmann::json::parse(contents(path("r.json")));
    for (auto const* region : {"near_field", "far_field"}) {
      EXPECT_EQ(all["morphed"][region]["fallen"], verdict["morphed"][region]["fallen"]);
      for (auto const* measure : {"determinant_3x3x3", "minimum_angle_deg"})
        EXPECT_EQ(all["morphed"][region]["measures"][measure]["worst"],
                  verdict["morphed"][region]["measures"][measure]["worst"]);
    }
  }
  Outcome const compared = gridmorph("quality passage.cgns passage_rotation.cgns --quality fast");
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_NE(compared.out.find("minimum angle"), std::string::npos);
}

TEST_F(MorphRun, WhatLooksLikeTheCauseIsSaid) {
  // Millimetres in a mesh in metres, in the displacements alone and in the points too.
  std::istringstream lines(contents(path("rotation.csv")));
  std::string line, both, displacements;
  std::getline(lines, line);
  both = displacements = line + "\n";
  while (std::getline(lines, line)) {
    double v[6];
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5), 6);
    for (int c = 0; c < 6; ++c) {
      char const* const end = c < 5 ? "," : "\n";
      both += fmt::format("{:.17g}{}", 1000 * v[c], end);
      displacements += fmt::format("{:.17g}{}", (c < 3 ? 1 : 1000) * v[c], end);
    }
  }
  write("both.csv", both);
  write("displacements.csv", displacements);
  auto const with_blade = [&](std::string const& rule) {
    std::string text = contents(path("rotation.toml"));
    std::string const field = "rule    = \"field\"\nfile    = \"rotation.csv\"\n";
    text.replace(text.find(field), field.size(), rule);
    write("case.toml", text + "[guard]\nmax_trim = 1\n");  // so that it is not refused before
    return gridmorph("morph case.toml");
  };
  auto const expect_cause = [](Outcome const& run, int status, std::string const& words) {
    EXPECT_EQ(run.status, status) << run.err;
    auto const at = run.err.find("likely cause: ");
    ASSERT_NE(at, std::string::npos) << run.err;
    EXPECT_NE(run.err.find(words, at), std::string::npos) << run.err;
  };
  expect_cause(with_blade("rule = \"field\"\nfile = \"both.csv\"\nmax_distance = 1000\n"), 4,
               "may be in another unit (length_scale");
  expect_cause(with_blade("rule = \"field\"\nfile = \"displacements.csv\"\n"), 4,
               "displacements may be in another unit");
  expect_cause(with_blade("rule = \"rigid\"\nrotation = { angle_deg = 20, axis = [0, 0, 1], origin = [0, 0, 0] }\n"), 4,
               "look at axis and origin");
  std::string text = contents(path("rotation.toml"));
  std::string const axis = "direction = [1, 0, 0]";
  text.replace(text.find(axis), axis.size(), "direction = [0, 0, 1]");
  write("case.toml", text);
  expect_cause(gridmorph("morph case.toml"), 2, "periodic interfaces turn about (1, 0, 0)");
}

TEST_F(MorphRun, ATerminalShowsPercentAndALogOfAShortRunNothing) {
  EXPECT_EQ(gridmorph("morph rotation.toml").err, "");
  if (shell("script --version").status != 0) GTEST_SKIP() << "needs script(1) for a terminal";
  Outcome const run = shell("script -qec \"$G morph rotation.toml\" /dev/null");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("measuring quality, 50 %"), std::string::npos) << run.out;
  EXPECT_EQ(shell("script -qec \"$G -q morph rotation.toml\" /dev/null").out, "");
}

TEST_F(MorphRun, ADiskThatIsFullIsAFailureOfTheMachineAndLeavesNothing) {
  // A limit on the size of files stands in for the full disk.
  Outcome const run = shell("ulimit -f 64; $G morph rotation.toml -o out.cgns");
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_NE(run.err.find("gridmorph: error: "), std::string::npos);
  expect_nothing_written();
}

}  // namespace
}  // namespace gridmorph::test
