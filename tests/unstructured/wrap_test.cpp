#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/elements/classify.hpp>
#include <gridmorph/plan/elements/wrap.hpp>

#include <gtest/gtest.h>

#include <algorithm>

#include "bodies.hpp"
#include "support/expect_error.hpp"
#include "support/unstructured_meshes.hpp"

namespace gridmorph::test {
namespace {

struct Wrapped {
  Mesh mesh;
  Wrap wrap;
};

Wrapped wrapped(Bodies const& bodies, WrapOptions const& options, Vec3 const& low = {-4, -4, -4},
                Vec3 const& high = {5, 5, 5}) {
  Mesh mesh = bodies.in_domain(low, high);
  Wrap wrap = make_wrap({}, mesh, bodies.walls, options);
  return {std::move(mesh), std::move(wrap)};
}

/// Every point within the offset of a node of the walls is in the wrap.
void expect_covered(Bodies const& bodies, Wrap const& wrap) {
  double const reach = 0.999 * wrap.offset;
  for (Vec3 const& p : bodies.points())
    for (Vec3 const& step : {Vec3{}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1},
                             Vec3{0, 0, -1}, Vec3{0.57, 0.57, 0.57}, Vec3{-0.57, 0.57, -0.57}})
      ASSERT_TRUE(wrap.contains(p + reach * step)) << p.x << ' ' << p.y << ' ' << p.z;
}

/// Cells that hang together through faces, from the first one on.
Index connected_cells(Wrap const& wrap, bool inside) {
  std::vector<char> seen(wrap.n_cells(), 0);
  std::vector<Index> stack;
  for (Index c = 0; c < wrap.n_cells() && stack.empty(); ++c)
    if ((wrap.inside[c] != 0) == inside) stack.push_back(c);
  Index count = 0;
  if (!stack.empty()) seen[stack.back()] = 1;
  while (!stack.empty()) {
    Index3 const c = wrap.index(stack.back());
    stack.pop_back();
    ++count;
    for (int axis = 0; axis < 3; ++axis)
      for (int const by : {-1, 1}) {
        Index3 next = c;
        next[axis] += by;
        if (next[axis] < 0 || next[axis] >= wrap.cells(axis)) continue;
        Index const n = wrap.cell(next);
        if (seen[n] != 0 || wrap.is_inside(next) != inside) continue;
        seen[n] = 1;
        stack.push_back(n);
      }
  }
  return count;
}

/// Edges of the lattice around which two of the four cells are inside, opposite one another.
int contacts(Wrap const& wrap) {
  int count = 0;
  for (int a = 0; a < 3; ++a) {
    auto const u = std::size_t((a + 1) % 3), v = std::size_t((a + 2) % 3);
    for (Index n = 0; n < wrap.n_cells(); ++n) {
      Index3 const c = wrap.index(n);
      if (c[u] + 1 >= wrap.cells(int(u)) || c[v] + 1 >= wrap.cells(int(v))) continue;
      Index3 right = c, up = c, both = c;
      ++right[u];
      ++up[v];
      ++both[u];
      ++both[v];
      bool const p = wrap.is_inside(c), q = wrap.is_inside(both), r = wrap.is_inside(right), s = wrap.is_inside(up);
      count += (p && q && !r && !s) || (!p && !q && r && s) ? 1 : 0;
    }
  }
  return count;
}

bool outermost_free(Wrap const& wrap) {
  for (Index n = 0; n < wrap.n_cells(); ++n) {
    Index3 const c = wrap.index(n);
    for (int a = 0; a < wrap.dimension; ++a)
      if ((c[a] == 0 || c[a] == wrap.cells(a) - 1) && wrap.is_inside(c)) return false;
  }
  return true;
}

TEST(Wrap, OfABoxIsTheBoxLargerByTheOffset) {
  Bodies bodies;
  bodies.box({0, 0, 0}, {1, 0.5, 0.25});
  Wrap const wrap = wrapped(bodies, {.offset = 0.1}).wrap;
  EXPECT_EQ(wrap.n_inside(), Index(wrap.cells(0) - 2) * (wrap.cells(1) - 2) * (wrap.cells(2) - 2));
  EXPECT_DOUBLE_EQ(wrap.planes[0][1], -0.1);
  EXPECT_DOUBLE_EQ(wrap.planes[0][std::size_t(wrap.cells(0)) - 1], 1.1);
  EXPECT_DOUBLE_EQ(wrap.planes[1][std::size_t(wrap.cells(1)) - 1], 0.6);
  EXPECT_DOUBLE_EQ(wrap.planes[2][std::size_t(wrap.cells(2)) - 1], 0.35);
  EXPECT_DOUBLE_EQ(wrap.planes[0].front(), -4);
  EXPECT_DOUBLE_EQ(wrap.planes[2].back(), 5);
  EXPECT_EQ(wrap.cells(0) - 2, 4);
}

TEST(Wrap, CoversWhatIsCloserThanTheOffsetAndHangsTogether) {
  for (int const kind : {0, 1, 2}) {
    Bodies bodies;
    if (kind == 0) bodies.sphere({0.2, 0.1, 0}, 0.5, 12);
    if (kind == 1) bodies.rod({0, 0, 0}, {1, 0.8, 1.2}, 0.03);
    if (kind == 2) {
      bodies.box({0, 0, 0}, {1, 0.2, 0.2});
      bodies.box({0, 0, 0}, {0.2, 1, 0.2});
    }
    Wrap const wrap = wrapped(bodies, {.offset = 0.06, .resolution = 10}).wrap;
    SCOPED_TRACE(kind);
    expect_covered(bodies, wrap);
    EXPECT_EQ(connected_cells(wrap, true), wrap.n_inside());
    EXPECT_EQ(connected_cells(wrap, false), wrap.n_cells() - wrap.n_inside()) << "no hollows";
    EXPECT_EQ(contacts(wrap), 0);
    EXPECT_TRUE(outermost_free(wrap));
    EXPECT_FALSE(wrap.contains({4, -3, 4}));
  }
}

TEST(Wrap, OfASlenderDiagonalRodIsSlender) {
  Bodies bodies;
  bodies.rod({0, 0, 0}, {1, 1, 1}, 0.02);
  Wrap const wrap = wrapped(bodies, {.offset = 0.03, .resolution = 10}).wrap;
  // A straight line crosses about 3 cells a layer; with its offset it meets some of their neighbours.
  EXPECT_LT(wrap.n_inside(), 20 * 10);
  EXPECT_GE(wrap.n_inside(), 28);
}

TEST(Wrap, KeepsBodiesFarApartSmallAndApart) {
  Bodies bodies;
  bodies.sphere({0, 0, 0}, 0.5, 8);
  bodies.sphere({30, 0, 0}, 0.5, 8);
  Wrap const wrap = wrapped(bodies, {.offset = 0.1, .resolution = 10}, {-10, -10, -10}, {40, 10, 10}).wrap;
  expect_covered(bodies, wrap);
  EXPECT_NEAR(wrap.spacing, 0.12, 0.05);
  EXPECT_FALSE(wrap.contains({15, 0, 0}));
  EXPECT_FALSE(wrap.contains({1, 0, 0}));
  EXPECT_EQ(2 * connected_cells(wrap, true), wrap.n_inside());
}

TEST(Wrap, StaysWithinTheLimitOfCells) {
  Bodies bodies;
  bodies.sphere({0, 0, 0}, 0.5, 12);
  Wrap const fine = wrapped(bodies, {.offset = 0.05, .resolution = 20, .max_cells = 100000}).wrap;
  Wrap const coarse = wrapped(bodies, {.offset = 0.05, .resolution = 20, .max_cells = 500}).wrap;
  EXPECT_EQ(fine.cells(0), 22);
  EXPECT_LE(coarse.n_cells(), 500);
  EXPECT_GT(coarse.n_cells(), 250);
  expect_covered(bodies, coarse);
}

TEST(Wrap, OfABodyOnTheLimitOfTheMeshGoesBeyondItAndIsFull) {
  // Half a hollow sphere: its inside is open to the plane z = 0, where the mesh ends.
  Bodies bodies;
  bodies.sphere({0, 0, 0}, 1, 24);
  Bodies half;
  half.walls.front() = {};
  Mesh mesh = bodies.in_domain({-4, -4, 0}, {4, 4, 4});
  for (Index f = 0; f < bodies.walls.front().size(); ++f) {
    auto const face = bodies.walls.front()[f];
    if (std::all_of(face.begin(), face.end(), [&](Index32 n) { return mesh.coordinates[n].z > -1e-9; }))
      half.walls.front().add(face);
  }
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.z(n) = std::max(mesh.coordinates.z(n), 0.0);
  // The lower half of the nodes would be inside the body.
  for (Index n = 0; n < Index(bodies.points().size()); ++n)
    if (bodies.points()[n].z < -1e-9) mesh.coordinates.set(n, {4, 4, 0});
  Wrap const wrap = make_wrap({}, mesh, half.walls, {.offset = 0.1, .resolution = 10});
  EXPECT_TRUE(wrap.contains({0, 0, 0.05}));
  EXPECT_TRUE(wrap.contains({0.3, 0.2, 0.4}));
  EXPECT_TRUE(wrap.contains({0, 0, -0.01}));
  EXPECT_TRUE(outermost_free(wrap));
  EXPECT_EQ(connected_cells(wrap, false), wrap.n_cells() - wrap.n_inside());
}

TEST(Wrap, ClosesHolesOfOneCell) {
  Bodies bodies;  // a frame around a small hole
  bodies.box({0, 0, 0}, {1, 0.4, 0.1});
  bodies.box({0, 0.6, 0}, {1, 1, 0.1});
  bodies.box({0, 0.4, 0}, {0.4, 0.6, 0.1});
  bodies.box({0.6, 0.4, 0}, {1, 0.6, 0.1});
  Wrap const wrap = wrapped(bodies, {.offset = 0.03, .resolution = 10}).wrap;
  EXPECT_TRUE(wrap.contains({0.5, 0.5, 0.05}));
  EXPECT_EQ(wrap.n_inside(), Index(wrap.cells(0) - 2) * (wrap.cells(1) - 2) * (wrap.cells(2) - 2));
}

TEST(Wrap, AnswersForBoxesLikeALookAtEveryCell) {
  Bodies bodies;
  bodies.rod({0, 0, 0}, {1, 0.8, 1.2}, 0.03);
  Wrap const wrap = wrapped(bodies, {.offset = 0.05, .resolution = 10}).wrap;
  unsigned state = 1;
  auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return double(state >> 8) / double(1u << 24);
  };
  int met = 0;
  for (int n = 0; n < 2000; ++n) {
    LatticeBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = -1 + 3 * random();
      box.high[a] = box.low[a] + 0.8 * random();
    }
    bool expected = false;
    for (Index c = 0; c < wrap.n_cells(); ++c) {
      if (wrap.inside[c] == 0) continue;
      LatticeBox const cell = wrap.box(wrap.index(c));
      bool overlap = true;
      for (std::size_t a = 0; a < 3; ++a) overlap = overlap && box.low[a] < cell.high[a] && cell.low[a] < box.high[a];
      expected = expected || overlap;
    }
    met += int(expected);
    ASSERT_EQ(wrap.meets(box), expected);
  }
  EXPECT_GT(met, 50);
}

TEST(Wrap, RefusesWhatItCannotWrap) {
  Bodies bodies;
  bodies.box({0, 0, 0}, {1, 1, 1});
  Mesh const mesh = bodies.in_domain({-1, -1, -1}, {2, 2, 2});
  std::vector<CsrGraph> const none(1);
  expect_all_in(message_of<MeshError>([&] { make_wrap({}, mesh, none, {.offset = 0.1}); }), {"nothing to wrap"});
  expect_all_in(message_of<MotionError>([&] { make_wrap({}, mesh, bodies.walls, {}); }), {"offset", "positive"});
}

TEST(Wrap, IsShownAsAMeshOfItsCells) {
  Bodies bodies;
  bodies.sphere({0, 0, 0}, 1, 12);
  Wrap const wrap = wrapped(bodies, {.offset = 0.1, .resolution = 10}).wrap;
  Mesh const mesh = wrap_mesh(wrap);
  check_mesh(mesh);
  EXPECT_EQ(mesh.n_elements(), wrap.n_inside());
  // Closed: twice the faces of the cells are those between cells and those on the surface.
  EXPECT_GT(mesh.patches.front().faces.size(), 0);
}

TEST(SuggestedOffset, KeepsLayersInsideAndLeavesRoomForOtherBoundaries) {
  EXPECT_DOUBLE_EQ(suggest_offset({.layer_height = 0.1, .wall_edge = 0.01, .body = 1}), 0.2);
  EXPECT_DOUBLE_EQ(suggest_offset({.layer_height = 0.1, .wall_edge = 0.01, .motion = 4, .body = 1}), 0.5);
  EXPECT_DOUBLE_EQ(suggest_offset({.layer_height = 0.1, .motion = 0.1, .body = 10, .gap = 0.9}), 0.3);
  EXPECT_DOUBLE_EQ(suggest_offset({.layer_height = 0.1, .motion = 2, .body = 1, .gap = 0.15}), 0.1);
  EXPECT_DOUBLE_EQ(suggest_offset({.wall_edge = 1, .motion = 0.4, .body = 3, .gap = 1}), 0.2);
  EXPECT_DOUBLE_EQ(suggest_offset({.wall_edge = 0.05, .body = 1}), 0.1);
}

TEST(Classification, AgreesWithTheWrapElementByElement) {
  // A block of unit cells from (0, 0, 0) to (12, 12, 12) with an imagined wall in the middle.
  Mesh const mesh = to_prisms_and_tetrahedra(unit_box({12, 12, 12}), 4);
  std::vector<CsrGraph> walls(1);
  auto node = [](int i, int j, int k) { return Index32(i + 13 * (j + 13 * k)); };
  for (int i = 4; i < 8; ++i)
    for (int j = 4; j < 8; ++j) {
      std::array<Index32, 4> const face{node(i, j, 6), node(i + 1, j, 6), node(i + 1, j + 1, 6), node(i, j + 1, 6)};
      walls.front().add(face);
    }
  Wrap const wrap = make_wrap({}, mesh, walls, {.offset = 1.25, .resolution = 6});
  Classification const found = classify({}, mesh, wrap);
  std::vector<char> near(mesh.n_nodes(), 0);
  std::array<Index, 3> count{};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    Region const region = found.element[e];
    ++count[std::size_t(region)];
    int inside = 0;
    Vec3 centre;
    auto const corners = mesh.elements.corners(e);
    for (Index32 const n : corners) {
      inside += int(wrap.contains(mesh.coordinates[n]));
      centre += (1.0 / double(corners.size())) * mesh.coordinates[n];
    }
    if (region == Region::near) {
      EXPECT_EQ(inside, int(corners.size()));
    }
    if (region == Region::far) {
      EXPECT_EQ(inside, 0);
      EXPECT_FALSE(wrap.contains(centre));
    }
    if (region != Region::far)
      for (Index32 const n : corners) near[n] = 1;
  }
  EXPECT_EQ(count[std::size_t(Region::near)], found.n_near);
  EXPECT_EQ(count[std::size_t(Region::partial)], found.n_partial);
  EXPECT_EQ(count[std::size_t(Region::far)], found.n_far);
  EXPECT_GT(found.n_near, 50);
  EXPECT_GT(found.n_partial, 50);
  EXPECT_GT(found.n_far, 500);
  EXPECT_TRUE(std::equal(near.begin(), near.end(), found.near.begin()));
  EXPECT_EQ(found.n_near_nodes, std::count(near.begin(), near.end(), 1));
}

}  // namespace
}  // namespace gridmorph::test
