// Nodes and elements ordered by position: neighbours come together, nothing is lost, and the way back is exact.
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace gridmorph::test {
namespace {

std::vector<Index32> shuffled(Index first, Index n, Random& random) {
  std::vector<Index32> list(static_cast<std::size_t>(n));
  std::iota(list.begin(), list.end(), Index32(first));
  random.shuffle(list);
  return list;
}

/// The mesh with the nodes and elements of each zone in random order; of its file's order, as if it had been read so.
Mesh shuffle(Mesh mesh, unsigned seed) {
  Random random(seed);
  FileOrder order;
  for (auto const& zone : mesh.zones) {
    for (Index32 const n : shuffled(zone.first_node, zone.size(), random)) order.node.push_back(n);
    for (Index32 const e : shuffled(zone.first_element, zone.n_elements, random)) order.element.push_back(e);
  }
  reorder(mesh, order);
  mesh.file_order = {};
  return mesh;
}

/// Two zones that share a face, with patches as faces and as nodes, a connection, and two prisms given by their faces.
Mesh two_boxes() {
  Mesh mesh = to_prisms_and_tetrahedra(unit_box({5, 4, 6}), 2);
  mesh.patches[5].nodes = patch_nodes(mesh.patches[5]);
  mesh.patches[5].faces = {};
  for (Index32 e = 0; e < mesh.n_elements(); ++e) mesh.elements.number.push_back(3 * e + 7);
  for (Index32 const e : {3, 8}) {
    mesh.polyhedra.element.push_back(e);
    if (mesh.polyhedra.first_face.empty()) mesh.polyhedra.first_face.push_back(0);
    std::array<Index32, max_face_corners> room{};
    for (int s = 0; s < n_sides(mesh, e); ++s) mesh.polyhedra.faces.add(side_nodes(mesh, e, s, room));
    mesh.polyhedra.first_face.push_back(mesh.polyhedra.faces.size());
  }
  for (Index32 const e : {3, 8}) mesh.elements.type[e] = ElementType::polyhedron;
  Index32 const first_node = Index32(mesh.n_nodes()), first_element = Index32(mesh.n_elements());
  Mesh const other = to_hexahedra(unit_box({3, 4, 6}));
  mesh.add_zone("second", other.n_nodes());
  for (Index e = 0; e < other.n_elements(); ++e) {
    std::vector<Index32> nodes;
    for (Index32 const n : other.elements.corners(e)) nodes.push_back(n + first_node);
    mesh.add_element(other.elements.type[e], nodes);
    mesh.elements.number.push_back(first_element + Index32(e));
  }
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < first_node; ++n) x.set(n, mesh.coordinates[n]);
  for (Index n = 0; n < other.n_nodes(); ++n) x.set(first_node + n, other.coordinates[n] + Vec3{5, 0, 0});
  mesh.coordinates = x;
  Connection c;
  c.name = "between";
  c.zone = 0;
  c.donor_zone = 1;
  for (Index32 n = 0; n < mesh.n_nodes(); ++n)
    if (x[n].x == 5) (n < first_node ? c.nodes : c.donor_nodes).push_back(n);
  mesh.connections = {c};
  return mesh;
}

TEST(FileOrder, TheWayBackIsExact) {
  auto const mesh = shuffle(two_boxes(), 3);
  auto ordered = mesh;
  reorder(ordered, order_by_position(mesh));
  check_mesh(ordered);
  EXPECT_NE(ordered.elements.nodes.item, mesh.elements.nodes.item);
  auto const back_again = in_file_order(ordered);
  expect_same_mesh(back_again, mesh);
  EXPECT_EQ(back_again.elements.number, mesh.elements.number);
  auto const x = in_file_order(ordered, ordered.coordinates);
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(norm(x[n] - mesh.coordinates[n]), 0);
  std::vector<double> along;
  for (Index n = 0; n < mesh.n_nodes(); ++n) along.push_back(ordered.coordinates.y(n));
  auto const back = in_file_order(ordered.file_order.node, along);
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back[n], mesh.coordinates.y(n));
}

TEST(FileOrder, WhatBelongsTogetherStaysTogether) {
  auto const mesh = shuffle(two_boxes(), 4);
  auto ordered = mesh;
  reorder(ordered, order_by_position(mesh));
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    EXPECT_EQ(ordered.zones[z].first_node, mesh.zones[z].first_node);
    EXPECT_EQ(count_types(ordered, int(z)), count_types(mesh, int(z)));
  }
  EXPECT_EQ(largest_mismatch(ordered, ordered.connections[0]), 0);
  auto const a = make_topology(mesh), b = make_topology(ordered);
  EXPECT_EQ(a.boundary.size(), b.boundary.size());
  EXPECT_EQ(find_face_patches(mesh, a).faces_of_patch, find_face_patches(ordered, b).faces_of_patch);
  for (std::size_t p = 0; p < ordered.polyhedra.element.size(); ++p)
    EXPECT_EQ(ordered.elements.type[ordered.polyhedra.element[p]], ElementType::polyhedron);
}

TEST(FileOrder, MessagesCountAsTheFileDoes) {
  for (bool const numbered : {true, false}) {
    auto mesh = shuffle(two_boxes(), 5);
    if (!numbered) mesh.elements.number.clear();
    auto ordered = mesh;
    reorder(ordered, order_by_position(mesh));
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      EXPECT_EQ(describe_node(ordered, n), describe_node(mesh, ordered.file_order.node[n]));
    for (Index e = 0; e < mesh.n_elements(); ++e)
      EXPECT_EQ(describe_element(ordered, e), describe_element(mesh, ordered.file_order.element[e]));
  }
}

TEST(FileOrder, DependsOnPositionsAlone) {
  auto a = shuffle(two_boxes(), 6), b = shuffle(two_boxes(), 7);
  reorder(a, order_by_position(a));
  reorder(b, order_by_position(b));
  for (Index n = 0; n < a.n_nodes(); ++n) EXPECT_EQ(norm(a.coordinates[n] - b.coordinates[n]), 0) << n;
}

/// Mean distance in numbers between the ends of an edge of an element.
double mean_edge(Mesh const& mesh) {
  double sum = 0, count = 0;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    for (std::size_t k = 1; k < corners.size(); ++k, ++count) sum += std::abs(corners[k] - corners[0]);
  }
  return sum / count;
}

TEST(FileOrder, NeighboursComeTogether) {
  for (int const n : {8, 16, 24}) {
    auto mesh = shuffle(to_prisms_and_tetrahedra(unit_box({n, n, n}), 2), 8);
    EXPECT_GT(mean_edge(mesh), 0.3 * double(mesh.n_nodes()));
    reorder(mesh, order_by_position(mesh));
    // The curve fills cubes one after another: numbers differ by the content of a cube that holds both, and large cubes
    // have few elements across their sides. It grows as n^2, the nodes as n^3.
    EXPECT_LT(mean_edge(mesh), 2.0 * n * n) << n;
    Index last = -1;
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      auto const corners = mesh.elements.corners(e);
      Index const first = *std::min_element(corners.begin(), corners.end());
      EXPECT_GE(first, last);
      last = first;
    }
  }
}

TEST(FileOrder, OnlyNumbersAtRandomAreScattered) {
  for (int const n : {8, 18}) {
    auto mesh = to_prisms_and_tetrahedra(unit_box({n, n, n}), 2);
    EXPECT_FALSE(is_scattered(mesh));
    mesh = shuffle(mesh, 9);
    EXPECT_EQ(is_scattered(mesh), mesh.n_nodes() >= 4096) << n;
    reorder(mesh, order_by_position(mesh));
    EXPECT_FALSE(is_scattered(mesh));
  }
  EXPECT_FALSE(is_scattered({}));
}

TEST(FileOrder, OneSizeOrOrderTooManyIsRefused) {
  auto mesh = two_boxes();
  FileOrder const order = order_by_position(mesh);
  EXPECT_THROW(reorder(mesh, {order.node, {}}), MeshError);
  reorder(mesh, order);
  EXPECT_THROW(reorder(mesh, order), MeshError);
  Mesh empty;
  reorder(empty, order_by_position(empty));
  EXPECT_EQ(in_file_order(empty).n_nodes(), 0);
  Mesh without;
  without.add_zone("zone", 4);
  EXPECT_THROW(order_by_position(without), MeshError);
}

}  // namespace
}  // namespace gridmorph::test
