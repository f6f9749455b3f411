// What a correct case file becomes.
#include "case_text.hpp"

#include <gridmorph/morph/morph.hpp>

namespace gridmorph::test {
namespace {

std::string const smallest = "[mesh]\ninput = \"in.cgns\"\n[[motion]]\npatches = \"a\"\nrule = \"fixed\"\n";

CaseFile parse(std::string const& text) { return parse_case_file(text, "case.toml"); }

TEST(CaseFileText, NeedsLittle) {
  CaseFile const c = parse(smallest);
  EXPECT_EQ(c.input, "in.cgns");
  EXPECT_TRUE(c.output.empty());
  EXPECT_FALSE(c.axis.has_value());
  EXPECT_FALSE(c.motion.strict);
  EXPECT_EQ(c.motion.conformity_tolerance, Motion{}.conformity_tolerance);
  EXPECT_TRUE(c.plan.boundary_layers.empty());
  EXPECT_EQ(c.plan.volume.law, Law::linear);
  EXPECT_EQ(c.plan.volume.priority.size(), 3u);
  EXPECT_EQ(c.plan.topology.matching_tolerance, 0);
  EXPECT_FALSE(c.guard.write_inverted);
  EXPECT_FALSE(c.output_options.report.has_value());
}

TEST(CaseFileText, AnchorsRelativePathsAtTheCaseFile) {
  CaseFile const c = parse_case_file(
      "[mesh]\ninput = \"../in.cgns\"\noutput = \"/tmp/out.cgns\"\n[output]\nreport = \"r.json\"\n"
      "[[motion]]\npatches = \"a\"\nrule = \"fixed\"\n",
      "/data/run/case.toml");
  EXPECT_EQ(c.input, "/data/in.cgns");
  EXPECT_EQ(c.output, "/tmp/out.cgns");
  EXPECT_EQ(c.output_options.report, "/data/run/r.json");
}

TEST(CaseFileText, ReadsTheAxisAsTableAndAsLetter) {
  auto const axis_of = [](std::string const& axis) {
    return parse("[mesh]\ninput = \"in.cgns\"\naxis = " + axis + "\n[[motion]]\npatches = \"a\"\nrule = \"fixed\"\n")
        .axis.value();
  };
  EXPECT_EQ(axis_of("{ origin = [1, 2, 3], direction = [0, 0, 5] }").origin, (Vec3{1, 2, 3}));
  EXPECT_EQ(axis_of("{ origin = [1, 2, 3], direction = [0, 0, 5] }").direction, (Vec3{0, 0, 5}));
  EXPECT_EQ(axis_of("{ direction = [1, 1, 0] }").origin, (Vec3{0, 0, 0}));
  EXPECT_EQ(axis_of("\"y\"").direction, (Vec3{0, 1, 0}));
}

TEST(CaseFileText, ReadsLawsOfTheUsersOwn) {
  CaseFile const c = parse(
      "[mesh]\ninput = \"in.cgns\"\n[constants]\npower = 3\n[[motion]]\npatches = [\"a\"]\nrule = \"fixed\"\n"
      "[volume]\nlaw = \"formula\"\nw = \"t^power\"\n"
      "laws = [ { between = [\"wall\", \"case\"], law = \"formula\", w = \"smoothstep(0, 1, t)\" } ]\n");
  VolumeOptions const& volume = c.plan.volume;
  EXPECT_EQ(volume.law, Law::own);
  EXPECT_DOUBLE_EQ(volume.own_law.weight(0.5), 0.125);
  EXPECT_EQ(volume.own_law.name, "w = \"t^power\"");
  ASSERT_EQ(volume.laws.size(), 1u);
  EXPECT_EQ(volume.laws[0].law, Law::own);
  EXPECT_DOUBLE_EQ(volume.laws[0].own.weight(0.25), 3 * 0.0625 - 2 * 0.015625);
  EXPECT_EQ(volume.laws[0].where, "case.toml:11");
}

TEST(CaseFileText, ReadsEverySetting) {
  CaseFile const c = parse(
      "default = \"error\"\n"
      "[mesh]\ninput = \"in.cgns\"\nmatching_tolerance = 1e-4\nopen_faces = \"open\"\n"
      "[conformity]\ntolerance = 1e-6\n"
      "[[motion]]\npatches = [\"a\", \"type:wall\"]\nrule = \"fixed\"\nrank = -2\n"
      "[[boundary_layer]]\nwalls = [\"a\"]\nextent = { layers = 30 }\nmode = \"translate\"\n"
      "[[boundary_layer]]\nwalls = \"b\"\nextent = { thickness = 2e-3 }\n"
      "[volume]\nlaw = \"c2\"\npriority = [ { rule = \"aspect-ratio\" }, { rule = \"boundary\", order = [\"inflow\", "
      "\"wall\"] } ]\n"
      "[guard]\nmin_determinant = 0.125\nwrite_inverted = true\n"
      "[output]\ndisplacement = true\nquality = true\nreport = \"r.json\"\n");
  EXPECT_TRUE(c.motion.strict);
  EXPECT_EQ(c.plan.topology.matching_tolerance, 1e-4);
  EXPECT_EQ(c.plan.topology.open_faces, "open");
  EXPECT_EQ(c.motion.conformity_tolerance, 1e-6);
  EXPECT_EQ(c.motion.rules.at(0).patches, (std::vector<std::string>{"a", "type:wall"}));
  EXPECT_EQ(c.motion.rules.at(0).rank, -2);
  EXPECT_EQ(c.motion.rules.at(0).where, "case.toml:8");
  ASSERT_EQ(c.plan.boundary_layers.size(), 2u);
  EXPECT_EQ(c.plan.boundary_layers[0].extent, BoundaryLayer::Extent::layers);
  EXPECT_EQ(c.plan.boundary_layers[0].layers, 30);
  EXPECT_EQ(c.plan.boundary_layers[1].walls, (std::vector<std::string>{"b"}));
  EXPECT_EQ(c.plan.boundary_layers[1].extent, BoundaryLayer::Extent::thickness);
  EXPECT_EQ(c.plan.boundary_layers[1].thickness, 2e-3);
  EXPECT_EQ(c.plan.volume.law, Law::c2);
  ASSERT_EQ(c.plan.volume.priority.size(), 2u);
  EXPECT_EQ(c.plan.volume.priority[0].kind, PriorityRule::Kind::aspect_ratio);
  EXPECT_EQ(c.plan.volume.priority[1].kind, PriorityRule::Kind::boundary);
  EXPECT_EQ(c.plan.volume.priority[1].order, (std::vector<std::string>{"inflow", "wall"}));
  EXPECT_EQ(c.guard.min_determinant, 0.125);
  EXPECT_TRUE(c.guard.write_inverted);
  EXPECT_TRUE(c.output_options.displacement);
  EXPECT_TRUE(c.output_options.quality);
  EXPECT_EQ(c.output_options.report, "r.json");
}

TEST(CaseFileText, TakesOneBoundaryLayerWithoutDoubleBrackets) {
  CaseFile const c = parse(smallest + "[boundary_layer]\nextent = \"block\"\n");
  ASSERT_EQ(c.plan.boundary_layers.size(), 1u);
  EXPECT_TRUE(c.plan.boundary_layers[0].walls.empty());
  EXPECT_EQ(c.plan.boundary_layers[0].extent, BoundaryLayer::Extent::block);
}

TEST(CaseFileText, HasTheDefaultNearFieldUnlessItSaysFalse) {
  EXPECT_TRUE(parse(smallest).plan.default_boundary_layer);
  EXPECT_TRUE(parse("boundary_layer = true\n" + smallest).plan.default_boundary_layer);
  CaseFile const none = parse("boundary_layer = false\n" + smallest);
  EXPECT_TRUE(none.plan.boundary_layers.empty());
  EXPECT_FALSE(none.plan.default_boundary_layer);
}

TEST(CaseFileText, TakesTheLatticeWhereItSpeaksOfTheWrap) {
  auto const method = [](std::string const& more) { return parse(smallest + more).plan.elements.method; };
  EXPECT_EQ(method(""), NearFieldMethod::automatic);
  EXPECT_EQ(method("[near_field]\noffset = 0.1\n"), NearFieldMethod::automatic);
  for (auto const* wrap :
       {"[near_field]\nwrap = \"tube\"\n", "[near_field]\nresolution = 3\n", "[background]\ncells = 3\n"})
    EXPECT_EQ(method(wrap), NearFieldMethod::lattice) << wrap;
  EXPECT_EQ(method("[near_field]\nmethod = \"layers\"\nresolution = 3\n"), NearFieldMethod::layers);
  EXPECT_EQ(method("[near_field]\nmethod = \"least-squares\"\n"), NearFieldMethod::least_squares);
}

TEST(CaseFileText, LeavesTheExtentOfANearFieldToThePlanWhereItSaysNone) {
  CaseFile const c = parse(smallest + "[boundary_layer]\nwalls = \"b\"\n");
  ASSERT_EQ(c.plan.boundary_layers.size(), 1u);
  EXPECT_EQ(c.plan.boundary_layers[0].extent, BoundaryLayer::Extent::automatic);
}

TEST(CaseFileText, KeepsTheRulesInTheirOrder) {
  CaseFile const c =
      parse(smallest + "[[motion]]\npatches = \"b\"\nrule = \"free\"\n[[motion]]\npatches = \"c\"\nrule = \"fixed\"\n");
  ASSERT_EQ(c.motion.rules.size(), 3u);
  EXPECT_EQ(c.motion.rules[1].patches.front(), "b");
  EXPECT_EQ(c.motion.rules[1].where, "case.toml:6");
  EXPECT_EQ(c.motion.rules[2].patches.front(), "c");
}

TEST(CaseFileText, MayHaveWindowsLineEnds) {
  std::string text;
  for (char const c : smallest) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse(text).input, "in.cgns");
}

TEST(Sequence, OfVeryManyStepsSomeAreLookedAtAheadOfTimeTheFirstAndTheLastAmongThem) {
  for (int const steps : {1, 2, 7, 100, 99999}) {
    std::vector<int> const some = some_steps(steps, 100);
    EXPECT_EQ(int(some.size()), std::min(steps, 100));
    EXPECT_EQ(some.front(), 0);
    EXPECT_EQ(some.back(), steps - 1);
    EXPECT_TRUE(std::is_sorted(some.begin(), some.end(), std::less_equal<>())) << "each once";
  }
}

}  // namespace
}  // namespace gridmorph::test
