// Plans kept in files: equal to the ones that were saved, and refused for anything but what they were made for.
#include "invariants/cases.hpp"
#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/temporary_folder.hpp"

#include <gridmorph/motion/rigid_motion.hpp>
#include <gridmorph/plan/plan_file.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

namespace gridmorph::test {
namespace {

/// A periodic sector whose hub and case the flow slides on, with a near field at the inlet.
Case sliding_sector() {
  Sector const shape;
  Case c;
  c.name = "sliding_sector";
  c.mesh = [=] { return annulus_sector(shape, 1); };
  c.motion = [=](double factor) {
    Motion m = motion({rule({"inlet", "outlet"}, function_rule(scaled(factor, turning_waves(shape, 0.05)))),
                       rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
    m.axis = {shape.origin, shape.axis};
    return m;
  };
  c.options.boundary_layers = {{{"inlet"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  return c;
}

/// The same on the smooth surface through the nodes of hub and case.
Case sliding_on_baseline() {
  Case c = sliding_sector();
  c.name = "sliding_on_baseline";
  c.motion = [=, revolution = c.motion](double factor) {
    Motion m = revolution(factor);
    m.rules[1].rule = SlipRule{SlipRule::Surface::baseline};
    return m;
  };
  return c;
}

std::vector<Case> cases() {
  std::vector<Case> list = make_cases();
  list.push_back(sliding_sector());
  list.push_back(sliding_on_baseline());
  return list;
}

class KeptPlan : public testing::TestWithParam<Case> {};

TEST_P(KeptPlan, MorphsBitForBitLikeTheOneThatWasSaved) {
  Case const& c = GetParam();
  TemporaryFolder const folder;
  Mesh mesh = c.mesh();
  PlanKey const key = plan_key(mesh, c.motion(1), c.options);
  PreparedMorph const prepared = prepare(mesh, c.motion(1), c.options);
  std::vector<Vec3> const boundary = prepared.boundary_displacement(mesh);
  save_plan(folder / "plan", prepared.plan(), key);

  // As another run would do it: nothing is prepared.
  Mesh const again = c.mesh();
  Plan const plan = load_plan(folder / "plan", plan_key(again, c.motion(1), c.options));

  Kokkos::DefaultHostExecutionSpace const exec;
  Morphed const expected = run_plan(exec, mesh, prepared.plan(), boundary);
  Morphed const found = run_plan(exec, again, plan, boundary);
  EXPECT_EQ(different_bits(found.displacement, expected.displacement), 0);
  EXPECT_EQ(different_bits(found.position, expected.position), 0);
  EXPECT_EQ(describe(plan), describe(prepared.plan()));
  EXPECT_EQ(plan.notes, prepared.plan().notes);
  EXPECT_EQ(plan.boundary_nodes, prepared.plan().boundary_nodes);
  save_plan(folder / "copy", plan, key);
  EXPECT_EQ(bytes_of(folder / "copy"), bytes_of(folder / "plan"));
  EXPECT_EQ(folder.names().size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(OfEveryMesh, KeptPlan, testing::ValuesIn(cases()),
                         [](auto const& test) { return test.param.name; });

TEST(KeptPlan, OfARunWithOtherDisplacementsServesThisOne) {
  Case const c = sliding_sector();
  TemporaryFolder const folder;
  Mesh mesh = c.mesh();
  PlanKey const key = plan_key(mesh, c.motion(1), c.options);
  save_plan(folder / "plan", prepare(mesh, c.motion(1), c.options).plan(), key);

  Outcome const expected = morph(c.mesh(), c.motion(-0.4), c.options);
  Mesh const again = c.mesh();
  Plan const plan = load_plan(folder / "plan", plan_key(again, c.motion(-0.4), c.options));
  Morphed const found = run_plan(Kokkos::DefaultHostExecutionSpace(), again, plan, expected.boundary);
  EXPECT_EQ(different_bits(found.position, expected.morphed.position), 0);
}

/// Everything that makes a plan.
struct Input {
  Mesh mesh = annulus_sector({}, 1);
  Motion motion = sliding_sector().motion(1);
  PlanOptions options = sliding_sector().options;
  [[nodiscard]] PlanKey key() const { return plan_key(mesh, motion, options); }
};

struct Change {
  std::string name;
  std::function<void(Input&)> make;
  char const* what;  ///< words of the message; null: no reason to refuse
};

char const *const structure = "zones, patches or interfaces", *const coordinates = "coordinates of the mesh",
                  *const rules = "motion rules", *const options = "plan options";

std::vector<Change> changes() {
  return {
      {"nothing", [](Input&) {}, nullptr},
      {"zone_name", [](Input& i) { i.mesh.zones[0].name += "x"; }, structure},
      {"zone_extent", [](Input& i) { std::swap(i.mesh.zones[0].extent[0], i.mesh.zones[0].extent[2]); }, structure},
      {"precision_of_file", [](Input& i) { i.mesh.zones[0].single_precision = true; }, structure},
      {"zone_more",
       [](Input& i) {
         i.mesh.add_zone("more", {2, 2, 2});
       },
       structure},
      {"patch_family", [](Input& i) { i.mesh.patches[0].families = {"other"}; }, structure},
      {"patch_kind", [](Input& i) { i.mesh.patches[0].kind = PatchKind::symmetry; }, structure},
      {"patch_range", [](Input& i) { --i.mesh.patches[0].range.end[1]; }, structure},
      {"patch_order", [](Input& i) { std::swap(i.mesh.patches[0], i.mesh.patches[1]); }, structure},
      {"interface_gone", [](Input& i) { i.mesh.interfaces.pop_back(); }, structure},
      {"interface_orientation", [](Input& i) { i.mesh.interfaces[0].to_donor.orientation.sign[0] *= -1; }, structure},
      {"interface_not_periodic",
       [](Input& i) {
         for (Interface1to1& interface : i.mesh.interfaces) interface.periodic.reset();
       },
       structure},
      {"last_bit_of_a_node",
       [](Input& i) {
         double& z = i.mesh.coordinates.z(i.mesh.n_nodes() - 1);
         z = std::nextafter(z, 100);
       },
       coordinates},
      {"nodes_swapped",
       [](Input& i) {
         Vec3 const p = i.mesh.coordinates[0];
         i.mesh.coordinates.set(0, i.mesh.coordinates[1]);
         i.mesh.coordinates.set(1, p);
       },
       coordinates},
      {"components_swapped", [](Input& i) { std::swap(i.mesh.coordinates.x, i.mesh.coordinates.y); }, coordinates},
      {"rule_kind", [](Input& i) { i.motion.rules[0].rule = FixedRule{}; }, rules},
      {"rule_gone", [](Input& i) { i.motion.rules.pop_back(); }, rules},
      {"rule_order", [](Input& i) { std::swap(i.motion.rules[0], i.motion.rules[1]); }, rules},
      {"rule_patches", [](Input& i) { i.motion.rules[0].patches = {"inlet"}; }, rules},
      {"rule_patches_cut_elsewhere", [](Input& i) { i.motion.rules[0].patches = {"inletoutlet"}; }, rules},
      {"rule_rank", [](Input& i) { i.motion.rules[0].rank = 1; }, rules},
      {"slip_surface", [](Input& i) { i.motion.rules[1].rule = SlipRule{}; }, rules},
      {"slip_profile",
       [](Input& i) {
         std::get<SlipRule>(i.motion.rules[1].rule).profile = {{0, 1}, {1, 1.5}};
       },
       rules},
      {"slip_crease", [](Input& i) { std::get<SlipRule>(i.motion.rules[1].rule).crease_angle_rad = 0.7; }, rules},
      {"slip_plane",
       [](Input& i) {
         std::get<SlipRule>(i.motion.rules[1].rule).plane = {{Vec3{}, Vec3{0, 0, 1}}};
       },
       rules},
      {"free_constraint", [](Input& i) { i.motion.rules[1].rule = FreeRule{FreeRule::Constraint::plane}; }, rules},
      {"axis", [](Input& i) { i.motion.axis.origin.y += 1e-12; }, rules},
      {"strict", [](Input& i) { i.motion.strict = true; }, rules},
      {"law", [](Input& i) { i.options.volume.law = Law::c1; }, options},
      {"priority", [](Input& i) { std::swap(i.options.volume.priority[1], i.options.volume.priority[2]); }, options},
      {"kind_order",
       [](Input& i) {
         i.options.volume.priority[0].order = {"inflow", "wall"};
       },
       options},
      {"near_field_gone", [](Input& i) { i.options.boundary_layers.clear(); }, options},
      {"near_field_layers", [](Input& i) { i.options.boundary_layers[0].layers = 2; }, options},
      {"near_field_walls", [](Input& i) { i.options.boundary_layers[0].walls = {"outlet"}; }, options},
      {"matching_tolerance", [](Input& i) { i.options.topology.matching_tolerance = 1e-5; }, options},
      {"open_faces", [](Input& i) { i.options.topology.open_faces = "open"; }, options},
      {"field", [](Input& i) { i.motion.rules[0].rule = function_rule(waves(3)); }, nullptr},
      {"field_description",
       [](Input& i) { std::get<FunctionRule>(i.motion.rules[0].rule).description = "formula dx = 2"; }, nullptr},
      {"place_in_case_file", [](Input& i) { i.motion.rules[0].where = "case.toml:99"; }, nullptr},
      {"conformity_tolerance", [](Input& i) { i.motion.conformity_tolerance = 1e-3; }, nullptr},
      {"notes_and_source",
       [](Input& i) {
         i.mesh.notes.emplace_back("read twice");
         i.mesh.source = "elsewhere.cgns";
       },
       nullptr},
  };
}

void PrintTo(Change const& change, std::ostream* out) { *out << change.name; }

class ChangedInput : public testing::TestWithParam<Change> {};

TEST_P(ChangedInput, IsNamedAndRefusedOnlyWhereThePlanDependsOnIt) {
  TemporaryFolder const folder;
  Input input;
  PlanKey const key = input.key();
  save_plan(folder / "plan", prepare(input.mesh, input.motion, input.options).plan(), key);

  Input changed;
  GetParam().make(changed);
  if (GetParam().what == nullptr) {
    EXPECT_NO_THROW(load_plan(folder / "plan", changed.key()));
    return;
  }
  std::string const message = message_of<PlanError>([&] { load_plan(folder / "plan", changed.key()); });
  for (char const* what : {structure, coordinates, rules, options})
    EXPECT_EQ(message.find(what) != std::string::npos, what == GetParam().what) << what << " in:\n" << message;
  expect_all_in(message, {(folder / "plan").string(), "Plan again"});
}

INSTANTIATE_TEST_SUITE_P(Of, ChangedInput, testing::ValuesIn(changes()),
                         [](auto const& test) { return test.param.name; });

TEST(PlanKey, ForgetsTheMatrixOfARigidRuleButNotThatItIsRigid) {
  Input input;
  RigidSteps steps;
  steps.translation = {1, 2, 3};
  input.motion.rules[0].rule = make_rigid(steps);
  PlanKey const key = input.key();
  steps.angle_rad = 0.3;
  input.motion.rules[0].rule = make_rigid(steps);
  EXPECT_EQ(input.key(), key);
  input.motion.rules[0].rule = FixedRule{};
  EXPECT_NE(input.key(), key);
}

TEST(PlanKey, NamesAllThatChangedInOneMessage) {
  TemporaryFolder const folder;
  Input input;
  PlanKey const key = input.key();
  save_plan(folder / "plan", prepare(input.mesh, input.motion, input.options).plan(), key);
  Input changed;
  changed.mesh.coordinates.x(7) += 1;
  changed.motion.rules[0].rank = 3;
  changed.options.volume.law = Law::c2;
  std::string const message = message_of<PlanError>([&] { load_plan(folder / "plan", changed.key()); });
  expect_all_in(message, {coordinates, rules, options});
  EXPECT_EQ(message.find(structure), std::string::npos) << message;
}

TEST(PlanKey, OfAnotherMeshIsNotSaved) {
  TemporaryFolder const folder;
  Input input;
  PlanKey key = input.key();
  key.n_nodes += 1;
  Plan const plan = prepare(input.mesh, input.motion, input.options).planned.plan;
  expect_all_in(message_of<PlanError>([&] { save_plan(folder / "plan", plan, key); }),
                {std::to_string(plan.n_nodes), std::to_string(key.n_nodes)});
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace gridmorph::test
