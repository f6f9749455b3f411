// The ffd rule on patches: against plain sums of polynomials, translations and linear fields; how it ends at the faces
// of its box.
#include "moved_nodes.hpp"
#include "plain_splines.hpp"
#include "support/cascade.hpp"
#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace gridmorph::test {
namespace {

FfdRule ffd(std::array<int, 3> counts, int degree, std::optional<FfdBox> box = {}) {
  FfdRule out;
  out.counts = counts;
  for (std::size_t a = 0; a < 3; ++a) out.degree[a] = std::min(degree, counts[a] - 1);
  out.displacement.assign(out.size(), {});
  out.box = box;
  return out;
}

FfdBox box_of(Vec3 const& from, Vec3 const& to) {
  Vec3 const e = to - from;
  return {from, {Vec3{e.x, 0, 0}, Vec3{0, e.y, 0}, Vec3{0, 0, e.z}}};
}

/// A plate z = 0, (x, y) in [0, 1]^2, of n x n nodes: the patch "plate".
Mesh plate(int n) {
  MeshBuilder builder("plate");
  int const zone = builder.zone("plate", {n, n, 2}, [n](Index3 const& at) {
    return Vec3{double(at[0]) / (n - 1), double(at[1]) / (n - 1), double(at[2])};
  });
  builder.patch("plate", PatchKind::wall, zone, 2, 0);
  builder.patch("top", PatchKind::farfield, zone, 2, 1);
  for (int axis = 0; axis < 2; ++axis)
    for (int side = 0; side < 2; ++side)
      builder.patch("xy"[axis] + std::string(side == 0 ? "_min" : "_max"), PatchKind::other, zone, axis, side);
  return builder.finish();
}

/// A rule for the wall inside around_a_box(); its sides stand.
Motion on_step(FfdRule const& lattice) {
  return motion({rule({"step"}, lattice), rule({"u_*", "v_*", "w_*"}, FixedRule{})});
}

/// Displacement of any point by a rule for the plate.
Vec3 at_point(BoundaryMotion const& moves, Vec3 const& point) {
  Vec3 u{7, 7, 7};
  moves.displacement(0, {&point, 1}, {&u, 1});
  return u;
}

TEST(Ffd, EqualDisplacementsTranslateEveryNodeExactly) {
  Vec3 const by{0.1, -0.02, 1.0 / 3};
  for (Mesh const& mesh : {around_a_box(3), to_prisms_and_tetrahedra(unit_box({3, 4, 3}), 1)}) {
    for (int const degree : {1, 2, 3, 5}) {
      FfdRule rule_of_all = ffd({7, 5, 6}, degree);
      rule_of_all.displacement.assign(rule_of_all.size(), by);
      for (auto const& [n, at, u] :
           moved_nodes(mesh, mesh.elements.size() == 0 ? on_step(rule_of_all) : motion({rule({"k_min"}, rule_of_all)})))
        EXPECT_EQ(u, by);
    }
  }
}

TEST(Ffd, DisplacementsLinearInTheControlPointsAreLinearInTheNodes) {
  Mesh const mesh = around_a_box(5);
  FfdBox const box{{-3, -3, -3}, {Vec3{8, 1, 0}, Vec3{0, 8, 1}, Vec3{-1, 0, 8}}};
  Mat3 const linear{{{0.1, -0.2, 0.03}, {0.4, 0.1, -0.3}, {-0.1, 0.2, 0.05}}};
  for (int const degree : {1, 2, 3, 6}) {
    FfdRule lattice = ffd({7, 3, 4}, degree, box);
    lattice.displacement = at_control_points(lattice, [&](Vec3 const& p) {
      return linear * (box.origin + p.x * box.edges[0] + p.y * box.edges[1] + p.z * box.edges[2]);
    });
    for (auto const& [n, at, u] : moved_nodes(mesh, on_step(lattice))) EXPECT_LE(distance(u, linear * at), 1e-14);
  }
}

TEST(Ffd, IsTheSumOfPolynomialsInItsBoxAndInALatticeOfTheSamePoints) {
  Random random(8);
  Mesh const mesh = plate(9);
  FfdBox const box{{-0.5, -0.2, -1}, {Vec3{2, 0, 0.1}, Vec3{-0.3, 1.5, 0}, Vec3{0, 0.1, 2}}};
  FfdRule lattice = ffd({4, 5, 3}, 4, box);  // Bernstein
  for (Vec3& d : lattice.displacement) d = random.vector(0.2);
  FfdRule same = lattice;
  same.points = at_control_points(lattice, [&](Vec3 const& p) {
    return box.origin + p.x * box.edges[0] + p.y * box.edges[1] + p.z * box.edges[2];
  });
  same.box.reset();
  auto const nodes = moved_nodes(mesh, motion({rule({"plate"}, lattice)})),
             others = moved_nodes(mesh, motion({rule({"plate"}, same)}));
  // (s, t, w) by Cramer's rule.
  auto const& e = box.edges;
  double const volume = dot(cross(e[0], e[1]), e[2]);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Vec3 const arm = nodes[n].at - box.origin;
    Vec3 const place{dot(arm, cross(e[1], e[2])) / volume, dot(cross(e[0], arm), e[2]) / volume,
                     dot(cross(e[0], e[1]), arm) / volume};
    EXPECT_LE(distance(nodes[n].u, plain_bezier(lattice, lattice.displacement, place)), 1e-15);
    EXPECT_LE(distance(nodes[n].u, plain_sum(lattice, lattice.displacement, place)), 1e-15);
    EXPECT_LE(distance(nodes[n].u, others[n].u), 1e-12);
  }
}

TEST(Ffd, TurnsWithItsBoxAndMesh) {
  Random random(9);
  Mesh const mesh = around_a_box(2);
  RigidTransform const turn = rotation_about({0.3, 1, -2}, (1 / norm(Vec3{1, 2, -1})) * Vec3{1, 2, -1}, 0.7);
  auto const turned = [&](Vec3 const& v) { return turn(v) - turn({0, 0, 0}); };
  FfdBox const box = box_of({-3, -3, -3}, {4, 4, 4});
  FfdRule lattice = ffd({4, 3, 5}, 2, box);
  for (Vec3& d : lattice.displacement) d = random.vector(0.1);
  FfdRule other = lattice;
  other.box = FfdBox{turn(box.origin), {turned(box.edges[0]), turned(box.edges[1]), turned(box.edges[2])}};
  for (Vec3& d : other.displacement) d = turned(d);
  Mesh turned_mesh = mesh;
  turned_mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) turned_mesh.coordinates.set(n, turn(mesh.coordinates[n]));
  auto const nodes = moved_nodes(mesh, on_step(lattice)), others = moved_nodes(turned_mesh, on_step(other));
  ASSERT_EQ(nodes.size(), others.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) EXPECT_LE(distance(turned(nodes[n].u), others[n].u), 1e-13);
}

TEST(Ffd, NothingDependsOnHowZonesAreStored) {
  Random random(10);
  Mesh const mesh = around_a_box(4);
  FfdRule lattice = ffd({5, 4, 3}, 3);
  for (Vec3& d : lattice.displacement) d = random.vector(0.1);
  Motion const moves = on_step(lattice);
  std::map<Index, Vec3> expected;
  for (auto const& [n, at, u] : moved_nodes(mesh, moves)) expected[n] = u;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    ScrambledMesh const other = scramble(mesh, {.seed = seed, .cuts = 2});
    for (auto const& [n, at, u] : moved_nodes(other.mesh, moves))
      EXPECT_LE(distance(u, expected.at(other.old_node[n])), 1e-15) << seed;
  }
}

TEST(Ffd, EndsAtFacesThatThePatchCutsWithTheContinuityAskedFor) {
  Mesh const mesh = plate(41);
  FfdBox const box = box_of({0.313, -0.5, -1}, {0.777, 1.5, 1});
  for (int const continuity : {0, 1, 2})
    for (int const degree : {3, 8}) {
      FfdRule lattice = ffd({9, 3, 3}, degree, box);
      lattice.continuity = continuity;
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          for (int i = continuity + 1; i < 8 - continuity; ++i)
            lattice.displacement[lattice.number(i, j, k)] = {0.01, 0, 0.1};
      BoundaryMotion const moves(mesh, resolve(mesh, motion({rule({"plate"}, lattice)})));
      for (double const y : {0.1, 0.5, 0.93})
        for (bool const upper : {false, true}) {
          double const face = upper ? 0.777 : 0.313, inwards = upper ? -1 : 1;
          EXPECT_EQ(at_point(moves, {face, y, 0}), Vec3{});
          EXPECT_EQ(at_point(moves, {face - inwards * 1e-3, y, 0}), Vec3{});
          // u ~ h^(continuity + 1): that many derivatives are zero at the face, and no more.
          double const h = 1e-4;
          double const far = norm(at_point(moves, {face + inwards * h, y, 0})),
                       near = norm(at_point(moves, {face + inwards * h / 2, y, 0}));
          ASSERT_GT(near, 0);
          EXPECT_NEAR(std::log2(far / near), continuity + 1, 0.01);
        }
    }
}

TEST(Ffd, HoldsOnlyTheFacesThatThePatchCuts) {
  Mesh const mesh = plate(11);
  FfdRule lattice = ffd({5, 4, 3}, 2, box_of({0.25, -0.1, -1}, {1, 1.1, 0}));  // the plate ends on i-max, lies in k-max
  lattice.displacement[lattice.number(4, 0, 2)] = {0, 0, 0.1};
  lattice.displacement[lattice.number(2, 3, 2)] = {0, 0, 0.1};
  std::vector<std::string> notes;
  auto const nodes = moved_nodes(mesh, motion({rule({"plate"}, lattice)}), &notes);
  int moved = 0, outside = 0;
  for (auto const& [n, at, u] : nodes) {
    moved += norm(u) > 0 ? 1 : 0;
    outside += at.x < 0.25 ? 1 : 0;
    if (at.x < 0.25) {
      EXPECT_EQ(u, Vec3{});
    }
  }
  EXPECT_GT(moved, 40);
  ASSERT_EQ(notes.size(), 1u);
  expect_all_in(notes[0], {"88 of 121 nodes are inside", "33 outside stay", "run out through i-min,", "2 layers"});
  EXPECT_EQ(outside, 33);
}

TEST(Ffd, DisplacementsInHeldLayersAreRefusedByName) {
  Mesh const mesh = plate(11);
  FfdRule lattice = ffd({6, 4, 2}, 3, box_of({0.25, -0.1, -1}, {0.85, 1.1, 1}));
  lattice.displacement[lattice.number(1, 2, 0)] = {0, 0, 0.1};
  lattice.displacement[lattice.number(2, 2, 1)] = {0, 0, 0.1};
  auto const run = [&] { (void)moved_nodes(mesh, motion({rule({"plate"}, lattice)})); };
  expect_all_in(message_of<MotionError>(run), {"rule 1 (ffd", "i-min, i-max", "continuity 1 holds 2 layers",
                                               "(2, 3, 1) is displaced", "open_faces", "Continuity 0 would do"});
  lattice.continuity = 0;
  EXPECT_NO_THROW(run());
  lattice.displacement[lattice.number(5, 0, 0)] = {0, 0, 0.1};
  expect_all_in(message_of<MotionError>(run), {"(6, 1, 1) is displaced"});
  lattice.open[1] = true;
  std::vector<std::string> notes;
  (void)moved_nodes(mesh, motion({rule({"plate"}, lattice)}), &notes);
  expect_all_in(notes.at(0), {"i-min, where 1 layers", "i-max, open"});
}

TEST(Ffd, CutFacesAreFoundOnElementsAndInBentLatticesToo) {
  Mesh const blocks = plate(21), elements = to_prisms_and_tetrahedra(blocks, 1);
  FfdRule lattice = ffd({5, 5, 3}, 2);
  lattice.points = at_control_points(lattice, [](Vec3 const& p) {
    return Vec3{-0.3 + 0.9 * p.x + 0.1 * p.y * p.y, -0.2 + 1.4 * p.y + 0.1 * p.x * p.x, 2 * p.z - 1 + 0.2 * p.x * p.y};
  });
  lattice.displacement[lattice.number(1, 2, 1)] = {0, 0, 0.1};
  for (Mesh const& mesh : {blocks, elements}) {
    std::vector<std::string> notes;
    (void)moved_nodes(mesh, motion({rule({"plate"}, lattice)}), &notes);
    expect_all_in(notes.at(0), {"run out through i-max, where"});
  }
}

TEST(Ffd, FitsItsBoxToThePatches) {
  Mesh const mesh = plate(5);
  FfdRule lattice = ffd({3, 3, 2}, 2);
  lattice.margin = 0.1;
  lattice.displacement.assign(lattice.size(), {0, 0, 0.5});
  std::vector<std::string> notes;
  (void)moved_nodes(mesh, motion({rule({"plate"}, lattice)}), &notes);
  expect_all_in(notes.at(0),
                {"box from (-0.1, -0.1, -0.1) along (1.2, 0, 0), (0, 1.2, 0) and (0, 0, 0.2)", "25 of 25"});
  // The box stays when displacements change.
  BoundaryMotion const moves(mesh, resolve(mesh, motion({rule({"plate"}, lattice)})));
  FfdRule other = lattice;
  other.displacement.assign(other.size(), {0.25, 0, 0});
  other.share = 0.5;
  EXPECT_EQ(at_point(moves.with(motion({rule({"plate"}, other)})), {0.5, 0.5, 0}), (Vec3{0.125, 0, 0}));
  EXPECT_EQ(at_point(moves.with(motion({rule({"plate"}, other)})), {-0.11, 0.5, 0}), Vec3{});
}

TEST(Ffd, OnePointAcrossIsTheSameEverywhereAcross) {
  Mesh const mesh = flat_box(6, 4, 2);  // a 2-D mesh in z = 0
  FfdRule lattice = ffd({4, 3, 1}, 3);
  for (std::size_t n = 0; n < lattice.size(); ++n) lattice.displacement[n] = {0, 0.01 * double(n), 0};
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"j_min"}, lattice)}))) {
    EXPECT_EQ(u.z, 0);
    EXPECT_GT(u.y, 0);
  }
}

TEST(Ffd, ShareIsOfAllDisplacementsAndZeroIsZero) {
  Random random(11);
  Mesh const mesh = plate(5);
  FfdRule lattice = ffd({4, 4, 2}, 3, box_of({-0.1, -0.1, -1}, {1.1, 1.1, 1}));
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"plate"}, lattice)}))) EXPECT_EQ(u, Vec3{});
  for (Vec3& d : lattice.displacement) d = random.vector(1);
  FfdRule half = lattice;
  half.share = 0.5;
  auto const whole = moved_nodes(mesh, motion({rule({"plate"}, lattice)})),
             part = moved_nodes(mesh, motion({rule({"plate"}, half)}));
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_EQ(0.5 * whole[n].u, part[n].u);
}

// In an H mesh the two sides of a blade stand a pitch apart, where the lattice has other displacements. The edges are
// on both sides and tear; where the lattice says the same across the pitch, nothing does.

/// A lattice around all of the blades, its displacements those of `at` for the place of a control point in it.
FfdRule around_blades(std::array<int, 3> counts, std::function<Vec3(Vec3 const&)> const& at) {
  FfdRule out = ffd(counts, 2, box_of({-0.5, -0.25, -0.5}, {1.75, 0.75, 1.75}));
  out.displacement = at_control_points(out, at);
  return out;
}
Motion on_h_blade(FfdRule const& lattice) {
  return motion({rule({"blade"}, lattice), rule({"inlet", "outlet"}, FixedRule{}), rule({"hub", "case"}, FreeRule{})});
}

TEST(FfdOnHBlades, TheSameAcrossThePitchMovesBothSidesAlike) {
  FfdRule const lattice = around_blades({4, 3, 1}, [](Vec3 const& p) {
    return Vec3{0.02 * p.y, 0, 0.1 * p.x * p.y + 0.03 * p.x};
  });
  for (unsigned const seed : {0u, 1u, 2u}) {
    // Cut, so that each side is in other blocks.
    Mesh const mesh = seed == 0 ? cascade() : scramble(cascade(), {.seed = seed, .cuts = 3}).mesh;
    Outcome const moved = morph(mesh, on_h_blade(lattice));
    double largest = 0;
    Index copies = 0;
    FfdLattice const places(lattice, "test");
    std::map<std::array<long, 2>, std::vector<Vec3>> sides;
    for (std::size_t p = 0; p < moved.mesh.patches.size(); ++p) {
      if (moved.mesh.patches[p].families.front() != "blade") continue;
      for (Index const n : moved.prepared.surface.boundary().surface(int(p)).nodes) {
        Vec3 const x = moved.mesh.coordinates[n], u = moved.u(n);
        EXPECT_LE(distance(u, plain_sum(lattice, lattice.displacement, *places.place(x))), 1e-15);
        largest = std::max(largest, norm(u));
        auto& there = sides[{std::lround(1e9 * x.x), std::lround(1e9 * x.y)}];
        for (Vec3 const& other : there) EXPECT_LE(distance(u, other), 1e-15);
        copies += there.empty() ? 0 : 1;
        there.push_back(u);
      }
    }
    EXPECT_GT(largest, 0.05);
    EXPECT_GE(copies, 9 * 15);
  }
}

TEST(FfdOnHBlades, WhatTearsTheEdgesIsNamedWithItsCause) {
  FfdRule const across = around_blades({4, 3, 2}, [](Vec3 const& p) {
    return Vec3{0, 0, 0.1 * p.x * (1 - p.z) + 0.01};
  });
  FfdRule const same = around_blades({4, 3, 1}, [](Vec3 const&) { return Vec3{0, 0, 0.1}; });
  for (unsigned const seed : {0u, 3u}) {
    auto const said = [&](Mesh const& mesh, FfdRule const& lattice) {
      Mesh const cut = seed == 0 ? mesh : scramble(mesh, {.seed = seed, .cuts = 3}).mesh;
      return message_of<MotionError>([&] { (void)morph(cut, on_h_blade(lattice)); });
    };
    expect_all_in(said(cascade(), across), {"(ffd) gives", "nodes of 'blade' and their periodic copies", "apart by",
                                            "a pitch apart, as in H meshes", "one control point along it"});
    // About an axis no lattice turns its displacements from pitch to pitch.
    FfdRule around_axis = same;
    around_axis.box = box_of({-0.5, -5, -5}, {1.75, 5, 5});
    expect_all_in(said(cascade(2), around_axis),
                  {"(ffd) gives", "their periodic copies", "in every pitch of 22.9183 degrees",
                   "a pitch apart, as in H meshes", "no lattice", "the rule sections"});
  }
}

TEST(FfdErrors, SayWhatIsWrongAllInOne) {
  Mesh const mesh = plate(3);
  FfdRule bad = ffd({3, 2, 2}, 2, box_of({0, 0, 0}, {1, 1, 0}));
  bad.degree = {3, 0, 1};
  bad.continuity = 3;
  bad.margin = -1;
  bad.share = std::nan("");
  expect_all_in(message_of<MotionError>([&] { (void)resolve(mesh, motion({rule({"plate"}, bad)})); }),
                {"rule 1 (ffd", "degree 3 along i", "from 1 to 2", "degree 0 along j", "continuity 3", "margin",
                 "share", "span no volume"});
  FfdRule lengths = ffd({3, 2, 2}, 2);
  lengths.displacement.resize(5);
  expect_all_in(message_of<MotionError>([&] { (void)resolve(mesh, motion({rule({"plate"}, lengths)})); }),
                {"5 displacements for 12 control points"});
  FfdRule infinite = ffd({3, 2, 2}, 2);
  infinite.displacement[7] = {0, INFINITY, 0};
  expect_all_in(message_of<MotionError>([&] { (void)resolve(mesh, motion({rule({"plate"}, infinite)})); }),
                {"control point (2, 1, 2)", "finite"});
  FfdRule away = ffd({3, 2, 2}, 2, box_of({100, 100, 100}, {200, 200, 200}));
  expect_all_in(message_of<MotionError>([&] { (void)moved_nodes(mesh, motion({rule({"plate"}, away)})); }),
                {"none of the 9 nodes", "from (0, 0, 0) to (1, 1, 0)", "unit"});
}

}  // namespace
}  // namespace gridmorph::test
