// [parameters], expressions of them, values from outside, and the designs of a [sweep].
#include "case_text.hpp"

#include <gridmorph/case/detail/parameter_reader.hpp>

#include <cmath>

namespace gridmorph::test {
namespace {

std::string const head = "[mesh]\ninput = \"in.cgns\"\naxis = \"x\"\n";

/// A blade that is shifted along y and turned about the axis.
std::string shifted(std::string const& parameters, std::string const& more = "") {
  return head + "[parameters]\n" + parameters +
         "\n[[motion]]\npatches = \"blade\"\nrule = \"rigid\"\ntranslation = [0, \"2 * lean\", 0]\n" + more;
}

CaseFile read(std::string const& text, ParameterValues const& values = {}) {
  return read_case_file(CaseDocument(text, "case.toml"), values);
}

Vec3 moved_by(Rule const& rule, Vec3 const& x) {
  auto const& rigid = std::get<RigidRule>(rule);
  return rigid.matrix * x + rigid.translation - x;
}

double shift_of(Motion const& motion) { return moved_by(motion.rules.at(0).rule, {0, 0, 0}).y; }

TEST(Parameters, AreKnownWhereverANumberIsRead) {
  CaseFile const file =
      read(head +
           "[parameters]\nlean = { value = 0.5, range = [0, 1], unit = \"m\" }\nangle = 30\n"
           "[constants]\nhalf = \"lean / 2\"\n"
           "[[motion]]\npatches = \"blade\"\nrule = \"rigid\"\nrotation = { angle_deg = \"2 * angle\" }\n"
           "translation = [\"half\", \"lean\", 1]\n"
           "[[motion]]\npatches = \"hub\"\nrule = \"formula\"\ndx = \"lean * y\"\n"
           "[[motion]]\npatches = \"case\"\nrule = \"contour\"\nprofile = [[0, 1], [\"lean\", \"1 + half\"]]\n"
           "[boundary_layer]\nextent = { thickness = \"half\" }\n");
  ASSERT_EQ(file.parameters.size(), 2U);
  EXPECT_EQ(file.parameters[1].name, "lean");
  EXPECT_EQ(file.parameters[1].unit, "m");
  Vec3 const u = moved_by(file.motion.rules[0].rule, {0, 1, 0});
  EXPECT_NEAR(u.x, 0.25, 1e-15);
  EXPECT_NEAR(u.y, std::cos(std::acos(-1) / 3) - 1 + 0.5, 1e-15);
  EXPECT_NEAR(displacement_of(file.motion.rules[1].rule, {0, 3, 0}).x, 1.5, 1e-15);
  EXPECT_EQ(file.plan.boundary_layers.at(0).thickness, 0.25);
}

TEST(Parameters, TakeValuesFromOutside) {
  std::string const text = shifted("lean = { value = 0.5, range = [-1, 1] }");
  EXPECT_EQ(shift_of(read(text).motion), 1);
  EXPECT_EQ(shift_of(read(text, {{"lean", -0.25}}).motion), -0.5);
  // The rules of a design, beside what was given before.
  CaseFile const given = read(shifted("lean = 0\nup = 1", "rotation = { angle_deg = \"up - 1\" }\n"), {{"lean", 3}});
  EXPECT_EQ(shift_of(given.motion_for({{"up", 1}})), 6);
  EXPECT_EQ(shift_of(given.motion_for({{"lean", 4}})), 8);
}

TEST(Parameters, ErrorsSayWhereAndWhatToDo) {
  EXPECT_TRUE(
      reported(problems_of(shifted("lean = { value = 2, range = [-1, 1] }")), "case.toml:5", {"lean is 2", "[-1, 1]"}));
  EXPECT_TRUE(
      reported(problems_of(shifted("lean = { value = 2, range = [1, -1] }")), "case.toml:5", {"lowest, highest"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = { range = [-1, 1] }")), "case.toml:5", {"'value' is missing"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = \"wide\"")), "case.toml:5", {"expected a number"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = 1\ntheta = 2")), "case.toml:6", {"cannot be the name"}));
  EXPECT_TRUE(
      reported(problems_of(shifted("lean = 1\nidle = 2")), "case.toml:6", {"idle", "is used by no expression"}));
  EXPECT_TRUE(reported(problems_of(shifted("lena = 1")), "case.toml:9", {"unknown name 'lean'", "'lena'"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = 1", "[constants]\nlean = 3\n")), "case.toml",
                       {"lean", "one of [parameters]"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = 0", "rank = 0\nrotation = { angle_deg = \"1 / lean\" }\n")),
                       "case.toml:11", {"angle_deg", "inf"}));
  EXPECT_TRUE(reported(problems_of(shifted("lean = 0", "rotation = { angle_deg = \"lean * t\" }\n")), "case.toml:10",
                       {"uses t", "parameters and constants alone"}));
  EXPECT_TRUE(reported(error_lines([] {
                         (void)read(shifted("lean = 0"), {{"laen", 1}});
                       }),
                       "case.toml", {"'laen'", "did you mean 'lean'"}));
  EXPECT_TRUE(reported(error_lines([] {
                         (void)read(shifted("lean = { value = 0, range = [0, 1] }"), {{"lean", 2}});
                       }),
                       "case.toml:5", {"lean is 2"}));
  // Without parameters and constants a string is none where a number is wanted.
  EXPECT_TRUE(
      reported(problems_of(head + "[[motion]]\npatches = \"blade\"\nrule = \"rigid\"\ntranslation = [0, \"2\", 0]\n"),
               "case.toml:7", {"expected a number", "the string \"2\""}));
}

TEST(Sweep, HasTheDesignsOfATable) {
  TemporaryFolder const folder;
  std::ofstream(folder / "designs.csv") << "lean, up\n0.25, 1\n-0.5,\n";
  std::ofstream(folder / "case.toml") << shifted("lean = 0\nup = 7\nwide = 1",
                                                 "rotation = { angle_deg = \"0 * up * wide\" }\n"
                                                 "[sweep]\ndesigns = \"designs.csv\"\noutput = \"d_{design}.cgns\"\n");
  CaseFile const file = read_case_file(folder / "case.toml");
  ASSERT_TRUE(file.sequence && file.sequence->is_sweep());
  EXPECT_EQ(file.sequence->steps, 2);
  EXPECT_EQ(file.sequence->values_at(0), (ParameterValues{{"lean", 0.25}, {"up", 1}, {"wide", 1}}));
  EXPECT_EQ(file.sequence->values_at(1), (ParameterValues{{"lean", -0.5}, {"up", 7}, {"wide", 1}}));
  EXPECT_EQ(shift_of(motion_at(file, file.sequence->moment(0))), 0.5);
  EXPECT_EQ(shift_of(motion_at(file, file.sequence->moment(1))), -1);
  EXPECT_EQ(shift_of(file.motion), 0);
}

TEST(Sweep, OfALatinHypercubeMeetsEachPartOfEachRangeOnce) {
  std::vector<Parameter> const parameters{{"a", 0, {{-1, 3}}, ""}, {"b", 0, {{10, 10.5}}, ""}};
  for (int const count : {1, 2, 7, 64}) {
    auto const designs = casefile::latin_hypercube(parameters, count, 5);
    ASSERT_EQ(designs.size(), std::size_t(count));
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      auto const [low, high] = *parameters[p].range;
      std::vector<int> met(count, 0);
      for (auto const& design : designs) {
        ASSERT_GE(design[p], low);
        ASSERT_LT(design[p], high);
        ++met[std::size_t((design[p] - low) / (high - low) * count)];
      }
      EXPECT_EQ(met, std::vector<int>(count, 1));
    }
  }
  // The same on every machine, as the engine of the standard is; another seed has others.
  auto const one = casefile::latin_hypercube(parameters, 3, 1);
  EXPECT_EQ(one, casefile::latin_hypercube(parameters, 3, 1));
  EXPECT_NE(one, casefile::latin_hypercube(parameters, 3, 2));
}

TEST(Sweep, ErrorsSayWhereAndWhatToDo) {
  auto const sweep = [](std::string const& keys,
                        std::string const& parameters = "lean = { value = 0, range = [0, 1] }") {
    return shifted(parameters, "[sweep]\n" + keys);
  };
  EXPECT_TRUE(reported(problems_of(sweep("output = \"d_{design}.cgns\"")), "case.toml:10", {"needs one of designs"}));
  EXPECT_TRUE(reported(problems_of(sweep("latin_hypercube = 3\noutput = \"d.cgns\"")), "case.toml:12", {"{design}"}));
  EXPECT_TRUE(reported(problems_of(sweep("latin_hypercube = 0")), "case.toml:11", {"1 to 99999"}));
  EXPECT_TRUE(
      reported(problems_of(sweep("latin_hypercube = 3", "lean = 0")), "case.toml:11", {"needs the range of 'lean'"}));
  EXPECT_TRUE(reported(problems_of(sweep("designs = \"none.csv\"")), "case.toml:11", {"does not exist"}));
  EXPECT_TRUE(
      reported(problems_of(sweep("latin_hypercube = 3\n[sequence]\nsteps = 2")), "case.toml:10", {"[sequence]"}));
  EXPECT_TRUE(reported(problems_of(sweep("latin_hypercube = 3\n[guard]\nmin_angle_deg = \"9 * lean\"")), "case.toml:13",
                       {"[guard] min_angle_deg", "depends on 'lean'"}));
  EXPECT_TRUE(
      reported(problems_of(head + "[[motion]]\npatches = \"blade\"\nrule = \"fixed\"\n[sweep]\nlatin_hypercube = 3\n"),
               "case.toml:7", {"has no parameters"}));
  // One plan: what it is made of stays.
  EXPECT_TRUE(reported(problems_of(sweep("latin_hypercube = 3\n[boundary_layer]\nextent = { thickness = \"lean\" }")),
                       "case.toml:13", {"[boundary_layer extent] thickness", "one plan"}));
  EXPECT_TRUE(reported(problems_of(sweep("latin_hypercube = 3\n[volume]\nlaw = \"formula\"\nw = \"t + 0 * lean\"")),
                       "case.toml:14", {"unknown name 'lean'"}));
  // A design that the rules cannot have is named.
  CaseFile const file = read(shifted("lean = { value = 1, range = [-1, 1] }",
                                     "scale = \"lean\"\n[sweep]\nlatin_hypercube = 2\noutput = \"d_{design}.cgns\"\n"));
  auto const lines = error_lines([&] {
    for (int step = 0; step < 2; ++step) (void)motion_at(file, file.sequence->moment(step));
  });
  EXPECT_TRUE(reported(lines, "design ", {"lean = -0."}));
  EXPECT_TRUE(reported(lines, "case.toml:10", {"scale"}));
}

}  // namespace
}  // namespace gridmorph::test
