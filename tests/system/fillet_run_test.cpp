// Fillets by the command: which kind of mesh is made of which, and what stays in the file.
#include "run_command.hpp"

#include <generators/passage.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

namespace gridmorph::testing {
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

}  // namespace
}  // namespace gridmorph::testing
