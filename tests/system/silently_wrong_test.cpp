// Inputs that do not say what was meant are refused, or said to be so, however quiet the run.
#include "run_command.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::testing {
namespace {

class SilentlyWrong : public CommandTest {
 protected:
  [[nodiscard]] static bool says(std::string const& text, std::string const& words) {
    return text.find(words) != std::string::npos;
  }
};

bool has_shortfall(nlohmann::json const& report, std::string const& severity, std::string const& words) {
  return std::any_of(report["shortfalls"].begin(), report["shortfalls"].end(), [&](auto const& s) {
    return s["severity"] == severity && s["message"].template get<std::string>().find(words) != std::string::npos;
  });
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
            blade.push_back(mesh.coordinates[mesh.zones[std::size_t(patch.zone)].node({i, j, k})]);
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
    if (radius(p) < top - 0.03 * (top - bottom)) fewer += row(p, 1);
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
  EXPECT_TRUE(says(short_of_rows.err, "warning: c.toml:6: fewer.csv: ")) << short_of_rows.err;
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
  Outcome const typed = gridmorph("inspect $'no\\x1b[2J\\rsuch.vtu'");
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

}  // namespace
}  // namespace gridmorph::testing
