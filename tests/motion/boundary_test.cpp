// What rules see of a mesh does not depend on whether its cells are those of blocks or hexahedra.
#include "support/mesh_builders.hpp"

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

namespace gridmorph::test {
namespace {

struct BothKinds {
  Mesh blocks;
  Mesh elements = as_hexahedra(blocks);
  UnstructuredTopology topology = make_topology(elements);
  BoundaryFacePatches face_patches = find_face_patches(elements, topology);
  std::shared_ptr<Boundary const> of_blocks = std::make_shared<Boundary const>(blocks);
  std::shared_ptr<Boundary const> of_elements = std::make_shared<Boundary const>(elements, topology, face_patches);

  explicit BothKinds(Mesh mesh) : blocks(std::move(mesh)) {}
};

std::vector<Index> sorted(std::vector<Index> list) {
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<int> all_patches(Mesh const& mesh) {
  std::vector<int> out(mesh.patches.size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

TEST(Boundary, HasTheNodesAndFacetsOfBothKindsOfMesh) {
  BothKinds const both(annulus_sector({}, 3));
  for (int const p : all_patches(both.blocks)) {
    EXPECT_TRUE(both.of_blocks->surface(p).grid);
    EXPECT_FALSE(both.of_elements->surface(p).grid);
    EXPECT_EQ(sorted(both.of_blocks->surface(p).nodes), both.of_elements->surface(p).nodes) << p;
    EXPECT_EQ(both.of_blocks->facets({&p, 1}).facets.size(), both.of_elements->facets({&p, 1}).facets.size()) << p;
    for (int const q : all_patches(both.blocks))
      EXPECT_EQ(both.of_blocks->share_nodes(p, q), both.of_elements->share_nodes(p, q)) << p << " and " << q;
  }
  ASSERT_EQ(both.blocks.interfaces.size(), both.elements.connections.size());
  for (int c = 0; c < int(both.blocks.interfaces.size()); ++c)
    EXPECT_EQ(both.of_blocks->pairs(c), both.of_elements->pairs(c)) << c;
}

// Normals of all facets point into the mesh, whichever way its blocks and elements are numbered.
TEST(Boundary, FacetsOfBothKindsLookIntoTheMesh) {
  BothKinds const both(annulus_sector({}, 5));
  for (int const p : all_patches(both.blocks)) {
    auto const areas = [&](Boundary const& boundary) {
      PatchSurface const surface(boundary, {p});
      Vec3 sum;
      for (GridFacet const& f : surface.facets()) {
        Vec3 const a = surface.points[f[0]];
        for (int k = 2; k < 4 && f[k] >= 0; ++k)
          sum += 0.5 * cross(surface.points[f[k - 1]] - a, surface.points[f[k]] - a);
      }
      return sum;
    };
    Vec3 const blocks = areas(*both.of_blocks), elements = areas(*both.of_elements);
    EXPECT_GT(norm(blocks), 0);
    EXPECT_LT(distance(blocks, elements), 1e-12 * norm(blocks)) << p;
  }
}

TEST(Boundary, NodesSlideOnTheSameSurfaceOfTheBaseline) {
  BothKinds const both(annulus_sector({}, 1));
  Motion motion;
  motion.rules = {{{"hub"}, SlipRule{.surface = SlipRule::Surface::baseline}, 0, "hub"}};
  BoundaryMotion const blocks(both.of_blocks, resolve(both.blocks, motion));
  BoundaryMotion const elements(both.of_elements, resolve(both.elements, motion));
  int checked = 0;
  for (int const p : all_patches(both.blocks)) {
    SlipSurface const *a = blocks.slip_surface(p), *b = elements.slip_surface(p);
    ASSERT_EQ(a == nullptr, b == nullptr) << p;
    if (a == nullptr) continue;
    EXPECT_EQ(a->kind, b->kind);
    for (Vec3 const& x : both.of_blocks->points(p)) {
      Vec3 const off = x + 0.01 * Vec3{1, 0.5, -0.3};
      EXPECT_LT(distance(a->view().project(off), b->view().project(off)), 1e-10);
      ++checked;
    }
  }
  EXPECT_GT(checked, 0);
}

// Another time: rules displace by something else, what they slide on is not made again.
TEST(BoundaryMotion, AtAnotherTimeSharesItsSlipSurfaces) {
  Mesh const mesh = annulus_sector({}, 1);
  Motion motion;
  motion.rules = {{{"hub"}, SlipRule{.surface = SlipRule::Surface::baseline}, 0, "hub"},
                  {{"inlet"}, RigidRule{{}, {1, 0, 0}}, 0, "inlet"}};
  BoundaryMotion const now(mesh, resolve(mesh, motion));
  motion.rules[1].rule = RigidRule{{}, {2, 0, 0}};
  BoundaryMotion const later = now.with(motion);
  EXPECT_EQ(&later.slip_surfaces(), &now.slip_surfaces());
  std::array<Vec3, 1> const points{Vec3{1, 2, 3}};
  std::array<Vec3, 1> u{};
  now.displacement(1, points, u);
  EXPECT_EQ(u[0], (Vec3{1, 0, 0}));
  later.displacement(1, points, u);
  EXPECT_EQ(u[0], (Vec3{2, 0, 0}));
}

}  // namespace
}  // namespace gridmorph::test
