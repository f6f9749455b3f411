// Unstructured meshes on the command line: inspected, measured, morphed, and refused where something is missing.
#include "run_command.hpp"

#include <nlohmann/json.hpp>

namespace gridmorph::testing {
namespace {

class UnstructuredTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("mesh.su2", text("0.5"));
    write("moved.su2", text("0.6"));
    write("turned.su2", text("1.6"));
  }
  /// A square of four quadrilaterals; `x` of its middle node.
  static std::string text(std::string const& x) {
    return "NDIME= 2\nNELEM= 4\n9 0 1 4 3\n9 1 2 5 4\n9 3 4 7 6\n9 4 5 8 7\nNPOIN= 9\n0 0\n0.5 0\n1 0\n0 0.5\n" + x +
           " 0.5\n1 0.5\n0 1\n0.5 1\n1 1\nNMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 8\n3 0 1\n3 1 2\n3 2 5\n3 5 8\n3 8 "
           "7\n"
           "3 7 6\n3 6 3\n3 3 0\n";
  }
};

TEST_F(UnstructuredTest, InspectSaysWhatThereIs) {
  Outcome const run = gridmorph("inspect mesh.su2 --quiet");
  EXPECT_EQ(run.status, 0) << run.err;
  for (auto const* part : {"2-D", "9 nodes", "4 quadrilaterals", "wall", "8 faces", "determinant 2x2x2"})
    EXPECT_NE(run.out.find(part), std::string::npos) << run.out;
  auto const json = nlohmann::json::parse(gridmorph("inspect mesh.su2 --json --quiet").out);
  EXPECT_EQ(json["boundaries"][0]["faces"], 8);
  EXPECT_EQ(json["types"]["quadrilateral"], 4);
  EXPECT_TRUE(json["problems"].empty());
}

TEST_F(UnstructuredTest, QualityComparesAndFallsShortWhereElementsTurnOver) {
  EXPECT_EQ(gridmorph("quality mesh.su2").status, 0);
  Outcome const moved = gridmorph("quality mesh.su2 moved.su2 --json --quiet");
  EXPECT_EQ(moved.status, 0) << moved.err;
  auto const region = nlohmann::json::parse(moved.out)["morphed"]["far_field"];
  EXPECT_NEAR(region["measures"]["relative_displacement"]["max"].get<double>(), 0.2, 1e-12);
  EXPECT_EQ(region["measures"]["volume"]["worst"]["element"], 1);
  EXPECT_EQ(gridmorph("quality mesh.su2 turned.su2").status, 1);
}

TEST_F(UnstructuredTest, MorphAndPlanAskForAWallThatMoves) {
  write("case.toml",
        "[mesh]\ninput = \"mesh.su2\"\noutput = \"out.su2\"\n[[motion]]\npatches = [\"*\"]\nrule = \"fixed\"\n");
  for (auto const* command : {"morph case.toml", "plan case.toml"})
    expect_bad_input(gridmorph(command), {"no wall moves", "fixed"});
}

TEST_F(UnstructuredTest, OtherMeshesAreNoBaselines) {
  expect_bad_input(gridmorph("quality mesh.su2 passage.cgns"), {"is unstructured and 'passage.cgns' is not"});
  write("other.su2", "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\n");
  expect_bad_input(gridmorph("quality mesh.su2 other.su2"), {"not the same mesh"});
}

TEST_F(UnstructuredTest, DamagedFilesNameTheLine) {
  std::string const whole = text("0.5");
  write("cut.su2", whole.substr(0, whole.find("0.5 1\n1 1")));
  expect_bad_input(gridmorph("inspect cut.su2"), {"cut.su2:", "the file ends after 7 of 9 points"});
}

}  // namespace
}  // namespace gridmorph::testing
