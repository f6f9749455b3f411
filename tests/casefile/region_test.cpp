// [[region]] tables become the regions they say.
#include "case_text.hpp"

#include <gridmorph/motion/shock/shock_search.hpp>

namespace gridmorph::test {
namespace {

std::string const mesh_and_rule =
    "[mesh]\ninput = \"in.cgns\"\naxis = \"x\"\n[[motion]]\npatches = \"blade\"\nrule = \"fixed\"\n";

InnerRegion region_of(std::string const& lines) {
  return parse_case_file(mesh_and_rule + "[[region]]\nname = \"part\"\n" + lines, "case.toml").motion.regions.at(0);
}

TEST(RegionText, ConditionsThatStandTogetherMustAllHold) {
  InnerRegion const r = region_of(
      "box = { from = [0, -1, -1], to = [1, 1, 1] }\nsphere = { centre = [0.5, 0, 0], radius = 0.9 }\n"
      "axial = [0.2, 5]\nradius = [0.3, 0.8]");
  EXPECT_EQ(r.name, "part");
  EXPECT_EQ(r.where, "case.toml:7");
  EXPECT_TRUE(r.holds({0.5, 0.5, 0}));
  EXPECT_FALSE(r.holds({1.2, 0.5, 0}));    // box
  EXPECT_FALSE(r.holds({0.9, 0.6, 0.6}));  // sphere and radius
  EXPECT_FALSE(r.holds({0.1, 0.5, 0}));    // axial
  EXPECT_FALSE(r.holds({0.5, 0.1, 0}));    // radius
}

TEST(RegionText, NodesAreCountedFromOneAndBothEndsBelongToThem) {
  InnerRegion const r = region_of("zones = \"Zone 3\"\nnodes = { from = [1, 2, 5], to = [33, 17, 5] }");
  ASSERT_TRUE(r.nodes);
  EXPECT_EQ(*r.nodes, (IndexRange{{0, 1, 4}, {33, 17, 5}}));
  EXPECT_FALSE(r.holds);
}

TEST(RegionText, ThoseThatAreOnlyMeasuredAreNoPartOfTheMotion) {
  CaseFile const c = parse_case_file(mesh_and_rule +
                                         "[[region]]\nname = \"wake\"\nzones = \"a\"\nonly_measured = true\n"
                                         "[[region]]\nname = \"tip\"\nzones = \"b\"\n",
                                     "case.toml");
  ASSERT_EQ(c.motion.regions.size(), 1U);
  EXPECT_EQ(c.motion.regions[0].name, "tip");
  ASSERT_EQ(c.measured_regions.size(), 1U);
  EXPECT_EQ(c.measured_regions[0].name, "wake");
  auto const problems =
      problems_of(mesh_and_rule +
                  "[[region]]\nname = \"a\"\nzones = \"z\"\nnodes = { from = [1, 1, 5], to = [9, 9, 5] }\n"
                  "only_measured = true\n");
  EXPECT_TRUE(reported(problems, "case.toml:11", {"surface of the grid"}));
}

TEST(RegionText, EveryProblemIsReportedWithItsLine) {
  auto const problems =
      problems_of(mesh_and_rule +
                  "[[region]]\nname = \"a\"\n"
                  "[[region]]\nname = \"b\"\nbox = { from = [1, 0, 0], to = [0, 1, 1] }\n"
                  "[[region]]\nzones = [\"x\", \"y\"]\nnodes = { from = [0, 1, 1], to = [2.5, 2, 2] }\n"
                  "[[region]]\nname = \"d\"\nradius = [2, 1]\n");
  EXPECT_TRUE(reported(problems, "case.toml:8", {"say where the region lies"}));
  EXPECT_TRUE(reported(problems, "case.toml:11", {"from its smaller to its larger"}));
  EXPECT_TRUE(reported(problems, "case.toml:12", {"name"}));
  EXPECT_TRUE(reported(problems, "case.toml:14", {"whole numbers from 1 on, found 0"}));
  EXPECT_TRUE(reported(problems, "case.toml:14", {"whole numbers from 1 on, found 2.5"}));
  EXPECT_TRUE(reported(problems, "case.toml:14", {"those of one zone"}));
  EXPECT_TRUE(reported(problems, "case.toml:17", {"the smaller one first"}));
}

TEST(AttachedRuleText, IsRead) {
  auto const rule = std::get<AttachedRule>(rule_of(
      "rule = \"attached\"\nof = [\"a\", \"b\"]\nhow = \"shift\"\nnear = { point = [1, 2, 3], distance = 0.5 }"));
  EXPECT_EQ(rule.of, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(rule.how, AttachedRule::How::shift);
  ASSERT_TRUE(rule.near);
  EXPECT_EQ(rule.near->first, (Vec3{1, 2, 3}));
  EXPECT_EQ(rule.near->second, 0.5);
}

TEST(RegionText, AShockIsASearchInASolution) {
  TemporaryFolder const folder;
  auto const flow = folder.write("flow.cgns", "").string();
  InnerRegion const r = region_of("zones = \"wing*\"\nshock = { file = \"" + flow +
                                  "\", solution = \"last\", sensor = \"jump\", variable = "
                                  "\"Density\", threshold = 0.2, heat_ratio = 1.3, smallest = 3, grow = 2 }");
  ASSERT_NE(r.shock, nullptr);
  EXPECT_EQ(r.shock->file, flow);
  EXPECT_EQ(r.shock->solution, "last");
  EXPECT_EQ(r.shock->sensor, ShockSearch::Sensor::jump);
  EXPECT_EQ(r.shock->variable, "Density");
  EXPECT_EQ(r.shock->least(), 0.2);
  EXPECT_EQ(r.shock->heat_ratio, 1.3);
  EXPECT_EQ(r.shock->smallest, 3);
  EXPECT_EQ(r.shock->grow, 2);
  InnerRegion const plain = region_of("shock = {}");
  EXPECT_EQ(plain.shock->sensor, ShockSearch::Sensor::normal_mach);
  EXPECT_EQ(plain.shock->least(), 1);
  EXPECT_EQ(plain.shock->compression, 0.05);
  CaseFile const read = parse_case_file(
      mesh_and_rule + "[[region]]\nname = \"part\"\nshock = { file = \"flow.cgns\" }\n", folder.path("case.toml"));
  EXPECT_EQ(read.files, std::vector<std::filesystem::path>{flow});  // so that no output takes its place
}

TEST(RegionText, EveryProblemOfAShockIsReportedWithItsLine) {
  auto const problems =
      problems_of(mesh_and_rule +
                  "[[region]]\nname = \"a\"\nshock = { sensor = \"jmup\" }\n"
                  "[[region]]\nname = \"b\"\nshock = { variable = \"Mach\", threshold = 0, grow = -1, smallest = 0 }\n"
                  "[[region]]\nname = \"c\"\nshock = { sensor = \"jump\", compression = 0.1, heat_ratio = 1 }\n"
                  "[[motion]]\npatches = \"a\"\nrule = \"shock\"\nfade = 0.1\n"
                  "[[motion]]\npatches = \"b\"\nrule = \"shock\"\nto = \"x.cgns\"\nof = \"blade\"\nsmooth = "
                  "-1\ndirection = [0, 0, 0]\n");
  EXPECT_TRUE(reported(problems, "case.toml:9", {"sensor", "jump"}));
  EXPECT_TRUE(reported(problems, "case.toml:12", {"variable", "is of sensor"}));
  EXPECT_TRUE(reported(problems, "case.toml:12", {"threshold", "positive"}));
  EXPECT_TRUE(reported(problems, "case.toml:12", {"grow", "0 to 1000"}));
  EXPECT_TRUE(reported(problems, "case.toml:12", {"smallest", "1 cell"}));
  EXPECT_TRUE(reported(problems, "case.toml:15", {"compression", "is of sensor"}));
  EXPECT_TRUE(reported(problems, "case.toml:15", {"heat_ratio", "larger than 1"}));
  EXPECT_TRUE(reported(problems, "case.toml:16", {"to", "new_flow.cgns"}));
  EXPECT_TRUE(reported(problems, "case.toml:19", {"of and fade belong together"}));
  EXPECT_TRUE(reported(problems, "case.toml:24", {"of and fade belong together"}));
  EXPECT_TRUE(reported(problems, "case.toml:25", {"smooth", "positive length"}));
  EXPECT_TRUE(reported(problems, "case.toml:26", {"direction", "no length"}));
}

TEST(RegionText, TheRuleShockNamesTheFileThatItGoesTo) {
  TemporaryFolder const folder;
  auto const to = folder.write("new.cgns", "");
  CaseFile const c = parse_case_file(
      mesh_and_rule +
          "[[region]]\nname = \"part\"\nshock = {}\n[[motion]]\npatches = \"part\"\nrule = \"shock\"\nto = "
          "\"new.cgns\"\nsolution = \"last\"\ndirection = [0, 2, 0]\nsmooth = 0.5\nof = \"blade\"\nfade = 0.25\n",
      folder.path("case.toml"));
  ASSERT_EQ(c.shock_follows.size(), 1U);
  ShockFollow const& follow = c.shock_follows[0];
  EXPECT_EQ(follow.rule, 1U);
  EXPECT_EQ(follow.to, to);
  EXPECT_EQ(follow.solution, "last");
  EXPECT_EQ(*follow.direction, (Vec3{0, 2, 0}));
  EXPECT_EQ(*follow.smooth, 0.5);
  auto const& rule = std::get<ShockRule>(c.motion.rules[1].rule);
  EXPECT_EQ(rule.of, std::vector<std::string>{"blade"});
  EXPECT_EQ(rule.fade, 0.25);
  EXPECT_EQ(std::get<ShockRule>(fraction_of(c, 0.5).rules[1].rule).share, 0.5);
}

}  // namespace
}  // namespace gridmorph::test
