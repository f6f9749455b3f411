// A morph of blocks stopped after each of its stages.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/scramble.hpp"

#include <gridmorph/morph/stage_by_stage.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace gridmorph::test {
namespace {

struct Stopped {
  std::vector<StagesDone> done;
  std::vector<Coordinates> positions;
};

Stopped stage_by_stage(Outcome const& whole) {
  Stopped out;
  morph_stage_by_stage(whole.plan(), whole.mesh.coordinates, whole.boundary,
                       [&](StagesDone const& done, Coordinates const& positions) {
                         out.done.push_back(done);
                         out.positions.push_back(positions);
                       });
  return out;
}

PlanOptions with_layers(std::string const& wall, int layers, BoundaryLayer::Mode mode) {
  PlanOptions options;
  options.boundary_layers = {{{wall}, BoundaryLayer::Extent::layers, layers, 0, mode}};
  return options;
}

/// A near field, chains that end on one another, rotations that are handed on.
Outcome around_a_body(unsigned seed, BoundaryLayer::Mode mode = BoundaryLayer::Mode::rotate) {
  Mesh mesh = around_a_box(1);
  if (seed > 0) mesh = scramble(mesh, {seed, 2}).mesh;
  return morph(mesh,
               motion({rule({"step"}, function_rule(waves(0.02)), 1),
                       rule({"u_min", "u_max", "v_min", "v_max", "w_min", "w_max"}, FixedRule{})}),
               with_layers("step", 1, mode));
}

/// Periodic interfaces, slip surfaces and their spread.
Outcome sector() {
  Sector const shape;
  Motion m = motion({rule({"inlet", "outlet"}, function_rule(turning_waves(shape, 0.05))),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
  m.axis = {shape.origin, shape.axis};
  return morph(annulus_sector({}, 1), m);
}

/// The stage of the last cell at each node, and whether any cell there has its turn at all.
std::vector<std::array<int, 2>> range_of_stages_at_nodes(Mesh const& mesh, StagesOfCells const& cells) {
  std::vector<std::array<int, 2>> out(mesh.n_nodes(), {1 << 20, -1});
  std::size_t n = 0;
  for (Zone const& zone : mesh.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i, ++n)
          for (int corner = 0; corner < 8; ++corner) {
            auto& at = out[zone.node({i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2)})];
            at[0] = std::min(at[0], cells.stage[n]);
            at[1] = std::max(at[1], cells.stage[n]);
          }
  return out;
}

TEST(StageByStage, TheLastStageIsTheMorphBitForBit) {
  for (Outcome const& whole : {around_a_body(0), around_a_body(3), around_a_body(0, BoundaryLayer::Mode::translate),
                               sector(), morph(star(5, 1), motion({rule({"*"}, function_rule(waves(0.05)))})),
                               morph(o_grid(0, 1), motion({rule({"*"}, function_rule(waves(0.02)))}))}) {
    Stopped const stopped = stage_by_stage(whole);
    ASSERT_EQ(stopped.done.size(), 1 + whole.plan().stages.size() + whole.plan().spreads.size());
    EXPECT_EQ(different_bits(stopped.positions.back(), whole.morphed.position), 0) << whole.mesh.source;
    EXPECT_EQ(stopped.done.front().name, "boundary");
    Index moved_before = 0;
    for (Coordinates const& positions : stopped.positions) {
      Index moved = 0;
      for (Index n = 0; n < whole.mesh.n_nodes(); ++n)
        moved += same_bits(positions[n], whole.mesh.coordinates[n]) ? 0 : 1;
      EXPECT_GE(moved, moved_before) << whole.mesh.source << ": no stage takes nodes back";
      moved_before = moved;
    }
  }
}

TEST(StageByStage, NodesArriveWithTheStageOfTheirCellsAndNotBefore) {
  for (unsigned const seed : {0U, 1U, 2U}) {
    Outcome const whole = around_a_body(seed);
    ASSERT_TRUE(whole.plan().spreads.empty());
    ASSERT_GE(whole.plan().stages.size(), 3U) << "near field and two iterations";
    Stopped const stopped = stage_by_stage(whole);
    auto const range = range_of_stages_at_nodes(whole.mesh, stages_of_cells(whole.mesh, whole.plan()));
    std::set<Index> const given(whole.plan().boundary_nodes.begin(), whole.plan().boundary_nodes.end());
    std::set<Index> on_interfaces;  // a node of another zone may have arrived before, so that only its own cells tell
    for (Interface1to1 const& face : whole.mesh.interfaces) {
      Zone const& zone = whole.mesh.zones[face.zone];
      Zone const& donor = whole.mesh.zones[face.donor_zone];
      for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
        for (int j = face.range.begin[1]; j < face.range.end[1]; ++j)
          for (int i = face.range.begin[0]; i < face.range.end[0]; ++i) {
            on_interfaces.insert(zone.node({i, j, k}));
            on_interfaces.insert(donor.node(face.to_donor(Index3{i, j, k})));
          }
    }
    Index arrived = 0, waiting = 0;
    for (std::size_t s = 0; s < stopped.positions.size(); ++s)
      for (Index n = 0; n < whole.mesh.n_nodes(); ++n) {
        auto const [first, last] = range[n];
        if (last <= int(s)) {
          ASSERT_TRUE(same_bits(stopped.positions[s][n], whole.morphed.position[n])) << describe_node(whole.mesh, n);
          ++arrived;
        } else if (first > int(s) && given.count(n) == 0 && on_interfaces.count(n) == 0) {
          bool const on_boundary = [&] {  // known nodes are listed once however many zones share them
            for (Patch const& patch : whole.mesh.patches) {
              Zone const& zone = whole.mesh.zones[patch.zone];
              if (n < zone.first_node || n >= zone.first_node + zone.size()) continue;
              Index const m = n - zone.first_node;
              if (patch.range.contains({int(m % zone.extent[0]), int(m / zone.extent[0] % zone.extent[1]),
                                        int(m / zone.extent[0] / zone.extent[1])}))
                return true;
            }
            return false;
          }();
          if (on_boundary) continue;
          ASSERT_TRUE(same_bits(stopped.positions[s][n], whole.mesh.coordinates[n])) << describe_node(whole.mesh, n);
          ++waiting;
        }
      }
    EXPECT_GT(arrived, 0);
    EXPECT_GT(waiting, 0);
  }
}

TEST(StageByStage, EveryCellHasItsTurnOnceInTheDirectionOfItsChain) {
  for (unsigned const seed : {0U, 1U, 2U, 3U}) {
    Outcome const whole = around_a_body(seed);
    StagesOfCells const cells = stages_of_cells(whole.mesh, whole.plan());
    ASSERT_EQ(Index(cells.stage.size()), whole.mesh.n_cells());
    std::vector<std::vector<Index>> n(whole.plan().stages.size());
    for (std::size_t s = 0; s < n.size(); ++s) n[s].resize(whole.plan().stages[s].lines.chains.size());
    for (std::size_t c = 0; c < cells.stage.size(); ++c) {
      ASSERT_GE(cells.stage[c], 1);
      ASSERT_GE(cells.chain[c], 1);
      ASSERT_GE(cells.direction[c], 1);
      ASSERT_LE(cells.direction[c], 3);
      ++n[std::size_t(cells.stage[c]) - 1].at(std::size_t(cells.chain[c]) - 1);
    }
    for (std::size_t s = 0; s < n.size(); ++s)
      for (std::size_t c = 0; c < n[s].size(); ++c) {
        auto const& chain = whole.plan().stages[s].lines.chains[c];
        EXPECT_EQ(n[s][c], Index(chain.n_s - 1) * (chain.n_a - 1) * (chain.n_b - 1)) << "seed " << seed;
      }
  }
}

/// Extents differ, so that the length of the chain tells which index direction of the turned zone it has.
TEST(StageByStage, DirectionsAreThoseOfTheZoneHoweverItIsTurned) {
  for (unsigned seed = 0; seed <= 12; ++seed) {
    Mesh const plain = box({5, 7, 10}, Shape::curved, 1);
    Mesh const mesh = seed == 0 ? plain : scramble(plain, {seed, 0}).mesh;
    Outcome const whole = morph(mesh, motion({rule({"*"}, function_rule(waves(0.05)))}));
    ASSERT_EQ(whole.plan().stages.size(), 1U);
    StagesOfCells const cells = stages_of_cells(whole.mesh, whole.plan());
    for (int const d : cells.direction)
      ASSERT_EQ(whole.mesh.zones[0].extent[d - 1], whole.plan().stages[0].lines.chains[0].n_s);
  }
}

}  // namespace
}  // namespace gridmorph::test
