#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "bodies.hpp"
#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

namespace gridmorph::test {
namespace {

/// A background mesh, planned.
struct Planned {
  gridmorph::Wrap wrap;
  Background background;
  PreparedMorph prepared;
  WrapNodes nodes;
};

Planned planned(Bodies const& bodies, WrapOptions const& options, Vec3 const& low, Vec3 const& high, int dimension = 3,
                Law law = Law::linear) {
  VolumeOptions volume;
  volume.law = law;
  Mesh const mesh = bodies.in_domain(low, high, dimension);
  gridmorph::Wrap wrap = make_wrap({}, mesh, bodies.walls, options);
  Background background = make_background(wrap);
  PreparedMorph prepared = prepare_background({}, background, volume);
  WrapNodes nodes = wrap_nodes(background, prepared);
  return {std::move(wrap), std::move(background), std::move(prepared), std::move(nodes)};
}

std::vector<Vec3> boundary_of(Planned const& p, VectorField const& motion) {
  std::vector<Vec3> boundary(p.prepared.plan().boundary_nodes.size());
  for (std::size_t n = 0; n < p.nodes.position.size(); ++n)
    boundary[p.nodes.boundary_node[n]] = motion(p.nodes.position[n]);
  return boundary;
}

/// Smallest determinant of the cells that lie in the domain.
double smallest_determinant(Planned const& p, Coordinates const& moved, Vec3 const& low, Vec3 const& high) {
  Mesh const& mesh = p.background.mesh;
  Kokkos::DefaultHostExecutionSpace const exec;
  std::array<Measure, 1> const measures{Measure::determinant_3x3x3};
  auto const values = cell_fields(exec, mesh, {views(moved), views(mesh.coordinates), {}, {}}, measures);
  exec.fence();
  auto const first = first_cells(mesh);
  double least = 1;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    Zone const& zone = mesh.zones[z];
    Index cell = first[z];
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i, ++cell) {
          Vec3 const from = mesh.coordinates[zone.node({i, j, k})],
                     to = mesh.coordinates[zone.node({i + 1, j + 1, k + 1})];
          bool const within = from.x < high.x && from.y < high.y && (from.z < high.z || p.wrap.dimension == 2) &&
                              to.x > low.x && to.y > low.y && (to.z > low.z || p.wrap.dimension == 2);
          if (within) least = std::min(least, values[0](cell));
        }
  }
  return least;
}

struct Case {
  char const* name;
  Bodies bodies;
  WrapOptions options;
  VectorField motion;
  Vec3 low{-4, -4, -4}, high{5, 5, 5};
};

Bodies box_body() {
  Bodies b;
  b.box({0, 0, 0}, {1, 1, 1});
  return b;
}
Bodies l_body() {
  Bodies b;
  b.box({0, 0, 0}, {1, 0.3, 0.3});
  b.box({0, 0, 0}, {0.3, 1, 0.3});
  return b;
}
Bodies plus_body() {
  Bodies b;
  b.box({-1, -0.2, -0.2}, {1, 0.2, 0.2});
  b.box({-0.2, -1, -0.2}, {0.2, 1, 0.2});
  b.box({-0.2, -0.2, -1}, {0.2, 0.2, 1});
  return b;
}
Bodies rod_body() {
  Bodies b;
  b.rod({0, 0, 0}, {1, 1, 1}, 0.03);
  return b;
}
Bodies two_bodies() {
  Bodies b;
  b.sphere({0, 0, 0}, 0.5, 12);
  b.sphere({3, 0.5, 0.2}, 0.4, 12);
  return b;
}
Bodies sphere_body() {
  Bodies b;
  b.sphere({0, 0, 0}, 0.5, 16);
  return b;
}

VectorField turn(Vec3 const& origin, Vec3 const& axis, double angle_deg) {
  RigidTransform const t = rotation_about(origin, axis, angle_deg * std::numbers::pi / 180);
  return [t](Vec3 const& p) { return t(p) - p; };
}
VectorField shift(Vec3 const& by) {
  return [by](Vec3 const&) { return by; };
}

std::vector<Case> cases() {
  return {{"box moved", box_body(), {.offset = 0.1}, shift({0.5, 0.3, 0})},
          {"box turned", box_body(), {.offset = 0.1}, turn({0, 0, 0}, {0, 0, 1}, 30)},
          {"L moved", l_body(), {.offset = 0.05}, shift({0.3, 0.3, -0.2})},
          {"L turned", l_body(), {.offset = 0.05}, turn({0, 0, 0}, {0, 0, 1}, 30)},
          {"plus moved", plus_body(), {.offset = 0.05}, shift({0.4, 0.2, 0.1})},
          {"plus turned", plus_body(), {.offset = 0.05}, turn({0, 0, 0}, {1, 1, 1}, 30)},
          {"rod moved", rod_body(), {.offset = 0.05}, shift({0.3, 0, 0})},
          {"fine rod moved", rod_body(), {.offset = 0.05, .resolution = 10}, shift({0.3, 0, 0})},
          {"rod turned", rod_body(), {.offset = 0.05, .resolution = 3}, turn({0, 0, 0}, {1, -1, 0}, 30)},
          {"two bodies",
           two_bodies(),
           {.offset = 0.1},
           [](Vec3 const& p) {
             return p.x < 1.5 ? Vec3{0.3, 0.2, 0} : Vec3{-0.2, 0.2, 0.1};
           }},
          {"sphere moved by its radius",
           sphere_body(),
           {.offset = 0.15},
           shift({0.5, 0, 0}),
           {-4.5, -4.5, -4.5},
           {4.5, 4.5, 4.5}}};
}

TEST(Background, CarriesMotionsOfAllKindsOfWrapsWithoutTurningCellsOver) {
  for (Case const& c : cases()) {
    SCOPED_TRACE(c.name);
    Planned const p = planned(c.bodies, c.options, c.low, c.high);
    std::vector<Vec3> const boundary = boundary_of(p, c.motion);
    Morphed const m = run_plan(Kokkos::DefaultHostExecutionSpace(), p.background.mesh, p.prepared.plan(), boundary);
    EXPECT_GT(smallest_determinant(p, m.position, c.low, c.high), 0.05);
    // Nothing moves further, in any direction, than the wrap does.
    Vec3 low, high;
    for (Vec3 const& u : boundary) {
      low = {std::min(low.x, u.x), std::min(low.y, u.y), std::min(low.z, u.z)};
      high = {std::max(high.x, u.x), std::max(high.y, u.y), std::max(high.z, u.z)};
    }
    double over = 0;
    for (Index n = 0; n < p.background.mesh.n_nodes(); ++n) {
      Vec3 const u = m.displacement[n];
      over = std::max({over, u.x - high.x, u.y - high.y, u.z - high.z, low.x - u.x, low.y - u.y, low.z - u.z});
    }
    EXPECT_LT(over, 0.01);
  }
}

TEST(Background, IsPlannedInASecondForTheMostCellsAWrapHas) {
  Bodies b = rod_body();
  Planned const p = planned(b, {.offset = 0.05, .resolution = 10}, {-3, -3, -3}, {4, 4, 4});
  EXPECT_GT(p.background.mesh.zones.size(), 1000u);
  auto const& s = p.prepared.seconds;
  RecordProperty("prepare_ms", int(1000 * (s.topology + s.rules + s.plan)));
  EXPECT_LT(s.topology + s.rules + s.plan, 30);  // a machine under load; measured alone: below 1 s
}

TEST(Background, JoinsCellsThatLookAlike) {
  Planned const p = planned(box_body(), {.offset = 0.1}, {-4, -4, -4}, {5, 5, 5});
  EXPECT_EQ(p.background.mesh.zones.size(), 26u);
  EXPECT_EQ(p.background.mesh.interfaces.size(), 2u * (54 - 6));
}

TEST(Background, HoldsStillWhereTheWrapDoes) {
  Planned const p = planned(plus_body(), {.offset = 0.05}, {-4, -4, -4}, {5, 5, 5});
  Morphed const m = run_plan(Kokkos::DefaultHostExecutionSpace(), p.background.mesh, p.prepared.plan(),
                             boundary_of(p, shift({0, 0, 0})));
  EXPECT_EQ(different_bits(m.position, p.background.mesh.coordinates), 0);
}

TEST(Background, TakesTheWrapsDisplacementExactlyAndNoneOnTheOuterBox) {
  Planned const p = planned(l_body(), {.offset = 0.05}, {-4, -4, -4}, {5, 5, 5});
  auto const field = waves(0.05);
  Morphed const m =
      run_plan(Kokkos::DefaultHostExecutionSpace(), p.background.mesh, p.prepared.plan(), boundary_of(p, field));
  Mesh const& mesh = p.background.mesh;
  Index on_wrap = 0;
  for (Patch const& patch : mesh.patches)
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const n = mesh.zones[patch.zone].node({i, j, k});
          Vec3 const expected = patch.families.front() == "wrap" ? field(mesh.coordinates[n]) : Vec3{};
          ASSERT_TRUE(same_bits(m.displacement[n], expected));
          on_wrap += patch.families.front() == "wrap" ? 1 : 0;
        }
  EXPECT_GT(on_wrap, 500);
}

TEST(Background, ListsEachPointOfTheWrapOnce) {
  Planned const p = planned(plus_body(), {.offset = 0.05}, {-4, -4, -4}, {5, 5, 5});
  std::map<std::tuple<double, double, double>, int> seen;
  for (Vec3 const& x : p.nodes.position) ++seen[{x.x, x.y, x.z}];
  EXPECT_EQ(seen.size(), p.nodes.position.size());
  std::map<std::tuple<double, double, double>, int> expected;
  Mesh const& mesh = p.background.mesh;
  for (Patch const& patch : mesh.patches)
    if (patch.families.front() == "wrap")
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
            Vec3 const x = mesh.coordinates[mesh.zones[patch.zone].node({i, j, k})];
            ++expected[{x.x, x.y, x.z}];
          }
  EXPECT_EQ(seen.size(), expected.size());
  for (auto const& [point, count] : expected) ASSERT_EQ(seen.count(point), 1u);
}

TEST(Background, OfAPlaneMeshMovesInItsPlaneOnly) {
  Bodies b;
  b.polygon({{0, 0, 0}, {0.5, 0.2, 0}, {1, 0.1, 0}, {0.5, -0.1, 0}});
  Planned const p = planned(b, {.offset = 0.08}, {-4, -4, 0}, {5, 4, 0}, 2);
  EXPECT_EQ(p.wrap.cells(2), 1);
  Morphed const m = run_plan(Kokkos::DefaultHostExecutionSpace(), p.background.mesh, p.prepared.plan(),
                             boundary_of(p, turn({0, 0, 0}, {0, 0, 1}, 30)));
  EXPECT_GT(smallest_determinant(p, m.position, {-4, -4, -1}, {5, 4, 1}), 0.2);
  Index moved = 0;
  for (Zone const& zone : p.background.mesh.zones)
    for (int j = 0; j < zone.extent[1]; ++j)
      for (int i = 0; i < zone.extent[0]; ++i) {
        Vec3 const below = m.displacement[zone.node({i, j, 0})], above = m.displacement[zone.node({i, j, 1})];
        ASSERT_TRUE(same_bits(below, above));
        ASSERT_EQ(below.z, 0);
        moved += norm(below) > 0 ? 1 : 0;
      }
  EXPECT_GT(moved, 500);
}

/// Rows of a far field, applied on the host.
std::vector<Vec3> gathered(InterpolationOperator const& rows, Coordinates const& u) {
  std::vector<Vec3> out;
  for (Index r = 0; r < rows.size(); ++r) {
    Vec3 sum;
    for (Index k = rows.first[r]; k < rows.first[r + 1]; ++k) sum += double(rows.weight[k]) * u[rows.item[k]];
    out.push_back(sum);
  }
  return out;
}

Coordinates points_of(std::vector<Vec3> const& points) {
  Coordinates c(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) c.set(Index(n), points[n]);
  return c;
}

TEST(LatticeRows, ReproduceFieldsThatAreLinearInEveryDirection) {
  Planned const p = planned(plus_body(), {.offset = 0.05}, {-4, -4, -4}, {5, 5, 5});
  auto const field = [](Vec3 const& x) { return Vec3{1 + x.x * x.y, x.x - 2 * x.y * x.z, x.x * x.y * x.z}; };
  Mesh const& mesh = p.background.mesh;
  // Within each cell the field is trilinear, so that rows must give it exactly at any point of any cell.
  Coordinates u(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) u.set(n, field(mesh.coordinates[n]));
  std::vector<Vec3> points;
  std::vector<Index32> numbers;
  unsigned state = 7;
  auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return double(state >> 8) / double(1u << 24);
  };
  while (points.size() < 5000) {
    Vec3 const x{-4 + 9 * random(), -4 + 9 * random(), -4 + 9 * random()};
    if (p.wrap.contains(x)) continue;
    numbers.push_back(Index32(points.size()));
    points.push_back(x);
  }
  FarRows const far = lattice_rows({}, p.background, points_of(points), numbers);
  EXPECT_EQ(far.n_outside, 0);
  EXPECT_EQ(far.rows.target, numbers);
  std::vector<Vec3> const got = gathered(far.rows, u);
  for (std::size_t n = 0; n < points.size(); ++n) ASSERT_LT(norm(got[n] - field(points[n])), 2e-5) << n;
}

TEST(LatticeRows, NameOneNodeForAPointOnANode) {
  Planned const p = planned(box_body(), {.offset = 0.1}, {-4, -4, -4}, {5, 5, 5});
  Mesh const& mesh = p.background.mesh;
  std::vector<Index32> nodes;
  for (Index32 n = 0; n < Index32(mesh.n_nodes()); n += 97) nodes.push_back(n);
  FarRows const far = lattice_rows({}, p.background, mesh.coordinates, nodes);
  EXPECT_EQ(far.n_outside, 0) << "nodes of the wrap's surface are not inside it";
  for (Index r = 0; r < far.rows.size(); ++r) {
    ASSERT_EQ(far.rows.first[r + 1] - far.rows.first[r], 1);
    Index32 const item = far.rows.item[far.rows.first[r]];
    ASSERT_EQ(norm(mesh.coordinates[item] - mesh.coordinates[nodes[r]]), 0);
  }
}

TEST(LatticeRows, CountPointsInTheWrapAndBeyondTheBoxAndTakeTheNearestPlace) {
  Planned const p = planned(box_body(), {.offset = 0.1}, {-4, -4, -4}, {5, 5, 5});
  std::vector<Vec3> const points{{0.5, 0.4, 0.95}, {7, 0, 0}, {2, 2, 2}};
  std::vector<Index32> const nodes{0, 1, 2};
  FarRows const far = lattice_rows({}, p.background, points_of(points), nodes);
  EXPECT_EQ(far.n_outside, 2);
  EXPECT_NEAR(far.largest_distance, 2, 1e-6);
  std::vector<Vec3> const at = gathered(far.rows, p.background.mesh.coordinates);
  EXPECT_LT(norm(at[0] - Vec3{0.5, 0.4, 1.1}), 1e-5);
  EXPECT_LT(norm(at[1] - Vec3{5, 0, 0}), 1e-5);
  EXPECT_LT(norm(at[2] - Vec3{2, 2, 2}), 1e-5);
}

TEST(LatticeRows, InAPlaneNeedNoThirdCoordinate) {
  Bodies b;
  b.polygon({{0, 0, 0}, {0.5, 0.2, 0}, {1, 0.1, 0}, {0.5, -0.1, 0}});
  Planned const p = planned(b, {.offset = 0.08}, {-4, -4, 0}, {5, 4, 0}, 2);
  std::vector<Vec3> const points{{3, 2, 0}, {-1, 0.3, 0}};
  std::vector<Index32> const nodes{0, 1};
  FarRows const far = lattice_rows({}, p.background, points_of(points), nodes);
  EXPECT_EQ(far.n_outside, 0);
  std::vector<Vec3> const at = gathered(far.rows, p.background.mesh.coordinates);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_LE(far.rows.first[n + 1] - far.rows.first[n], 4);
    EXPECT_NEAR(at[n].x, points[n].x, 1e-6);
    EXPECT_NEAR(at[n].y, points[n].y, 1e-6);
  }
}

TEST(Background, OfTheUsersIsTakenWithTheSelectorsOfItsPatches) {
  Planned p = planned(box_body(), {.offset = 0.1}, {-4, -4, -4}, {5, 5, 5});
  Background mine = make_background(p.background.mesh, {"type:wall"}, {"outer"});
  PreparedMorph const prepared = prepare_background({}, mine);
  EXPECT_EQ(wrap_nodes(mine, prepared).position.size(), p.nodes.position.size());
  EXPECT_THROW(make_background(p.background.mesh, {"hull"}, {}), MotionError);
  std::vector<Index32> const nodes{0};
  expect_all_in(message_of<MeshError>([&] { lattice_rows({}, mine, mine.mesh.coordinates, nodes); }), {"lattice"});
}

}  // namespace
}  // namespace gridmorph::test
