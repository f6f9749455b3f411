// The case file that `inspect` suggests runs as it is, from any folder, moves nothing, and runs again with one motion
// in it.
#include "run_command.hpp"
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_meshes.hpp"

#include <generators/passage.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <functional>

namespace gridmorph::test {
namespace {

namespace fs = std::filesystem;
using test::Sector;

class Suggestions : public CommandTest {
 protected:
  /// Writes `mesh`, asks for a case file in another folder, runs it from a third one, and again with a motion.
  template <class AnyMesh>
  void expect_runs(std::string const& name, AnyMesh const& mesh, std::string const& motion) {
    SCOPED_TRACE(name);
    fs::create_directories(path("meshes"));
    fs::create_directories(path("cases/" + name));
    std::string const file = path("meshes/" + name + ".cgns").string();
    write_mesh(file, mesh);
    Outcome const asked = gridmorph("inspect -q meshes/" + name + ".cgns --suggest cases/" + name + "/case.toml");
    ASSERT_EQ(asked.status, 0) << asked.err;
    Outcome const still = shell("cd meshes && $G morph -q ../cases/" + name + "/case.toml");
    std::string const text = contents(path("cases/" + name + "/case.toml"));
    ASSERT_EQ(still.status, 0) << still.err << text;
    expect_same_coordinates<AnyMesh>(file, path("cases/" + name + "/" + name + "_morphed.cgns").string());
    auto const at = text.find("[0, 0, 0]\n", text.find("translation"));
    if (at == std::string::npos) return;  // nothing in it moves
    write("cases/" + name + "/moved.toml",
          std::string(text).replace(at, 9, motion) + "[guard]\nmax_trim = 1\n");  // any way, over slip surfaces too
    Outcome const moved = gridmorph("morph -q cases/" + name + "/moved.toml -o cases/" + name + "/moved.cgns");
    EXPECT_LE(moved.status, 1) << moved.err << text;
    EXPECT_TRUE(fs::exists(path("cases/" + name + "/moved.cgns"))) << text;
  }

 private:
  static void expect_same(Coordinates const& a, Coordinates const& b) {
    ASSERT_EQ(a.size(), b.size());
    for (Index n = 0; n < a.size(); ++n) ASSERT_EQ(a[n], b[n]) << "node " << n;
  }
  template <class AnyMesh>
  static void expect_same_coordinates(std::string const& a, std::string const& b) {
    if constexpr (std::is_same_v<AnyMesh, Mesh>)
      expect_same(read_mesh(a).coordinates, read_mesh(b).coordinates);
    else
      expect_same(read_mesh(a).coordinates, read_mesh(b).coordinates);
  }
};

constexpr char const* small = "[0.001, 0.0005, 0]";

TEST_F(Suggestions, RunOnBlocksOfEveryShape) {
  using enum test::Shape;
  expect_runs("box", test::box({5, 4, 6}, straight, 1), small);
  expect_runs("curved", test::box({5, 4, 6}, curved, 1), small);
  expect_runs("t_junctions", test::bricks_with_t_junctions(1), small);
  expect_runs("around_a_box", test::around_a_box(1), small);
  expect_runs("o_grid", test::o_grid(0.4, 1), small);
  expect_runs("c_grid", test::c_grid(1), small);
  if (test::reduced()) return;
  expect_runs("star", test::star(5, 1), small);
  expect_runs("translational", test::translational(1, 1), small);
}

TEST_F(Suggestions, RunOnSectorsAboutAnyAxis) {
  Sector sector;
  Vec3 const unit = (1e-3 / norm(sector.axis)) * sector.axis;
  std::string const along = fmt::format("[{}, {}, {}]", unit.x, unit.y, unit.z);
  expect_runs("sector", test::annulus_sector(sector, 1), along);
  expect_runs("bend", test::bend_sector(sector, 1), along);
  sector.inner_radius = 0;
  expect_runs("wedge", test::annulus_sector(sector, 1), along);
}

/// Blade, tip and what is cut into it are one body, and over the tip there is no near field: with a motion in the
/// suggested case the blade grows until the gap over it is half as high, and untwists, and no cell turns inside out.
TEST_F(Suggestions, OnPassagesWithATipGapTakeAMotionThatClosesTheGapByHalf) {
  for (BladeTip const tip : {BladeTip::flat, BladeTip::squealer, BladeTip::groove}) {
    std::string const kind(name(tip));
    SCOPED_TRACE(kind);
    PassageOptions options;
    options.nodes = 20'000;
    options.tip = tip;
    Mesh const mesh = make_passage(options);
    ASSERT_NO_FATAL_FAILURE(expect_runs(kind, mesh, "[0, 0, 0]"));
    std::string text = contents(path("cases/" + kind + "/case.toml"));
    std::string const still = "rule = \"rigid\"\ntranslation = [0, 0, 0]";
    auto const at = text.find(still);
    ASSERT_NE(at, std::string::npos) << text;
    for (std::string const& family : blade_families(tip))
      EXPECT_NE(text.rfind("\"" + family + "\"", at), std::string::npos) << text;
    EXPECT_NE(text.find("walls = [\"blade\"]"), std::string::npos) << text;
    text.replace(at, still.size(),
                 R"keys(rule = "formula"
dr     = "0.0015 * max(0, (r - 0.46) / 0.2)"
dtheta = "-0.03 * max(0, (r - 0.46) / 0.2) * axial / r"
daxial = "0.03 * max(0, (r - 0.46) / 0.2) * r * theta")keys");
    write("cases/" + kind + "/grown.toml", text);
    Outcome const grown = gridmorph("morph -q cases/" + kind + "/grown.toml --report grown.json");
    EXPECT_EQ(grown.status, 0) << grown.err << text;
    auto const report = nlohmann::json::parse(contents(path("grown.json")));
    for (auto const* region : {"near_field", "far_field"}) {
      EXPECT_GT(report["morphed"][region]["cells"], 1000) << region;
      EXPECT_EQ(report["morphed"][region]["inverted"], 0) << region;
    }
    // The gap is what the blade leaves of 1.5 % of the span.
    Mesh const moved = read_mesh(path("cases/" + kind + "/" + kind + "_morphed.cgns").string());
    double rise = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      auto const radius = [](Vec3 const& p) { return std::hypot(p.y, p.z); };
      rise = std::max(rise, radius(moved.coordinates[n]) - radius(mesh.coordinates[n]));
    }
    EXPECT_NEAR(rise, 0.0015, 0.0001);
  }
}

TEST_F(Suggestions, RunOnElementsOfEveryKind) {
  auto const ball = [](Vec3 const& c) { return distance(c, {3, 3, 3}) < 1.2; };
  expect_runs("hexahedra", test::box_around({6, 6, 6}, ball), small);
  expect_runs("tetrahedra", test::box_around({6, 6, 6}, ball, true), small);
  expect_runs("airfoil", test::airfoil(40, 4, 0.002, 1.3, 5), small);
  expect_runs("flat", test::flat_box(6, 5, 2), small);
  expect_runs("prisms", test::to_prisms_and_tetrahedra(test::unit_box({4, 3, 5}), 2), small);
  expect_runs("two_zones", test::in_two_zones(test::box_around({6, 6, 6}, ball), [](Vec3 const& c) { return c.x < 3; }),
              small);
  if (test::reduced()) return;
  // Types that say nothing, and a family of several planes.
  auto bare = test::box_around({6, 6, 6}, ball);
  for (auto& patch : bare.patches) {
    bool const side = patch.kind == PatchKind::farfield;
    patch.kind = PatchKind::other;
    patch.bc_type = "Null";
    if (side) patch.families = {"limits"};
  }
  bare.families = {"limits"};
  expect_runs("no_types", bare, small);
  auto planes = test::to_prisms_and_tetrahedra(test::unit_box({4, 3, 5}), 2);
  for (auto& patch : planes.patches)
    if (patch.kind != PatchKind::wall) {
      patch.families = {"symmetry"};
      patch.kind = PatchKind::symmetry;
      patch.bc_type = "BCSymmetryPlane";
    }
  planes.families = {"symmetry"};
  expect_runs("planes", planes, small);
}

TEST_F(Suggestions, NameTheBodyWhereTypesSayNothing) {
  auto mesh = test::box_around({6, 6, 6}, [](Vec3 const& c) { return distance(c, {3, 3, 3}) < 1.2; });
  for (auto& patch : mesh.patches) {
    patch.name = "surface " + std::to_string(&patch - mesh.patches.data());
    patch.kind = PatchKind::other;
    patch.bc_type = "Null";
  }
  std::string body;
  for (auto const& patch : mesh.patches) {
    auto const nodes = patch_nodes(patch);
    bool const inside = std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) {
      Vec3 const p = mesh.coordinates[n];
      return std::min({p.x, p.y, p.z}) > 0 && std::max({p.x, p.y, p.z}) < 6;
    });
    if (inside) body = patch.name;
  }
  write_mesh(path("duct.cgns").string(), mesh);
  auto const json = nlohmann::json::parse(gridmorph("inspect -q duct.cgns --json").out);
  std::string const text = json["case_file"];
  EXPECT_NE(text.find("patches = [\"" + body + "\"]\nrule = \"rigid\""), std::string::npos) << text;
  for (auto const& b : json["boundaries"]) {
    EXPECT_EQ(b["first_height"]["mean"], 1) << "unit cells";
    EXPECT_EQ(b["guess"].get<std::string>().find("plane") == 0, b["name"] != body) << b["guess"];
  }
}

/// RotationAngle holds angles about x, then y, then z: taken for a rotation vector it would be another axis.
/// Buildings on a street, a car on the road: walls all, and the plane one is no body.
TEST_F(Suggestions, LeaveTheGroundThatABodyStandsOn) {
  for (bool const tetrahedra : {false, true}) {
    Mesh mesh = test::box_around(
        {8, 8, 6}, [](Vec3 const& p) { return p.x > 3 && p.x < 5 && p.y > 3 && p.y < 5 && p.z < 2; }, tetrahedra);
    for (Patch& patch : mesh.patches)
      if (patch.name == "k_min") patch.kind = PatchKind::wall, patch.bc_type = "BCWall";
    expect_runs("street", mesh, "[0.1, 0.05, 0]");
    std::string const text = contents(path("cases/street/case.toml"));
    EXPECT_NE(text.find("patches = [\"body\"]\nrule = \"rigid\""), std::string::npos) << text;
    EXPECT_NE(text.find("patches = [\"k_min\"]\nrule = \"slip\"\nsurface = \"plane\""), std::string::npos) << text;
    // Without anything forgiven, since the ground lets the body slide.
    write("cases/street/strict.toml", std::string(text).replace(text.find("[0, 0, 0]\n"), 9, "[0.1, 0.05, 0]"));
    EXPECT_LE(gridmorph("morph -q cases/street/strict.toml -o cases/street/strict.cgns").status, 1) << text;
  }
}

TEST_F(Suggestions, GiveTheAxisOfAnObliqueSector) {
  Sector sector;
  write_mesh(path("oblique.cgns").string(), test::annulus_sector(sector, 1));
  auto const json = nlohmann::json::parse(gridmorph("inspect -q oblique.cgns --json").out);
  ASSERT_EQ(json["periodic"].size(), 1u);
  auto const& axis = json["periodic"][0]["rotation"]["axis"];
  auto const vector = [](nlohmann::json const& v) { return Vec3{v[0], v[1], v[2]}; };
  Vec3 const unit = (1 / norm(sector.axis)) * sector.axis;
  EXPECT_LT(distance(vector(axis["direction"]), unit), 1e-12);
  EXPECT_LT(norm(cross(vector(axis["origin"]) - sector.origin, unit)), 1e-12);
  EXPECT_EQ(json["periodic"][0]["rotation"]["sectors"], sector.copies);
}

/// Files of others are named as what they are; endings are honoured or refused.
TEST_F(Suggestions, FilesOfOtherProgramsAreNamed) {
  using namespace std::string_literals;
  struct Other {
    std::string name, text, is;
  };
  std::string const zeros(200, '\0');
  for (auto const& other :
       std::vector<Other>{{"a.msh", "$NOD\n3\n", "format 1"},
                          {"b.msh", "(0 \"GAMBIT to Fluent File\")\n(2 3)\n", "Fluent"},
                          {"a.vtk", "# vtk DataFile Version 3.0\nmesh\nASCII\n", "VTK"},
                          {"a.vtp", "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">\n", "VTK"},
                          {"a.exo", "CDF\x01"s + zeros + "num_nod_per_el1", "Exodus"},
                          {"a.stl", "solid wing\nfacet normal 0 0 1\n", "STL"},
                          {"a.cgns.gz", "\x1f\x8b"s + zeros, "gzip"},
                          {"points", "FoamFile\n{\n version 2.0;\n}\n", "OpenFOAM"},
                          {"rotation.toml", contents(path("rotation.toml")), "case file"}}) {
    write(other.name, other.text);
    expect_bad_input(gridmorph("inspect " + other.name), {other.name, other.is});
  }
  fs::create_directories(path("case/constant/polyMesh"));
  expect_bad_input(gridmorph("inspect case"), {"OpenFOAM"});
}

TEST_F(Suggestions, EndingsThatContradictTheFormatAreRefused) {
  expect_bad_input(gridmorph("morph rotation.toml -o out.vtk"), {"out.vtk", "VTK", "CGNS"});
  expect_bad_input(gridmorph("morph rotation.toml -o out.cgns -r out.csv"), {"out.csv", "JSON"});
  expect_bad_input(gridmorph("inspect passage.cgns --suggest out.cgns"), {"out.cgns", "TOML"});
  expect_bad_input(gridmorph("surface passage.cgns -p blade -o out.vtk"), {"out.vtk", ".stl", ".csv"});
}

TEST_F(Suggestions, NodesOfPatchesAreWrittenAsAFieldReadsThem) {
  ASSERT_EQ(gridmorph("surface -q passage.cgns -p blade -o nodes.csv").status, 0);
  write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nfile = \"nodes.csv\"\n");
  Outcome const run = gridmorph("morph -q case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const before = read_mesh(path("passage.cgns").string()), after = read_mesh(path("out.cgns").string());
  for (Index n = 0; n < before.n_nodes(); ++n) ASSERT_EQ(before.coordinates[n], after.coordinates[n]);
  auto const ball = [](Vec3 const& c) { return distance(c, {3, 3, 3}) < 1.2; };
  write_mesh(path("ball.cgns").string(), test::box_around({6, 6, 6}, ball));
  EXPECT_EQ(gridmorph("surface -q ball.cgns -p body -o body.csv").status, 0);
  EXPECT_EQ(gridmorph("surface -q ball.cgns -p body -o body.stl").status, 0);
  EXPECT_NE(contents(path("body.csv")).find("x,y,z,dx,dy,dz\n"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::test
