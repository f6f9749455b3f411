// Meshes of hexahedra as the blocks found in them, by the command: the same motion as of the blocks that they were.
#include "run_command.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace gridmorph::test {
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
  /// The case file with blocks in its [mesh].
  [[nodiscard]] std::string with_blocks(std::string const& word) const {
    std::string out = rules;
    replace(out, "[mesh]\n", "[mesh]\nblocks = \"" + word + "\"\n");
    return out;
  }
  /// The notes of a run, one to a line.
  [[nodiscard]] std::string notes_of(std::string const& case_text) const {
    write("noted.toml", case_text);
    Outcome const run = gridmorph("morph noted.toml -o noted.cgns --json");
    EXPECT_LE(run.status, 1) << run.err;  // 1: the mesh falls short of a limit
    std::string out;
    auto const document = nlohmann::json::parse(run.out);
    for (auto const& note : document["notes"]) out += note.get<std::string>() + "\n";
    return out;
  }

  std::string rules;
};

TEST_F(FoundBlocksRun, AreMorphedAsTheBlocksThatTheyWereAndTheFileStaysOneOfElements) {
  ASSERT_EQ(gridmorph("morph rotation.toml").status, 0);
  Mesh const blocks = read_mesh(path("passage.cgns").string()),
             moved = read_mesh(path("passage_rotation.cgns").string());
  write("case.toml", rules);
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

/// Connections pair nodes that lie within 1e-6 of the mesh size, blocks within 1e-8.
TEST_F(FoundBlocksRun, AreElementsWherePeriodicSidesLieFartherApartThanThoseOfBlocksMay) {
  Mesh mesh = read_mesh(path("hexahedra.cgns").string());
  double const size = mesh.size();
  for (Connection const& c : mesh.connections) {
    if (!c.periodic || c.nodes.size() < 2) continue;
    for (std::size_t n = 0; n < c.donor_nodes.size(); ++n) {
      Index const node = c.donor_nodes[n];
      Vec3 const p = mesh.coordinates[node];
      mesh.coordinates.set(node, {p.x + (n % 2 == 0 ? 3e-8 : -3e-8) * size, p.y, p.z});
    }
    break;
  }
  write_mesh(path("apart.cgns").string(), mesh);
  std::string const apart =
      "[mesh]\ninput = \"apart.cgns\"\noutput = \"out.cgns\"\naxis = \"x\"\n"
      "[[motion]]\npatches = \"blade\"\nrule = \"rigid\"\ntranslation = [1e-5, 0, 0]\n"
      "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n"
      "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"fixed\"\n";
  std::string const notes = notes_of(apart);
  EXPECT_NE(notes.find("periodic sides lie farther apart"), std::string::npos) << notes;
  EXPECT_NE(notes.find("morphed as elements"), std::string::npos) << notes;
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
  std::string text = with_blocks("find");
  replace(text, "\"hexahedra.cgns\"", "\"passage.cgns\"");
  write("case.toml", text);
  expect_bad_input(gridmorph("morph case.toml -o out.cgns"), {"[mesh] blocks", "blocks already"});
}

TEST_F(FoundBlocksRun, AreNotLookedForWhereTheCaseFileSpeaksOfElements) {
  EXPECT_NE(notes_of(rules).find("blocks found in"), std::string::npos);
  rules.resize(rules.find("[volume]"));  // which elements do not have
  EXPECT_EQ(notes_of(with_blocks("off")).find("blocks"), std::string::npos);
  std::string const near = rules + "\n[near_field]\noffset = 0.01\n";
  std::string const said = notes_of(near);
  EXPECT_NE(said.find("no blocks were looked for among the hexahedra"), std::string::npos) << said;
  EXPECT_NE(said.find("[near_field] is for elements"), std::string::npos) << said;
  std::string both = with_blocks("find") + "\n[near_field]\noffset = 0.01\n";
  write("case.toml", both);
  expect_bad_input(gridmorph("morph case.toml -o out.cgns"), {"near_field", "morphed as the blocks found in it"});
}

TEST_F(FoundBlocksRun, WhatIsNoMeshOfBlocksIsMorphedAsElements) {
  std::string const shear =
      "[mesh]\ninput = \"NAME\"\n[[motion]]\npatches = [\"*\"]\nrule = \"formula\"\ndx = \"0.1 * z\"\n";
  auto const notes_with = [&](std::string const& file, Mesh const& mesh) {
    write_mesh(path(file).string(), mesh);
    std::string text = shear;
    replace(text, "NAME", file);
    return notes_of(text);
  };
  Mesh const box = to_hexahedra(test::unit_box({9, 9, 2}));
  EXPECT_NE(notes_with("box.cgns", box).find("1 block found in 162 hexahedra"), std::string::npos);
  // Rows of holes leave grid lines of one and two cells.
  Mesh const holes = test::part_of(
      box, [](Vec3 const& p) { return std::fmod(p.x, 3) < 1 || std::fmod(p.y, 3) < 1; }, "holes", PatchKind::wall);
  EXPECT_NE(notes_with("holes.cgns", holes).find("limits of blocks run through nearly every row"), std::string::npos);
  EXPECT_EQ(notes_with("second.cgns", test::second_order(box)).find("block"), std::string::npos)
      << "nodes in the middle of edges have no place in blocks";
  EXPECT_EQ(notes_with("mixed.cgns", test::flat_box(4, 4, 2)).find("block"), std::string::npos);
}

/// Quadrilaterals around an airfoil: an O grid that closes on itself.
TEST_F(FoundBlocksRun, QuadrilateralsInThePlaneAreBlocksToo) {
  Mesh const airfoil = test::airfoil(64, 1000, 1e-3, 1.2, 10);
  write_mesh(path("airfoil.cgns").string(), airfoil);
  std::string const text =
      "[mesh]\ninput = \"airfoil.cgns\"\n[[motion]]\npatches = [\"airfoil\"]\nrule = \"rigid\"\n"
      "rotation = { angle_deg = 30, origin = [0.5, 0.0, 0.0], axis = [0.0, 0.0, 1.0] }\n[[motion]]\n"
      "patches = [\"farfield\"]\nrule = \"fixed\"\n";
  write("case.toml", text);
  Outcome const run = gridmorph("morph case.toml -o out.cgns --json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find(std::to_string(airfoil.n_elements()) + " quadrilaterals"), std::string::npos) << run.out;
  Mesh const out = read_mesh(path("out.cgns").string());
  ASSERT_EQ(out.dimension, 2);
  ASSERT_EQ(out.n_nodes(), airfoil.n_nodes());
  double const c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  for (Index n = 0; n < out.n_nodes(); ++n) {
    Vec3 const x = airfoil.coordinates[n] - Vec3{0.5, 0, 0}, y = out.coordinates[n] - Vec3{0.5, 0, 0};
    EXPECT_EQ(y.z, 0);
    if (n < 64) {
      EXPECT_LE(norm(y - Vec3{c * x.x - s * x.y, s * x.x + c * x.y, 0}), 1e-12) << "wall node " << n;
    }
    if (n >= out.n_nodes() - 64) {
      EXPECT_LE(norm(y - x), 1e-12) << "farfield node " << n;
    }
  }
  // The blocks, written and morphed as what they are, move alike.
  ASSERT_EQ(gridmorph("blocks airfoil.cgns -o blocks.cgns").status, 0);
  std::string of_blocks = text;
  replace(of_blocks, "airfoil.cgns", "blocks.cgns");
  write("blocks.toml", of_blocks);
  ASSERT_EQ(gridmorph("morph blocks.toml -o blocks_out.cgns").status, 0);
  Mesh const blocks = read_mesh(path("blocks.cgns").string()), moved = read_mesh(path("blocks_out.cgns").string());
  EXPECT_EQ(blocks.dimension, 2);
  std::map<std::pair<double, double>, Vec3> places;
  for (Index n = 0; n < blocks.n_nodes(); ++n)
    places[{blocks.coordinates[n].x, blocks.coordinates[n].y}] = moved.coordinates[n];
  for (Index n = 0; n < out.n_nodes(); ++n) {
    auto const at = places.find({airfoil.coordinates[n].x, airfoil.coordinates[n].y});
    ASSERT_NE(at, places.end()) << n;
    EXPECT_LE(std::hypot(at->second.x - out.coordinates[n].x, at->second.y - out.coordinates[n].y), 1e-9) << n;
  }
}

/// A table of displacements in the plane, which says nothing of a second one; and selectors by zones of the file.
TEST_F(FoundBlocksRun, TablesAndZonesOfTheFileHoldForTheBlocks) {
  write_mesh(path("airfoil.cgns").string(), test::airfoil(64, 1000, 1e-3, 1.2, 10));
  std::string table = "x,y,z,dx,dy,dz\n";
  Mesh const airfoil = read_mesh(path("airfoil.cgns").string());
  for (Index n = 0; n < 64; ++n) {
    Vec3 const x = airfoil.coordinates[n];
    table += fmt::format("{},{},0,0,{},0\n", x.x, x.y, 0.05 * x.x * x.x);
  }
  write("bend.csv", table);
  write("case.toml",
        "[mesh]\ninput = \"airfoil.cgns\"\n[[motion]]\npatches = [\"zone/airfoil\"]\nrule = \"field\"\n"
        "file = \"bend.csv\"\n[[motion]]\npatches = [\"*/farfield\"]\nrule = \"fixed\"\n");
  Outcome const run = gridmorph("morph case.toml -o out.cgns");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("1 block found"), std::string::npos) << run.out;
  Mesh const out = read_mesh(path("out.cgns").string());
  for (Index n = 0; n < 64; ++n) {
    Vec3 const x = airfoil.coordinates[n], y = out.coordinates[n];
    EXPECT_LE(norm(y - x - Vec3{0, 0.05 * x.x * x.x, 0}), 1e-12) << n;
  }
}

}  // namespace
}  // namespace gridmorph::test
