// Unstructured meshes on the command line: inspected, measured, morphed, and refused where something is missing.
#include "run_command.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <tuple>
#include <utility>

namespace gridmorph::test {
namespace {

class UnstructuredRun : public CommandTest {
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

TEST_F(UnstructuredRun, InspectSaysWhatThereIs) {
  Outcome const run = gridmorph("inspect mesh.su2 --quiet");
  EXPECT_EQ(run.status, 0) << run.err;
  for (auto const* part :
       {"2-D", "9 nodes", "4 quadrilaterals", "wall", "faces", "first cell", "determinant 2x2x2", "[[motion]]"})
    EXPECT_NE(run.out.find(part), std::string::npos) << run.out;
  auto const json = nlohmann::json::parse(gridmorph("inspect mesh.su2 --json --quiet").out);
  EXPECT_EQ(json["boundaries"][0]["faces"], 8);
  EXPECT_EQ(json["types"]["quadrilateral"], 4);
  EXPECT_TRUE(json["problems"].empty());
}

TEST_F(UnstructuredRun, TheCaseFileThatInspectSuggestsIsReadAndRuns) {
  Outcome const run = gridmorph("inspect mesh.su2 --suggest suggested.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  Outcome const morph = gridmorph("morph suggested.toml");
  EXPECT_EQ(morph.status, 0) << morph.err;
  EXPECT_TRUE(std::filesystem::exists(path("mesh_morphed.su2")));
  auto const json = nlohmann::json::parse(gridmorph("inspect mesh.su2 --json --quiet").out);
  EXPECT_NE(json["case_file"].get<std::string>().find("wall"), std::string::npos);
}

TEST_F(UnstructuredRun, QualityComparesAndFallsShortWhereElementsTurnOver) {
  EXPECT_EQ(gridmorph("quality mesh.su2").status, 0);
  Outcome const moved = gridmorph("quality mesh.su2 moved.su2 --json --quiet");
  EXPECT_EQ(moved.status, 0) << moved.err;
  auto const region = nlohmann::json::parse(moved.out)["morphed"]["far_field"];
  EXPECT_NEAR(region["measures"]["relative_displacement"]["max"].get<double>(), 0.2, 1e-12);
  int const smallest = region["measures"]["volume"]["worst"]["element"];
  EXPECT_TRUE(smallest == 1 || smallest == 3) << smallest;  // they are of one size
  EXPECT_EQ(gridmorph("quality mesh.su2 turned.su2").status, 1);
}

TEST_F(UnstructuredRun, MorphAndPlanAskForAWallThatMoves) {
  write("case.toml",
        "[mesh]\nblocks = \"off\"\ninput = \"mesh.su2\"\noutput = \"out.su2\"\n[[motion]]\npatches = [\"*\"]\n"
        "rule = \"fixed\"\n");
  for (auto const* command : {"morph case.toml", "plan case.toml"})
    expect_bad_input(gridmorph(command), {"no wall moves", "fixed"});
}

/// A ring of quadrilaterals around a body, and a mode shape of the body.
class UnstructuredSequence : public CommandTest {
 protected:
  static constexpr int around = 24, rows = 10;

  void SetUp() override {
    CommandTest::SetUp();
    std::string mesh = fmt::format("NDIME= 2\nNELEM= {}\n", around * rows);
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < around; ++i)
        mesh += fmt::format("9 {} {} {} {}\n", i + around * j, i + around * (j + 1),
                            (i + 1) % around + around * (j + 1), (i + 1) % around + around * j);
    mesh += fmt::format("NPOIN= {}\n", around * (rows + 1));
    std::string mode = "x,y,z,dx,dy,dz\n";
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i < around; ++i) {
        double const angle = 2 * std::acos(-1.0) * i / around, r = 0.5 * std::pow(1.3, j);
        double const x = r * std::cos(angle), y = r * std::sin(angle);
        mesh += fmt::format("{:.17g} {:.17g}\n", x, y);
        if (j == 0) mode += fmt::format("{:.17g},{:.17g},0,{:.17g},{:.17g},0\n", x, y, 0.1 * x * y, 0.3 * x);
      }
    mesh += "NMARK= 2\n" + marker("body", 0) + marker("farfield", around * rows);
    write("ring.su2", mesh);
    write("mode.csv", mode);
  }
  static std::string marker(std::string const& name, int first) {
    std::string text = fmt::format("MARKER_TAG= {}\nMARKER_ELEMS= {}\n", name, around);
    for (int i = 0; i < around; ++i) text += fmt::format("3 {} {}\n", first + i, first + (i + 1) % around);
    return text;
  }
  void write_case(std::string const& output, double amplitude) const {
    write("case.toml", "[mesh]\nblocks = \"off\"\ninput = \"ring.su2\"\n[sequence]\nsteps = 4\noutput = \"" + output +
                           "\"\n[[motion]]\npatches = [\"body\"]\nrule = \"field\"\nmodes = [ { file = \"mode.csv\", "
                           "amplitude = " +
                           fmt::format("{}", amplitude) + ", phase_deg = 60 } ]\n");
  }
  [[nodiscard]] Coordinates coordinates(std::string const& name) const {
    return read_mesh(path(name).string()).coordinates;
  }
};

TEST_F(UnstructuredSequence, EveryStepIsTheMeshThatItsDisplacementAloneGives) {
  write_case("out_{step}.su2", 0.5);
  Outcome const run = gridmorph("morph case.toml --report out.json");
  ASSERT_EQ(run.status, 0) << run.err;
  auto const json = nlohmann::json::parse(contents(path("out.json")));
  ASSERT_EQ(json["sequence"]["steps"].size(), 4u);
  double const offset = json["plan"]["offset"];
  for (int step = 0; step < 4; ++step) {
    // The same wrap: a sequence reckons with its largest step.
    double const factor = 0.5 * std::cos(std::acos(-1.0) * (step / 2.0 + 1 / 3.0));
    write("single.toml",
          fmt::format("[mesh]\nblocks = \"off\"\ninput = \"ring.su2\"\noutput = \"single.su2\"\n[[motion]]\npatches = "
                      "[\"body\"]\nrule = \"field\"\nfile = \"mode.csv\"\nfactor = {:.17g}\n"
                      "[near_field]\noffset = {:.17g}\n",
                      factor, offset));
    ASSERT_EQ(gridmorph("morph single.toml").status, 0);
    auto const alone = coordinates("single.su2"), together = coordinates(fmt::format("out_{}.su2", step + 1));
    for (Index n = 0; n < alone.size(); ++n) EXPECT_LT(distance(alone[n], together[n]), 1e-6) << step << " " << n;
    double const largest = json["sequence"]["steps"][step]["largest_displacement"];
    // On the walls 0.15; what turns and shears with the body further out moves further.
    EXPECT_GT(largest, std::abs(factor) * 0.14) << step;
    EXPECT_LT(largest, std::abs(factor) * 0.30) << step;
  }
}

TEST_F(UnstructuredSequence, EveryStepHasTheFieldsThatAreAskedFor) {
  write_mesh(path("ring.cgns").string(), read_mesh(path("ring.su2").string()));
  write_case("out_{step}.cgns", 0.5);
  std::string text = contents(path("case.toml"));
  text.replace(text.find("ring.su2"), 8, "ring.cgns");
  for (bool const quality : {true, false}) {
    write("case.toml", text + fmt::format("[output]\ndisplacement = true\nquality = {}\n", quality));
    Outcome const run = gridmorph("morph case.toml");
    ASSERT_EQ(run.status, 0) << run.err;
    for (int step = 1; step <= 4; ++step) {
      std::string const bytes = contents(path(fmt::format("out_{}.cgns", step)));
      for (auto const* name : {"DisplacementX", "DisplacementY"})
        EXPECT_NE(bytes.find(name), std::string::npos) << step;
      for (auto const* name : {"MorphCells", "AspectRatio"})
        EXPECT_EQ(bytes.find(name) != std::string::npos, quality) << name << " in step " << step;
    }
  }
}

TEST_F(UnstructuredSequence, ASeriesInOneFileKeepsTheBaselineAsItsFirstGrid) {
  write_mesh(path("ring.cgns").string(), read_mesh(path("ring.su2").string()));
  write_case("out.cgns", 0.5);
  std::string text = contents(path("case.toml"));
  text.replace(text.find("ring.su2"), 8, "ring.cgns");
  write("case.toml", text);
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("wrote out.cgns (4 steps)"), std::string::npos) << run.out;
  auto const before = coordinates("ring.cgns"), after = coordinates("out.cgns");
  for (Index n = 0; n < before.size(); ++n) EXPECT_EQ(after[n], before[n]) << n;
  EXPECT_NE(contents(path("out.cgns")).find("GridCoordinates_4"), std::string::npos);
}

TEST_F(UnstructuredSequence, AStepThatInvertsOrASeriesInOneFileLeavesNothing) {
  write_case("out_{step}.su2", 30);
  Outcome const run = gridmorph("morph case.toml");
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_NE(run.err.find("is not written"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("out_1.su2")));
  write_case("out.su2", 0.1);
  expect_bad_input(gridmorph("morph case.toml"), {"one file per step", "step_{step}.su2"});
}

/// The same ring, its body turned, with nodes that turn with its wall less and less: a body that turns as a whole needs
/// no steps.
class UnstructuredTurn : public UnstructuredSequence {
 protected:
  [[nodiscard]] Outcome turn(double degrees, int steps) const {
    std::filesystem::remove(path("turned.su2"));
    write("case.toml",
          fmt::format("[mesh]\nblocks = \"off\"\ninput = \"ring.su2\"\noutput = \"turned.su2\"\n[[motion]]\npatches = "
                      "[\"body\"]\n"
                      "rule = \"rigid\"\nrotation = {{ axis = [0, 0, 1], origin = [0, 0, 0], angle_deg = {} }}\n"
                      "[boundary_layer]\nwalls = [\"body\"]\nmode = \"blend\"\n"
                      "[guard]\nmin_determinant = 0.001\nsteps = {}\n",
                      degrees, steps));
    return gridmorph("morph case.toml");
  }
};

TEST_F(UnstructuredTurn, ASequenceGoesThereInStepsToo) {
  auto const sequence = [&](int steps) {
    for (int n = 1; n <= 3; ++n) std::filesystem::remove(path(fmt::format("turn_{}.su2", n)));
    write("case.toml",
          fmt::format("[mesh]\ninput = \"ring.su2\"\n[sequence]\ntimes = [0, 0.25, 1]\noutput = \"turn_{{step}}.su2\"\n"
                      "[[motion]]\npatches = [\"body\"]\nrule = \"rigid\"\namplitude = [[0, 0], [1, 1]]\n"
                      "rotation = {{ axis = [0, 0, 1], origin = [0, 0, 0], angle_deg = 120 }}\n"
                      "[boundary_layer]\nwalls = [\"body\"]\nmode = \"blend\"\n"
                      "[guard]\nmin_determinant = 0.001\nsteps = {}\n",
                      steps));
    return gridmorph("morph case.toml");
  };
  EXPECT_EQ(sequence(1).status, turn(120, 1).status);
  EXPECT_FALSE(std::filesystem::exists(path("turn_1.su2")));
  Outcome const run = sequence(4);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("step 3: "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("in 2 steps, each planned on the mesh before it, none is"), std::string::npos) << run.out;
  auto const before = coordinates("ring.su2"), still = coordinates("turn_1.su2"), quarter = coordinates("turn_2.su2"),
             whole = coordinates("turn_3.su2");
  ASSERT_EQ(turn(120, 4).status, 0);
  auto const alone = coordinates("turned.su2");
  double const angle = std::acos(-1.0) / 6;
  for (Index n = 0; n < before.size(); ++n) {
    EXPECT_EQ(still[n], before[n]) << n;
    EXPECT_LT(distance(whole[n], alone[n]), 1e-6) << n;
    if (n >= around) continue;
    Vec3 const x = before[n],
               turned{x.x * std::cos(angle) - x.y * std::sin(angle), x.x * std::sin(angle) + x.y * std::cos(angle), 0};
    EXPECT_LT(distance(quarter[n], turned), 1e-14) << n;
  }
}

TEST_F(UnstructuredTurn, WhatOneStepCannotMakeIsMadeInSteps) {
  Outcome const one = turn(120, 1);
  EXPECT_EQ(one.status, 4);
  EXPECT_FALSE(std::filesystem::exists(path("turned.su2")));
  Outcome const two = turn(120, 4);
  EXPECT_EQ(two.status, 0) << two.err;
  EXPECT_NE((two.out + two.err).find("in 2 steps, each planned on the mesh before it, none is"), std::string::npos)
      << two.out << two.err;
  auto const before = coordinates("ring.su2"), after = coordinates("turned.su2");
  for (int i = 0; i < around; ++i) {
    double const c = std::cos(2 * std::acos(-1.0) / 3), s = std::sin(2 * std::acos(-1.0) / 3);
    Vec3 const x = before[i];
    EXPECT_LT(distance(after[i], {c * x.x - s * x.y, s * x.x + c * x.y, 0}), 1e-15);
    EXPECT_EQ(distance(after[i + around * rows], before[i + around * rows]), 0);
  }
  // No more than it takes: a turn that one step makes knows nothing of others.
  Outcome const small = turn(60, 4);
  EXPECT_EQ(small.status, 0) << small.err;
  EXPECT_EQ((small.out + small.err).find("steps"), std::string::npos);
}

TEST_F(UnstructuredTurn, ABodyThatTurnsAsAWholeNeedsNone) {
  write("case.toml",
        "[mesh]\ninput = \"ring.su2\"\noutput = \"turned.su2\"\n[[motion]]\npatches = [\"body\"]\nrule = \"rigid\"\n"
        "rotation = { axis = [0, 0, 1], origin = [0, 0, 0], angle_deg = 180 }\n[guard]\nsteps = 1\n");
  Outcome const run = gridmorph("morph case.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  auto const before = coordinates("ring.su2"), after = coordinates("turned.su2");
  for (int i = 0; i < around; ++i) {
    EXPECT_LT(distance(after[i], -before[i]), 1e-15);
    EXPECT_EQ(distance(after[i + around * rows], before[i + around * rows]), 0);
  }
}

TEST_F(UnstructuredTurn, WhereStepsDoNotHelpNothingIsWritten) {
  Outcome const run = turn(180, 2);
  EXPECT_EQ(run.status, 4);
  EXPECT_NE(run.err.find("is not written"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("turned.su2")));
  write("case.toml",
        "[mesh]\ninput = \"ring.su2\"\noutput = \"out.su2\"\n[[motion]]\npatches = [\"body\"]\nrule = "
        "\"fixed\"\n[guard]\nsteps = 65\n");
  expect_bad_input(gridmorph("morph case.toml"), {"steps", "1 to 64, found 65"});
}

/// A square hole in a square of quadrilaterals and triangles that are numbered the other way round: 9 x 9 nodes.
std::string hybrid_square() {
  constexpr int n = 9;
  std::string elements, body, outer;
  int count = 0, at_body = 0, at_outer = 0;
  auto const node = [](int i, int j) { return i + n * j; };
  for (int j = 0; j < n - 1; ++j)
    for (int i = 0; i < n - 1; ++i) {
      if (i >= 3 && i < 5 && j >= 3 && j < 5) continue;  // the hole
      bool const near = i >= 2 && i < 6 && j >= 2 && j < 6;
      int const a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      if (near) {
        elements += fmt::format("9 {} {} {} {}\n", a, b, c, d);
        ++count;
      } else {
        elements += fmt::format("5 {} {} {}\n5 {} {} {}\n", a, c, b, a, d, c);  // clockwise
        count += 2;
      }
    }
  for (int k = 3; k < 5; ++k)
    for (auto const& [p, q] : {std::pair(node(k, 3), node(k + 1, 3)), std::pair(node(k, 5), node(k + 1, 5)),
                               std::pair(node(3, k), node(3, k + 1)), std::pair(node(5, k), node(5, k + 1))}) {
      body += fmt::format("3 {} {}\n", p, q);
      ++at_body;
    }
  for (int k = 0; k < n - 1; ++k)
    for (auto const& [p, q] : {std::pair(node(k, 0), node(k + 1, 0)), std::pair(node(k, n - 1), node(k + 1, n - 1)),
                               std::pair(node(0, k), node(0, k + 1)), std::pair(node(n - 1, k), node(n - 1, k + 1))}) {
      outer += fmt::format("3 {} {}\n", p, q);
      ++at_outer;
    }
  std::string text = fmt::format("NDIME= 2\nNELEM= {}\n{}NPOIN= {}\n", count, elements, n * n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) text += fmt::format("{} {}\n", i, j);
  return text + fmt::format("NMARK= 2\nMARKER_TAG= body\nMARKER_ELEMS= {}\n{}MARKER_TAG= outer\nMARKER_ELEMS= {}\n{}",
                            at_body, body, at_outer, outer);
}

TEST_F(UnstructuredRun, AHybridMeshNumberedBothWaysIsMovedAndItsInvertedElementsAreSeen) {
  write("hybrid.su2", hybrid_square());
  auto const move = [&](double by, std::string const& guard) {
    write("case.toml",
          fmt::format("[mesh]\ninput = \"hybrid.su2\"\noutput = \"out.su2\"\n[[motion]]\npatches = [\"body\"]\n"
                      "rule = \"rigid\"\ntranslation = [{}, 0, 0]\n[guard]\n{}",
                      by, guard));
    return gridmorph("morph case.toml -r report.json");
  };
  auto const region = [&](char const* state, char const* count) {
    auto const json = nlohmann::json::parse(contents(path("report.json")));
    return json[state]["near_field"][count].get<int>() + json[state]["far_field"][count].get<int>();
  };
  Outcome const little = move(0.5, "");
  EXPECT_EQ(little.status, 0) << little.err << little.out;
  EXPECT_EQ(region("baseline", "inverted"), 0);
  EXPECT_EQ(region("morphed", "inverted"), 0);
  for (std::string const guard : {"", "quality = \"fast\"\n"}) {
    std::filesystem::remove(path("out.su2"));
    Outcome const far = move(6, guard);  // beyond the outer boundary
    EXPECT_EQ(far.status, 4) << far.err;
    EXPECT_GT(region("morphed", "newly_inverted"), 0);
    for (auto const* words : {"the worst is zone", "from patch '", "times the largest it had", "likely cause: "})
      EXPECT_NE(far.err.find(words), std::string::npos) << words << far.err;
    EXPECT_FALSE(std::filesystem::exists(path("out.su2")));
  }
  EXPECT_EQ(move(6, "write_inverted = true\n").status, 1);
}

TEST_F(UnstructuredRun, OtherMeshesAreNoBaselines) {
  expect_bad_input(gridmorph("quality mesh.su2 passage.cgns"), {"is unstructured and 'passage.cgns' is not"});
  write("other.su2", "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\n");
  expect_bad_input(gridmorph("quality mesh.su2 other.su2"), {"not the same mesh"});
}

TEST_F(UnstructuredRun, DamagedFilesNameTheLine) {
  std::string const whole = text("0.5");
  write("cut.su2", whole.substr(0, whole.find("0.5 1\n1 1")));
  expect_bad_input(gridmorph("inspect cut.su2"), {"cut.su2:", "the file ends after 7 of 9 points"});
}

/// A case of OpenFOAM: a row of cubes along x, its lower side the patch `floor`, all else `rest`.
class FoamRun : public CommandTest {
 protected:
  static constexpr int n = 6;  // cubes

  void SetUp() override {
    CommandTest::SetUp();
    std::filesystem::create_directories(path("case/constant/polyMesh"));
    auto const node = [](int i, int k) { return 4 * i + k; };
    std::string points = fmt::format("{}\n(\n", 4 * (n + 1)), faces, owner, neighbour;
    for (int i = 0; i <= n; ++i)
      for (auto const& [y, z] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)})
        points += fmt::format("({} {} {})\n", i, y, z);
    int n_faces = 0;
    auto const face = [&](std::array<int, 4> const& f, int cell) {
      faces += fmt::format("4({} {} {} {})\n", f[0], f[1], f[2], f[3]);
      owner += fmt::format("{} ", cell);
      ++n_faces;
    };
    for (int i = 1; i < n; ++i) {
      face({node(i, 0), node(i, 1), node(i, 2), node(i, 3)}, i - 1);
      neighbour += fmt::format("{} ", i);
    }
    auto const side = [&](int a, int b) {
      for (int i = 0; i < n; ++i) face({node(i, b), node(i, a), node(i + 1, a), node(i + 1, b)}, i);
    };
    side(1, 0);  // z = 0
    int const rest = n_faces;
    side(2, 1);
    side(3, 2);
    side(0, 3);
    face({node(0, 3), node(0, 2), node(0, 1), node(0, 0)}, 0);
    face({node(n, 0), node(n, 1), node(n, 2), node(n, 3)}, n - 1);
    file("points", "vectorField", points + ")");
    file("faces", "faceList", fmt::format("{}\n(\n{})", n_faces, faces));
    file("owner", "labelList", fmt::format("{}({})", n_faces, owner));
    file("neighbour", "labelList", fmt::format("{}({})", n - 1, neighbour));
    file(
        "boundary", "polyBoundaryMesh",
        fmt::format(
            "2\n(\nfloor {{ type wall; nFaces {}; startFace {}; }}\nrest {{ type patch; nFaces {}; startFace {}; }}\n)",
            n, n - 1, n_faces - rest, rest));
  }
  void file(std::string const& name, std::string const& of_class, std::string const& body) const {
    write("case/constant/polyMesh/" + name,
          "FoamFile { version 2.0; format ascii; class " + of_class + "; object " + name + "; }\n" + body + "\n");
  }
  [[nodiscard]] Outcome sequence(std::string const& output, double size) const {
    write("case.toml", fmt::format("[mesh]\ninput = \"case\"\n[sequence]\ntimes = [0, 0.5, 1]\noutput = "
                                   "\"{}\"\n[[motion]]\npatches = [\"*\"]\nrule = \"formula\"\n"
                                   "dx = \"-{} * t * x\"\n",
                                   output, size));
    return gridmorph("morph case.toml");
  }
};

TEST_F(FoamRun, SequencesAreCasesOrFoldersOfTimes) {
  ASSERT_EQ(sequence("step_{step}", 0.01).status, 0);
  ASSERT_EQ(sequence("series", 0.01).status, 0);
  auto const x = [&](std::string const& name) { return read_mesh(path(name).string()).coordinates; };
  auto const before = x("case");
  for (auto const& [step, time, t] : {std::tuple("step_1", "series/0", 0.0), std::tuple("step_2", "series/0.5", 0.5),
                                      std::tuple("step_3", "series/latestTime", 1.0)}) {
    auto const alone = x(step), together = x(time);
    for (Index k = 0; k < before.size(); ++k) {
      EXPECT_EQ(alone[k], together[k]) << step;
      EXPECT_NEAR(alone.x(k), (1 - 0.01 * t) * before.x(k), 1e-14);
    }
  }
  // Where cells would be inverted nothing is left behind.
  EXPECT_EQ(sequence("bad_{step}", 3).status, 4);
  EXPECT_EQ(sequence("bad", 3).status, 4);
  for (char const* name : {"bad", "bad_1", "bad_2", "bad_3"}) EXPECT_FALSE(std::filesystem::exists(path(name))) << name;
}

TEST_F(FoamRun, CellZonesAreListedAndMoveAsRegions) {
  file("cellZones", "regIOobject", "1\n(\nfar { type cellZone; cellLabels List<label> 2(2 3); }\n)");
  Outcome const inspect = gridmorph("inspect case --quiet");
  EXPECT_NE(inspect.out.find("far: 2 elements"), std::string::npos) << inspect.out;
  EXPECT_EQ(nlohmann::json::parse(gridmorph("inspect case --json --quiet").out)["subsets"][0]["elements"], 2);
  std::string const head =
      "[mesh]\ninput = \"case\"\noutput = \"moved\"\n[[motion]]\npatches = [\"*\", \"part\"]\nrule = \"formula\"\ndx = "
      "\"0.1 * x\"\n[[region]]\nname = \"part\"\n";
  write("case.toml", head + "zones = \"far\"\n");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE((run.out + run.err).find("region 'part': 2 elements, 12 nodes"), std::string::npos) << run.out;
  Outcome const measured = gridmorph("morph case.toml --json --quality full");
  EXPECT_EQ(nlohmann::json::parse(measured.out)["morphed"]["regions"]["part"]["cells"], 2) << measured.err;
  write("only.toml",
        "[mesh]\ninput = \"case\"\noutput = \"only\"\n[[motion]]\npatches = [\"*\"]\nrule = \"formula\"\ndx = \"0.1 * "
        "x\"\n[[region]]\nname = \"part\"\nzones = \"far\"\nonly_measured = true\n");
  EXPECT_EQ(nlohmann::json::parse(gridmorph("morph only.toml --json").out)["morphed"]["regions"]["part"]["cells"], 2);
  write("none.toml", contents(path("only.toml")) + "box = { from = [50, 50, 50], to = [51, 51, 51] }\n");
  expect_bad_input(gridmorph("morph none.toml"), {"region 'part'", "holds no element"});
  write("wrong.toml", head + "zones = \"fra\"\n");
  expect_bad_input(gridmorph("morph wrong.toml"), {"region 'part'", "there is no zone 'fra'", "'internalMesh', 'far'"});
}

/// Fields of a mesh without a place for them go into the file for viewers.
TEST_F(FoamRun, TheMeshForViewersHasTheFields) {
  std::string const head =
      "[mesh]\ninput = \"case\"\noutput = \"out\"\n[[motion]]\npatches = [\"*\"]\nrule = \"formula\"\ndy = "
      "\"0.1\"\n[output]\ndisplacement = true\n";
  write("without.toml", head);
  expect_bad_input(gridmorph("morph without.toml"), {"displacement", "OpenFOAM", "vtk = "});
  write("wrong.toml", head + "vtk = \"out.cgns\"\n");
  expect_bad_input(gridmorph("morph wrong.toml"), {"out.cgns", "CGNS", "VTK"});
  write("with.toml", head + "vtk = \"out.vtu\"\n");
  Outcome const run = gridmorph("morph with.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("wrote out.vtu"), std::string::npos) << run.out;
  EXPECT_NE(contents(path("out.vtu")).find("Name=\"Displacement\""), std::string::npos);
  Mesh const mesh = read_mesh(path("out.vtu").string());
  ASSERT_EQ(mesh.patches.size(), 2U);
  EXPECT_EQ(mesh.patches[0].name, "floor");
  EXPECT_EQ(mesh.n_elements(), n);
}

}  // namespace
}  // namespace gridmorph::test
