// Neighbours, boundary faces and patches against counts and positions known from the structured mesh.
#include "quality/test_meshes.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace gridmorph::test {
namespace {

TEST(UnstructuredTopology, NeighboursOfHexahedraAreThoseOfTheCells) {
  Index3 const n{4, 3, 5};
  auto const mesh = to_hexahedra(unit_box(n));
  check_mesh(mesh);
  auto const topology = make_topology(mesh);
  auto const cell = [&](int i, int j, int k) { return Index32(i + n[0] * (j + n[1] * k)); };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        std::multiset<Index32> expected;
        for (auto const& s : {Index3{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}) {
          Index3 const p{i + s[0], j + s[1], k + s[2]};
          bool const inside = p[0] >= 0 && p[0] < n[0] && p[1] >= 0 && p[1] < n[1] && p[2] >= 0 && p[2] < n[2];
          expected.insert(inside ? cell(p[0], p[1], p[2]) : ElementSides::boundary);
        }
        auto const found = topology.sides.of(cell(i, j, k));
        EXPECT_EQ(std::multiset<Index32>(found.begin(), found.end()), expected);
      }
  EXPECT_EQ(topology.boundary.size(), 2 * (4 * 3 + 3 * 5 + 4 * 5));
  EXPECT_EQ(topology.crowded_sides, 0);
}

/// Every inner side is seen from both elements, and the area vectors of the boundary add up to zero and its flux to the
/// volume.
void expect_closed(Mesh const& mesh, double volume) {
  auto const topology = make_topology(mesh);
  std::map<std::pair<Index32, Index32>, int> seen;
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (Index32 const other : topology.sides.of(e))
      if (other >= 0) ++seen[{std::min(Index32(e), other), std::max(Index32(e), other)}];
  for (auto const& [pair, times] : seen) EXPECT_EQ(times, 2);
  Vec3 sum;
  double flux = 0;
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    auto const nodes = topology.boundary.nodes[f];
    Vec3 const origin = mesh.coordinates[nodes[0]];
    for (std::size_t k = 2; k < nodes.size(); ++k) {
      Vec3 const area = 0.5 * cross(mesh.coordinates[nodes[k - 1]] - origin, mesh.coordinates[nodes[k]] - origin);
      sum += area;
      flux += dot(area, origin) / 3;
    }
  }
  EXPECT_NEAR(norm(sum), 0, 1e-12);
  EXPECT_NEAR(flux, volume, 1e-11 * volume);
}

TEST(UnstructuredTopology, BoundaryFacesCloseTheMeshAndPointOutwards) {
  Mesh const box = unit_box({4, 3, 5});
  expect_closed(to_hexahedra(box), 60);
  expect_closed(to_prisms_and_tetrahedra(box, 0), 60);
  expect_closed(to_prisms_and_tetrahedra(box, 2), 60);
  expect_closed(to_prisms_and_tetrahedra(box, 5), 60);
}

TEST(UnstructuredTopology, PyramidsMeetTheirNeighbours) {
  // A unit cube of six pyramids around its centre.
  Mesh mesh;
  mesh.add_zone("cube", 9);
  mesh.coordinates = Coordinates(9);
  for (int n = 0; n < 8; ++n) mesh.coordinates.set(n, {double(n & 1), double(n >> 1 & 1), double(n >> 2)});
  mesh.coordinates.set(8, {0.5, 0.5, 0.5});
  constexpr std::array<int, 8> sids{0, 1, 3, 2, 4, 5, 7, 6};
  for (int f = 0; f < 6; ++f) {
    std::array<Index32, 5> pyramid{};
    // Faces of a hexahedron point outwards; seen from inside they run the other way.
    for (int c = 0; c < 4; ++c) pyramid[3 - c] = sids[face_corner(ElementType::hexahedron, f, c)];
    pyramid[4] = 8;
    mesh.add_element(ElementType::pyramid, pyramid);
  }
  check_mesh(mesh);
  auto const topology = make_topology(mesh);
  EXPECT_EQ(topology.boundary.size(), 6);
  expect_closed(mesh, 1);
}

TEST(UnstructuredTopology, EveryPatchGetsItsFacesAndNothingStaysOpen) {
  Index3 const n{4, 3, 5};
  for (auto const& mesh : {to_hexahedra(unit_box(n)), to_prisms_and_tetrahedra(unit_box(n), 2)}) {
    auto const topology = make_topology(mesh);
    auto const face_patches = find_face_patches(mesh, topology);
    EXPECT_TRUE(face_patches.problems.empty());
    EXPECT_TRUE(face_patches.notes.empty());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      EXPECT_EQ(face_patches.faces_of_patch[p], mesh.patches[p].faces.size()) << mesh.patches[p].name;
  }
}

TEST(UnstructuredTopology, PatchesGivenAsNodesGetTheSameFaces) {
  auto const faces = to_prisms_and_tetrahedra(unit_box({4, 3, 5}), 2);
  auto nodes = faces;
  for (auto& patch : nodes.patches) {
    patch.nodes = patch_nodes(patch);
    patch.faces = {};
  }
  auto const topology = make_topology(faces);
  EXPECT_EQ(find_face_patches(nodes, topology).patch, find_face_patches(faces, topology).patch);
}

TEST(UnstructuredTopology, FacesThatNothingClaimsAreAProblemThatNamesTheFirst) {
  auto mesh = to_hexahedra(unit_box({2, 2, 2}));
  mesh.patches.erase(mesh.patches.begin());  // i_min
  auto const face_patches = find_face_patches(mesh, make_topology(mesh));
  ASSERT_EQ(face_patches.problems.size(), 1u);
  for (auto const* part : {"zone 'box'", "4 boundary faces belong", "hexahedron 1 ", "nodes "})
    EXPECT_NE(face_patches.problems[0].find(part), std::string::npos) << face_patches.problems[0];
}

TEST(UnstructuredTopology, FacesClaimedTwiceAndFacesInsideAreSaid) {
  auto mesh = to_hexahedra(unit_box({2, 2, 2}));
  mesh.patches.push_back(mesh.patches[0]);
  mesh.patches.back().name = "again";
  auto const no_side = std::array<Index32, 4>{0, 4, 13, 10};
  mesh.patches[1].faces.add(no_side);
  auto const face_patches = find_face_patches(mesh, make_topology(mesh));
  ASSERT_EQ(face_patches.problems.size(), 1u);
  EXPECT_NE(face_patches.problems[0].find("'again'"), std::string::npos);
  ASSERT_EQ(face_patches.notes.size(), 2u);
  EXPECT_NE(face_patches.notes[0].find("1 of its 5 faces are not on the boundary"), std::string::npos);
  // The plane i = 2 between two cells is boundary where a patch lists it, on both sides.
  auto with_baffle = to_hexahedra(unit_box({2, 2, 2}));
  auto const baffle = std::array<Index32, 4>{1, 4, 13, 10};
  with_baffle.patches[1].faces.add(baffle);
  EXPECT_TRUE(make_topology(with_baffle).boundary.behind.empty());
  with_baffle.patches[1].kind = PatchKind::wall;
  auto const topology = make_topology(with_baffle);
  auto const patches = find_face_patches(with_baffle, topology);
  EXPECT_TRUE(patches.problems.empty());
  EXPECT_TRUE(patches.notes.empty());
  EXPECT_EQ(topology.boundary.size(), 26);
  EXPECT_EQ(patches.faces_of_patch[1], 6);
}

TEST(UnstructuredTopology, ElementsThatOverlapAreSaid) {
  auto mesh = to_hexahedra(unit_box({2, 1, 1}));
  auto const corners = mesh.elements.corners(0);
  mesh.add_element(ElementType::hexahedron, std::vector<Index32>(corners.begin(), corners.end()));
  auto const topology = make_topology(mesh);
  EXPECT_GT(topology.crowded_sides, 0);
  auto const face_patches = find_face_patches(mesh, topology);
  EXPECT_TRUE(std::any_of(face_patches.problems.begin(), face_patches.problems.end(),
                          [](auto const& p) { return p.find("more than two elements") != std::string::npos; }));
}

TEST(UnstructuredTopology, CollapsedElementsMeetTheirNeighboursWhereTheyHaveFaces) {
  // A prism over the triangle of nodes 1, 2, 4 of a unit square, written as a hexahedron that names two nodes twice,
  // beside the prism of the other half.
  Mesh mesh;
  mesh.add_zone("halves", 8);
  mesh.coordinates = Coordinates(8);
  for (int n = 0; n < 8; ++n) mesh.coordinates.set(n, {double(n & 1), double(n >> 1 & 1), double(n >> 2)});
  mesh.add_element(ElementType::hexahedron, std::array{0, 1, 3, 3, 4, 5, 7, 7});
  mesh.add_element(ElementType::prism, std::array{0, 3, 2, 4, 7, 6});
  auto const topology = make_topology(mesh);
  auto const sides = topology.sides.of(0);
  EXPECT_EQ(std::count(sides.begin(), sides.end(), 1), 1);
  EXPECT_EQ(std::count(sides.begin(), sides.end(), ElementSides::collapsed), 1);
  EXPECT_EQ(topology.boundary.size(), 8);
  EXPECT_EQ(find_boundary_face(topology, std::array{0, 1, 3, 3}), find_boundary_face(topology, std::array{0, 1, 3}));
  expect_closed(mesh, 1);
}

TEST(UnstructuredTopology, ConnectionsLeadToTheElementBehind) {
  for (auto const& orientation : all_orientations()) {
    Mesh const structured = two_zones(orientation, false);
    auto const mesh = to_hexahedra(structured);
    auto const topology = make_topology(mesh);
    // The only neighbours across the cut have a face whose four nodes coincide.
    int across = 0;
    for (Index f = 0; f < topology.boundary.size(); ++f) {
      Index32 const behind = topology.boundary.across[f];
      if (behind < 0) continue;
      ++across;
      EXPECT_EQ(topology.boundary.across[behind], f);
      EXPECT_EQ(topology.boundary.connection[f] ^ 1, topology.boundary.connection[behind]);
      Index32 const other = topology.boundary.element[behind];
      EXPECT_NE(mesh.zone_of_element(other), mesh.zone_of_element(topology.boundary.element[f]));
      for (Index32 const n : topology.boundary.nodes[f]) {
        auto const corners = mesh.elements.corners(other);
        EXPECT_TRUE(std::any_of(corners.begin(), corners.end(),
                                [&](Index32 m) { return distance(mesh.coordinates[n], mesh.coordinates[m]) < 1e-14; }));
      }
    }
    EXPECT_EQ(across, 2 * 5 * 4);
    auto const owner = coincident_nodes(mesh);
    int paired = 0;
    for (Index32 n = 0; n < Index32(owner.size()); ++n) {
      if (owner[n] == n) continue;
      ++paired;
      EXPECT_LT(owner[n], n);
      EXPECT_LT(distance(mesh.coordinates[n], mesh.coordinates[owner[n]]), 1e-14);
    }
    EXPECT_EQ(paired, 6 * 5);
  }
}

TEST(UnstructuredTopology, PointsAreMatchedByPosition) {
  auto const mesh = to_hexahedra(two_zones({}, false));
  auto const& c = mesh.connections.front();
  std::vector<Index32> all(mesh.zones[1].size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = Index32(mesh.zones[1].first_node + Index(n));
  EXPECT_EQ(match_points(mesh.coordinates, c.nodes, all, 1e-9), c.donor_nodes);
  std::vector<Index32> const far{Index32(mesh.zones[0].first_node)};
  EXPECT_EQ(match_points(mesh.coordinates, far, all, 1e-9), std::vector<Index32>{-1});
}

TEST(UnstructuredTopology, PatchesThatTouchWithoutAConnectionAreFound) {
  auto mesh = to_hexahedra(two_zones({}, false));
  for (int const side : {0, 1}) {
    Patch patch;
    patch.name = side == 0 ? "this side" : "that side";
    patch.zone = side;
    patch.nodes = side == 0 ? mesh.connections[0].nodes : mesh.connections[0].donor_nodes;
    mesh.patches.push_back(patch);
  }
  auto const connection = mesh.connections[0];
  EXPECT_TRUE(undeclared_connections(mesh, 1e-9).empty());
  mesh.connections.clear();
  auto const found = undeclared_connections(mesh, 1e-9);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].nodes, connection.nodes);
  EXPECT_EQ(found[0].other_nodes, connection.donor_nodes);
  EXPECT_NE(describe(mesh, found[0]).find("'that side'"), std::string::npos);
  mesh.coordinates.set(connection.nodes[7], mesh.coordinates[connection.nodes[7]] + Vec3{1e-3, 0, 0});
  EXPECT_TRUE(undeclared_connections(mesh, 1e-9).empty());
}

TEST(UnstructuredTopology, FlatMeshesHaveEdgesAsBoundary) {
  auto const mesh = flat_box(5, 4, 2);
  check_mesh(mesh);
  auto const topology = make_topology(mesh);
  EXPECT_EQ(topology.boundary.size(), 2 * (5 + 4));
  auto const face_patches = find_face_patches(mesh, topology);
  EXPECT_TRUE(face_patches.problems.empty());
  // Elements lie on the left of their edges: the boundary runs round the area once.
  double area = 0;
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    auto const e = topology.boundary.nodes[f];
    Vec3 const a = mesh.coordinates[e[0]], b = mesh.coordinates[e[1]];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  EXPECT_NEAR(area, 20, 1e-12);
}

TEST(Mesh, WhatDoesNotFitTogetherIsRefused) {
  auto const good = to_hexahedra(unit_box({2, 2, 2}));
  auto bad = good;
  bad.elements.nodes.item[3] = 1000;
  EXPECT_THROW(check_mesh(bad), MeshError);
  bad = good;
  bad.elements.type[2] = ElementType::triangle;
  EXPECT_THROW(check_mesh(bad), MeshError);
  bad = good;
  bad.zones[0].n_elements += 1;
  EXPECT_THROW(check_mesh(bad), MeshError);
  bad = good;
  bad.patches[0].faces.item[0] = -1;
  EXPECT_THROW(check_mesh(bad), MeshError);
  bad = good;
  bad.patches[0].zone = 7;
  EXPECT_THROW(check_mesh(bad), MeshError);
  check_mesh(good);
}

}  // namespace
}  // namespace gridmorph::test
