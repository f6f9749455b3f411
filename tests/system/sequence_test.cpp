// Sequences of meshes from one plan.
#include "run_command.hpp"
#include "support/reduced.hpp"
#include "support/with_keys.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace gridmorph::test {
namespace {

class SequenceRun : public CommandTest {
 protected:
  /// A case on the passage: the displacement of `rotation.toml`'s file as a mode shape.
  void write_sequence(std::string const& sequence, std::string const& mode, std::string const& rest = "") const {
    write("case.toml",
          "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n[sequence]\n" + sequence +
              "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nmodes = [ { file = \"" + csv() + "\"" + mode +
              " } ]\n"
              "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"circumferential-slide\"\nof = \"blade\"\n"
              "[[motion]]\npatches = [\"type:periodic\"]\nrule = \"follow\"\nof = \"blade\"\n"
              "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n" +
              (rest.starts_with("[guard]\n") ? "" : "[guard]\n") + with_trim(rest));
  }
  /// A mode that turns a blade leads off hub and case by 2 % of its displacement, since it is linear.
  static std::string with_trim(std::string const& rest) {
    std::string const guard = "[guard]\n";
    std::string out = rest;
    return out.insert(out.starts_with(guard) ? guard.size() : 0, "max_trim = 0.02\n");
  }
  [[nodiscard]] std::string csv() const {
    std::string const text = contents(path("rotation.toml"));
    auto const at = text.find("\nfile");
    auto const begin = text.find('"', at) + 1;
    return text.substr(begin, text.find('"', begin) - begin);
  }
  [[nodiscard]] Mesh mesh(std::string const& name) const { return read_mesh(path(name).string()); }
  static void expect_same(Mesh const& a, Mesh const& b) {
    ASSERT_EQ(a.n_nodes(), b.n_nodes());
    for (Index n = 0; n < a.n_nodes(); ++n) ASSERT_EQ(a.coordinates[n], b.coordinates[n]) << describe_node(a, n);
  }
};

TEST_F(SequenceRun, EveryStepIsTheMeshThatItsDisplacementAloneGives) {
  write_sequence("steps = 8\noutput = \"out_{step}.cgns\"\n", ", amplitude = 0.4, phase_deg = 30");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  for (int step = 0; step < 8; step += test::reduced() ? 7 : 1) {
    double const factor = 0.4 * std::cos(std::acos(-1.0) * (step / 4.0 + 1 / 6.0));
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", factor);
    std::string single = contents(path("case.toml"));
    single.replace(single.find("[sequence]"), single.find("[[motion]]") - single.find("[sequence]"), "");
    single.replace(single.find("modes = ["),
                   single.find(" ]\n", single.find("modes = [")) + 3 - single.find("modes = ["),
                   "file = \"" + csv() + "\"\nfactor = " + text + "\n");
    write("single.toml", single);
    ASSERT_EQ(gridmorph("morph single.toml -o single.cgns").status, 0);
    Mesh const alone = mesh("single.cgns"), in_sequence = mesh("out_" + std::to_string(step + 1) + ".cgns");
    for (Index n = 0; n < alone.n_nodes(); ++n)
      ASSERT_LT(distance(alone.coordinates[n], in_sequence.coordinates[n]), 1e-14 * alone.size()) << step;
  }
}

TEST_F(SequenceRun, ManyStepsDriftByNothing) {
  // Periods of four steps: each of the four times comes round in all of them, and a quarter of a period is no motion at
  // all.
  int const periods = test::reduced() ? 3 : 10;
  write_sequence(fmt::format("steps = {}\nperiods = {}\noutput = \"out_{{step}}.cgns\"\n", 4 * periods, periods),
                 ", amplitude = 0.4");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const baseline = mesh("passage.cgns");
  auto const of_step = [&](int step) { return mesh(fmt::format("out_{:02}.cgns", step + 1)); };
  for (int step = 4; step < 4 * periods; ++step) expect_same(of_step(step % 4), of_step(step));
  expect_same(of_step(1), baseline);
  expect_same(of_step(4 * periods - 1), baseline);
  EXPECT_GT(distance(mesh("out_01.cgns").coordinates[0], baseline.coordinates[0]) +
                distance(mesh("out_01.cgns").coordinates[baseline.n_nodes() / 2],
                         baseline.coordinates[baseline.n_nodes() / 2]),
            0);
}

TEST_F(SequenceRun, AVerdictOfStepsSaysWhatAllMeasuresSay) {
  for (std::string const limit : {"", "[guard]\nmin_determinant = 0.99\nmax_skewness = 0.3\n"}) {
    write_sequence("steps = 4\noutput = \"out_{step}.cgns\"\n", ", amplitude = 0.8, phase_deg = 20", limit);
    auto const report = [&](std::string const& quality) {
      Outcome const run = gridmorph("morph case.toml --quality " + quality + " --report r.json");
      EXPECT_EQ(run.status, limit.empty() ? 0 : 1) << run.err;
      return nlohmann::json::parse(contents(path("r.json")));
    };
    auto const by_verdicts = report("auto"), all = report("full");
    for (auto const* part : {"baseline", "morphed", "sequence"}) EXPECT_EQ(by_verdicts.at(part), all.at(part)) << part;
    EXPECT_EQ(all.at("sequence").at("steps").at(0).at("shortfalls").empty(), limit.empty());
    EXPECT_FALSE(by_verdicts.at("morphed").at("verdict_only").get<bool>());
  }
}

TEST_F(SequenceRun, OneFileHoldsTheSameStepsAsOneFileEach) {
  write_sequence("steps = 3\nperiod = 0.5\noutput = \"out_{step}.cgns\"\n", ", amplitude = 0.4");
  ASSERT_EQ(gridmorph("morph case.toml").status, 0);
  Outcome const run = gridmorph("morph case.toml -o out_series.cgns --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("out_series.cgns (3 steps)"), std::string::npos);
  expect_same(mesh("out_series.cgns"), mesh("passage.cgns"));
  auto const json = nlohmann::json::parse(contents(path("r.json")));
  auto const& steps = json.at("sequence").at("steps");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_NEAR(steps.at(1).at("time").get<double>(), 0.5 / 3, 1e-15);
  double smallest = 1;
  for (auto const& step : steps) {
    smallest = std::min(smallest, step.at("min_determinant").at("value").get<double>());
    EXPECT_EQ(step.at("newly_inverted"), 0);
  }
  auto const worst = json.at("sequence").at("worst_step").get<int>();
  EXPECT_EQ(steps.at(std::size_t(worst - 1)).at("min_determinant").at("value").get<double>(), smallest);
  double in_tables = 1;  // of the regions that have cells
  for (auto const* region : {"near_field", "far_field"}) {
    auto const& measures = json.at("morphed").at(region).at("measures");
    if (measures.contains("determinant_3x3x3"))
      in_tables = std::min(in_tables, measures.at("determinant_3x3x3").at("min").get<double>());
  }
  EXPECT_EQ(in_tables, smallest) << "the tables show the worst step";
  EXPECT_EQ(json.at("fields").at(0).at("evaluated"), json.at("fields").at(0).at("coincident"));
}

TEST_F(SequenceRun, ZeroAmplitudeLeavesEveryStepBitIdentical) {
  write_sequence("steps = 3\noutput = \"out_{step}.cgns\"\n", ", amplitude = 0, phase_deg = 12");
  ASSERT_EQ(gridmorph("morph case.toml").status, 0);
  for (int step = 1; step <= 3; ++step)
    expect_same(mesh("out_" + std::to_string(step) + ".cgns"), mesh("passage.cgns"));
}

TEST_F(SequenceRun, OtherRecipesAreTriedOnTheWorstStepAndTheirKeysGiveTheSameMeshes) {
  std::string const near = "[boundary_layer]\nwalls = [\"blade\"]\nextent = \"block\"\nmode = \"rotate\"\n";
  auto const run = [&](std::string const& text) {
    write("case.toml", text);
    Outcome const out = gridmorph("morph case.toml --report r.json");
    return std::pair(out, nlohmann::json::parse(contents(path("r.json"))));
  };
  write_sequence("steps = 3\nperiods = 0.3\noutput = \"out_{step}.cgns\"\n", ", amplitude = 10, phase_deg = -36", near);
  std::string const text = contents(path("case.toml"));
  ASSERT_EQ(run(test::with_keys(text, "[guard] retry = false")).first.status, 4) << "the motion is too large";
  auto const [unasked, by_itself] = run(text);
  EXPECT_LE(unasked.status, 1) << unasked.err;
  EXPECT_EQ(by_itself["retry"]["step"], 2);
  auto const [out, report] = run(test::with_keys(text, "[guard] retry = true"));
  ASSERT_LE(out.status, 1) << out.err;
  auto const& retry = report["retry"];
  EXPECT_EQ(retry["step"], 2) << "at 10 times the shape";
  EXPECT_GT(retry["first"]["newly_inverted"], 0);
  std::string const kept = retry["kept"];
  EXPECT_NE(out.out.find(kept), std::string::npos) << "the keys are said";
  for (auto const& step : report["sequence"]["steps"]) EXPECT_EQ(step["newly_inverted"], 0);
  std::vector<Mesh> best;
  for (int step = 1; step <= 3; ++step) best.push_back(mesh(fmt::format("out_{}.cgns", step)));
  auto const [again, same] = run(test::with_keys(text, kept));
  ASSERT_EQ(again.status, out.status) << again.err;
  for (int step = 1; step <= 3; ++step) expect_same(mesh(fmt::format("out_{}.cgns", step)), best[step - 1]);
}

TEST_F(SequenceRun, AFrozenGuardMendsEveryStepByOneLinearMap) {
  std::string const near = "[boundary_layer]\nwalls = [\"blade\"]\nextent = \"block\"\n";
  write_sequence("steps = 4\noutput = \"out_{step}.cgns\"\n", ", amplitude = 4.5, phase_deg = 90", near);
  std::string const text = contents(path("case.toml"));
  write("case.toml", test::with_keys(text, "[guard] retry = false"));
  ASSERT_EQ(gridmorph("morph case.toml").status, 4) << "the motion is too large";
  write("case.toml", test::with_keys(text, "[guard] smooth = true, [guard] freeze = true"));
  Outcome const run = gridmorph("morph case.toml --report r.json");
  ASSERT_LE(run.status, 1) << run.err;
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  auto const& frozen = report["frozen_guard"];
  EXPECT_EQ(frozen["displacements"], 4);
  EXPECT_GE(frozen["modes"], 1);
  EXPECT_GT(frozen["nodes"], 0);
  EXPECT_LT(frozen["largest_distance"], frozen["largest_shift"]);
  EXPECT_NE(run.out.find("the guard is frozen into the plan"), std::string::npos);
  for (auto const& step : report["sequence"]["steps"]) EXPECT_EQ(step["newly_inverted"], 0);
  expect_same(mesh("out_1.cgns"), mesh("passage.cgns"));  // at rest
  expect_bad_input(
      [&] {
        write("case.toml", test::with_keys(text, "[guard] freeze = true"));
        for (int step = 1; step <= 4; ++step) std::filesystem::remove(path(fmt::format("out_{}.cgns", step)));
        std::filesystem::remove(path("r.json"));
        return gridmorph("morph case.toml");
      }(),
      {"[guard] freeze", "smooth = true"});
}

TEST_F(SequenceRun, AStepThatInvertsKeepsAllFilesFromAppearing) {
  for (std::string const output : {"out_{step}.cgns", "out.cgns"}) {
    write_sequence("steps = 4\noutput = \"" + output + "\"\n", ", amplitude = 40, phase_deg = 90",
                   "[guard]\nretry = false\n");
    Outcome const run = gridmorph("morph case.toml --report out.json");
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_NE(run.err.find("is not written"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::parse(contents(path("out.json")))["output"].is_null());
    std::filesystem::remove(path("out.json"));
    expect_nothing_written();
  }
}

TEST_F(SequenceRun, EveryStepIsJudgedByTheLimits) {
  write_sequence("steps = 4\noutput = \"out.cgns\"\n", ", amplitude = 0.2", "[guard]\nmax_loss = 0.0001\n");
  Outcome const run = gridmorph("morph case.toml --report out.json");
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_NE(run.out.find("of 4 steps fall short, the first is step "), std::string::npos) << run.out;
  int count = 0;
  auto const report = nlohmann::json::parse(contents(path("out.json")));
  for (auto const& step : report["sequence"]["steps"]) count += step["shortfall"].is_string() ? 1 : 0;
  EXPECT_GT(count, 1);
}

TEST_F(SequenceRun, ARampOfARuleGivesTheMeshesOfItsShares) {
  std::string const rest =
      "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"circumferential-slide\"\nof = \"blade\"\n"
      "[[motion]]\npatches = [\"type:periodic\"]\nrule = \"follow\"\nof = \"blade\"\n"
      "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n";
  std::string const head = "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n";
  auto const blade = [](std::string const& twist, std::string const& amplitude) {
    return "[[motion]]\npatches = [\"blade\"]\nrule = \"sections\"\ntwist_deg = " + twist + "\n" + amplitude;
  };
  write("ramp.toml", head + "[sequence]\ntimes = [0, 1, 1.5, 2]\noutput = \"out_{step}.cgns\"\n" +
                         blade("[[0, 2], [1, 4]]", "amplitude = [[0, 0], [2, 1]]\n") + rest);
  Outcome const run = gridmorph("morph ramp.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  expect_same(mesh("out_1.cgns"), mesh("passage.cgns"));
  std::string const twists[3] = {"[[0, 1], [1, 2]]", "[[0, 1.5], [1, 3]]", "[[0, 2], [1, 4]]"};
  for (int step = 2; step <= (test::reduced() ? 2 : 4); ++step) {
    write("single.toml", head + blade(twists[step - 2], "") + rest);
    ASSERT_EQ(gridmorph("morph single.toml -o single.cgns").status, 0);
    Mesh const alone = mesh("single.cgns"), in_sequence = mesh("out_" + std::to_string(step) + ".cgns");
    for (Index n = 0; n < alone.n_nodes(); ++n)
      ASSERT_LT(distance(alone.coordinates[n], in_sequence.coordinates[n]), 1e-13 * alone.size()) << step;
  }
}

TEST_F(SequenceRun, ContouredEndWallsLieOnTheirProfileAndTheBladeGoesWithThem) {
  write("case.toml",
        "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\noutput = \"out.cgns\"\n"
        "[[motion]]\npatches = \"hub\"\nrule = \"contour\"\nprofile = [[-1, 0.44], [-0.16, 0.44], [0, 0.45], [0.2, "
        "0.46], [1, "
        "0.46]]\n"
        "[[motion]]\npatches = [\"blade\", \"type:periodic\"]\nrule = \"free\"\n"
        "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"free\"\nconstraint = \"axial\"\n"
        "[[motion]]\npatches = \"case\"\nrule = \"fixed\"\n");
  Outcome const run = gridmorph("morph case.toml");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const before = mesh("passage.cgns"), after = mesh("out.cgns");
  auto const each = [&](std::string const& family, auto const& visit) {
    for (auto const& patch : before.patches)
      if (patch.families.front() == family)
        for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
          for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
            for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
              Index const n = before.zones[patch.zone].node({i, j, k});
              visit(before.coordinates[n], after.coordinates[n]);
            }
  };
  auto const radius = [](Vec3 const& p) { return std::hypot(p.y, p.z); };
  each("hub", [&](Vec3 const& p, Vec3 const& q) {
    EXPECT_NEAR(p.x, q.x, 1e-15);
    EXPECT_NEAR(std::atan2(p.z, p.y), std::atan2(q.z, q.y), 1e-14);
    if (std::abs(p.x + 0.16) < 1e-9) {
      EXPECT_NEAR(radius(q), 0.44, 1e-12);
    }
    if (std::abs(p.x) < 1e-9) {
      EXPECT_NEAR(radius(q), 0.45, 1e-12);
    }
    EXPECT_GT(radius(q), 0.4399);
    EXPECT_LT(radius(q), 0.4601);
  });
  double most = 0;
  each("blade", [&](Vec3 const& p, Vec3 const& q) { most = std::max(most, std::abs(radius(q) - radius(p))); });
  EXPECT_GT(most, 0.005);
  each("case", [&](Vec3 const& p, Vec3 const& q) { EXPECT_LT(distance(p, q), 1e-12); });
}

TEST_F(SequenceRun, ADiskThatIsFullLeavesNothing) {
  for (std::string const output : {"out_{step}.cgns", "out.cgns"}) {
    write_sequence("steps = 4\noutput = \"" + output + "\"\n", ", amplitude = 0.2");
    Outcome const run = shell("ulimit -f 64; $G morph case.toml");
    EXPECT_EQ(run.status, 3) << run.err;
    expect_nothing_written();
  }
}

TEST_F(SequenceRun, ProblemsAreKnownBeforeAnyWork) {
  write_sequence("steps = 4\n", "");
  expect_bad_input(gridmorph("morph case.toml"), {"no output", "[sequence]"});
  write_sequence("steps = 4\noutput = \"nowhere/out_{step}.cgns\"\n", "");
  expect_bad_input(gridmorph("morph case.toml"), {"'nowhere' does not exist"});
  write_sequence("steps = 4\noutput = \"out.cgns\"\n", "", "[output]\ndisplacement = true\n");
  expect_bad_input(gridmorph("morph case.toml"), {"one file per step"});
  write_sequence("steps = 4\noutput = \"out_{step}.cgns\"\n", "", "[output]\nreport = \"out_3.cgns\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"the same file"});
}

/// The blade is shifted along the axis and turned about it.
std::string const parametric =
    "[mesh]\ninput = \"passage.cgns\"\noutput = \"one.cgns\"\naxis = \"x\"\n"
    "[parameters]\nshift = { value = 0, range = [-0.01, 0.01], unit = \"m\" }\nturn = { value = 0, range = [-3, 60] }\n"
    "[[motion]]\npatches = [\"blade\"]\nrule = \"rigid\"\ntranslation = [\"shift\", 0, 0]\nrotation = { angle_deg = "
    "\"turn\" }\n"
    "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n";
std::string swept(std::string const& sweep) {
  std::string text = parametric;
  return text.erase(text.find("output"), std::string_view("output = \"one.cgns\"\n").size()) + "[sweep]\n" + sweep;
}

TEST_F(SequenceRun, ASweepMakesTheMeshOfEachDesign) {
  // A blade that shifts along the axis leaves the slopes of hub and case by some of its way.
  std::string const guard = "[guard]\nmax_trim = 0.1\n";
  write("one.toml", parametric + guard);
  write("sweep.toml", swept("designs = \"designs.csv\"\noutput = \"d_{design}.cgns\"\n") + guard);
  write("designs.csv", "turn, shift\n0.1, 0.0005\n0, 0\n-0.2, -0.001\n");
  Outcome const run = gridmorph("morph sweep.toml --report sweep.json --html sweep.html");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("design         shift          turn"), std::string::npos) << run.out;
  auto const report = nlohmann::json::parse(contents(path("sweep.json")));
  auto const& designs = report["sequence"]["steps"];
  ASSERT_EQ(designs.size(), 3U);
  EXPECT_EQ(designs[2]["parameters"], (nlohmann::json{{"shift", -0.001}, {"turn", -0.2}}));
  EXPECT_FALSE(designs[2].contains("time"));
  EXPECT_EQ(report["parameters"]["shift"]["unit"], "m");
  for (int d = 1; d <= 3; ++d) {
    auto const& p = designs[d - 1]["parameters"];
    ASSERT_EQ(gridmorph(fmt::format("morph one.toml --set shift={} --set turn={}", p["shift"].get<double>(),
                                    p["turn"].get<double>()))
                  .status,
              0);
    expect_same(mesh("one.cgns"), mesh(fmt::format("d_{}.cgns", d)));
  }
  expect_same(mesh("d_2.cgns"), mesh("passage.cgns"));
  std::string const page = contents(path("sweep.html"));
  EXPECT_NE(page.find("The 3 designs"), std::string::npos);
  EXPECT_NE(page.find("design 3, shift -0.001, turn -0.2"), std::string::npos);
  Outcome const predicted = gridmorph("plan sweep.toml");
  ASSERT_EQ(predicted.status, 0) << predicted.err;
  EXPECT_NE(predicted.out.find("of 3 comes out worst"), std::string::npos) << predicted.out;
}

TEST_F(SequenceRun, ASweepLeavesOutDesignsWhoseCellsAreInverted) {
  write("sweep.toml", swept("designs = \"designs.csv\"\n") + "[guard]\nretry = false\n");
  write("designs.csv", "turn\n1\n55\n2\n");
  Outcome const run = gridmorph("morph sweep.toml -o d_{design}.cgns --html sweep.html");
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_NE(run.out.find("not written: 1 of 3 designs, whose cells are inverted: 2"), std::string::npos) << run.out;
  EXPECT_TRUE(std::filesystem::exists(path("d_1.cgns")) && std::filesystem::exists(path("d_3.cgns")));
  EXPECT_FALSE(std::filesystem::exists(path("d_2.cgns")));
  EXPECT_NE(contents(path("sweep.html")).find("Some designs are inverted: the others are written"), std::string::npos);
  // None that is valid: nothing is written, as of a sequence.
  write("designs.csv", "turn\n55\n58\n");
  Outcome const none = gridmorph("morph sweep.toml -o e_{design}.cgns");
  EXPECT_EQ(none.status, 4) << none.err;
  EXPECT_FALSE(std::filesystem::exists(path("e_1.cgns")));
  EXPECT_NE(none.err.find("all designs have cells"), std::string::npos) << none.err;
}

TEST_F(SequenceRun, WhatIsNoSweepIsRefused) {
  write("sweep.toml", swept("latin_hypercube = 2\n"));
  auto const says = [&](std::string const& command, std::string const& what) {
    Outcome const run = gridmorph(command);
    EXPECT_EQ(run.status, 2) << command;
    EXPECT_NE(run.err.find(what), std::string::npos) << run.err;
  };
  says("morph sweep.toml", "add output = \"design_{design}.cgns\" to [sweep]");
  says("morph sweep.toml -o d.cgns", "has no {design} in its name");
  says("morph sweep.toml -o d_{design}.cgns --fraction 0.5", "[sweep]");
  says("morph sweep.toml -o d_{design}.cgns --set shfit=1", "did you mean 'shift'");
  says("morph sweep.toml -o d_{design}.cgns --set shift", "write it as name=value");
  says("morph sweep.toml -o d_{design}.cgns --set shift=1", "outside its range");
}

/// The blade bends between hub and case, and all else stands; the passage's first cells are thin.
std::string const bent =
    "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n"
    "[parameters]\nbend = { value = 0, range = [-0.01, 0.01], unit = \"m\" }\nlean = { value = 0, range = [-0.01, "
    "0.01] }\n"
    "fixed = 1\n"
    "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\nconstants = { q = 167 }\n"
    "dx = \"fixed * q * max(0, (r - 0.471) * (0.6245 - r)) * lean\"\n"
    "dz = \"q * max(0, (r - 0.471) * (0.6245 - r)) * (bend + lean * axial / 0.05)\"\n"
    "[[motion]]\npatches = [\"hub\", \"case\", \"inlet\", \"outlet\", \"type:periodic\"]\nrule = \"fixed\"\n"
    "[boundary_layer]\nwalls = [\"blade\"]\n";

TEST_F(SequenceRun, ABoxOfDesignsIsCertifiedUpToOneThatIsInverted) {
  write("box.toml", bent + "mode = \"translate\"\n");
  Outcome const run = gridmorph("certify box.toml --limit 50 --report box.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("CERTIFIED: "), std::string::npos) << run.out;
  auto const box = nlohmann::json::parse(contents(path("box.json")));
  double const certified = box["certified"], broken = box["broken"];
  EXPECT_TRUE(box["holds"].get<bool>());
  EXPECT_GT(certified, 0.9 * broken);
  EXPECT_EQ(box["parameters"]["bend"]["certified"][1], 0.01 * certified);
  // Corners of the box are valid, and the design that is named is inverted where it says.
  std::string const unlimited = [&] {
    std::string text = bent + "mode = \"translate\"\n[guard]\nretry = false\n[volume]\norder = \"priority\"\n";
    for (auto at = text.find(", range = [-0.01, 0.01]"); at != std::string::npos;
         at = text.find(", range = [-0.01, 0.01]"))
      text.erase(at, std::string_view(", range = [-0.01, 0.01]").size());
    return text;
  }();
  write("one.toml", unlimited);
  auto const morph = [&](double bend, double lean) {
    return gridmorph(fmt::format("morph one.toml -o one.cgns --set bend={:.17g} --set lean={:.17g}", bend, lean));
  };
  for (double const s : {-1.0, 1.0})
    for (double const t : {-1.0, 1.0})
      EXPECT_LE(morph(s * 0.01 * certified, t * 0.01 * certified).status, 1) << s << " " << t;
  Outcome const inverted = morph(box["design"]["bend"], box["design"]["lean"]);
  EXPECT_EQ(inverted.status, 4) << inverted.out;
  EXPECT_NE((inverted.out + inverted.err).find(box["worst"]["zone"].get<std::string>()), std::string::npos);
  // A box that is too large is certified in part.
  EXPECT_EQ(gridmorph("certify box.toml").status, 0);
  std::string wide = bent + "mode = \"translate\"\n";
  for (auto at = wide.find("0.01]"); at != std::string::npos; at = wide.find("0.01]")) wide.replace(at, 5, "0.9]");
  for (auto at = wide.find("[-0.01"); at != std::string::npos; at = wide.find("[-0.01")) wide.replace(at, 6, "[-0.9");
  write("wide.toml", wide);
  Outcome const part = gridmorph("certify wide.toml");
  EXPECT_EQ(part.status, 1) << part.err;
  EXPECT_NE(part.out.find("CERTIFIED IN PART"), std::string::npos) << part.out;
}

TEST_F(SequenceRun, BoxesThatCannotBeCertifiedSayWhy) {
  write("turning.toml", bent + "mode = \"rotate\"\nextent = { layers = 4 }\n");
  Outcome const turning = gridmorph("certify turning.toml");
  EXPECT_EQ(turning.status, 2);
  EXPECT_NE(turning.err.find("meshes are not linear in parameter 1"), std::string::npos) << turning.err;
  EXPECT_NE(turning.err.find("1 bend, 2 lean"), std::string::npos) << turning.err;
  write("none.toml", "[mesh]\ninput = \"passage.cgns\"\n" + still);
  Outcome const none = gridmorph("certify none.toml");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("no parameter has a range"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace gridmorph::test
