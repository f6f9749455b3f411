// Morphing from case file to mesh file.
#include "run_command.hpp"
#include "support/shared_mesh.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

namespace gridmorph::testing {
namespace {

using MorphRunTest = CommandTest;

TEST_F(MorphRunTest, WritesMeshAndReportAndPrintsTheTable) {
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

TEST_F(MorphRunTest, HonoursTheDisplacementFileExactly) {
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

TEST_F(MorphRunTest, ZeroMotionLeavesEveryCoordinateBitIdentical) {
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

TEST_F(MorphRunTest, ThreadsDoNotChangeTheResult) {
  ASSERT_EQ(gridmorph("morph rotation.toml -o out1.cgns --threads 1").status, 0);
  ASSERT_EQ(gridmorph("morph rotation.toml -o out2.cgns --threads 2").status, 0);
  Mesh const one = read_mesh(path("out1.cgns").string()), two = read_mesh(path("out2.cgns").string());
  for (Index n = 0; n < one.n_nodes(); ++n) ASSERT_EQ(one.coordinates[n], two.coordinates[n]) << describe_node(one, n);
}

/// inspect's case file moves every wall by zero through the whole engine: rules, chains, projection.
TEST_F(MorphRunTest, SuggestedCaseFilesLeaveRealMeshesBitIdentical) {
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
TEST_F(MorphRunTest, SuggestedCaseFilesPlanOnMeshesWithGaps) {
  std::filesystem::copy(test::shared_mesh("rotorstator.cgns"), path("rotorstator.cgns"));
  Outcome const inspected = gridmorph("inspect rotorstator.cgns --suggest");
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("\nmatching_tolerance = "), std::string::npos);
  EXPECT_NE(inspected.out.find("\nopen_faces = "), std::string::npos);
  write("suggested.toml", inspected.out);
  EXPECT_EQ(gridmorph("plan suggested.toml").status, 0);
}

TEST_F(MorphRunTest, EveryStepIsTimedInTheOutputAndInTheReport) {
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

TEST_F(MorphRunTest, QuietPrintsNothing) {
  Outcome const run = gridmorph("--quiet morph rotation.toml");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST_F(MorphRunTest, DryRunPrintsThePlanAndWritesNothing) {
  Outcome const run = gridmorph("morph rotation.toml --dry-run --report out.json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("near field"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("passage_rotation.cgns")));
  expect_nothing_written();
}

TEST_F(MorphRunTest, AMeshThatInvertsIsWrittenOnlyWhenAskedFor) {
  std::string const torn =
      "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndtheta = \"0.2*sin(200*axial)\"\n"
      "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n";
  write_case("case.toml", torn);
  Outcome const refused = gridmorph("morph case.toml");
  EXPECT_EQ(refused.status, 1) << refused.err;
  EXPECT_NE(refused.err.find("is not written"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("out.cgns")));
  write_case("case.toml", torn + "[guard]\nwrite_inverted = true\n");
  EXPECT_EQ(gridmorph("morph case.toml").status, 1);
  EXPECT_TRUE(std::filesystem::exists(path("out.cgns")));
}

TEST_F(MorphRunTest, AThresholdThatIsNotMetGivesStatusOneAndTheMesh) {
  std::string text = contents(path("rotation.toml"));
  write("strict.toml", text + "\n[guard]\nmin_determinant = 0.99\n");
  EXPECT_EQ(gridmorph("morph strict.toml").status, 1);
  EXPECT_TRUE(std::filesystem::exists(path("passage_rotation.cgns")));
}

TEST_F(MorphRunTest, ADiskThatIsFullIsAFailureOfTheMachineAndLeavesNothing) {
  // A limit on the size of files stands in for the full disk.
  Outcome const run = shell("ulimit -f 64; $G morph rotation.toml -o out.cgns");
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_NE(run.err.find("gridmorph: error: "), std::string::npos);
  expect_nothing_written();
}

}  // namespace
}  // namespace gridmorph::testing
