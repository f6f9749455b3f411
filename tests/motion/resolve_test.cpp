// Selectors and the one rule per patch, on meshes that are only names and ranges.
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/motion/motion.hpp>

#include <cmath>

namespace gridmorph {
namespace {

using test::expect_all_in;
using test::message_of;

Patch make_patch(std::string name, PatchKind kind, std::vector<std::string> families, int axis, int side,
                 int zone = 0) {
  Patch p{std::move(name), "", kind, std::move(families), zone, {{0, 0, 0}, {5, 5, 5}}};
  (side == 0 ? p.range.end[axis] : p.range.begin[axis]) = side == 0 ? 1 : 4;
  return p;
}

/// Interface from one k face of a zone to another's, node (i, j) to node (i, j).
Interface1to1 make_interface(std::string name, int zone, int side, int donor, int donor_side, bool periodic) {
  Interface1to1 i;
  i.name = std::move(name);
  i.zone = zone;
  i.donor_zone = donor;
  i.range = make_patch("", PatchKind::other, {}, 2, side).range;
  i.to_donor.own_origin = {0, 0, side == 0 ? 0 : 4};
  i.to_donor.donor_origin = {0, 0, donor_side == 0 ? 0 : 4};
  if (periodic) i.periodic.emplace();
  return i;
}

/// Two zones, periodic in k within each, joined by nothing else than a plain interface for the names' sake.
Mesh names() {
  Mesh m;
  m.add_zone("stator", {5, 5, 5});
  m.add_zone("rotor", {5, 5, 5});
  m.coordinates = Coordinates(m.n_nodes());
  m.patches = {make_patch("bc_in", PatchKind::inflow, {"INLET"}, 0, 0),
               make_patch("mix_up", PatchKind::connection, {}, 0, 1),
               make_patch("hub", PatchKind::wall, {"ENDWALL"}, 1, 0),
               make_patch("case", PatchKind::wall, {"ENDWALL", "CASE"}, 1, 1),
               make_patch("mix_down", PatchKind::connection, {}, 0, 0, 1),
               make_patch("ENDWALL", PatchKind::outflow, {}, 0, 1, 1),
               make_patch("sym", PatchKind::symmetry, {}, 1, 0, 1),
               make_patch("hub", PatchKind::wall, {}, 1, 1, 1)};
  m.interfaces = {make_interface("per_1", 0, 0, 0, 1, true), make_interface("per_2", 0, 1, 0, 0, true),
                  make_interface("per_1", 1, 0, 1, 1, true), make_interface("per_2", 1, 1, 1, 0, true),
                  make_interface("inner", 0, 0, 1, 1, false)};
  return m;
}

using Numbers = std::vector<int>;

TEST(SelectPatches, FamiliesComeBeforeBcNames) {
  EXPECT_EQ(select_patches(names(), {"ENDWALL"}), (Numbers{2, 3}));  // not the BC of that name
  EXPECT_EQ(select_patches(names(), {"CASE"}), (Numbers{3}));        // an additional family
  EXPECT_EQ(select_patches(names(), {"hub"}), (Numbers{2, 7}));
  EXPECT_EQ(select_patches(names(), {"rotor/hub"}), (Numbers{7}));
  EXPECT_EQ(select_patches(names(), {"mix_up"}), (Numbers{1}));
}

TEST(SelectPatches, UnderstandsGlobs) {
  EXPECT_EQ(select_patches(names(), {"mix_*"}), (Numbers{1, 4}));
  EXPECT_EQ(select_patches(names(), {"h?b"}), (Numbers{2, 7}));
  EXPECT_EQ(select_patches(names(), {"*L*"}), (Numbers{0, 2, 3}));  // INLET and ENDWALL, families only
  EXPECT_EQ(select_patches(names(), {"s*m", "bc_**in"}), (Numbers{0, 6}));
  EXPECT_THROW(select_patches(names(), {"h?"}), MotionError);
  EXPECT_THROW(select_patches(names(), {"Hub"}), MotionError);  // case-sensitive
}

TEST(SelectPatches, AddressesEveryKindByType) {
  Mesh m = names();
  m.patches.push_back(make_patch("far", PatchKind::farfield, {}, 1, 0));
  m.patches.push_back(make_patch("pole", PatchKind::degenerate, {}, 1, 0));
  m.patches.push_back(make_patch("what", PatchKind::other, {}, 1, 0));
  EXPECT_EQ(select_patches(m, {"type:wall"}), (Numbers{2, 3, 7}));
  EXPECT_EQ(select_patches(m, {"type:inflow", "type:outflow"}), (Numbers{0, 5}));
  EXPECT_EQ(select_patches(m, {"type:symmetry"}), (Numbers{6}));
  EXPECT_EQ(select_patches(m, {"type:connection"}), (Numbers{1, 4}));
  EXPECT_EQ(select_patches(m, {"type:farfield"}), (Numbers{8}));
  EXPECT_EQ(select_patches(m, {"type:degenerate"}), (Numbers{9}));
  EXPECT_EQ(select_patches(m, {"type:other"}), (Numbers{10}));
}

TEST(SelectPatches, ListsWhatThereIsWhenNothingMatches) {
  auto const text = message_of<MotionError>([] { select_patches(names(), {"blade", "type:wal", "per_1"}); });
  expect_all_in(text, {"'blade'", "'ENDWALL'", "'INLET'", "type:wall", "'wal'", "'per_1' names interfaces"});
}

MotionRule rule(std::vector<std::string> patches, Rule r, std::string where = "") {
  return {std::move(patches), std::move(r), 0, std::move(where)};
}

TEST(Resolve, GivesPatchesWithoutRuleTheDefaultOfTheirType) {
  Motion motion;
  motion.rules = {rule({"hub"}, SlipRule{.surface = SlipRule::Surface::revolution})};
  ResolvedMotion const r = resolve(names(), motion);
  EXPECT_EQ(r.patch[2].rule, 0);
  EXPECT_EQ(r.patch[7].rule, 0);
  EXPECT_FALSE(r.patch[2].by_default);
  ASSERT_TRUE(std::holds_alternative<SlipRule>(r.patch_rule(6)));
  EXPECT_EQ(std::get<SlipRule>(r.patch_rule(6)).surface, SlipRule::Surface::plane);
  for (int p : {0, 1, 3, 4, 5}) {
    EXPECT_TRUE(r.patch[p].by_default);
    EXPECT_TRUE(std::holds_alternative<FixedRule>(r.patch_rule(p)));
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(r.interface[i].rule, -1);
    EXPECT_TRUE(r.interface[i].by_default);
  }
  EXPECT_EQ(r.interface[4].rule, -1);
  std::string notes;
  for (auto const& n : r.notes) notes += n + "\n";
  expect_all_in(notes, {"'sym'", "slip on their own plane", "'INLET'", "fixed", "'per_1'", "freely as one"});
}

TEST(Resolve, StrictMotionNamesEveryPatchWithoutRule) {
  Motion motion;
  motion.strict = true;
  motion.rules = {rule({"type:wall", "type:connection"}, FixedRule{})};
  auto const text = message_of<MotionError>([&] { resolve(names(), motion); });
  expect_all_in(text, {"'sym'", "'INLET'", "'ENDWALL'", "'per_1'", "strict"});
  EXPECT_EQ(text.find("mix_up"), std::string::npos);

  motion.rules = {rule({"type:wall", "type:connection", "type:inflow", "type:outflow"}, FixedRule{}),
                  rule({"type:symmetry"}, SlipRule{}), rule({"type:periodic"}, FreeRule{})};
  EXPECT_NO_THROW(resolve(names(), motion));
}

TEST(Resolve, TwoRulesOnOnePatchAreAnErrorThatNamesAllThree) {
  Motion motion;
  motion.rules = {rule({"type:wall"}, FixedRule{}, "case.toml:3"), rule({"CASE"}, RigidRule{}, "case.toml:9")};
  expect_all_in(message_of<MotionError>([&] { resolve(names(), motion); }),
                {"rule 1 (fixed, case.toml:3)", "rule 2 (rigid, case.toml:9)", "BC 'case'", "zone 'stator'"});
}

TEST(Resolve, ARuleOnOneSideOfAPeriodicInterfaceHoldsForTheOther) {
  Motion motion;
  motion.rules = {rule({"stator/per_1"}, FixedRule{}), rule({"rotor/per_2"}, RigidRule{})};
  ResolvedMotion const r = resolve(names(), motion);
  EXPECT_EQ(r.interface[0].rule, 0);
  EXPECT_EQ(r.interface[1].rule, 0);
  EXPECT_EQ(r.interface[2].rule, 1);
  EXPECT_EQ(r.interface[3].rule, 1);
  EXPECT_FALSE(r.interface[1].by_default);
}

TEST(Resolve, TheTwoSidesOfAPeriodicInterfaceCannotHaveTwoRules) {
  Motion motion;
  motion.rules = {rule({"per_1"}, FixedRule{}), rule({"per_2"}, RigidRule{})};
  expect_all_in(message_of<MotionError>([&] { resolve(names(), motion); }),
                {"rule 1 (fixed)", "rule 2 (rigid)", "'per_"});
}

TEST(Resolve, AFreePeriodicInterfaceHasNoRule) {
  Motion motion;
  motion.rules = {rule({"type:periodic"}, FreeRule{})};
  ResolvedMotion const r = resolve(names(), motion);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(r.interface[i].rule, -1);
    EXPECT_FALSE(r.interface[i].by_default);
  }
}

TEST(Resolve, PlainInterfacesAndSlippingPeriodicsAreRefused) {
  Motion motion;
  motion.rules = {rule({"inner"}, FixedRule{}), rule({"type:periodic"}, SlipRule{})};
  expect_all_in(message_of<MotionError>([&] { resolve(names(), motion); }),
                {"plain interface 'inner'", "zone 'rotor'", "rule 2 (slip)", "periodic interface 'per_1'"});
}

TEST(Resolve, ReportsAllProblemsAtOnce) {
  Motion motion;
  motion.axis.direction = {0, 0, 0};
  RigidRule broken;
  broken.matrix.m[1][2] = std::nan("");
  motion.rules = {rule({"nobody"}, FixedRule{}, "a.toml:1"),
                  rule({"hub"}, broken, "a.toml:2"),
                  rule({}, FixedRule{}, "a.toml:3"),
                  rule({"CASE"}, FunctionRule{}, "a.toml:4"),
                  rule({"INLET"}, CircumferentialSlideRule{{"blade"}}, "a.toml:5"),
                  rule({"mix_up"}, FollowRule{{"sym"}}, "a.toml:6"),
                  rule({"type:nothing"}, FixedRule{}, "a.toml:7")};
  expect_all_in(message_of<MotionError>([&] { resolve(names(), motion); }),
                {"axis", "'nobody'", "a.toml:2", "not finite", "a.toml:3", "names no patches", "a.toml:4",
                 "no function", "'blade'", "a.toml:6", "has the rule 'slip'", "a.toml:7", "'nothing'"});
}

TEST(Resolve, APlainInterfaceOfTheSameFamilyDoesNotDisturb) {
  Mesh m = names();
  for (auto& i : m.interfaces) i.families = {"row"};
  Motion motion;
  motion.rules = {rule({"row"}, FixedRule{})};
  ResolvedMotion const r = resolve(m, motion);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(r.interface[i].rule, 0);
  EXPECT_EQ(r.interface[4].rule, -1);
}

TEST(Resolve, APolarLineIsNoPlaneToSlipOn) {
  Mesh m = names();
  m.patches[6].bc_type = "BCSymmetryPolar";
  EXPECT_TRUE(std::holds_alternative<FixedRule>(resolve(m, {}).patch_rule(6)));
}

TEST(Resolve, AMeshWithoutPatchesNeedsNoRules) { EXPECT_TRUE(resolve(Mesh{}, {}).rules.empty()); }

}  // namespace
}  // namespace gridmorph
