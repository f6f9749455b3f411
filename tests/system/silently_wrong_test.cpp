// Inputs that do not say what was meant are refused, or said to be so, however quiet the run.
#include "run_command.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

namespace fs = std::filesystem;

class SilentlyWrong : public CommandTest {
 protected:
  /// A box of blocks or elements, its floor named and all other sides slipping on their planes.
  void write_box(std::string const& name, bool blocks) const {
    Mesh const box = test::box({9, 9, 9}, test::Shape::straight, 1);
    if (blocks)
      write_mesh(path(name).string(), box);
    else
      write_mesh(path(name).string(), as_hexahedra(box));
  }
  [[nodiscard]] static bool says(std::string const& text, std::string const& words) {
    return text.find(words) != std::string::npos;
  }
};

bool has_shortfall(nlohmann::json const& report, std::string const& severity, std::string const& words) {
  return std::any_of(report["shortfalls"].begin(), report["shortfalls"].end(), [&](auto const& s) {
    return s["severity"] == severity && s["message"].template get<std::string>().find(words) != std::string::npos;
  });
}

/// Of a plane patch of a box along the axes.
Vec3 normal_of(Mesh const& mesh, Patch const& patch) {
  Box box;
  Zone const& zone = mesh.zones[patch.zone];
  auto const add = [&](Index n) { box.include(mesh.coordinates[n]); };
  if (zone.is_block())
    for_each_node(zone, patch.range, add);
  else
    for (Index32 const n : patch_nodes(patch)) add(n);
  Vec3 const size = box.high - box.low;
  return {size.x == 0 ? 1.0 : 0.0, size.y == 0 ? 1.0 : 0.0, size.z == 0 ? 1.0 : 0.0};
}

std::string floor_of(Mesh const& mesh) { return mesh.patches.front().name; }

TEST_F(SilentlyWrong, DisplacementThatASlipSurfaceUndoesForTheMostPartIsRefused) {
  for (bool const blocks : {true, false}) {
    SCOPED_TRACE(blocks ? "blocks" : "elements");
    write_box("box.cgns", blocks);
    Mesh const mesh = read_mesh(path("box.cgns").string());
    std::string const moving = floor_of(mesh);
    std::string others;
    for (std::size_t p = 1; p < mesh.patches.size(); ++p)
      others += (p > 1 ? ", \"" : "\"") + mesh.patches[p].name + "\"";
    Vec3 const normal = normal_of(mesh, mesh.patches.front());
    Vec3 const along = {normal.y, normal.z, normal.x};
    auto const run = [&](double share, std::string const& guard) {
      Vec3 const u = 0.01 * normal + share * 0.01 * along;
      write("c.toml", fmt::format("[mesh]\ninput = \"box.cgns\"\noutput = \"o.cgns\"\n[[motion]]\npatches = "
                                  "[\"{}\"]\nrule = \"rigid\"\ntranslation = [{}, {}, {}]\n[[motion]]\n"
                                  "patches = [{}]\nrule = \"slip\"\nsurface = \"plane\"\n{}",
                                  moving, u.x, u.y, u.z, others, guard));
      return gridmorph("morph -q c.toml -r o.json");
    };
    // Along the floor's normal its rim stays on the sides.
    Outcome const upright = run(0, "");
    EXPECT_EQ(upright.status, 0) << upright.err;
    Outcome const leaning = run(0.1, "");
    EXPECT_EQ(leaning.status, 1) << leaning.err;
    EXPECT_TRUE(says(leaning.err, "warning: the displacement by c.toml:4 takes ") &&
                says(leaning.err, "off the slip surface of patch"))
        << leaning.err;
    auto const report = nlohmann::json::parse(contents(path("o.json")));
    EXPECT_TRUE(has_shortfall(report, "failure", "off the slip surface"));
    Outcome const meant = run(0.1, "[guard]\nmax_trim = 0.2\n");
    EXPECT_EQ(meant.status, 0) << meant.err;
    fs::remove(path("o.cgns"));
    Outcome const across = run(1.5, "");
    EXPECT_EQ(across.status, 2) << across.err;
    EXPECT_TRUE(says(across.err, "off the slip surface of patch") && says(across.err, "A patch that slips does not"))
        << across.err;
    EXPECT_FALSE(fs::exists(path("o.cgns")));
    EXPECT_EQ(run(1.5, "[guard]\nmax_trim = 1\n").status, 0);
  }
}

TEST_F(SilentlyWrong, NodesBeyondThePointsOfAFileAreAWarningHoweverQuietTheRun) {
  Mesh const mesh = read_mesh(path("passage.cgns").string());
  std::string rows = "x,y,z,dx,dy,dz\n", fewer = rows, mm = rows;
  double top = 0;
  std::vector<Vec3> blade;
  for (Patch const& patch : mesh.patches)
    if (patch.name.find("blade") != std::string::npos || (!patch.families.empty() && patch.families.front() == "blade"))
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
            blade.push_back(mesh.coordinates[mesh.zones[patch.zone].node({i, j, k})]);
  ASSERT_FALSE(blade.empty());
  auto const radius = [](Vec3 const& p) { return std::hypot(p.y, p.z); };
  double bottom = radius(blade.front());
  for (Vec3 const& p : blade) {
    top = std::max(top, radius(p));
    bottom = std::min(bottom, radius(p));
  }
  auto const row = [](Vec3 const& p, double scale) {
    return std::to_string(scale * p.x) + "," + std::to_string(scale * p.y) + "," + std::to_string(scale * p.z) +
           ",0,0,0\n";
  };
  for (Vec3 const& p : blade) {
    rows += row(p, 1);
    mm += row(p, 1000);
    if (radius(p) < top - 0.02 * (top - bottom)) fewer += row(p, 1);
  }
  write("whole.csv", rows);
  write("fewer.csv", fewer);
  write("mm.csv", mm);
  auto const run = [&](std::string const& file) {
    write_case("c.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nfile = \"" + file +
                             "\"\n"
                             "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n");
    return gridmorph("morph -q c.toml -r o.json");
  };
  Outcome const whole = run("whole.csv");
  ASSERT_LE(whole.status, 1) << whole.err;
  EXPECT_FALSE(says(whole.err, "whole.csv")) << whole.err;
  Outcome const short_of_rows = run("fewer.csv");
  ASSERT_LE(short_of_rows.status, 1) << short_of_rows.err;
  EXPECT_TRUE(says(short_of_rows.err, "warning: c.toml:5: fewer.csv: ")) << short_of_rows.err;
  auto const report = nlohmann::json::parse(contents(path("o.json")));
  EXPECT_TRUE(has_shortfall(report, "warning", "fewer.csv"));
  Outcome const other_units = run("mm.csv");
  EXPECT_EQ(other_units.status, 2);
  EXPECT_TRUE(says(other_units.err, "length_scale = 0.001 would fit")) << other_units.err;
}

TEST_F(SilentlyWrong, PeriodicAngleThatNodesContradictIsSaid) {
  Mesh mesh = test::annulus_sector({}, 1);
  bool any = false;
  for (auto& face : mesh.interfaces)
    if (face.periodic) {
      // As far off as 40 blades are from 36.
      double const sign = any ? -1 : 1;
      face.periodic = periodic_rotation({0, 0, 0}, {0, 0, 1}, sign * 0.123);
      any = true;
    }
  ASSERT_TRUE(any);
  write_mesh(path("sector.cgns").string(), mesh);
  Outcome const seen = gridmorph("inspect sector.cgns");
  EXPECT_TRUE(says(seen.out, "the file declares a rotation of") && says(seen.out, "by the nodes it is")) << seen.out;
}

TEST_F(SilentlyWrong, ControlCharactersOfNamesDoNotReachTheTerminal) {
  Mesh mesh = as_hexahedra(test::box({3, 3, 3}, test::Shape::straight, 1));
  write_mesh(path("box.vtu").string(), mesh);
  Outcome const typed = gridmorph("inspect \"$(printf 'no\\033[2J\\rsuch.vtu')\"");
  EXPECT_EQ(typed.status, 2);
  EXPECT_FALSE(says(typed.err, "\x1b") || says(typed.err, "\r")) << typed.err;
  EXPECT_TRUE(says(typed.err, "no?[2J?such.vtu")) << typed.err;
}

TEST_F(SilentlyWrong, NamesThatBeginWithAZeroAreToldInWords) {
  write("zero.toml", "[mesh]\ninput = \"\\u0000m.vtu\"\n[[motion]]\npatches = [\"x\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph zero.toml"), {"zero.toml:2", "\\u0000"});
  write("zero.vtm", std::string("<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet file=\"") +
                        '\0' + "q.vtu\"/></vtkMultiBlockDataSet></VTKFile>");
  expect_bad_input(gridmorph("inspect zero.vtm"), {"zero.vtm:1", "zero byte"});
}

TEST_F(SilentlyWrong, MeshWithoutBoundariesGetsNoCaseFile) {
  Mesh mesh = as_hexahedra(test::box({3, 3, 3}, test::Shape::straight, 1));
  mesh.patches.clear();
  write_mesh(path("bare.cgns").string(), mesh);
  Outcome const asked = gridmorph("inspect bare.cgns --suggest case.toml");
  EXPECT_EQ(asked.status, 2);
  EXPECT_TRUE(says(asked.err, "names no boundary")) << asked.err;
  EXPECT_FALSE(fs::exists(path("case.toml")));
}

}  // namespace
}  // namespace gridmorph::test
