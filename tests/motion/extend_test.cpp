// Blades on end walls that move: along themselves, with the walls' nodes around them.
#include "support/expect_error.hpp"
#include "support/motions.hpp"
#include "support/periodic_match.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace gridmorph::test {
namespace {

/// One zone over the floor "hub" (j_min), below "case" (j_max); its side "blade" (k_min) has the spanwise lines
/// (x, y, side(y)).
Mesh channel(int n, std::function<double(double y)> const& side) {
  MeshBuilder builder("channel");
  int const zone = builder.zone("channel", {5, n, 7}, [=](Index3 const& at) {
    double const s = double(at[1]) / (n - 1), y = s * s * (3 - 2 * s), z = at[2] / 6.0;
    return Vec3{at[0] / 4.0, y, side(y) * (1 - z) + 2 * z};
  });
  std::array<std::string, 6> const names{"inlet", "outlet", "hub", "case", "blade", "far"};
  for (int axis = 0; axis < 3; ++axis)
    for (int s = 0; s < 2; ++s) builder.patch(names[2 * axis + s], PatchKind::wall, zone, axis, s);
  return builder.finish();
}

std::map<Index, Vec3> displacements(BoundaryMotion const& moves, std::string const& patch, int rule) {
  std::map<Index, Vec3> out;
  for (std::size_t p = 0; p < moves.boundary().patches().size(); ++p) {
    Patch const& own = moves.boundary().patches()[p];
    if (own.name != patch && (own.families.empty() || own.families.front() != patch)) continue;
    for (Index const n : moves.boundary().surface(int(p)).nodes) {
      Vec3 const at = moves.boundary().coordinates()[n];
      moves.displacement(rule, {&at, 1}, {&out[n], 1});
    }
  }
  EXPECT_FALSE(out.empty());
  return out;
}

Motion lifted(VectorField const& hub) {
  return motion({rule({"blade"}, ExtendRule{{"hub"}}), rule({"hub"}, function_rule(hub))});
}

TEST(Extend, AStraightBladeIsTrimmedInItsOwnPlaneAndTheWallGoesAlong) {
  double const lean = 0.5, up = 0.1;
  Mesh const mesh = channel(9, [=](double y) { return lean * y; });
  BoundaryMotion const moves(mesh, resolve(mesh, lifted([=](Vec3 const& p) { return Vec3{0, up * (1 + p.x), 0}; })));
  EXPECT_TRUE(moves.is_explicit(0));
  auto const blade = displacements(moves, "blade", 0), hub = displacements(moves, "hub", 1);
  int rim = 0;
  for (auto const& [n, u] : blade) {
    Vec3 const at = mesh.coordinates[n], x = at + u;
    EXPECT_NEAR(x.z, lean * x.y, 1e-14);
    EXPECT_EQ(u.x, 0);
    EXPECT_NEAR(u.y, up * (1 + at.x) * (1 - at.y), 1e-13);  // straight lines: spacings shrink alike
    if (at.y == 0) {
      EXPECT_EQ(hub.at(n), u);
      ++rim;
    }
  }
  EXPECT_EQ(rim, 5);
  double least = 1;
  for (auto const& [n, u] : hub) {
    Vec3 const at = mesh.coordinates[n], x = at + u;
    EXPECT_NEAR(x.y, up * (1 + x.x), 1e-13);
    EXPECT_LE(u.z, lean * up * 2 + 1e-13);
    if (at.z == 2) {
      EXPECT_LE(distance(u, {0, up * (1 + at.x), 0}), 1e-14);
    }
    least = std::min(least, u.z);
  }
  EXPECT_GE(least, -1e-15);
}

TEST(Extend, TheWallIsWithoutAStepAroundTheBlade) {
  // Layers of 1e-6 on the blade; the wall has waves across it, so that chords of its facets are off it by 1e-3.
  MeshBuilder builder("layers");
  int const zone = builder.zone("layers", {9, 5, 7}, [](Index3 const& at) {
    double const y = at[1] / 4.0, z = std::pow(10.0, at[2] - 6) * (at[2] > 0 ? 1 : 0);
    return Vec3{at[0] / 8.0, y, 0.4 * y + z};
  });
  builder.patch("hub", PatchKind::wall, zone, 1, 0);
  builder.patch("blade", PatchKind::wall, zone, 2, 0);
  Mesh const mesh = builder.finish();
  auto const waves = [](Vec3 const& p) { return Vec3{0, 0.1 + 0.02 * std::sin(9 * p.x + 7 * p.z), 0}; };
  BoundaryMotion const moves(mesh, resolve(mesh, lifted(waves)));
  auto const hub = displacements(moves, "hub", 1);
  for (int i = 0; i < 9; ++i) {
    Index const rim = mesh.zones[0].node({i, 0, 0}), beside = mesh.zones[0].node({i, 0, 1});
    EXPECT_LE(distance(hub.at(rim), hub.at(beside)), 1e-5) << i;  // by the slope of the waves, a tenth, times 1e-5
  }
}

TEST(Extend, ACurvedBladeStaysOnItsSurfaceToThirdOrder) {
  auto const arc = [](double y) { return 0.3 * std::sin(2 * y); };
  double before = 0;
  for (int const n : {9, 17, 33}) {
    Mesh const mesh = channel(n, arc);
    BoundaryMotion const moves(mesh, resolve(mesh, lifted([](Vec3 const&) { return Vec3{0, 0.2, 0}; })));
    double off = 0;
    for (auto const& [node, u] : displacements(moves, "blade", 0)) {
      Vec3 const x = mesh.coordinates[node] + u;
      off = std::max(off, std::abs(x.z - arc(x.y)));
    }
    if (before > 0) {
      EXPECT_GT(before, 5 * off) << n;
    }
    before = off;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(Extend, WallsMayBeInflatedOrHaveATarget) {
  Mesh const mesh = channel(9, [](double y) { return 0.25 * y; });
  InflateRule rise;
  rise.height = [](std::span<SurfacePlace const>, std::span<double> h) { std::fill(h.begin(), h.end(), 0.1); };
  TargetGeometry target;
  Boundary const boundary(mesh);
  for (Index const n : boundary.surface(2).nodes) target.nodes.push_back(mesh.coordinates[n] + Vec3{0, 0.1, 0});
  for (Rule const& wall : {Rule(rise), Rule(TargetRule{std::make_shared<TargetGeometry const>(target)})}) {
    Motion const m = motion({rule({"blade"}, ExtendRule{{"hub"}}), rule({"hub"}, wall)});
    BoundaryMotion const moves(mesh, resolve(mesh, m));
    for (auto const& [n, u] : displacements(moves, "blade", 0))
      if (mesh.coordinates[n].y == 0) {
        EXPECT_LE(distance(u, {0, 0.1, 0.025}), 1e-13);
      }
    for (auto const& [n, u] : displacements(moves, "hub", 1)) EXPECT_NEAR(u.y, 0.1, 1e-13);
  }
}

TEST(Extend, BeyondItsEndALineGoesOnStraight) {
  Mesh const mesh = channel(9, [](double y) { return 0.25 * y; });
  BoundaryMotion const moves(mesh, resolve(mesh, lifted([](Vec3 const&) { return Vec3{0, -0.2, 0}; })));
  for (auto const& [n, u] : displacements(moves, "blade", 0))
    if (mesh.coordinates[n].y == 0) {
      EXPECT_LE(distance(u, {0, -0.2, -0.05}), 1e-14);
    }
}

TEST(Extend, PeriodicCopiesOfTheWallAndOfLinesInItMatch) {
  Sector const sector;
  Mesh const mesh = annulus_sector(sector, 5);
  auto const bumps = [&](Vec3 const& p) {
    Vec3 const at = sector_coordinates(sector, p);
    double const dr = 0.05 + 0.03 * std::cos(sector.copies * at.z) * std::sin(2 * at.x);
    return sector_position(sector, at.x, at.y + dr, at.z) - p;
  };
  // Inlet and outlet have lines from hub to case, as blades have.
  Motion m = motion({rule({"inlet", "outlet"}, ExtendRule{{"hub"}}), rule({"hub"}, function_rule(bumps))});
  m.axis = {sector.origin, sector.axis};
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  auto hub = displacements(moves, "hub", 1);
  for (auto const& [n, u] : hub) {
    Vec3 const at = sector_coordinates(sector, mesh.coordinates[n]),
               x = sector_coordinates(sector, mesh.coordinates[n] + u);
    EXPECT_NEAR(x.y, at.y + 0.05 + 0.03 * std::cos(sector.copies * x.z) * std::sin(2 * x.x), 0.01);
  }
  for (std::string const name : {"inlet", "outlet"}) {
    auto const plane = displacements(moves, name, 0);
    hub.insert(plane.begin(), plane.end());
  }
  PeriodicMatch const match = periodic_match(mesh, hub);
  EXPECT_GT(match.pairs, 10);
  EXPECT_LE(match.apart, 1e-12);
}

TEST(Extend, NothingMovesWhereTheWallDoesNot) {
  Mesh const mesh = channel(9, [](double y) { return 0.3 * y * y; });
  BoundaryMotion const moves(mesh, resolve(mesh, lifted([](Vec3 const&) { return Vec3{}; })));
  for (auto const& [patch, r] : {std::pair("blade", 0), std::pair("hub", 1)})
    for (auto const& [n, u] : displacements(moves, patch, r)) EXPECT_EQ(u, Vec3{});
}

TEST(Extend, NothingDependsOnHowZonesAreStoredOrWhetherTheyAreHexahedra) {
  Mesh const mesh = channel(9, [](double y) { return 0.3 * y * y; });
  Motion const m = lifted([](Vec3 const& p) { return Vec3{0, 0.1 + 0.05 * p.z, 0}; });
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  std::map<Index, Vec3> expected = displacements(moves, "blade", 0);
  expected.merge(displacements(moves, "hub", 1));
  for (unsigned seed = 1; seed <= 6; ++seed) {
    ScrambledMesh const other = scramble(mesh, {.seed = seed, .cuts = 2});
    BoundaryMotion const same(other.mesh, resolve(other.mesh, m));
    for (auto const& [patch, r] : {std::pair("blade", 0), std::pair("hub", 1)})
      for (auto const& [n, u] : displacements(same, patch, r))
        EXPECT_LE(distance(u, expected.at(other.old_node[n])), 1e-12) << seed << ' ' << patch;
  }
  Mesh const elements = to_hexahedra(mesh);
  UnstructuredTopology const topology = make_topology(elements);
  auto const boundary = std::make_shared<Boundary const>(elements, topology, find_face_patches(elements, topology));
  BoundaryMotion const same(boundary, resolve(boundary->names(), m));
  for (auto const& [patch, r] : {std::pair("blade", 0), std::pair("hub", 1)})
    for (auto const& [n, u] : displacements(same, patch, r)) EXPECT_LE(distance(u, expected.at(n)), 1e-12);
}

TEST(Extend, WhatCannotBeIsRefused) {
  Mesh const mesh = channel(9, [](double y) { return 0.3 * y; });
  auto const refused = [](Mesh const& of, Motion const& m) {
    return message_of<MotionError>([&] { BoundaryMotion(of, resolve(of, m)); });
  };
  expect_all_in(refused(mesh, motion({rule({"blade"}, ExtendRule{{"hub"}}), rule({"hub"}, SlipRule{})})),
                {"not known beforehand"});
  expect_all_in(refused(mesh, motion({rule({"inlet"}, ExtendRule{{"outlet"}}), rule({"outlet"}, FixedRule{})})),
                {"no nodes on the walls"});
  expect_all_in(refused(mesh, lifted([](Vec3 const&) { return Vec3{0, 0.95, 0}; })), {"are left between the walls"});
  Mesh const triangles = to_prisms_and_tetrahedra(mesh, 0);
  UnstructuredTopology const topology = make_topology(triangles);
  auto const boundary = std::make_shared<Boundary const>(triangles, topology, find_face_patches(triangles, topology));
  expect_all_in(message_of<MotionError>([&] {
                  BoundaryMotion(boundary, resolve(boundary->names(), lifted([](Vec3 const&) { return Vec3{}; })));
                }),
                {"do not stand in rows", "free"});
}

}  // namespace
}  // namespace gridmorph::test
