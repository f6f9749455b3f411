#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/classify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/unstructured_meshes.hpp"

namespace gridmorph::test {
namespace {

Bodies diagonal_rod() {
  Bodies b;
  b.rod({0, 0, 0}, {1, 1, 1}, 0.03);
  return b;
}
Bodies ball_on_a_rope() {
  Bodies b;
  b.sphere({0, 0, 0}, 0.5, 16);
  b.rod({0, 0, 0.4}, {0, 0, 5}, 0.05);
  return b;
}
Bodies plank() {
  Bodies b;
  b.box({0, 0, 0}, {3, 0.5, 0.1});
  return b;
}
/// A swept, tapered, twisted wing whose sections are flat ellipses.
Bodies wing() {
  Bodies b;
  constexpr int n = 12, m = 24;
  b.grid(n, m, [](int j, int i) {
    double const s = double(j) / n, f = 2 * std::numbers::pi * i / m, chord = 1 - 0.6 * s, twist = 0.3 * s;
    double const x = 0.5 * chord * std::cos(f), y = 0.06 * chord * std::sin(f);
    return Vec3{1.5 * s + x * std::cos(twist) - y * std::sin(twist), x * std::sin(twist) + y * std::cos(twist), 4 * s};
  });
  return b;
}

struct TubeCase {
  char const* name;
  Bodies bodies;
  double offset;
  Vec3 low, high;    ///< domain
  Vec3 pivot, axis;  ///< of a turn by 30 degrees
};

std::vector<TubeCase> tube_cases() {
  return {{"rod", diagonal_rod(), 0.05, {-3, -3, -3}, {4, 4, 4}, {0, 0, 0}, {1, -1, 0}},
          {"ball on a rope", ball_on_a_rope(), 0.1, {-5, -5, -3}, {5, 5, 5}, {0, 0, 5}, {0, 1, 0}},
          {"plank", plank(), 0.1, {-4, -4, -4}, {6, 4, 4}, {0, 0, 0}, {0, 0, 1}},
          {"wing", wing(), 0.1, {-20, -20, 0}, {20, 20, 20}, {0, 0, 0}, {1, 0, 0}}};
}

gridmorph::Wrap tube_wrap(TubeCase const& c) {
  WrapOptions options;
  options.offset = c.offset;
  options.tube = true;
  return make_wrap({}, c.bodies.in_domain(c.low, c.high), c.bodies.walls, options);
}

TEST(Tube, HoldsItsWallsWithTheirOffset) {
  for (TubeCase const& c : tube_cases()) {
    SCOPED_TRACE(c.name);
    gridmorph::Wrap const wrap = tube_wrap(c);
    ASSERT_TRUE(wrap.tube) << wrap.note;
    double const reach = 0.95 * c.offset;
    for (Vec3 const& p : c.bodies.points())
      for (Vec3 const& step :
           {Vec3{}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
        ASSERT_TRUE(wrap.contains(p + reach * step)) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(Tube, IsSlimAndFollowsItsWalls) {
  TubeCase const c = tube_cases()[0];
  Tube const tube = *tube_wrap(c).tube;
  EXPECT_NEAR(std::abs(dot(tube.axis, Vec3{1, 1, 1})), std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(tube.length(), std::sqrt(3.0) + 0.1, 0.02);
  EXPECT_LT(tube.largest_radius(), 0.09);
  EXPECT_FALSE(tube.contains({0.5, 0.5, 0.7}));
  Tube const flat = *tube_wrap(tube_cases()[3]).tube;
  // Above the wing, half a chord: a round tube would hold it.
  EXPECT_FALSE(flat.contains({0.3, 0.45, 1}));
  EXPECT_TRUE(flat.contains({0.7, 0.02, 1}));
}

TEST(Tube, EndsWhereItsMeshDoes) {
  for (TubeCase const& c : tube_cases()) {
    SCOPED_TRACE(c.name);
    gridmorph::Wrap const wrap = tube_wrap(c);
    Tube const& tube = *wrap.tube;
    Mesh const mesh = wrap_mesh(wrap);
    check_mesh(mesh);
    EXPECT_EQ(mesh.n_elements(), Index(tube.sections() - 1) * tube.around);
    for (int j = 0; j + 1 < tube.sections(); ++j)
      for (int k = 0; k < tube.around; ++k) {
        // Middle of a bilinear face of the surface, a little moved inwards and outwards.
        Vec3 const c0 = 0.5 * (tube.centre[j] + tube.centre[j + 1]);
        Vec3 const p =
            0.25 * (tube.point(j, k) + tube.point(j, k + 1) + tube.point(j + 1, k) + tube.point(j + 1, k + 1));
        ASSERT_TRUE(tube.contains(p + 1e-6 * (c0 - p)));
        ASSERT_FALSE(tube.contains(p - 1e-6 * (c0 - p)));
      }
  }
}

TEST(Tube, IsNotFittedAroundWhatIsWideOrTornApart) {
  TubeCase wide{"sphere", {}, 0.1, {-4, -4, -4}, {4, 4, 4}, {}, {}};
  wide.bodies.sphere({0, 0, 0}, 0.5, 12);
  gridmorph::Wrap const around = tube_wrap(wide);
  EXPECT_FALSE(around.tube);
  EXPECT_NE(around.note.find("no tube"), std::string::npos) << around.note;
  EXPECT_GT(around.n_inside(), 20) << "cells of the lattice instead";

  TubeCase torn{"two spheres", {}, 0.1, {-4, -4, -4}, {9, 4, 4}, {}, {}};
  torn.bodies.sphere({0, 0, 0}, 0.3, 12);
  torn.bodies.sphere({6, 0, 0}, 0.3, 12);
  gridmorph::Wrap const apart = tube_wrap(torn);
  EXPECT_FALSE(apart.tube);
  EXPECT_NE(apart.note.find("gaps"), std::string::npos) << apart.note;
  EXPECT_FALSE(apart.contains({3, 0, 0}));
}

/// det of the Jacobian, moved over baseline, at the corner nodes of a cell; the smallest of all cells in the domain.
double smallest_volume_ratio(TubeCase const& c, Mesh const& mesh, Coordinates const& moved) {
  double least = 1;
  for (Zone const& zone : mesh.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i) {
          Index3 const cell{i, j, k};
          bool within = true;
          double ratio = 1;
          for (int n = 0; n < 8; ++n) {
            Index3 const at{i + (n & 1), j + (n >> 1 & 1), k + (n >> 2)};
            Vec3 const p = mesh.coordinates[zone.node(at)];
            within = within && p.x >= c.low.x && p.y >= c.low.y && p.z >= c.low.z && p.x <= c.high.x &&
                     p.y <= c.high.y && p.z <= c.high.z;
            std::array<Vec3, 3> before, after;
            for (std::size_t a = 0; a < 3; ++a) {
              Index3 from = at, to = at;
              from[a] = cell[a];
              to[a] = cell[a] + 1;
              before[a] = mesh.coordinates[zone.node(to)] - mesh.coordinates[zone.node(from)];
              after[a] = moved[zone.node(to)] - moved[zone.node(from)];
            }
            ratio =
                std::min(ratio, dot(after[0], cross(after[1], after[2])) / dot(before[0], cross(before[1], before[2])));
          }
          if (within) least = std::min(least, ratio);
        }
  return least;
}

TEST(OTypeBackground, CarriesTurnsOfLongBodiesWithoutTurningCellsOver) {
  for (TubeCase const& c : tube_cases()) {
    SCOPED_TRACE(c.name);
    Background background = make_background(tube_wrap(c));
    EXPECT_EQ(background.mesh.zones.size(), 22u);
    PreparedMorph const prepared = prepare_background({}, background);
    WrapNodes const nodes = wrap_nodes(background, prepared);
    RigidTransform const turn = rotation_about(c.pivot, c.axis, std::numbers::pi / 6);
    std::vector<Vec3> boundary(prepared.plan().boundary_nodes.size());
    double largest = 0;
    for (std::size_t n = 0; n < nodes.position.size(); ++n) {
      Vec3 const u = turn(nodes.position[n]) - nodes.position[n];
      boundary[nodes.boundary_node[n]] = u;
      largest = std::max({largest, std::abs(u.x), std::abs(u.y), std::abs(u.z)});
    }
    Morphed const m = run_plan(Kokkos::DefaultHostExecutionSpace(), background.mesh, prepared.plan(), boundary);
    EXPECT_GT(smallest_volume_ratio(c, background.mesh, m.position), 0.01);
    double beyond = 0;
    for (Index n = 0; n < background.mesh.n_nodes(); ++n) {
      Vec3 const u = m.displacement[n];
      beyond = std::max({beyond, std::abs(u.x) - largest, std::abs(u.y) - largest, std::abs(u.z) - largest});
    }
    EXPECT_LT(beyond, 0.01 * largest);
    Mesh const& mesh = background.mesh;
    for (Patch const& patch : mesh.patches)
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
            Index const n = mesh.zones[patch.zone].node({i, j, k});
            Vec3 const x = mesh.coordinates[n];
            Vec3 const expected = patch.families.front() == "wrap" ? turn(x) - x : Vec3{};
            ASSERT_LT(norm(m.displacement[n] - expected), 1e-12 * mesh.size());
          }
  }
}

TEST(OTypeBackground, IsBoundedByTheTubeAndByTheBox) {
  for (TubeCase const& c : tube_cases()) {
    SCOPED_TRACE(c.name);
    gridmorph::Wrap const wrap = tube_wrap(c);
    Background const background = make_background(wrap);
    Mesh const& mesh = background.mesh;
    // Volume: that of the box less that of the tube, each by sums over the tetrahedra of its cells' faces.
    Mesh const tube = wrap_mesh(wrap), cells = as_hexahedra(mesh);
    auto volume = [](Mesh const& m) {
      double sum = 0;
      std::array<Index32, max_face_corners> room{};
      for (Index e = 0; e < m.n_elements(); ++e)
        for (int s = 0; s < n_sides(m, e); ++s) {
          auto const side = side_nodes(m, e, s, room);
          Vec3 middle;
          for (Index32 const n : side) middle += (1.0 / double(side.size())) * m.coordinates[n];
          for (std::size_t a = 0; a < side.size(); ++a)
            sum += dot(middle, cross(m.coordinates[side[a]], m.coordinates[side[(a + 1) % side.size()]])) / 6;
        }
      return sum;
    };
    double box = 1;
    for (std::size_t a = 0; a < 3; ++a) box *= wrap.planes[a].back() - wrap.planes[a].front();
    double const inside = volume(tube);
    EXPECT_GT(inside, 0);
    EXPECT_NEAR(volume(cells), box - inside, 1e-9 * box);
  }
}

TEST(OTypeBackground, RowsReproduceLinearFieldsAtPointsOfTheFarField) {
  TubeCase const c = tube_cases()[3];
  gridmorph::Wrap const wrap = tube_wrap(c);
  Background const background = make_background(wrap);
  std::vector<Vec3> points;
  unsigned state = 3;
  auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return double(state >> 8) / double(1u << 24);
  };
  while (points.size() < 3000) {
    double const size = points.size() % 2 == 0 ? 3 : 20;
    Vec3 const x{size * (2 * random() - 1), size * (2 * random() - 1), size * random()};
    if (!wrap.contains(x)) points.push_back(x);
  }
  Coordinates at(Index(points.size()));
  std::vector<Index32> nodes;
  for (std::size_t n = 0; n < points.size(); ++n) {
    at.set(Index(n), points[n]);
    nodes.push_back(Index32(n));
  }
  FarRows const far = background_rows({}, background, at, nodes);
  EXPECT_EQ(far.n_outside, 0);
  EXPECT_EQ(far.rows.target, nodes);
  for (Index r = 0; r < far.rows.size(); ++r) {
    Vec3 sum;
    for (Index k = far.rows.first[r]; k < far.rows.first[r + 1]; ++k)
      sum += double(far.rows.weight[k]) * background.mesh.coordinates[far.rows.item[k]];
    ASSERT_LT(norm(sum - points[r]), 2e-5) << r;
  }
}

TEST(Classification, OfATubeNamesEveryElementThatHasAPointInIt) {
  Mesh const mesh = to_prisms_and_tetrahedra(unit_box({10, 10, 24}), 4);
  Bodies rod;
  rod.rod({4.3, 5.1, 3}, {5.4, 4.6, 21}, 0.6);
  Mesh with_rod = rod.in_domain({0, 0, 0}, {10, 10, 24});
  WrapOptions options;
  options.offset = 0.7;
  options.tube = true;
  gridmorph::Wrap const wrap = make_wrap({}, with_rod, rod.walls, options);
  ASSERT_TRUE(wrap.tube) << wrap.note;
  Classification const found = classify({}, mesh, wrap);
  EXPECT_GT(found.n_near, 50);
  EXPECT_GT(found.n_partial, 100);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    Vec3 middle;
    int inside = 0;
    for (Index32 const n : corners) {
      middle += (1.0 / double(corners.size())) * mesh.coordinates[n];
      inside += int(wrap.contains(mesh.coordinates[n]));
    }
    Region const region = found.element[e];
    ASSERT_EQ(region == Region::near, inside == int(corners.size()));
    if (inside > 0 || wrap.contains(middle)) {
      ASSERT_NE(region, Region::far);
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
