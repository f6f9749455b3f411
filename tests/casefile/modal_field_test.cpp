// Mode shapes over time, and the case-file keys that give them.
#include "model_support.hpp"

#include <gridmorph/mapping/modal_field.hpp>

namespace gridmorph::test {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

PointCloud point(Vec3 const& re, Vec3 const& im = {}, bool complex = false) {
  PointCloud cloud;
  cloud.source = "m.csv";
  cloud.position = {{0, 0, 0}, {1, 0, 0}};
  cloud.displacement = {re, re};
  if (complex) cloud.imaginary = {im, im};
  cloud.line = {1, 2};
  return cloud;
}

Vec3 at(ModalField const& field, double periods, Vec3 const& p = {0, 0, 0}) {
  std::array<Vec3, 1> const points{p};
  std::array<Vec3, 1> u{};
  field.at(periods, points, u);
  return u[0];
}

TEST(Oscillation, IsExactAtQuartersAndAccurateBetween) {
  for (int n = -9; n < 9; ++n) {
    auto const [c, s] = oscillation(n / 4.0);
    EXPECT_EQ(std::fabs(c) + std::fabs(s), 1) << n;
    EXPECT_EQ(c == 0 || s == 0, true) << n;
  }
  for (double turns = -3; turns < 3; turns += 0.0371) {
    EXPECT_NEAR(oscillation(turns).cosine, std::cos(two_pi * turns), 4e-15);
    EXPECT_NEAR(oscillation(turns).sine, std::sin(two_pi * turns), 4e-15);
  }
}

TEST(ModalField, AddsMeanAndModesWithAmplitudeFrequencyAndPhase) {
  StructuralModel const mean{point({0.5, 0, 0}), {}, {}, {}};
  std::vector<Mode> modes{{{point({0, 1, 0}), {}, {}, {}}, 2, 1, 0.125}, {{point({0, 0, 1}), {}, {}, {}}, 3, 2, 0}};
  ModalField const field(mean, modes, {});
  EXPECT_EQ(field.fields().size(), 1u) << "modes on equal nodes share their mapping";
  for (double t = 0; t < 1; t += 0.1) {
    Vec3 const wanted{0.5, 2 * std::cos(two_pi * (t + 0.125)), 3 * std::cos(2 * two_pi * t)};
    EXPECT_VEC3_NEAR(at(field, t), wanted, 1e-14);
  }
}

TEST(ModalField, AddsLoadCasesWithTheirFactors) {
  StructuralModel const mean{point({0.5, 0, 0}), {}, {}, {}};
  std::vector<StructuralModel> const loads{{point({0, 1, 0}), {}, {}, {}}, {point({0, 0, 2}), {}, {}, {}}};
  std::vector<Mode> const modes{{{point({1, 0, 0}), {}, {}, {}}, 3, 1, 0}};
  ModalField const field(mean, modes, loads, {});
  EXPECT_EQ(field.fields().size(), 1u) << "load cases on equal nodes share their mapping";
  for (double const t : {0.0, 0.3}) {
    std::array<double, 2> const factors{0.81, -t};
    std::array<Vec3, 1> const points{Vec3{0.25, 0, 0}};
    std::array<Vec3, 1> u{};
    field.at(t, factors, points, u);
    EXPECT_VEC3_NEAR(u[0], (Vec3{0.5 + 3 * std::cos(two_pi * t), 0.81, -2 * t}), 1e-14);
  }
}

TEST(ModalField, ComplexModesTravel) {
  // f + i g with f = cos(k x), g = -sin(k x): the real part of exp(i (w t - k x)) is cos(w t - k x).
  PointCloud cloud;
  cloud.source = "m.csv";
  double const k = 3;
  for (int n = 0; n <= 50; ++n) {
    double const x = n / 50.0;
    cloud.position.push_back({x, 0, 0});
    cloud.displacement.push_back({0, std::cos(k * x), 0});
    cloud.imaginary.push_back({0, -std::sin(k * x), 0});
    cloud.line.push_back(n + 1);
  }
  ModalField const field(std::nullopt, {{{cloud, {}, {}, {}}, 1, 1, 0}}, {});
  for (double t = 0; t < 1; t += 0.07)
    for (int n = 0; n <= 50; n += 7)
      EXPECT_NEAR(at(field, t, cloud.position[n]).y, std::cos(two_pi * t - k * n / 50.0), 1e-14);
}

TEST(ModalField, StepsDoNotDependOnTheStepsBefore) {
  auto const shape = [](Vec3 const& p) { return Vec3{0, p.x * p.z, p.x * p.x}; };
  auto const model = grid_model(9, 7, quarter_cylinder(1), shape);
  std::vector<Vec3> at_points;
  for (int n = 0; n < 40; ++n) at_points.push_back(quarter_cylinder(1.1)((n + 0.5) / 41, (n * 7 % 40 + 0.5) / 41));
  auto const evaluate = [&](ModalField const& field, double t) {
    std::vector<Vec3> u(at_points.size());
    field.at(t, at_points, u);
    return u;
  };
  ModalField const used(std::nullopt, {{model, 0.1, 1, 0.3}}, {});
  for (int step = 0; step < 100; ++step) static_cast<void>(evaluate(used, step / 100.0));
  ModalField const fresh(std::nullopt, {{model, 0.1, 1, 0.3}}, {});
  EXPECT_EQ(evaluate(used, 0.37), evaluate(fresh, 0.37));
  EXPECT_EQ(used.fields().front()->mapping().evaluated, 40) << "every position is mapped once";
}

TEST(ModalField, AtZeroAmplitudeNothingMovesAtAll) {
  auto const model = grid_model(5, 5, quarter_cylinder(1), [](Vec3 const& p) { return Vec3{-p.x, -1, p.y}; });
  ModalField const still(std::nullopt, {{model, 0, 1, 0.1}}, {});
  ModalField const crossing(std::nullopt, {{model, 2, 1, 0}}, {});
  for (Vec3 const& p : {quarter_cylinder(1.2)(0.3, 0.4), quarter_cylinder(1)(0, 0)}) {
    EXPECT_EQ(at(still, 0.77, p), (Vec3{0, 0, 0}));
    EXPECT_EQ(at(crossing, 0.25, p), (Vec3{0, 0, 0})) << "a quarter of a period";
    EXPECT_FALSE(at(crossing, 0, p) == (Vec3{0, 0, 0}));
  }
}

class ModalCase : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("a.csv", "0,0,0,0,0,1\n1,0,0,0,0,1\n");
    folder.write("b.csv", "0,0,0,0,2,0\n1,0,0,0,2,0\n");
    folder.write("bad.csv", "0,0,0,0,nan,0\n");
  }
  [[nodiscard]] CaseFile parsed(std::string const& keys, std::string const& top = "[sequence]\nsteps = 8\n") const {
    return parse_case_file(top + case_with_rule("rule = \"field\"\n" + keys), folder.path("case.toml"));
  }
  [[nodiscard]] std::vector<std::string> problems(std::string const& keys,
                                                  std::string const& top = "[sequence]\nsteps = 8\n") const {
    return error_lines([&] { (void)parsed(keys, top); });
  }
  [[nodiscard]] std::string line(int n) const { return folder.file("case.toml") + ":" + std::to_string(n) + ": "; }

  TemporaryFolder folder;
};

TEST_F(ModalCase, KeysSayWhatMovesWhen) {
  auto const c = parsed(
      "file = \"a.csv\"\nmodes = [ { file = \"b.csv\", amplitude = 3, phase_deg = 90 }, { file = \"a.csv\", harmonic = "
      "2 } ]\n",
      "[sequence]\nsteps = 8\nperiod = 0.5\nperiods = 2\noutput = \"s_{step}.cgns\"\n");
  ASSERT_TRUE(c.sequence);
  EXPECT_EQ(c.sequence->steps, 8);
  EXPECT_DOUBLE_EQ(c.sequence->time_at(4), 0.5);
  EXPECT_EQ(c.sequence->output, folder.path("s_{step}.cgns"));
  for (double const t : {0.0, 0.125, 0.3}) {
    Vec3 const u = displacement_of(motion_at(c, {t, 0, 1}).rules.at(0).rule, {0, 0, 0});
    EXPECT_VEC3_NEAR(u, (Vec3{0, -6 * std::sin(two_pi * t), 1 + std::cos(2 * two_pi * t)}), 1e-14);
  }
  EXPECT_EQ(displacement_of(c.motion.rules.at(0).rule, {0, 0, 0}), (Vec3{0, 0, 2})) << "without a time: at its begin";
}

TEST_F(ModalCase, LoadCasesHaveFactorsThatMayChange) {
  std::string const loads =
      "file = \"a.csv\"\nloads = [ { file = \"b.csv\", factor = 0.81 }, { file = \"a.csv\", factor = \"k * ";
  auto const still = parsed(loads + "2\" } ]\n", "[constants]\nk = -0.5\n");
  EXPECT_EQ(displacement_of(still.motion.rules.at(0).rule, {0, 0, 0}), (Vec3{0, 1.62, 0}));
  EXPECT_FALSE(still.timed.at(0).changes);
  auto const moving =
      parsed(loads + "t\" } ]\namplitude = 0.5\n", "[sequence]\nsteps = 4\nperiod = 2\n[constants]\nk = 3\n");
  EXPECT_TRUE(moving.timed.at(0).changes);
  for (double const t : {0.0, 0.25, 1.0})
    EXPECT_VEC3_NEAR(displacement_of(motion_at(moving, {t / 2, t, 1}).rules.at(0).rule, {0, 0, 0}),
                     (Vec3{0, 0.81, 0.5 + 1.5 * t}), 1e-14);
}

TEST_F(ModalCase, ProblemsOfLoadCasesNameTheirLine) {
  std::string const none = "[constants]\na = 1\n";
  EXPECT_TRUE(reported(problems("loads = []\n", none), line(10), {"the list is empty"}));
  EXPECT_TRUE(reported(problems("loads = [\n { factor = 2 } ]\n", none), line(11), {"'file' is missing"}));
  EXPECT_TRUE(
      reported(problems("loads = [\n { file = \"a.csv\", factor = \"t\" } ]\n", none), line(11), {"[sequence]"}));
  EXPECT_TRUE(reported(problems("loads = [\n { file = \"a.csv\", factor = \"\" } ]\n", none), line(11),
                       {"loads factor", "is empty"}));
  EXPECT_TRUE(reported(problems("loads = [\n { file = \"a.csv\", amplitude = 2 } ]\n", none), line(11),
                       {"'amplitude'", "factor"}));
  EXPECT_TRUE(reported(problems("file = \"a.csv\"\namplitude = \"\"\n", none), line(11), {"amplitude", "is empty"}));
}

TEST_F(ModalCase, FrequenciesAreInCyclesPerUnitOfTime) {
  auto const c = parsed("modes = [ { file = \"a.csv\", frequency = 6 } ]\n", "[sequence]\nsteps = 8\nperiod = 0.5\n");
  EXPECT_VEC3_NEAR(displacement_of(motion_at(c, {0.1, 0, 1}).rules.at(0).rule, {0, 0, 0}),
                   (Vec3{0, 0, std::cos(two_pi * 0.3)}), 1e-14);
}

TEST_F(ModalCase, ProblemsHaveTheirLine) {
  EXPECT_TRUE(reported(problems("modes = []\n"), line(10), {"the list is empty"}));
  EXPECT_TRUE(reported(problems("modes = [\n { amplitude = 2 } ]\n"), line(11), {"'file' is missing"}));
  EXPECT_TRUE(reported(problems("modes = [\n { file = \"bad.csv\" } ]\n"), line(11), {"bad.csv:1", "not finite"}));
  EXPECT_TRUE(
      reported(problems("modes = [\n { file = \"a.csv\", phase = 3 } ]\n"), line(11), {"'phase'", "phase_deg"}));
  EXPECT_TRUE(reported(problems("modes = [\n { file = \"a.csv\", harmonic = 1, frequency = 2 } ]\n"), line(11),
                       {"stands beside harmonic"}));
  EXPECT_TRUE(reported(problems("modes = [ { file = \"a.csv\", frequency = 2 } ]\n", "[constants]\na = 1\n"), line(10),
                       {"needs the period"}));
}

TEST_F(ModalCase, ProblemsOfTheSequenceHaveTheirLine) {
  std::string const modes = "modes = [ { file = \"a.csv\" } ]\n";
  EXPECT_TRUE(reported(problems(modes, "[sequence]\nsteps = 0\n"), line(2), {"1 to 99999", "found 0"}));
  EXPECT_TRUE(reported(problems(modes, "[sequence]\n\n"), line(1), {"'steps' is missing"}));
  EXPECT_TRUE(reported(problems(modes, "[sequence]\nsteps = 3\nperiod = -1\n"), line(3), {"must be positive"}));
  EXPECT_TRUE(reported(problems(modes, "[sequence]\nsteps = 3\nstep = 1\n"), line(3), {"unknown key 'step'", "steps"}));
  EXPECT_TRUE(reported(problems("file = \"a.csv\"\n"), line(1), {"no rule changes with time"}));
}

}  // namespace
}  // namespace gridmorph::test
