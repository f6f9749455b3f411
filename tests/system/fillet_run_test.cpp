// Fillets by the command: which kind of mesh is made of which, and what stays in the file.
#include "run_command.hpp"

#include <generators/passage.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace gridmorph::test {
namespace {

class FilletRuns : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    PassageOptions passage;
    passage.nodes = 200'000;
    write_mesh(path("fine.cgns").string(), make_passage(passage));
  }
  [[nodiscard]] nlohmann::json run(std::string const& arguments) const {
    Outcome const outcome = gridmorph(arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
  [[nodiscard]] nlohmann::json zones_of(std::string const& mesh) const {
    nlohmann::json const facts = run("inspect " + mesh);
    nlohmann::json out;
    for (auto const& zone : facts["zones"]) out.push_back(zone["name"]);
    return out;
  }
};

TEST_F(FilletRuns, HexahedraAreCutAndTheResultIsAMeshOfElements) {
  (void)run("hexahedra fine.cgns -o elements.cgns");
  auto const json = run("fillet elements.cgns -b blade -w hub -w case --radius 0.003 -o filled.cgns");
  EXPECT_GT(json["cut_elements"], 0);
  EXPECT_EQ(json["quality"]["far_field"]["inverted"], 0);
  EXPECT_NEAR(double(json["radius"][1]), 0.003, 1e-12);
  EXPECT_EQ(zones_of("filled.cgns"), zones_of("elements.cgns"));
  EXPECT_EQ(run("quality filled.cgns")["baseline"]["far_field"]["inverted"], 0);
}

TEST_F(FilletRuns, BlocksWhoseLayersMeetInAMitreKeepTheirZones) {
  (void)run("fillet fine.cgns -b blade -w hub --radius 0 --blade-layers 16 --wall-layers 8 -o sharp.cgns");
  auto const json = run("fillet sharp.cgns -b blade -w hub --radius 0.003 -o round.cgns");
  EXPECT_EQ(json["quality"]["far_field"]["inverted"], 0);
  EXPECT_GT(json["stations"], 0);
  EXPECT_EQ(zones_of("round.cgns"), zones_of("sharp.cgns"));
  // What has a fillet takes no other one.
  expect_bad_input(gridmorph("fillet round.cgns -b blade -w hub --radius 0.001 -o again.cgns"),
                   {"degrees", "there already"});
  EXPECT_FALSE(std::filesystem::exists(path("again.cgns")));
}

TEST_F(FilletRuns, ARadiusHasToBeANumberOrAnExpression) {
  for (std::string const radius : {"\"\"", "\" \"", "nan", "inf"})
    expect_bad_input(gridmorph("fillet fine.cgns -b blade -w hub --radius " + radius + " -o filled.cgns"), {"radius"});
  EXPECT_FALSE(std::filesystem::exists(path("filled.cgns")));
}

TEST_F(FilletRuns, OneThatFallsShortEndsWithOneAndSaysWhy) {
  EXPECT_EQ(run("fillet fine.cgns -b blade -w hub --radius 0.003 -o sound.cgns")["shortfalls"],
            nlohmann::json::array());
  // Two cells along the hub are within this radius.
  PassageOptions coarse;
  coarse.nodes = 60'000;
  write_mesh(path("coarse.cgns").string(), make_passage(coarse));
  (void)run("hexahedra coarse.cgns -o elements.cgns");
  Outcome const outcome = gridmorph("fillet elements.cgns -b blade -w hub --radius 0.0018 -o short.cgns --json");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("smallest determinant"), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(path("short.cgns")));
  auto const json = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_EQ(json["shortfalls"][0]["severity"], "failure") << outcome.out;
}

TEST_F(FilletRuns, ArcsGoWithTheBladeAndTheHubSlipsInAPlainCaseFile) {
  (void)run("fillet fine.cgns -b blade -w hub --radius 0.003 -o filled.cgns");
  std::ofstream(path("case.toml")) << R"([mesh]
input = "filled.cgns"
output = "moved.cgns"
axis = "x"
[[motion]]
patches = "blade"
rule = "formula"
dtheta = "0.01"
[[motion]]
patches = ["inlet", "outlet"]
rule = "circumferential-slide"
of = "blade"
[[motion]]
patches = "type:periodic"
rule = "follow"
of = "blade"
[[motion]]
patches = ["hub", "case"]
rule = "slip"
surface = "revolution"
)";
  (void)run("morph case.toml");
  Mesh const before = read_mesh(path("filled.cgns").string()), after = read_mesh(path("moved.cgns").string());
  Index on_arc = 0, on_hub = 0;
  for (Patch const& patch : before.patches) {
    std::string const& family = patch.families.front();
    if (family != "blade_fillet" && family != "hub") continue;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const n = before.zones[patch.zone].node({i, j, k});
          Vec3 const p = before.coordinates[n], q = after.coordinates[n];
          double const c = std::cos(0.01), s = std::sin(0.01);
          // The profile of the hub is a function of x; rows that turn as a whole keep it node by node.
          EXPECT_LT(std::abs(std::hypot(q.y, q.z) - std::hypot(p.y, p.z)), 1e-9);
          if (family == "hub") {
            ++on_hub;
          } else {
            ++on_arc;
            EXPECT_LT(distance(q, {p.x, c * p.y - s * p.z, s * p.y + c * p.z}), 1e-9);
          }
        }
  }
  EXPECT_GT(on_arc, 100);
  EXPECT_GT(on_hub, 1000);
}

}  // namespace
}  // namespace gridmorph::test
