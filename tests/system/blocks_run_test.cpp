// Meshes of hexahedra as the blocks found in them, by the command: the same motion as of the blocks that they were.
#include "run_command.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gridmorph::testing {
namespace {

class FoundBlocksRun : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    ASSERT_EQ(gridmorph("hexahedra passage.cgns -o hexahedra.cgns").status, 0);
    rules = contents(path("rotation.toml"));
    replace(rules, "\"passage.cgns\"", "\"hexahedra.cgns\"");
  }
  static void replace(std::string& text, std::string const& what, std::string const& by) {
    auto const at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
  }
  /// The case file with blocks = "find" in its [mesh].
  [[nodiscard]] std::string finding() const {
    std::string out = rules;
    replace(out, "[mesh]\n", "[mesh]\nblocks = \"find\"\n");
    return out;
  }

  std::string rules;
};

TEST_F(FoundBlocksRun, AreMorphedAsTheBlocksThatTheyWereAndTheFileStaysOneOfElements) {
  ASSERT_EQ(gridmorph("morph rotation.toml").status, 0);
  Mesh const blocks = read_mesh(path("passage.cgns").string()),
             moved = read_mesh(path("passage_rotation.cgns").string());
  write("case.toml", finding());
  Outcome const run = gridmorph("morph case.toml -o out.cgns --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const elements = read_mesh(path("hexahedra.cgns").string()), out = read_mesh(path("out.cgns").string());
  EXPECT_FALSE(out.is_structured());
  EXPECT_EQ(out.elements.nodes.item, elements.elements.nodes.item);
  ASSERT_EQ(out.n_nodes(), blocks.n_nodes()) << "hexahedra keep the numbers of the blocks' nodes";
  for (Index n = 0; n < out.n_nodes(); ++n)
    ASSERT_LE(distance(out.coordinates[n], moved.coordinates[n]), 1e-9 * blocks.size()) << n;
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  std::string const said = std::to_string(blocks.zones.size()) + " blocks found in " + std::to_string(blocks.n_cells());
  auto const& notes = report["notes"];
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [&](auto const& note) {
    return note.template get<std::string>().find(said) != std::string::npos;
  })) << notes;
  EXPECT_FALSE(report["stages"].empty()) << "stages are those of blocks";
}

TEST_F(FoundBlocksRun, SequencesAndFieldsGoBackToTheElements) {
  write("case.toml", finding() + "\n[output]\nquality = true\ndisplacement = true\n");
  ASSERT_EQ(gridmorph("morph case.toml -o once.cgns").status, 0);
  Mesh const once = read_mesh(path("once.cgns").string());
  std::string series = finding();
  replace(series, "output", "# output");
  write("series.toml", series + "\n[sequence]\nsteps = 1\nperiods = 1\noutput = \"series.cgns\"\n");
  Outcome const run = gridmorph("morph series.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  write("step.toml", series + "\n[sequence]\nsteps = 1\noutput = \"step_{step}.cgns\"\n");
  ASSERT_EQ(gridmorph("morph step.toml").status, 0);
  Mesh const step = read_mesh(path("step_1.cgns").string());
  ASSERT_EQ(step.n_nodes(), once.n_nodes());
  for (Index n = 0; n < once.n_nodes(); ++n) ASSERT_EQ(step.coordinates[n], once.coordinates[n]) << n;
}

TEST_F(FoundBlocksRun, AreWrittenByACommandOfTheirOwn) {
  Outcome const run = gridmorph("blocks hexahedra.cgns -o blocks.cgns --json");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const passage = read_mesh(path("passage.cgns").string()), found = read_mesh(path("blocks.cgns").string());
  EXPECT_TRUE(found.is_structured());
  EXPECT_EQ(found.zones.size(), passage.zones.size());
  EXPECT_EQ(found.n_cells(), passage.n_cells());
  auto const json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["blocks"].size(), found.zones.size());
  // They are a mesh like any other.
  std::string text = rules;
  replace(text, "\"hexahedra.cgns\"", "\"blocks.cgns\"");
  write("case.toml", text);
  EXPECT_EQ(gridmorph("morph case.toml -o out.cgns").status, 0);
}

TEST_F(FoundBlocksRun, WhatHasNoneIsRefused) {
  write_mesh(path("mixed.cgns").string(), test::to_prisms_and_tetrahedra(read_mesh(path("passage.cgns").string()), 1));
  expect_bad_input(gridmorph("blocks mixed.cgns -o blocks.cgns"),
                   {"mixed.cgns", "lie in no block", "is no hexahedron"});
  expect_bad_input(gridmorph("blocks passage.cgns -o blocks.cgns"), {"is a mesh of blocks already"});
  expect_bad_input(gridmorph("blocks hexahedra.cgns -o blocks.p3d"), {"NAME.cgns"});
  std::string text = finding();
  replace(text, "\"hexahedra.cgns\"", "\"mixed.cgns\"");
  write("case.toml", text);
  expect_bad_input(gridmorph("morph case.toml -o out.cgns"), {"lie in no block", "Remove blocks = \"find\""});
  replace(text, "\"mixed.cgns\"", "\"passage.cgns\"");
  write("case.toml", text);
  expect_bad_input(gridmorph("morph case.toml -o out.cgns"), {"[mesh] blocks", "blocks already"});
}

}  // namespace
}  // namespace gridmorph::testing
