// Cuts, coincident entities and blocks, on meshes small enough to count by hand.
#include <gridmorph/core/error.hpp>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/scramble.hpp"
#include "topology/topology_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace gridmorph::test {
namespace {

using Cuts = std::vector<int>;

TEST(Cuts, AWholeBoxIsNotCut) {
  Mesh const mesh = box({4, 5, 6}, Shape::straight, 1);
  auto const cuts = cut_zones(mesh, connect(mesh, {}), {});
  EXPECT_EQ(cuts[0][0], (Cuts{0, 3}));
  EXPECT_EQ(cuts[0][1], (Cuts{0, 4}));
  EXPECT_EQ(cuts[0][2], (Cuts{0, 5}));
}

TEST(Cuts, TravelThroughTJunctionsUntilNothingChanges) {
  // Bricks 1 to 3 below the plane v = 5, 4 and 5 above it; see the builder for the planes.
  Mesh const mesh = bricks_with_t_junctions(1);
  auto const cuts = cut_zones(mesh, connect(mesh, {}), {});
  EXPECT_EQ(cuts[0][0], (Cuts{0, 3}));
  EXPECT_EQ(cuts[0][1], (Cuts{0, 2, 5})) << "the limit between bricks 2 and 3";
  EXPECT_EQ(cuts[1][0], (Cuts{0, 2, 5})) << "u = 5, between bricks 4 and 5, through brick 3";
  EXPECT_EQ(cuts[1][1], (Cuts{0, 2}));
  EXPECT_EQ(cuts[2][0], (Cuts{0, 2, 5}));
  EXPECT_EQ(cuts[3][0], (Cuts{0, 3, 5})) << "u = 3, between bricks 1 and 2";
  EXPECT_EQ(cuts[4][0], (Cuts{0, 3}));
  for (auto const& c : cuts) EXPECT_EQ(c[2], (Cuts{0, 5}));
}

TEST(Cuts, MorePiecesThanAllowedAreRefused) {
  Mesh const mesh = o_grid(1, 1);
  Links const links = connect(mesh, {});
  std::vector<CutPlane> const asked{{0, 0, 3}, {0, 1, 2}, {0, 2, 1}};
  EXPECT_NO_THROW(cut_zones(mesh, links, asked, 8));
  expect_all_in(message_of<MeshError>([&] { cut_zones(mesh, links, asked, 7); }), {"7 blocks", "O1"});
}

TEST(Lattice, SplitsTheNodesOfAZoneAmongItsEntities) {
  for (Mesh const& mesh : {bricks_with_t_junctions(1), around_a_box(1), annulus_sector({}, 1), c_grid(1), star(3, 1)}) {
    Topology const t = topology_of(mesh);
    std::vector<int> times(mesh.n_nodes(), 0);
    for (int e = 0; e < t.lattice.n_entities(); ++e) {
      IndexRange const r = t.lattice.nodes(e);
      Zone const& zone = mesh.zones[t.lattice.zone_of(e)];
      for (int k = r.begin[2]; k < r.end[2]; ++k)
        for (int j = r.begin[1]; j < r.end[1]; ++j)
          for (int i = r.begin[0]; i < r.end[0]; ++i) ++times[zone.node({i, j, k})];
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), mesh.n_nodes()) << mesh.source;
  }
}

TEST(Lattice, CopiesCoincideAfterTheirTransform) {
  for (Mesh const& mesh : {bricks_with_t_junctions(1), annulus_sector({}, 1), o_grid(0, 1), c_grid(1), star(5, 1),
                           translational(2, 1), scramble(c_grid(2), {5, 4}).mesh}) {
    Topology const t = topology_of(mesh);
    for (int c = 0; c < t.lattice.n_classes(); ++c) {
      auto const copies = t.lattice.copies(c);
      EXPECT_FALSE(copies.front().moved);
      IndexRange const own = t.lattice.nodes(copies.front().entity);
      if (own.size() == 0) continue;
      Zone const& owner = mesh.zones[t.lattice.zone_of(copies.front().entity)];
      for (EntityCopy const& copy : copies) {
        EXPECT_EQ(t.lattice.class_of(copy.entity), c);
        Zone const& zone = mesh.zones[t.lattice.zone_of(copy.entity)];
        for (Index3 const& p : {own.begin, Index3{own.end[0] - 1, own.end[1] - 1, own.end[2] - 1}}) {
          Vec3 const here = copy.transform(mesh.coordinates[owner.node(p)]);
          EXPECT_LT(distance(here, mesh.coordinates[zone.node(copy.from_owner(p))]), 1e-13) << mesh.source;
        }
      }
    }
  }
}

/// Every pair of nodes in one place is in one class, and the other way round (no poles, no periods).
TEST(Lattice, IdentifiesExactlyTheNodesThatCoincide) {
  for (Mesh const& mesh : {bricks_with_t_junctions(1), around_a_box(1), o_grid(1, 1), star(3, 1), star(5, 1)}) {
    Topology const t = topology_of(mesh);
    std::set<std::array<long long, 3>> places;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const x = mesh.coordinates[n];
      places.insert({std::llround(1e9 * x.x), std::llround(1e9 * x.y), std::llround(1e9 * x.z)});
    }
    Index distinct = 0;
    for (int c = 0; c < t.lattice.n_classes(); ++c)
      distinct += t.lattice.nodes(t.lattice.copies(c).front().entity).size();
    EXPECT_EQ(distinct, Index(places.size())) << mesh.source;
  }
}

TEST(Lattice, CountsOfABoxAndOfAStar) {
  Topology const one = topology_of(box({4, 5, 6}, Shape::straight, 1));
  EXPECT_EQ(count_classes(one.lattice, 0), 8);
  EXPECT_EQ(count_classes(one.lattice, 1), 12);
  EXPECT_EQ(count_classes(one.lattice, 2), 6);
  EXPECT_EQ(count_classes(one.lattice, 3), 1);
  for (int n : {3, 5}) {
    Topology const t = topology_of(star(n, 1));
    EXPECT_EQ(count_classes(t.lattice, 0), 2 * (2 * n + 1));
    EXPECT_EQ(count_classes(t.lattice, 1), 2 * 3 * n + (2 * n + 1));
    EXPECT_EQ(count_classes(t.lattice, 2), 2 * n + 3 * n);
    EXPECT_EQ(t.blocks.size(), n) << "an irregular edge keeps its blocks apart";
    int with_all = 0;
    for (int c = 0; c < t.lattice.n_classes(); ++c) with_all += int(t.lattice.copies(c).size()) == n;
    EXPECT_EQ(with_all, 3) << "the inner edge and its two corners";
  }
}

TEST(Lattice, CornersOfAMeshThatIsPeriodicTwiceHaveFourCopies) {
  Topology const t = topology_of(translational(2, 1));
  EXPECT_EQ(euler(t.lattice), 0);  // a thick torus
  EXPECT_EQ(count_classes(t.lattice, 0), 2);
  EXPECT_EQ(count_classes(t.lattice, 1), 1 + 2 + 2);
  for (int c = 0; c < t.lattice.n_classes(); ++c) {
    int const dimension = t.lattice.dimension(t.lattice.copies(c).front().entity);
    if (dimension != 0) continue;
    EXPECT_EQ(t.lattice.copies(c).size(), 4u);
    EXPECT_EQ(std::count_if(t.lattice.copies(c).begin(), t.lattice.copies(c).end(),
                            [](EntityCopy const& copy) { return copy.moved; }),
              3);
    EXPECT_FALSE(t.lattice.axis_of(c));
  }
}

TEST(Lattice, NodesOnTheAxisOfASectorKnowIt) {
  Mesh const mesh = star_sector(5, 1);
  Topology const t = topology_of(mesh);
  for (int c = 0; c < t.lattice.n_classes(); ++c) {
    EntityCopy const& owner = t.lattice.copies(c).front();
    IndexRange const r = t.lattice.nodes(owner.entity);
    Vec3 const p = mesh.coordinates[mesh.zones[t.lattice.zone_of(owner.entity)].node(r.begin)];
    bool const on_axis = p.x == 0 && p.y == 0;
    auto const axis = t.lattice.axis_of(c);
    ASSERT_EQ(axis.has_value(), on_axis);
    EXPECT_NEAR(std::abs(axis.value_or(Vec3{0, 0, 1}).z), 1, 1e-12);
  }
}

TEST(Lattice, AClosedRingAndAWakeTouchThemselves) {
  Topology const ring = topology_of(o_grid(1, 1));
  EXPECT_EQ(euler(ring.lattice), 0);
  EXPECT_EQ(ring.lattice.pieces().size(), 1u);
  EXPECT_EQ(ring.blocks.size(), 1);
  EXPECT_EQ(count_classes(ring.lattice, 2), 5);

  // The wall limits cut the C into wake, body, wake; the cut across the wake is one and the same on both sides.
  Topology const c = topology_of(c_grid(1));
  EXPECT_EQ(c.lattice.cuts()[0][0], (Cuts{0, 4, 12, 16}));
  EXPECT_EQ(c.lattice.pieces().size(), 3u);
  EXPECT_EQ(euler(c.lattice), 0);
  EXPECT_EQ(count_classes(c.lattice, 2),
            2 /* i ends */ + 2 /* i cuts */ + 3 /* far */ + 1 /* wall */ + 1 /* wake */ + 6);
  int twice = 0;
  for (int f = 0; f < c.lattice.n_classes(); ++f)
    twice += c.lattice.dimension(c.lattice.copies(f).front().entity) == 2 && c.lattice.copies(f).size() == 2;
  EXPECT_EQ(twice, 1);
}

TEST(Lattice, RefusesAnInterfaceThatFoldsAFaceOntoItself) {
  // The j_min face of a straight box joined to itself, mirrored: nodes meet their mirror images on the same face.
  Mesh mesh = box({5, 4, 4}, Shape::straight, 1);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    mesh.coordinates.set(n, {p.y * (p.x - 1), 0.2 * (p.x - 1) * (p.x - 1) + p.y, p.z});
  }
  std::erase_if(mesh.patches, [](Patch const& p) { return p.families.front() == "v_min"; });
  Interface1to1 fold;
  fold.name = "fold";
  fold.zone = fold.donor_zone = 0;
  fold.range = {{0, 0, 0}, {5, 1, 4}};
  fold.to_donor = {{{0, 1, 2}, {-1, -1, 1}}, {0, 0, 0}, {4, 0, 0}};
  mesh.interfaces.push_back(fold);
  expect_all_in(message_of<MeshError>([&] { topology_of(mesh); }), {"fold", "box1", "[1:5, 1:1, 1:4]", "split"});
}

TEST(Blocks, CutsThatNothingNeedsAreMergedAgain) {
  struct {
    Mesh mesh;
    int blocks;
  } const cases[] = {
      {box({8, 7, 6}, Shape::curved, 1), 1},
      {bricks_with_t_junctions(1), 1},
      {l_shape(1), 3},
      {around_a_box(1), 8},
      {star(3, 1), 3},
      {star(5, 1), 5},
      {annulus_sector({}, 1), 1},
      {translational(1, 1), 1},
      {translational(2, 1), 1},
  };
  for (auto const& c : cases) {
    EXPECT_EQ(topology_of(c.mesh).blocks.size(), c.blocks) << c.mesh.source;
    for (unsigned seed = 1; seed < 5; ++seed)
      EXPECT_EQ(topology_of(scramble(c.mesh, {seed, 6}).mesh).blocks.size(), c.blocks)
          << c.mesh.source << ", seed " << seed;
  }
}

TEST(Blocks, HoldEveryPieceOnceAndTheirFacesAreWhole) {
  for (Mesh const& plain : {bricks_with_t_junctions(1), around_a_box(1), c_grid(1), o_grid(1, 1), star(5, 1)}) {
    Mesh const mesh = scramble(plain, {2, 5}).mesh;
    Topology const t = topology_of(mesh);
    std::vector<int> times(t.lattice.pieces().size(), 0);
    for (int b = 0; b < t.blocks.size(); ++b) {
      for (PlacedPiece const& p : t.blocks[b].pieces) {
        ++times[p.piece];
        EXPECT_EQ(t.blocks.block_of(p.piece), b);
      }
      for (int face = 0; face < 6; ++face) {
        std::set<int> families;
        for (int e : t.blocks.face_entities(t.lattice, {b, face / 2, face % 2})) {
          int const patch = t.blocks.patch_of_face()[t.lattice.class_of(e)];
          auto const label = limits_by_family(mesh).patch_label;
          families.insert(patch < 0 ? -1 : label[patch]);
        }
        EXPECT_EQ(families.size(), 1u) << plain.source << ": a block face belongs to one family, or is inside";
      }
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), std::ptrdiff_t(times.size()));
  }
}

}  // namespace
}  // namespace gridmorph::test
