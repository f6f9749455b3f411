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
  std::string moving = rules;
  auto const file = moving.find("file    =");
  ASSERT_NE(file, std::string::npos);
  auto const end = moving.find('\n', file);
  std::string const csv = moving.substr(moving.find('"', file), end - moving.find('"', file));
  moving.replace(file, end - file, "modes = [ { file = " + csv + ", amplitude = 0.4, phase_deg = 30 } ]");
  // A mode that turns a blade leads off hub and case, since it is linear.
  moving += "\n[guard]\nmax_trim = 0.02\n[output]\nquality = true\ndisplacement = true\n[sequence]\nsteps = 2\n";
  std::string blocks = moving;
  replace(blocks, "\"hexahedra.cgns\"", "\"passage.cgns\"");
  for (bool const found : {false, true}) {
    std::string text = found ? moving : blocks;
    replace(text, "output = \"passage_rotation.cgns\"\n", "");
    text += found ? "output = \"found_{step}.cgns\"\n" : "output = \"blocks_{step}.cgns\"\n";
    if (found) replace(text, "[mesh]\n", "[mesh]\nblocks = \"find\"\n");
    write("series.toml", text);
    Outcome const run = gridmorph("morph series.toml");
    ASSERT_EQ(run.status, 0) << run.err;
  }
  for (std::string const step : {"1", "2"}) {
    Mesh const of_blocks = read_mesh(path("blocks_" + step + ".cgns").string()),
               of_found = read_mesh(path("found_" + step + ".cgns").string());
    EXPECT_FALSE(of_found.is_structured());
    ASSERT_EQ(of_found.n_nodes(), of_blocks.n_nodes());
    for (Index n = 0; n < of_found.n_nodes(); ++n)
      ASSERT_LE(distance(of_found.coordinates[n], of_blocks.coordinates[n]), 1e-9 * of_blocks.size()) << step << n;
  }
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
