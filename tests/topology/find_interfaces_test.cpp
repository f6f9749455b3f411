// Interfaces found from points alone are those that the mesh was made with.
#include "support/interface_cells.hpp"
#include "support/mesh_builders.hpp"
#include "support/scramble.hpp"

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

namespace gridmorph::test {
namespace {

struct Case {
  std::string name;
  Mesh (*make)(unsigned seed);
};

Mesh wedge(unsigned seed) {
  Sector sector;
  sector.inner_radius = 0;
  return annulus_sector(sector, seed);
}

Case const cases[] = {
    {"box",
     [](unsigned s) {
       return box({5, 4, 6}, Shape::curved, s);
     }},
    {"t_junctions", bricks_with_t_junctions},
    {"l_shape", l_shape},
    {"around_a_box", around_a_box},
    {"sector_about_any_axis", [](unsigned s) { return annulus_sector({}, s); }},
    {"wedge_with_pole", wedge},
    {"o_grid", [](unsigned s) { return o_grid(0.4, s); }},
    {"o_grid_with_pole", [](unsigned s) { return o_grid(0, s); }},
    {"c_grid", c_grid},
    {"star3", [](unsigned s) { return star(3, s); }},
    {"star5", [](unsigned s) { return star(5, s); }},
    {"star_sector", [](unsigned s) { return star_sector(5, s); }},
    {"translational", [](unsigned s) { return translational(1, s); }},
    {"translational_twice", [](unsigned s) { return translational(2, s); }},
};

class FindInterfaces : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Meshes, FindInterfaces, testing::ValuesIn(cases),
                         [](auto const& info) { return info.param.name; });

Mesh without_interfaces(Mesh mesh) {
  mesh.interfaces.clear();
  return mesh;
}

TEST_P(FindInterfaces, FindsThoseOfScrambledMeshes) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Mesh const mesh = scramble(GetParam().make(seed), {.seed = seed, .cuts = int(seed % 4)}).mesh;
    FoundInterfaces const found = find_interfaces(without_interfaces(mesh));
    for (bool const periodic : {false, true})
      EXPECT_EQ(joined_cells(mesh, found.interfaces, periodic), joined_cells(mesh, mesh.interfaces, periodic))
          << (periodic ? "periodic" : "plain");
  }
}

TEST_P(FindInterfaces, WhatIsFoundConnectsAndCoversTheMesh) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Mesh mesh = scramble(GetParam().make(seed), {.seed = seed, .cuts = 2}).mesh;
    FoundInterfaces const found = find_interfaces(without_interfaces(mesh));
    mesh.interfaces = found.interfaces;
    EXPECT_TRUE(flaws(mesh, 1e-6).empty()) << flaws(mesh, 1e-6).front() << testing::PrintToString(found.notes);
    EXPECT_NO_THROW(connect_and_check(mesh, {}));
    EXPECT_LT(found.mismatch, 1e-9);
  }
}

// Places that are no numbers were searched for without end, and those of a mesh whose size a single node makes were all
// the same.
TEST(FoundInterfaces, CoordinatesThatAreNoNumbersOrFarAwayAreRefused) {
  for (double const bad : {std::nan(""), HUGE_VAL, 1e200, 1e16, -1e11}) {
    Mesh mesh = box({3, 3, 3}, Shape::curved, 1);
    mesh.coordinates.y(5) = bad;
    std::string const said = [&] {
      try {
        (void)find_interfaces(mesh, {});
      } catch (MeshError const& e) {
        return std::string(e.what());
      }
      return std::string();
    }();
    EXPECT_NE(said.find("repair the mesh"), said.npos) << said;
    EXPECT_NE(said.find(describe_node(mesh, 5)), said.npos) << said;
  }
}

TEST_P(FindInterfaces, NeedsNoPatches) {
  Mesh const mesh = scramble(GetParam().make(7), {.seed = 7, .cuts = 2}).mesh;
  Mesh bare = without_interfaces(mesh);
  bare.patches.clear();
  FoundInterfaces const found = find_interfaces(bare);
  EXPECT_EQ(joined_cells(mesh, found.interfaces, false), joined_cells(mesh, mesh.interfaces, false));
  auto const expected = joined_cells(mesh, mesh.interfaces, true),
             periodic = joined_cells(mesh, found.interfaces, true);
  // Periodic directions that nobody declared may come on top: boxes have them.
  EXPECT_TRUE(std::includes(periodic.begin(), periodic.end(), expected.begin(), expected.end()));
}

TEST_P(FindInterfaces, NodesMayBeApartByAShareOfTheSmallestEdge) {
  Mesh mesh = GetParam().make(3);
  auto const plain = joined_cells(mesh, mesh.interfaces, false);
  // Every zone goes its own way by a little: less than the tolerance, far more than round-off.
  for (std::size_t z = 0; z < mesh.zones.size(); ++z)
    for (Index n = mesh.zones[z].first_node; n < mesh.zones[z].first_node + mesh.zones[z].size(); ++n)
      mesh.coordinates.set(n, mesh.coordinates[n] + 1e-7 * Vec3{double(z % 3), double(z % 2), 1});
  EXPECT_EQ(joined_cells(mesh, find_interfaces(without_interfaces(mesh), {.tolerance = 0.05}).interfaces, false),
            plain);
  if (mesh.zones.size() < 2) return;
  auto const strict = find_interfaces(without_interfaces(mesh), {.tolerance = 1e-9});
  EXPECT_LT(joined_cells(mesh, strict.interfaces, false).size(), plain.size());
}

TEST(FindInterfacesCases, DeclaredOnesAndPatchesAreLeftAlone) {
  Mesh const mesh = bricks_with_t_junctions(1);
  EXPECT_TRUE(find_interfaces(mesh).interfaces.empty());
  // A wall on both sides of an interface, as a thin plate has, is a wall.
  Mesh plate = without_interfaces(mesh);
  auto const face = mesh.interfaces.front();
  for (auto const& [zone, range] : {std::pair{face.zone, face.range}, {face.donor_zone, face.to_donor(face.range)}})
    plate.patches.push_back({"plate", "BCWall", PatchKind::wall, {}, zone, range});
  auto const found = joined_cells(mesh, find_interfaces(plate).interfaces, false);
  auto const all = joined_cells(mesh, mesh.interfaces, false);
  EXPECT_EQ(found.size(), all.size() - joined_cells(mesh, {face}, false).size());
}

TEST(FindInterfacesCases, ZonesOnTheSameSideAreNoNeighbours) {
  MeshBuilder b("overlapping");
  for (int z = 0; z < 2; ++z)
    b.zone("z" + std::to_string(z), {3, 4, 5}, [z](Index3 const& p) {
      return Vec3{p[0] * (1.0 + z), p[1] * 1.1, p[2] * 0.9};
    });
  EXPECT_TRUE(find_interfaces(b.finish(), {.periodic = false}).interfaces.empty());
}

TEST(FindInterfacesCases, TheToleranceIsAShare) {
  EXPECT_THROW(find_interfaces(box({3, 3, 3}, Shape::straight, 1), {.tolerance = 0}), MeshError);
  EXPECT_THROW(find_interfaces(box({3, 3, 3}, Shape::straight, 1), {.tolerance = 0.5}), MeshError);
}

TEST(FindInterfacesCases, APeriodicSectorComesWithItsAxisAndAngle) {
  Sector sector;
  sector.origin = {0, 0, 0};
  sector.axis = {0, 0, 1};
  sector.copies = 24;
  Mesh const mesh = without_interfaces(annulus_sector(sector, 5));
  bool seen = false;
  for (auto const& face : find_interfaces(mesh).interfaces) {
    if (!face.periodic) continue;
    seen = true;
    EXPECT_EQ(face.periodic->rotation_angle_rad.x, 0);
    EXPECT_EQ(face.periodic->rotation_angle_rad.y, 0);
    EXPECT_NEAR(std::fabs(face.periodic->rotation_angle_rad.z), 2 * M_PI / 24, 1e-15);
    EXPECT_EQ(face.periodic->rotation_center, (Vec3{0, 0, 0}));
  }
  EXPECT_TRUE(seen);
}

/// Six zones between two spheres, each over a side of a cube.
Mesh cubed_sphere(int n) {
  MeshBuilder b("cubed sphere");
  for (int z = 0; z < 6; ++z)
    b.zone("z" + std::to_string(z), {n + 1, n + 1, 4}, [z, n](Index3 const& p) {
      double const u = 2.0 * p[0] / n - 1, v = 2.0 * p[1] / n - 1, w = z % 2 == 0 ? 1 : -1;
      Vec3 const at = z / 2 == 0 ? Vec3{w, u, v} : z / 2 == 1 ? Vec3{u, w, v} : Vec3{u, v, w};
      return ((1.0 + p[2]) / norm(at)) * at;
    });
  return b.finish();
}

/// Bare meshes without periodicity: symmetric ones map onto themselves in many ways, none of which is a passage.
TEST(FindInterfacesCases, SymmetricMeshesAreNotPeriodic) {
  std::vector<Mesh> meshes{cubed_sphere(6),
                           o_grid(0.4, 1),
                           o_grid(0, 1),
                           c_grid(1),
                           box({5, 4, 6}, Shape::straight, 1),
                           box({5, 5, 5}, Shape::straight, 1),
                           star(5, 1)};
  // A symmetric O-grid in a square: its outer sides match by translations, the body's sides from the wrong side.
  MeshBuilder square("square o-grid");
  square.zone("z", {33, 9, 4}, [](Index3 const& p) {
    double const a = 2 * M_PI * p[0] / 32, c = std::cos(a), s = std::sin(a);
    double const r = (1 + p[1]) / std::max(std::fabs(c), std::fabs(s));
    return Vec3{r * c, r * s, 0.7 * p[2]};
  });
  meshes.push_back(square.finish());
  for (Mesh mesh : meshes) {
    SCOPED_TRACE(mesh.source);
    mesh.interfaces.clear();
    mesh.patches.clear();
    FoundInterfaces const found = find_interfaces(mesh);
    EXPECT_TRUE(std::none_of(found.interfaces.begin(), found.interfaces.end(), [](auto const& face) {
      return face.periodic.has_value();
    })) << testing::PrintToString(found.notes);
  }
}

TEST(FindInterfacesCases, PlanesArePeriodicWhereTheRestOfTheBoundaryIsDeclared) {
  Mesh mesh = box({5, 4, 6}, Shape::straight, 1);
  std::erase_if(mesh.patches, [](Patch const& p) { return p.range.extent(2) == 1; });
  ASSERT_EQ(mesh.patches.size(), 4u);
  FoundInterfaces const found = find_interfaces(mesh);
  ASSERT_EQ(found.interfaces.size(), 1u);
  EXPECT_TRUE(found.interfaces[0].periodic);
}

/// A cube of cubes: every face cell is like every other, and there are many zones.
TEST(FindInterfacesCases, UniformMeshesOfManyZonesTakeSeconds) {
  MeshBuilder b("cubes");
  constexpr int n = 4, cells = 6;
  for (int z = 0; z < n * n * n; ++z) {
    Vec3 const corner{double(z % n), double(z / n % n), double(z / (n * n))};
    b.zone("z" + std::to_string(z), {cells + 1, cells + 1, cells + 1}, [corner](Index3 const& p) {
      return corner + (1.0 / cells) * Vec3{double(p[0]), double(p[1]), double(p[2])};
    });
  }
  Mesh const mesh = b.finish();
  auto const start = std::chrono::steady_clock::now();
  FoundInterfaces const found = find_interfaces(mesh);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(joined_cells(mesh, found.interfaces, false).size(), std::size_t(3 * n * n * (n - 1) * cells * cells));
  EXPECT_TRUE(joined_cells(mesh, found.interfaces, true).empty()) << "planes of one shape may be anything";
  EXPECT_EQ(std::count_if(found.notes.begin(), found.notes.end(),
                          [](auto const& note) { return note.find("not taken") != std::string::npos; }),
            3);
  EXPECT_LT(seconds, 60);
}

}  // namespace
}  // namespace gridmorph::test
