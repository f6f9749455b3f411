// Blocks in meshes of hexahedra: whatever order, numbers and orientations a file gives the elements, and however it
// cuts them into zones, the same blocks come out, with all cells, patches and interfaces.
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/random.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/found_blocks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace gridmorph::test {
namespace {

/// The same hexahedra with nodes and elements in another order, in each zone, and turned by any of the 24 rotations.
Mesh shuffled(Mesh const& mesh, unsigned seed) {
  constexpr std::array<int, 8> place{0, 1, 3, 2, 4, 5, 7, 6};  // of corners; its own inverse
  Random random(seed);
  std::vector<Orientation> turns;
  for (Orientation const& o : all_orientations())
    if (o.determinant() > 0) turns.push_back(o);
  std::vector<Index32> to(mesh.n_nodes());
  Mesh out = mesh;
  out.coordinates = Coordinates(mesh.n_nodes());
  out.elements.nodes = {};
  for (Zone const& zone : mesh.zones) {
    auto const first = to.begin() + std::ptrdiff_t(zone.first_node);
    std::vector<Index32> nodes(zone.size());
    std::iota(nodes.begin(), nodes.end(), Index32(zone.first_node));
    random.shuffle(nodes);
    std::copy(nodes.begin(), nodes.end(), first);
  }
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.coordinates.set(to[n], mesh.coordinates[n]);
  for (Zone const& zone : mesh.zones) {
    std::vector<Index32> elements(zone.n_elements);
    std::iota(elements.begin(), elements.end(), Index32(zone.first_element));
    random.shuffle(elements);
    for (Index32 const e : elements) {
      Orientation const& turn = turns[random.below(int(turns.size()))];
      std::array<Index32, 8> corners{};
      for (int c = 0; c < 8; ++c) {
        int const p = place[c];
        Index3 const step = turn.apply({2 * (p & 1) - 1, (p & 2) - 1, (p & 4) / 2 - 1});
        int const q = (step[0] > 0 ? 1 : 0) + (step[1] > 0 ? 2 : 0) + (step[2] > 0 ? 4 : 0);
        corners[c] = to[mesh.elements.nodes[e][place[q]]];
      }
      out.elements.nodes.add(corners);
    }
  }
  for (Patch& patch : out.patches)
    for (Index32& n : patch.faces.item) n = to[n];
  for (Connection& c : out.connections)
    for (auto* list : {&c.nodes, &c.donor_nodes})
      for (Index32& n : *list) n = to[n];
  return out;
}

FoundBlocks blocks_of(Mesh const& mesh) {
  UnstructuredTopology const topology = make_topology(mesh);
  return find_blocks(HostInstance(), mesh, topology, find_face_patches(mesh, topology));
}

/// Nodes along the directions of each block, the blocks and the directions in ascending order.
std::vector<std::vector<int>> sizes(Mesh const& mesh) {
  std::vector<std::vector<int>> out;
  for (Zone const& zone : mesh.zones) {
    out.emplace_back(zone.extent.begin(), zone.extent.end());
    std::sort(out.back().begin(), out.back().end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Cells of patches by the name that selectors know them by.
std::map<std::string, Index> cells_of_patches(Mesh const& mesh) {
  std::map<std::string, Index> out;
  for (Patch const& patch : mesh.patches) {
    std::string const& name = patch.families.empty() ? patch.name : patch.families.front();
    Index cells = 1;
    for (int a = 0; a < 3; ++a) cells *= std::max(1, patch.range.extent(a) - 1);
    out[name] += patch.faces.size() > 0 ? patch.faces.size() : cells;
  }
  return out;
}

void expect_blocks_of(Mesh const& elements, FoundBlocks const& found) {
  EXPECT_EQ(found.n_left, 0) << found.why_left;
  Mesh const& blocks = found.mesh;
  ASSERT_EQ(Index(found.node.size()), blocks.n_nodes());
  ASSERT_EQ(Index(found.element.size()), blocks.n_cells());
  auto sorted = found.element;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t e = 0; e < sorted.size(); ++e) ASSERT_EQ(sorted[e], Index32(e)) << "every element is one cell";
  auto const representative = coincident_nodes(elements);
  std::size_t cell = 0;
  for (Zone const& zone : blocks.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i, ++cell) {
          std::multiset<Index32> own, of_element;
          for (int c = 0; c < 8; ++c) own.insert(found.node[zone.node({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)})]);
          for (Index32 const n : elements.elements.corners(found.element[cell])) of_element.insert(representative[n]);
          ASSERT_EQ(own, of_element) << "cell " << cell;
        }
  EXPECT_EQ(flaws(blocks, 1e-6), std::vector<std::string>());
  Mesh checked = blocks;
  EXPECT_NO_THROW((void)connect_and_check(checked, {}));
  EXPECT_EQ(cells_of_patches(blocks), cells_of_patches(elements));
}

struct Built {
  Mesh mesh;
  std::size_t blocks;
};

std::vector<Built> meshes() {
  return {{box({4, 5, 6}, Shape::curved, 1), 1},
          {annulus_sector({}, 5), 0},
          {bricks_with_t_junctions(2), 0},
          {l_shape(3), 0},
          {around_a_box(4), 0},
          {o_grid(1, 6), 0},
          {o_grid(0, 7), 0},
          {c_grid(8), 0},
          {star(3, 9), 3},
          {star(5, 10), 5},
          {translational(1, 11), 0},
          {translational(2, 12), 0}};
}

TEST(FoundBlocks, HaveAllCellsPatchesAndInterfacesOfTheHexahedra) {
  for (auto const& [mesh, n] : meshes()) {
    SCOPED_TRACE(mesh.source);
    Mesh const elements = as_hexahedra(mesh);
    FoundBlocks const found = blocks_of(elements);
    expect_blocks_of(elements, found);
    if (n > 0) {
      EXPECT_EQ(found.mesh.zones.size(), n);
    }
    EXPECT_LE(found.mesh.zones.size(), std::max<std::size_t>(mesh.zones.size(), 16));
  }
}

TEST(FoundBlocks, DoNotDependOnNumbersOrientationsAndCuts) {
  for (auto const& [mesh, n] : meshes()) {
    SCOPED_TRACE(mesh.source);
    auto const expected = sizes(blocks_of(as_hexahedra(mesh)).mesh);
    for (unsigned seed = 1; seed < 5; ++seed) {
      Mesh const elements = shuffled(as_hexahedra(scramble(mesh, {seed, int(seed)}).mesh), seed);
      FoundBlocks const found = blocks_of(elements);
      expect_blocks_of(elements, found);
      EXPECT_EQ(sizes(found.mesh), expected) << "seed " << seed;
    }
  }
}

/// Each quadrilateral is one cell, whose two planes have its nodes; faces of patches are those of its edges.
TEST(FoundBlocks, InThePlaneHaveASecondPlane) {
  for (Mesh const& flat : {flat_box(5, 4, 4), periodic_flat_box(5, 4, 4), airfoil(24, 100, 0.01, 1.3, 4)}) {
    SCOPED_TRACE(flat.source);
    FoundBlocks const found = blocks_of(flat);
    ASSERT_EQ(found.n_left, 0) << found.why_left;
    Mesh const& blocks = found.mesh;
    EXPECT_EQ(blocks.dimension, 2);
    EXPECT_EQ(blocks.n_cells(), flat.n_elements());
    EXPECT_EQ(blocks.zones.size(), 1U);
    std::size_t cell = 0;
    for (Zone const& zone : blocks.zones) {
      ASSERT_EQ(zone.extent[2], 2);
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i, ++cell)
          for (int k = 0; k < 2; ++k) {
            std::multiset<Index32> own, of_element;
            for (int c = 0; c < 4; ++c) own.insert(found.node[zone.node({i + c % 2, j + c / 2, k})]);
            for (Index32 const n : flat.elements.corners(found.element[cell])) of_element.insert(n);
            ASSERT_EQ(own, of_element) << "cell " << cell;
          }
    }
    EXPECT_EQ(flaws(blocks, 1e-6), std::vector<std::string>());
    auto patches = cells_of_patches(blocks);
    EXPECT_EQ(patches["2-D plane"], 2 * flat.n_elements());
    patches.erase("2-D plane");
    auto expected = cells_of_patches(flat);
    if (!flat.connections.empty()) {  // rules find these by the names that their interface has
      expected.erase("i_min");
      expected.erase("i_max");
    }
    EXPECT_EQ(patches, expected);
    Mesh checked = blocks;
    EXPECT_NO_THROW((void)connect_and_check(checked, {}));
  }
  FoundBlocks const mixed = blocks_of(flat_box(4, 4, 2));
  EXPECT_NE(mixed.why_left.find("is no quadrilateral"), std::string::npos) << mixed.why_left;
}

TEST(FoundBlocks, SayWhatIsNone) {
  Mesh const sector = annulus_sector({}, 5);
  FoundBlocks const of_prisms = blocks_of(to_prisms_and_tetrahedra(sector, 1));
  EXPECT_GT(of_prisms.n_left, 0);
  EXPECT_NE(of_prisms.why_left.find("is no hexahedron"), std::string::npos) << of_prisms.why_left;
  Mesh torn = as_hexahedra(box({4, 4, 4}, Shape::curved, 1));
  // A box without one of its cells has edges at which no sheet goes on.
  torn.elements.type.pop_back();
  CsrGraph fewer;
  for (Index e = 0; e < torn.n_elements(); ++e) fewer.add(torn.elements.nodes[e]);
  torn.elements.nodes = fewer;
  torn.zones.front().n_elements = torn.n_elements();
  torn.patches.clear();
  FoundBlocks const found = blocks_of(torn);
  EXPECT_EQ(found.n_left, 0) << "three sheets cut what is left into boxes: " << found.why_left;
  EXPECT_EQ(found.mesh.zones.size(), 7U);
}

}  // namespace
}  // namespace gridmorph::test
