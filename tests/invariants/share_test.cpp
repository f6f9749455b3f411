// Shares of plans: nodes of boxes, dealt in any way, move to the same bits as by the whole plan.
#include "invariants/cases.hpp"

#include "support/morph_run.hpp"
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/morph/share_contents.hpp>
#include <gridmorph/plan/share.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

/// All nodes of a mesh in boxes, zone by zone cut at random places, planes between two in both, and now and then a
/// layer more, as ghost layers are; dealt to `n` at random.
std::vector<std::vector<NodeBox>> dealt(Mesh const& mesh, int n, Random& random) {
  std::vector<std::vector<NodeBox>> out{std::size_t(n)};
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 const extent = mesh.zones[z].extent;
    std::vector<IndexRange> boxes{{{0, 0, 0}, extent}};
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<IndexRange> cut;
      for (IndexRange const& box : boxes) {
        if (box.extent(axis) < 3 || random.coin()) {
          cut.push_back(box);
          continue;
        }
        int const at = box.begin[axis] + 1 + random.below(box.extent(axis) - 2), more = random.below(2);
        IndexRange lower = box, upper = box;
        lower.end[axis] = std::min(at + 1 + more, box.end[axis]);
        upper.begin[axis] = std::max(at - random.below(2), box.begin[axis]);
        cut.push_back(lower);
        cut.push_back(upper);
      }
      boxes = cut;
    }
    for (IndexRange const& box : boxes) out[std::size_t(random.below(n))].push_back({z, box});
  }
  return out;
}

/// The nodes of boxes in the order of a share.
std::vector<Index> nodes_of(Mesh const& mesh, std::span<NodeBox const> boxes) {
  std::vector<Index> out;
  for (NodeBox const& box : boxes)
    for_each_node(mesh.zones[box.zone], box.nodes, [&](Index node) { out.push_back(node); });
  return out;
}

Coordinates at(Coordinates const& x, std::vector<Index> const& nodes) {
  Coordinates out{Index(nodes.size())};
  for (std::size_t n = 0; n < nodes.size(); ++n) out.set(Index(n), x[nodes[n]]);
  return out;
}

class Shares : public ::testing::TestWithParam<Case> {};

TEST_P(Shares, MoveTheirNodesToTheSameBits) {
  Outcome const whole = morph(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  Kokkos::DefaultHostExecutionSpace const exec;
  Random random(5);
  for (int const n : reduced() ? std::vector<int>{3} : std::vector<int>{1, 2, 5}) {
    Index moved = 0;
    for (auto const& boxes : dealt(whole.mesh, n, random)) {
      // As another process gets it.
      Plan const share =
          share_from_bytes(to_bytes(ShareContents{share_of({}, whole.plan(), whole.mesh, boxes), {}, {}, {}})).chains;
      auto const nodes = nodes_of(whole.mesh, boxes);
      ASSERT_EQ(share.n_nodes, Index(nodes.size()));
      Morphed const own = run_plan(exec, at(whole.mesh.coordinates, nodes), share, whole.boundary);
      EXPECT_EQ(different_bits(own.position, at(whole.morphed.position, nodes)), 0) << n << " processes";
      EXPECT_EQ(different_bits(own.displacement, at(whole.morphed.displacement, nodes)), 0) << n << " processes";
      moved += Index(nodes.size());
    }
    EXPECT_GE(moved, whole.mesh.n_nodes());
  }
}

/// Sum over shares of what each hands back of the gradients of its nodes, those of copies being zero, and how far
/// velocities are from those of the whole plan.
TEST_P(Shares, HaveTheVelocitiesOfTheWholeAndGradientsThatAddUpToItsOwn) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Outcome const whole = morph(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  Random random(11);
  LinearisedMorph<Exec> const all(whole.plan(), whole.mesh.coordinates, whole.boundary);
  Coordinates const rate = random_vectors(3, all.boundary.size()), g = random_vectors(4, all.n_nodes);
  Coordinates const velocity = all.forwards(rate), expected = all.backwards(g);
  std::vector<Vec3> sum(std::size_t(expected.size()));
  std::vector<char> counted(std::size_t(all.n_nodes), 0);
  for (auto const& boxes : dealt(whole.mesh, 3, random)) {
    Plan const share = share_of({}, whole.plan(), whole.mesh, boxes);
    auto const nodes = nodes_of(whole.mesh, boxes);
    LinearisedMorph<Exec> const own(share, at(whole.mesh.coordinates, nodes), whole.boundary);
    EXPECT_EQ(different_bits(own.forwards(rate), at(velocity, nodes)), 0);
    Coordinates own_g = at(g, nodes);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (std::exchange(counted[std::size_t(nodes[n])], 1) != 0) own_g.set(Index(n), {});
    Coordinates const back = own.backwards(own_g);
    for (Index n = 0; n < back.size(); ++n) sum[std::size_t(n)] += back[n];
  }
  double worst = 0, largest = 0;
  for (Index n = 0; n < expected.size(); ++n) {
    double const d = distance(sum[std::size_t(n)], expected[n]);
    worst = std::isfinite(d) ? std::max(worst, d) : HUGE_VAL;
    largest = std::max(largest, norm(expected[n]));
  }
  EXPECT_LE(worst, 1e-11 * largest);
}

INSTANTIATE_TEST_SUITE_P(Of, Shares, ::testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
