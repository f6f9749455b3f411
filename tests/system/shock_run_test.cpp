// From a file with a flow solution to a mesh whose cells went along with the shock.
#include "motion/shock_flow.hpp"
#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/shared_mesh.hpp"
#include "support/temporary_folder.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/read_solution.hpp>
#include <gridmorph/motion/shock/shock_cells.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <sys/wait.h>

namespace gridmorph::test {
namespace {

class ShockRun : public ::testing::Test {
 protected:
  TemporaryFolder folder;

  [[nodiscard]] std::string text(std::string const& name) const {
    std::ostringstream out;
    out << std::ifstream(folder / name).rdbuf();
    return out.str();
  }
  int morph(std::string const& case_text) const {
    std::ofstream(folder / "case.toml") << case_text;
    std::string const line = "cd '" + (folder / ".").string() +
                             "' && '" GRIDMORPH_EXECUTABLE "' morph case.toml --report r.json > out 2> err";
    return WEXITSTATUS(std::system(line.c_str()));
  }
  void write(std::string const& name, Mesh const& mesh, NormalShock const& shock, bool at_nodes) const {
    FlowSolution const flow = solution_of(mesh, shock, at_nodes);
    OutputFields fields;
    for (auto const& [variable, values] : flow.values) {
      if (at_nodes)
        fields.nodes.push_back({variable, values});
      else
        fields.cells.push_back({variable, values});
    }
    write_mesh((folder / name).string(), mesh, mesh.coordinates, fields);
  }
};

/// A box between an inlet wall that moves a little and an outlet; its sides are planes that nodes slide on.
std::string const box_case = R"(
[mesh]
input  = "flow.cgns"
output = "moved.cgns"
[[motion]]
patches = "u_min"
rule    = "rigid"
translation = [0.01, 0, 0]
[[motion]]
patches = "u_max"
rule    = "fixed"
[[motion]]
patches = ["v_min", "v_max", "w_min", "w_max"]
rule    = "slip"
surface = "plane"
)";

TEST_F(ShockRun, CellsOfTheShockGoWhereTheOtherSolutionHasIt) {
  NormalShock const before{.width = 0.08};
  NormalShock after = before;
  double const way = 0.15;
  after.through.x += way;
  Mesh const blocks = box({33, 9, 9}, Shape::straight, 1);
  for (bool const elements : {false, true})
    for (bool const at_nodes : {true, false}) {
      Mesh const mesh = elements ? to_hexahedra(blocks) : blocks;
      write("flow.cgns", mesh, before, at_nodes);
      write("new.cgns", mesh, after, at_nodes);
      ASSERT_EQ(morph(box_case + R"(
[[region]]
name  = "shock"
shock = { sensor = "jump", threshold = 0.1 }
[[motion]]
patches = "shock"
rule    = "shock"
to      = "new.cgns"
)"),
                0)
          << text("err") << text("out");
      ShockSearch search;
      search.sensor = ShockSearch::Sensor::jump;
      Mesh const read = read_mesh((folder / "flow.cgns").string()), moved = read_mesh((folder / "moved.cgns").string());
      auto const corners = corners_of_cells(read);
      ShockCells const shock =
          find_shock(read, read_flow_solution((folder / "flow.cgns").string(), read, {shock_variables(search)}), search,
                     std::vector<std::uint8_t>(corners.size(), 1));
      Index n_shock = 0;
      for (std::size_t c = 0; c < corners.size(); ++c)
        for (Index const n : corners[c]) {
          if (shock.cells[c] == 0) continue;
          EXPECT_LT(distance(moved.coordinates[n], read.coordinates[n] + Vec3{way, 0, 0}), 0.2 * 2 / 32);
          ++n_shock;
        }
      EXPECT_GT(n_shock, 500);
      expect_all_in(text("out"), {"region 'shock': shock of", "the shock goes by 0.1", "along (1, 0, 0)"});
      auto const json = nlohmann::json::parse(text("r.json"));
      EXPECT_EQ(json["morphed"]["far_field"]["inverted"], 0);
    }
}

TEST_F(ShockRun, TheShockOfTheWingIsFoundAndFollowed) {
  std::string const wing = shared_mesh("mdo_tutorial_000_vol.cgns");
  Mesh const mesh = read_mesh(wing);
  double const way = 0.1;
  Coordinates shifted(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) shifted.set(n, mesh.coordinates[n] + Vec3{way, 0, 0});
  write_morphed(wing, (folder / "new.cgns").string(), mesh, shifted);
  std::string const head = "[mesh]\ninput = \"" + wing + "\"\noutput = \"moved.cgns\"\n" + R"(
[[motion]]
patches = "wall"
rule    = "fixed"
[[motion]]
patches = "far"
rule    = "fixed"
[[motion]]
patches = "sym"
rule    = "slip"
surface = "plane"
[[region]]
name  = "shock"
box   = { from = [2, 0.1, -1], to = [10, 3, 13] }
)";
  std::string const rule = R"(
[[motion]]
patches   = "shock"
rule      = "shock"
to        = "new.cgns"
direction = [1, 0, 0]
of        = "wall"
fade      = 0.3
)";
  // Coarse: the shock is spread so far that the normal Mach number does not reach 1 in any cell.
  EXPECT_EQ(morph(head + "shock = {}\n" + rule), 2);
  expect_all_in(text("err"), {"region 'shock'", "normal Mach number is 0.9", "threshold = 0.9"});
  ASSERT_EQ(morph(head + "shock = { threshold = 0.85 }\n" + rule), 0) << text("err") << text("out");
  expect_all_in(text("out"), {"the shock goes by 0.1 to 0.1 along (1, 0, 0)"});
  auto const json = nlohmann::json::parse(text("r.json"));
  EXPECT_EQ(json["morphed"]["far_field"]["inverted"], 0);
  EXPECT_EQ(json["morphed"]["near_field"]["inverted"], 0);
  Mesh const moved = read_mesh((folder / "moved.cgns").string());
  double largest = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    largest = std::max(largest, distance(moved.coordinates[n], mesh.coordinates[n]));
  EXPECT_NEAR(largest, way, 1e-3 * way);
}

TEST_F(ShockRun, WhatIsMissingIsSaidBeforeAnythingMoves) {
  Mesh const mesh = box({17, 5, 5}, Shape::straight, 1);
  write("flow.cgns", mesh, {}, true);
  write_mesh((folder / "bare.cgns").string(), mesh);
  auto const region = [](std::string const& keys) { return box_case + "[[region]]\nname = \"shock\"\n" + keys; };
  EXPECT_EQ(morph(region("shock = { file = \"bare.cgns\" }\n")), 2);
  expect_all_in(text("err"), {"region 'shock'", "bare.cgns", "no flow solution"});
  EXPECT_EQ(morph(region("shock = { sensor = \"jump\", variable = \"Mach\" }\n")), 2);
  expect_all_in(text("err"), {"no Mach", "'Density', 'Pressure'"});
  EXPECT_EQ(morph(region("shock = { solution = \"last\" }\n")), 2);
  expect_all_in(text("err"), {"no solution 'last'", "'MorphNodes'"});
  EXPECT_EQ(morph(region("shock = {}\n[[motion]]\npatches = \"shock\"\nrule = \"shock\"\nto = \"bare.cgns\"\n")), 2);
  expect_all_in(text("err"), {"case.toml", "bare.cgns", "no flow solution"});
  EXPECT_EQ(morph(region("box = { from = [0, 0, 0], to = [1, 1, 1] }\n[[motion]]\npatches = \"shock\"\nrule = "
                         "\"shock\"\nto = \"flow.cgns\"\n")),
            2);
  expect_all_in(text("err"), {"names no region with shock"});
}

}  // namespace
}  // namespace gridmorph::test
