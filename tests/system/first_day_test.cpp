// What people meet on the first day: messages that say what was meant, and suggested cases on meshes whose boundaries
// say little.
#include "run_command.hpp"
#include "support/mesh_builders.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>

namespace gridmorph::test {
namespace {

namespace fs = std::filesystem;

class FirstDay : public CommandTest {
 protected:
  [[nodiscard]] std::string suggested(std::string const& mesh) const {
    Outcome const asked = gridmorph("inspect -q " + mesh + " --suggest");
    EXPECT_EQ(asked.status, 0) << asked.err;
    return asked.out;
  }
};

std::string const turned = "[[motion]]\npatches = [\"blade\"]\nrule = \"rigid\"\nrotation = { angle_deg = 0.5 }\n";

TEST_F(FirstDay, WallsWithoutARuleAreNamedOnceEachWithTheRuleToAdd) {
  write_case("case.toml", turned);
  Outcome const run = gridmorph("morph case.toml");
  expect_bad_input(run, {"'blade' and 'hub'", "'blade' and 'case'", "common nodes", "no rule names 'hub'",
                         "patches = [\"hub\"], rule = \"slip\", surface = \"revolution\""});
  EXPECT_LE(run.error_lines().size(), 6u) << run.err;
  EXPECT_EQ(run.err.find("'hub'"), run.err.rfind("'blade' and 'hub'") + 12) << "said once: " << run.err;
  // What it says to add is all that is missing.
  std::string const rule = "\nrule = \"slip\"\nsurface = \"revolution\"\n";
  write_case("added.toml",
             turned + "[[motion]]\npatches = [\"hub\"]" + rule + "[[motion]]\npatches = [\"case\"]" + rule);
  EXPECT_LE(gridmorph("morph -q added.toml").status, 1);
}

TEST_F(FirstDay, AtMostSixPairsThatDisagreeAreWrittenOut) {
  // Nine bricks with names of their own, all but one without a rule.
  Mesh mesh = test::bricks_with_t_junctions(1);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    mesh.patches[p].name = "p" + std::to_string(p);
    mesh.patches[p].families.clear();
    mesh.patches[p].kind = PatchKind::wall;
    mesh.patches[p].bc_type = "BCWall";
  }
  mesh.families.clear();
  write_mesh(path("bricks.cgns").string(), mesh);
  std::string rules;
  for (std::size_t p = 0; p < mesh.patches.size(); p += 2)
    rules += "[[motion]]\npatches = [\"p" + std::to_string(p) + "\"]\nrule = \"rigid\"\ntranslation = [0, 0, " +
             std::to_string(p + 1) + "e-3]\n";
  write("case.toml", "[mesh]\ninput = \"bricks.cgns\"\noutput = \"out.cgns\"\n" + rules);
  Outcome const run = gridmorph("morph case.toml");
  expect_bad_input(run, {"disagree", "more pairs of patches"});
  EXPECT_EQ(run.error_lines().size(), 7u) << run.err;
}

TEST_F(FirstDay, ARotationWithoutAnAxisSaysWhichItTook) {
  std::string const rule = "\nrule = \"slip\"\nsurface = \"revolution\"\n";
  write_case("case.toml", turned + "[[motion]]\npatches = [\"hub\", \"case\"]" + rule);
  Outcome const run = gridmorph("plan case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(
      run.out.find(
          "case.toml:8: the rotation names no axis; it turns about that of [mesh], through (0, 0, 0) along (1, 0, 0)"),
      std::string::npos)
      << run.out;
}

TEST_F(FirstDay, InputsThatAreNotThereAreNamedWithLineAndWholePath) {
  std::string const folder = fs::canonical(path(".")).string() + "/";
  write("plain.toml",
        "[mesh]\n\ninput = \"meshes/none.cgns\"\noutput = \"out.cgns\"\nside_file = \"none.toml\"\n"
        "[[motion]]\npatches = [\"blade\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph plain.toml"),
                   {"plain.toml:3: ", folder + "meshes/none.cgns", "plain.toml:5: ", folder + "none.toml"});
  write_case("field.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nfile = \"none.csv\"\n");
  expect_bad_input(gridmorph("morph field.toml"), {"field.toml:8: ", folder + "none.csv"});
  write_case("background.toml",
             "[[motion]]\npatches = [\"blade\"]\nrule = \"fixed\"\n[background]\nfile = \"back.cgns\"\n");
  expect_bad_input(gridmorph("morph background.toml"), {"background.toml:9: ", folder + "back.cgns"});
  expect_bad_input(gridmorph("inspect none.cgns"), {folder + "none.cgns"});
}

TEST_F(FirstDay, MisspeltPatchesAreNamedWithTheNearestAndFamiliesAlone) {
  write_case("case.toml", "[[motion]]\npatches = [\"balde\"]\nrule = \"fixed\"\n");
  Outcome const run = gridmorph("morph case.toml");
  expect_bad_input(run, {"case.toml:5", "'balde' matches nothing; did you mean 'blade'?", "families: ", "'hub'"});
  EXPECT_EQ(run.err.find("BC names"), std::string::npos) << run.err;
  write_case("type.toml", "[[motion]]\npatches = [\"type:wal\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph type.toml"), {"did you mean 'type:wall'?"});
  expect_bad_input(gridmorph("surface passage.cgns -p balde -o out.stl"), {"did you mean 'blade'?"});
}

TEST_F(FirstDay, CommandLinesThatAreAlmostRightSayWhatWasMeant) {
  struct Almost {
    std::string typed, meant;
  };
  for (auto const& [typed, meant] : {Almost{"morph rotation.toml --fraction 50", "did you mean 0.5?"},
                                     {"morph rotation.toml --fraction half", "found half"},
                                     {"-V", "did you mean '--version'?"},
                                     {"-version", "did you mean '--version'?"},
                                     {"help", "did you mean 'gridmorph --help'?"},
                                     {"help morph", "did you mean 'gridmorph morph --help'?"},
                                     {"version", "did you mean 'gridmorph --version'?"},
                                     {"rotation.toml", "did you mean 'gridmorph morph rotation.toml'?"},
                                     {"moprh rotation.toml", "did you mean 'morph'?"},
                                     {"morph rotation.toml --ouput a.cgns", "did you mean '--output'?"},
                                     {"inspect passage.cgns -J", "unknown option '-J'"},
                                     {"inspect passage.cgns -Q", "did you mean '-q'?"}})
    expect_bad_input(gridmorph(typed), {meant});
  EXPECT_EQ(gridmorph("morph rotation.toml --fraction 0.5 --dry-run").status, 0);
}

/// A row of blades between two circles, in a plane: rotor and stator apart, with a mixing plane between them that no
/// type names.
Mesh radial_stage() {
  constexpr int n_theta = 12, n_r = 12;
  double const pitch = 2 * 3.14159265358979323846 / 12;
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "radial stage";
  Index const per_row = Index(n_theta + 1) * (n_r + 1);
  mesh.add_zone("stage", 2 * per_row);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const node = [&](int row, int i, int j) { return Index32(row * per_row + i + (n_theta + 1) * j); };
  auto const in_blade = [](int i, int j) { return i >= 5 && i < 7 && j >= 4 && j < 8; };
  auto const patch = [&](std::string const& name, PatchKind kind, char const* type) -> Patch& {
    Patch p;
    p.name = name;
    p.kind = kind;
    p.bc_type = type;
    p.zone = 0;
    return mesh.patches.emplace_back(std::move(p));
  };
  mesh.patches.reserve(16);
  for (int row = 0; row < 2; ++row) {
    for (int j = 0; j <= n_r; ++j)
      for (int i = 0; i <= n_theta; ++i) {
        double const r = 1 + row + double(j) / n_r, a = pitch * (double(i) / n_theta - 0.5);
        mesh.coordinates.set(node(row, i, j), {r * std::cos(a), r * std::sin(a), 0});
      }
    for (int j = 0; j < n_r; ++j)
      for (int i = 0; i < n_theta; ++i)
        if (!in_blade(i, j))
          mesh.add_element(ElementType::quadrilateral, std::array{node(row, i, j), node(row, i, j + 1),
                                                                  node(row, i + 1, j + 1), node(row, i + 1, j)});
    std::string const name = row == 0 ? "rotor" : "stator";
    Patch& wall = patch(name + " blade", PatchKind::wall, "BCWall");
    for (int i = 5; i < 7; ++i) {
      wall.faces.add(std::array{node(row, i, 4), node(row, i + 1, 4)});
      wall.faces.add(std::array{node(row, i, 8), node(row, i + 1, 8)});
    }
    for (int j = 4; j < 8; ++j) {
      wall.faces.add(std::array{node(row, 5, j), node(row, 5, j + 1)});
      wall.faces.add(std::array{node(row, 7, j), node(row, 7, j + 1)});
    }
    Patch& in = patch(row == 0 ? "inlet" : "stator mixing", row == 0 ? PatchKind::inflow : PatchKind::other,
                      row == 0 ? "BCInflow" : "UserDefined");
    for (int i = 0; i < n_theta; ++i) in.faces.add(std::array{node(row, i, 0), node(row, i + 1, 0)});
    Patch& out = patch(row == 1 ? "outlet" : "rotor mixing", row == 1 ? PatchKind::outflow : PatchKind::other,
                       row == 1 ? "BCOutflow" : "UserDefined");
    for (int i = 0; i < n_theta; ++i) out.faces.add(std::array{node(row, i, n_r), node(row, i + 1, n_r)});
    Connection pair;
    pair.name = name + " pitch";
    pair.zone = pair.donor_zone = 0;
    pair.periodic = periodic_rotation({0, 0, 0}, {0, 0, 1}, pitch);
    for (int j = 0; j <= n_r; ++j) {
      pair.nodes.push_back(node(row, 0, j));
      pair.donor_nodes.push_back(node(row, n_theta, j));
    }
    mesh.connections.push_back(pair);
    for (int side = 0; side < 2; ++side) {
      Patch& p = patch(name + (side == 0 ? " lower" : " upper"), PatchKind::other, "UserDefined");
      for (int j = 0; j < n_r; ++j)
        p.faces.add(std::array{node(row, side * n_theta, j), node(row, side * n_theta, j + 1)});
    }
  }
  return mesh;
}

/// The rule of one [[motion]] that names a patch.
std::string rule_of(std::string const& text, std::string const& patch) {
  auto const at = text.find("\"" + patch + "\"");
  if (at == std::string::npos) return "";
  auto const rule = text.find("rule = \"", at) + 8;
  return text.substr(rule, text.find('"', rule) - rule);
}

TEST_F(FirstDay, BladesOfAPlaneRadialStageAreWhatMoves) {
  Mesh mesh = radial_stage();
  write_mesh(path("stage.cgns").string(), mesh);
  std::string const text = suggested("stage.cgns");
  for (std::string const row : {"rotor", "stator"}) {
    EXPECT_EQ(rule_of(text, row + " blade"), "rigid") << text;
    EXPECT_NE(rule_of(text, row + " mixing"), "rigid") << text;
  }
  // Where types say nothing of the blades either: still no mixing plane.
  for (Patch& p : mesh.patches)
    if (p.kind == PatchKind::wall) {
      p.kind = PatchKind::other;
      p.bc_type = "UserDefined";
      p.name = p.name.starts_with("rotor") ? "first" : "second";
    } else if (p.name.ends_with(" mixing")) {
      p.name = p.name.starts_with("rotor") ? "a" : "b";
    }
  write_mesh(path("bare.cgns").string(), mesh);
  std::string const bare = suggested("bare.cgns");
  for (char const* name : {"first", "second"}) EXPECT_EQ(rule_of(bare, name), "rigid") << bare;
  for (char const* name : {"a", "b"}) EXPECT_NE(rule_of(bare, name), "rigid") << bare;
}

/// A block with six patches of no type, named by their faces.
Mesh block_of_six(std::string const& name, Index3 extent, std::function<Vec3(double, double, double)> const& at) {
  Mesh mesh;
  mesh.source = name;
  mesh.add_zone(name, extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Index3 const p = mesh.zones[0].index(n);
    mesh.coordinates.set(
        n, at(double(p[0]) / (extent[0] - 1), double(p[1]) / (extent[1] - 1), double(p[2]) / (extent[2] - 1)));
  }
  for (int face = 0; face < 6; ++face) {
    Patch p;
    p.name = std::string("face ") + "ijk"[face / 2] + (face % 2 == 0 ? "0" : "1");
    p.kind = PatchKind::other;
    p.bc_type = "UserDefined";
    p.zone = 0;
    p.range = {{0, 0, 0}, extent};
    int const axis = face / 2;
    p.range.begin[axis] = face % 2 == 0 ? 0 : extent[axis] - 1;
    p.range.end[axis] = p.range.begin[axis] + 1;
    mesh.patches.push_back(std::move(p));
  }
  return mesh;
}

TEST_F(FirstDay, OfDuctsAndCylindersWithoutTypesNoPlaneIsTheBody) {
  // A duct whose axis is bent to an S, its exit higher than its inlet; its inlet and exit are planes.
  write_mesh(path("duct.cgns").string(), block_of_six("duct", {17, 9, 9}, [](double s, double v, double w) {
               double const y = 2 * v - 1, z = 2 * w - 1;  // a square onto a disc
               return Vec3{6 * s,
                           2 * (s - std::sin(6.283185307179586 * s) / 6.283185307179586) + y * std::sqrt(1 - z * z / 2),
                           z * std::sqrt(1 - y * y / 2)};
             }));
  std::string const duct = suggested("duct.cgns");
  for (char const* plane : {"face i0", "face i1"}) EXPECT_NE(rule_of(duct, plane), "rigid") << duct;
  // Half an O-mesh around a cylinder.
  write_mesh(path("cylinder.cgns").string(), block_of_six("cylinder", {25, 9, 5}, [](double a, double s, double w) {
               double const r = 1 + 9 * s * s, t = 3.14159265358979323846 * a;
               return Vec3{r * std::cos(t), r * std::sin(t), w};
             }));
  std::string const cylinder = suggested("cylinder.cgns");
  for (char const* still : {"face i0", "face i1", "face j1", "face k0", "face k1"})
    EXPECT_NE(rule_of(cylinder, still), "rigid") << still << "\n" << cylinder;
  EXPECT_EQ(rule_of(cylinder, "face j0"), "rigid") << cylinder;
}

TEST_F(FirstDay, SuggestedOutputsHaveNamesThatMorphTakes) {
  // A folder: OpenFOAM's, from inside and from outside.
  fs::create_directories(path("case/constant/polyMesh"));
  auto const foam = [&](std::string const& name, std::string const& kind, std::string const& text) {
    write("case/constant/polyMesh/" + name,
          "FoamFile\n{\n version 2.0;\n format ascii;\n class " + kind + ";\n object " + name + ";\n}\n" + text);
  };
  foam("points", "vectorField", "8\n(\n(0 0 0)\n(1 0 0)\n(1 1 0)\n(0 1 0)\n(0 0 1)\n(1 0 1)\n(1 1 1)\n(0 1 1)\n)\n");
  foam("faces", "faceList", "6\n(\n4(0 3 2 1)\n4(4 5 6 7)\n4(0 1 5 4)\n4(1 2 6 5)\n4(2 3 7 6)\n4(3 0 4 7)\n)\n");
  foam("owner", "labelList", "6\n(\n0\n0\n0\n0\n0\n0\n)\n");
  foam("neighbour", "labelList", "0\n(\n)\n");
  foam("boundary", "polyBoundaryMesh", "1\n(\n walls\n {\n  type wall;\n  nFaces 6;\n  startFace 0;\n }\n)\n");
  Outcome const inside = shell("cd case && $G inspect -q . --suggest");
  EXPECT_NE(inside.out.find("output = \"case_morphed\""), std::string::npos) << inside.out << inside.err;
  EXPECT_NE(suggested("case").find("output = \"case_morphed\""), std::string::npos);
  EXPECT_NE(suggested("case/").find("output = \"case_morphed\""), std::string::npos);
  write("case/case.foam", "");
  EXPECT_NE(suggested("case/case.foam").find("output = \"case_morphed\""), std::string::npos);
}

TEST_F(FirstDay, OutputsOfBinaryUgridKeepBothPartsOfTheirEnding) {
  // One tetrahedron, little-endian doubles.
  std::string bytes;
  auto const integer = [&](std::int32_t v) { bytes.append(reinterpret_cast<char const*>(&v), 4); };
  auto const real = [&](double v) { bytes.append(reinterpret_cast<char const*>(&v), 8); };
  for (int const n : {4, 4, 0, 1, 0, 0, 0}) integer(n);
  for (double const x : {0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.}) real(x);
  for (int const n : {1, 3, 2, 1, 2, 4, 2, 3, 4, 1, 4, 3}) integer(n);
  for (int const tag : {1, 1, 2, 2}) integer(tag);
  for (int const n : {1, 2, 3, 4}) integer(n);
  write("tet.v2.lb8.ugrid", bytes);
  ASSERT_EQ(gridmorph("inspect -q tet.v2.lb8.ugrid --suggest case.toml").status, 0);
  std::string const text = contents(path("case.toml"));
  EXPECT_NE(text.find("output = \"tet.v2_morphed.lb8.ugrid\""), std::string::npos) << text;
  Outcome const run = gridmorph("morph -q case.toml");
  EXPECT_EQ(run.err.find("ugrid_file"), std::string::npos);
  EXPECT_EQ(run.err.find("stored"), std::string::npos) << run.err;
}

TEST_F(FirstDay, RetryTriesNearFieldsWhereTheCaseFileHasNoTable) {
  write_case("case.toml",
             "[[motion]]\npatches = [\"blade\"]\nrule = \"rigid\"\nrotation = { angle_deg = 60, axis = [0, 0, 1], "
             "origin = [0.05, 0, 0] }\n[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"free\"\n"
             "[guard]\nretry = true\nwrite_inverted = true\n");
  Outcome const run = gridmorph("morph -q case.toml --report r.json");
  ASSERT_TRUE(fs::exists(path("r.json"))) << run.err;
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  ASSERT_TRUE(report.contains("retry")) << "the motion is too small";
  auto const& tried = report["retry"]["tried"];
  for (char const* mode : {"translate", "rotate"})
    EXPECT_TRUE(std::any_of(tried.begin(), tried.end(),
                            [&](auto const& t) {
                              return t["keys"].template get<std::string>().find(
                                         std::string("[boundary_layer] mode = \"") + mode) == 0;
                            }))
        << mode << tried;
}

// End walls resolved to a millionth of the span, in single precision: what a mesh generator writes, and the suggested
// case file with a table of displacements.
TEST_F(FirstDay, APassageWithResolvedEndWallsInSinglePrecisionMorphsByTheSuggestedCase) {
  for (char const* motion : {"rotation", "chord"}) {
    std::string const folder = motion;
    Outcome const made =
        gridmorph("demo passage -q -n 20000 --first-cell 1e-6 --single -d " + folder + " -m " + motion);
    ASSERT_EQ(made.status, 0) << made.err;
    ASSERT_EQ(gridmorph("inspect -q " + folder + "/passage.cgns --suggest case.toml").status, 0);
    std::string text = contents(path("case.toml"));
    std::string const still = "rule = \"rigid\"\ntranslation = [0, 0, 0]";
    auto const at = text.find(still);
    ASSERT_NE(at, std::string::npos) << text;
    write("case.toml",
          text.replace(at, still.size(), "rule = \"field\"\nfile = \"" + folder + "/" + motion + ".csv\""));
    Outcome const run = gridmorph("morph case.toml -q -o " + folder + "/out.cgns --report r.json");
    EXPECT_EQ(run.status, 0) << run.err << text;
    auto const report = nlohmann::json::parse(contents(path("r.json")))["morphed"];
    for (auto const* region : {"near_field", "far_field"}) EXPECT_EQ(report[region]["inverted"], 0);
  }
}

}  // namespace
}  // namespace gridmorph::test
