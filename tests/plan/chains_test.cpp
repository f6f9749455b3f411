// Which chains a plan has, in which order, and why.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/scramble.hpp"

#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::test {
namespace {

std::string first_description(Plan const& plan) { return plan.stages.at(0).description.at(0); }

/// A straight box whose six faces are all known, of the given kinds.
Plan plan_of_box(std::array<PatchKind, 6> const& kinds, VolumeOptions const& volume = {}) {
  Bricks b;
  b.name = "box";
  b.extent = {9, 7, 5};
  b.position = [](Vec3 const& q) { return Vec3{2 * q.x, q.y, 1.2 * q.z}; };
  b.kind = kinds;
  Mesh mesh = make(b);
  PlanOptions options;
  options.volume = volume;
  return prepare(mesh, motion({rule({"*"}, FixedRule{})}), options).plan();
}

int nodes_along(Plan const& plan) { return plan.stages.at(0).lines.chains.at(0).n_s; }

constexpr auto wall = PatchKind::wall;
constexpr auto inflow = PatchKind::inflow;
constexpr auto outflow = PatchKind::outflow;
constexpr auto far = PatchKind::farfield;

TEST(Priority, TheBetterEndDecidesThenTheOtherOne) {
  EXPECT_EQ(nodes_along(plan_of_box({inflow, inflow, wall, far, outflow, outflow})), 7) << "the only wall";
  EXPECT_EQ(nodes_along(plan_of_box({wall, far, outflow, wall, wall, inflow})), 5) << "wall to inflow";
  EXPECT_EQ(nodes_along(plan_of_box({wall, wall, inflow, wall, wall, inflow})), 9) << "wall to wall";
  EXPECT_EQ(nodes_along(plan_of_box({far, far, far, far, far, outflow})), 5) << "kinds not listed come last";
}

TEST(Priority, TheOrderOfKindsIsTheUsers) {
  VolumeOptions volume;
  volume.priority = {{PriorityRule::Kind::boundary, {"outflow", "inflow", "wall"}}};
  EXPECT_EQ(nodes_along(plan_of_box({wall, wall, inflow, inflow, far, outflow}, volume)), 5);
  EXPECT_EQ(nodes_along(plan_of_box({wall, wall, inflow, inflow, far, far}, volume)), 7);
}

TEST(Priority, PatchesThatItNamesComeBeforeAllKinds) {
  std::array<PatchKind, 6> const kinds{wall, wall, inflow, far, outflow, far};
  EXPECT_EQ(nodes_along(plan_of_box(kinds)), 9) << "wall to wall";
  auto const with = [&](std::vector<std::string> const& patches) {
    VolumeOptions volume;
    volume.priority = {{PriorityRule::Kind::boundary, standard_order(), patches}};
    return nodes_along(plan_of_box(kinds, volume));
  };
  EXPECT_EQ(with({"w_max"}), 5);
  EXPECT_EQ(with({"v_*"}), 7);
  EXPECT_EQ(with({"v_max", "w_max"}), 7) << "in the order given";
  EXPECT_EQ(with({"w_max", "v_max"}), 5);
  EXPECT_EQ(with({"v_max", "w_*", "v_min"}), 7) << "the better end";
  EXPECT_THROW(with({"nowhere"}), Error);
}

TEST(Priority, TheShortestChainBreaksATie) {
  // 2 x 1 x 1.2: the lowest ratio of length to width is along v.
  EXPECT_EQ(nodes_along(plan_of_box({wall, wall, wall, wall, wall, wall})), 7);
  VolumeOptions volume;
  volume.priority = {{PriorityRule::Kind::aspect_ratio, {}}, {PriorityRule::Kind::boundary, {"wall"}}};
  EXPECT_EQ(nodes_along(plan_of_box({wall, wall, wall, wall, wall, wall}, volume)), 7);
}

TEST(Priority, TheChainWithTheWorstCellsComesFirst) {
  for (int skewed : {1, 2}) {
    Bricks b;
    b.name = "L";
    b.extent = {8, 7, 5};
    b.zones = {{{0, 0, 0}, {4, 4, 5}}, {{3, 0, 0}, {8, 4, 5}}, {{0, 3, 0}, {4, 7, 5}}};
    b.position = [skewed](Vec3 const& q) {
      Vec3 p{q.x, q.y, q.z};
      if (skewed == 1 && q.x > 0.5) p.z += 0.8 * (q.x - 0.5);
      if (skewed == 2 && q.y > 0.5) p.z += 0.8 * (q.y - 0.5);
      return p;
    };
    b.kind = {wall, wall, wall, wall, wall, wall};
    Mesh mesh = make(b);
    Plan const plan = prepare(mesh, motion({rule({"*"}, FixedRule{})}), {}).plan();
    std::string const first = first_description(plan);
    EXPECT_NE(first.find(skewed == 1 ? "'L2'" : "'L3'"), std::string::npos) << first;
    EXPECT_NE(first.find("smallest angle"), std::string::npos) << first;
    EXPECT_NE(first.find("wall to wall"), std::string::npos) << first;
  }
}

/// Three blocks, the one along +x skewed; its chains end on a far field, those of the others at walls.
Mesh skewed_branch() {
  Bricks b;
  b.name = "L";
  b.extent = {8, 7, 5};
  b.zones = {{{0, 0, 0}, {4, 4, 5}}, {{3, 0, 0}, {8, 4, 5}}, {{0, 3, 0}, {4, 7, 5}}};
  b.position = [](Vec3 const& q) { return Vec3{2 * q.x, 1.1 * q.y, q.z + (q.x > 0.5 ? 0.8 * (q.x - 0.5) : 0)}; };
  b.kind = {wall, far, far, wall, far, far};
  return make(b);
}

TEST(Priority, WhatTheUserPutsFirstRanksAllChains) {
  Mesh mesh = skewed_branch();
  Motion const all = motion({rule({"*"}, FixedRule{})});
  auto const first = [&](std::vector<PriorityRule> priority) {
    PlanOptions options;
    options.volume.priority = std::move(priority);
    return first_description(prepare(mesh, all, options).plan());
  };
  PriorityRule const boundary{PriorityRule::Kind::boundary, {"wall"}}, quality{PriorityRule::Kind::quality, {}},
      aspect_ratio{PriorityRule::Kind::aspect_ratio, {}};
  for (auto const& priority : {std::vector{boundary}, {boundary, quality}}) {
    std::string const text = first(priority);
    EXPECT_NE(text.find("'L3'"), std::string::npos) << text;
    EXPECT_NE(text.find("wall to wall"), std::string::npos) << text;
  }
  for (auto const& priority : {std::vector{quality}, {quality, boundary}, {quality, aspect_ratio}}) {
    std::string const text = first(priority);
    EXPECT_NE(text.find("'L2'"), std::string::npos) << "the worst cells first: " << text;
    EXPECT_EQ(text.find("wall to wall"), std::string::npos) << text;
  }
  for (auto const& priority : {std::vector{aspect_ratio}, {aspect_ratio, boundary}})
    EXPECT_EQ(first(priority).find("wall to wall"), std::string::npos) << "the shortest way: " << first(priority);
}

/// A box without any type in its file, of n cells along each direction, whose cells are clustered at both ends in w.
Mesh nameless_box(Index3 const& n, bool clustered) {
  Bricks b;
  b.name = "box";
  b.extent = {n[0] + 1, n[1] + 1, n[2] + 1};
  b.position = [clustered](Vec3 const& q) {
    double const w = clustered ? 0.5 * (1 + std::tanh(2.5 * (2 * q.z - 1)) / std::tanh(2.5)) : q.z;
    return Vec3{2 * q.x, q.y, 1.2 * w};
  };
  b.kind.fill(PatchKind::other);
  return make(b);
}

TEST(Priority, APatchWithoutATypeIsAWallWhereARuleMovesIt) {
  Mesh mesh = nameless_box({8, 6, 4}, false);
  auto const first = [&](std::vector<std::string> moving, std::vector<std::string> fixed) {
    return first_description(
        prepare(mesh,
                motion({rule(std::move(moving), function_rule(waves(0.01))), rule(std::move(fixed), FixedRule{})}),
                without_near_field())
            .plan());
  };
  std::string const u = first({"u_*"}, {"v_*", "w_*"}), w = first({"w_*"}, {"u_*", "v_*"});
  EXPECT_EQ(u.find("zone 'box1' [1:9, 1:7, 1:5]: wall to wall, aspect ratio 1.82"), 0u) << u;
  EXPECT_EQ(w.find("zone 'box1' [1:9, 1:7, 1:5]: wall to wall, aspect ratio 0.8"), 0u) << w;

  PlanOptions options;
  options.boundary_layers = {{{}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  Plan const plan = prepare(mesh, motion({rule({"v_min"}, function_rule(waves(0.01)))}), options).plan();
  EXPECT_EQ(plan.stages.at(0).name, "near field");
  EXPECT_EQ(plan.near_field.size(), 1u) << "walls of a boundary layer that names none";
}

TEST(Priority, APatchWithoutATypeIsAWallWhereItsCellsSaySo) {
  Motion const fixed = motion({rule({"*"}, FixedRule{})});
  Mesh even = nameless_box({8, 6, 16}, false), clustered = nameless_box({8, 6, 16}, true);
  EXPECT_NE(first_description(prepare(even, fixed, {}).plan()).find("other to other"), std::string::npos);
  std::string const across = first_description(prepare(clustered, fixed, {}).plan());
  EXPECT_NE(across.find("wall to wall, aspect ratio 0.8"), std::string::npos) << across;
  for (Patch& p : clustered.patches) p.kind = inflow;
  EXPECT_NE(first_description(prepare(clustered, fixed, {}).plan()).find("inflow to inflow"), std::string::npos)
      << "what the file says holds";

  Mesh const plain = nameless_box({8, 6, 16}, true);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Mesh cut = scramble(plain, {seed, 3}).mesh;
    Plan const plan = prepare(cut, fixed, {}).plan();
    EXPECT_EQ(plan.stages.at(0).lines.chains.at(0).n_s, 17) << "cuts hide no clustering; seed " << seed;
  }
}

TEST(Chains, RunThroughBlocksFromKnownFaceToKnownFace) {
  Mesh mesh = bricks_with_t_junctions(1);
  Plan const plan =
      prepare(mesh,
              motion({rule({"u_min", "u_max"}, FixedRule{}), rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})}),
              {})
          .plan();
  ASSERT_EQ(plan.stages.size(), 1u);
  ASSERT_EQ(plan.stages[0].lines.chains.size(), 1u) << "one block after merging, one chain";
  auto const& chain = plan.stages[0].lines.chains[0];
  EXPECT_EQ(chain.n_s, 9);
  EXPECT_EQ(chain.n_a * chain.n_b, 10 * 6);
  EXPECT_EQ(chain.first_side, -1) << "no side is known: a plain sweep";
}

TEST(Chains, CellsOfTheStagesCoverTheMeshOnce) {
  for (Mesh mesh : {bricks_with_t_junctions(1), around_a_box(1), star(5, 1), c_grid(1), l_shape(1)}) {
    Plan const plan = prepare(mesh, motion({rule({"*"}, FixedRule{})}), {}).plan();
    Index cells = 0;
    for (Stage const& stage : plan.stages)
      for (CellBox const& box : stage.cells) cells += box.cells.size();
    EXPECT_EQ(cells, mesh.n_cells()) << mesh.source;
  }
}

TEST(Chains, IndependentOnesShareAStage) {
  // Four corner blocks and four side blocks round a box: the sides first, wall to far field, all at once.
  Mesh mesh = around_a_box(1);
  for (Patch& p : mesh.patches)
    if (p.kind == inflow || p.kind == outflow) p.kind = far;
  Plan const plan = prepare(mesh,
                            motion({rule({"step", "u_min", "u_max", "v_min", "v_max"}, FixedRule{}),
                                    rule({"w_min", "w_max"}, FreeRule{})}),
                            {})
                        .plan();
  ASSERT_GE(plan.stages.size(), 2u);
  EXPECT_EQ(plan.stages[0].lines.chains.size(), 4u) << describe(plan);
  EXPECT_NE(plan.stages[0].description[0].find("wall"), std::string::npos);
}

TEST(Plan, DependsOnWhichFacesMoveNotOnHowFar) {
  Mesh mesh = star(5, 1);
  auto const plan = [&](double amplitude) {
    return prepare(mesh, motion({rule({"*"}, function_rule(waves(amplitude)))}), {}).plan();
  };
  Plan const still = plan(0), moving = plan(0.1);
  EXPECT_EQ(describe(still), describe(moving));
  EXPECT_EQ(still.boundary_nodes, moving.boundary_nodes);
}

TEST(Plan, OrderOfStagesDoesNotDependOnNumbering) {
  for (Mesh const& plain : {bricks_with_t_junctions(1), around_a_box(1), l_shape(1), c_grid(1)}) {
    Motion const m = motion({rule({"*"}, FixedRule{})});
    PlanOptions options;
    auto const shape = [&](Mesh mesh) {
      std::vector<std::vector<std::array<int, 3>>> stages;
      Plan const plan = prepare(mesh, m, options).plan();
      for (Stage const& stage : plan.stages) {
        stages.emplace_back();
        for (auto const& c : stage.lines.chains)
          stages.back().push_back({c.n_s, std::min(c.n_a, c.n_b), std::max(c.n_a, c.n_b)});
        std::sort(stages.back().begin(), stages.back().end());
      }
      return stages;
    };
    for (auto const leads : {PriorityRule::Kind::boundary, PriorityRule::Kind::quality}) {
      if (leads == PriorityRule::Kind::quality) options.volume.priority = {{leads, {}}};
      for (unsigned seed = 1; seed <= 6; ++seed)
        EXPECT_EQ(shape(plain), shape(scramble(plain, {seed, 3}).mesh)) << plain.source << ", seed " << seed;
    }
  }
}

TEST(Plan, DescribesStagesChainsAndReasons) {
  Mesh mesh = around_a_box(1);
  PlanOptions options;
  options.boundary_layers = {{{"step"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  std::string const text = describe(
      prepare(mesh,
              motion({rule({"step"}, function_rule(waves(0.01))),
                      rule({"u_min", "u_max", "v_min", "v_max"}, FixedRule{}), rule({"w_min", "w_max"}, FreeRule{})}),
              options)
          .plan());
  for (char const* part : {"near field", "stage 1", "zone 'around1'", "wall to farfield", "aspect ratio"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST(Plan, OfManyChainsHasAnOverviewAndTheFirstOfEachStage) {
  Plan const plan = prepare(around_a_box(1), motion({rule({"*"}, FixedRule{})}), {}).plan();
  std::size_t chains = 0, cut = 0;
  for (Stage const& stage : plan.stages) {
    chains += stage.description.size();
    cut += stage.description.size() > 1 ? 1 : 0;
  }
  ASSERT_GT(cut, 0U);
  auto const lines = [](std::string const& text, char const* with) {
    std::size_t n = 0;
    for (std::size_t at = text.find(with); at != std::string::npos; at = text.find(with, at + 1)) ++n;
    return n;
  };
  std::string const all = describe(plan), first = describe(plan, 1);
  EXPECT_EQ(lines(all, "\n  zone '"), chains);
  EXPECT_EQ(lines(first, "\n  zone '"), plan.stages.size());
  EXPECT_EQ(lines(first, "\n  and "), cut);
  std::string const table = overview(plan);
  EXPECT_EQ(lines(table, "\n"), plan.stages.size() + 1);
  EXPECT_NE(table.find("longest"), std::string::npos);
}

TEST(Plan, SaysWhereZonesTouchWithoutAnInterface) {
  auto const notes = [](PatchKind kind, Rule const& beside) {
    MeshBuilder builder("two");
    for (int z : {0, 1}) {
      builder.zone(z == 0 ? "left" : "right", {4, 4, 4}, [z](Index3 const& p) {
        return Vec3{double(p[0] + 3 * z), double(p[1]), double(p[2])};
      });
      for (int axis = 0; axis < 3; ++axis)
        for (int side : {0, 1}) {
          bool const touches = axis == 0 && side == 1 - z;
          builder.patch(touches ? "between" : "outer", touches ? kind : far, z, axis, side);
        }
    }
    Mesh mesh = builder.finish();
    Plan const plan = prepare(mesh, motion({rule({"outer"}, FixedRule{}), rule({"between"}, beside)}), {}).plan();
    std::string text;
    for (auto const& note : plan.notes) text += note + "\n";
    return text;
  };
  // The rim lies on the outer boundary, where one rule holds for both sides.
  EXPECT_NE(notes(PatchKind::other, FreeRule{}).find("4 pairs of nodes of two zones coincide"), std::string::npos)
      << notes(PatchKind::other, FreeRule{});
  EXPECT_EQ(notes(PatchKind::other, FixedRule{}).find("coincide"), std::string::npos);
  EXPECT_EQ(notes(PatchKind::connection, FreeRule{}).find("coincide"), std::string::npos) << "planes that slide";
  for (Mesh mesh : {bricks_with_t_junctions(1), around_a_box(1), star(5, 1), c_grid(1)}) {
    Plan const plan = prepare(mesh, motion({rule({"*"}, FixedRule{})}), {}).plan();
    for (auto const& note : plan.notes) EXPECT_EQ(note.find("coincide"), std::string::npos) << mesh.source;
  }
}

TEST(Prepare, CompletesTheBoundaryInWhatItReturnsAndLeavesTheMeshAsItIs) {
  Mesh mesh = box({5, 4, 4}, Shape::straight, 1);
  mesh.patches.pop_back();
  auto const patches = mesh.patches.size();
  PlanOptions options;
  options.topology.open_faces = "open";
  PreparedMorph const prepared = prepare(mesh, motion({rule({"*"}, FixedRule{})}), options);
  EXPECT_EQ(mesh.patches.size(), patches);
  EXPECT_TRUE(mesh.notes.empty());
  ASSERT_EQ(prepared.mesh.patches.size(), patches + 1);
  EXPECT_EQ(prepared.mesh.patches.back().name, "open");
  EXPECT_EQ(prepared.mesh.coordinates.x.data(), mesh.coordinates.x.data());
  EXPECT_EQ(prepared.boundary_displacement().size(), prepared.plan().boundary_nodes.size());
}

}  // namespace
}  // namespace gridmorph::test
