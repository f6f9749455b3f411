// Columns through boxes, where it is known which nodes stand on which: all elements, sides of the box, extents and
// positions.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/plan/elements/columns.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace gridmorph::test {
namespace {

using Extent = BoundaryLayer::Extent;

/// A box of cells in the coordinates i, j, k of its nodes, and what make_columns() asks for.
struct Standing {
  Mesh mesh;
  std::vector<Vec3> ijk;  ///< of each node, before it is moved
  UnstructuredTopology topology = make_topology(mesh);
  NodeGraph graph = make_node_graph(mesh, topology.elements_of_nodes);
  std::vector<Index32> faces;
  std::vector<ColumnExtent> extents;
  std::vector<std::uint8_t> known = std::vector<std::uint8_t>(std::size_t(mesh.n_nodes()), 0);

  explicit Standing(Mesh m) : mesh(std::move(m)) {
    for (Index n = 0; n < mesh.n_nodes(); ++n) ijk.push_back(mesh.coordinates[n]);
  }
  void stand_on(std::string const& patch, ColumnExtent const& extent) {
    for (auto const& p : mesh.patches)
      if (p.name == patch)
        for (Index f = 0; f < p.faces.size(); ++f) {
          faces.push_back(find_boundary_face(topology, p.faces[f]));
          extents.push_back(extent);
        }
  }
  template <class Position>
  void move(Position const& position) {
    for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, position(ijk[n]));
  }
  [[nodiscard]] Columns columns() const { return make_columns(mesh, topology, graph, faces, extents, known); }
  [[nodiscard]] Index32 at(Vec3 const& p) const { return Index32(std::find(ijk.begin(), ijk.end(), p) - ijk.begin()); }
};

/// The columns hold exactly the nodes of levels 1 ... n(i, j) above the wall, each with its root and the length of its
/// way.
template <class Levels>
void expect_columns(Standing const& s, Levels const& levels) {
  Columns const c = s.columns();
  std::map<Index32, std::size_t> place;
  double level = 0;
  for (std::size_t k = 0; k < c.node.size(); ++k) {
    EXPECT_TRUE(place.emplace(c.node[k], k).second) << "each node once";
    EXPECT_GE(s.ijk[c.node[k]].z, level) << "layer by layer";
    level = s.ijk[c.node[k]].z;
  }
  for (Index32 n = 0; n < s.mesh.n_nodes(); ++n) {
    Vec3 const p = s.ijk[n];
    int const n_levels = levels(p);
    ASSERT_EQ(place.contains(n), p.z > 0 && p.z <= n_levels) << p.x << ' ' << p.y << ' ' << p.z;
    double length = 0;
    for (int k = 1; k <= n_levels && (k <= p.z || p.z == 0); ++k)
      length += distance(s.mesh.coordinates[s.at({p.x, p.y, k - 1.})], s.mesh.coordinates[s.at({p.x, p.y, double(k)})]);
    if (p.z == 0) {
      EXPECT_NEAR(c.height[n], length, 1e-13);
    } else {
      EXPECT_EQ(c.height[n], 0);
    }
    if (!place.contains(n)) continue;
    EXPECT_EQ(c.root[place[n]], s.at({p.x, p.y, 0}));
    EXPECT_NEAR(c.above_wall[place[n]], length, 1e-13);
  }
}

/// Standing on k_min, sheared and turned.
void lean(Standing& s, double (*height)(double)) {
  RigidTransform const place = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  s.move([&](Vec3 const& p) { return place({p.x + 0.1 * height(p.z), p.y, height(p.z)}); });
}

TEST(Columns, EndWithTheirLayersOrThePrisms) {
  for (auto const& [cells, prisms, layers] :
       {std::tuple{Index3{2, 3, 6}, 4, 2}, {Index3{5, 4, 5}, 3, 3}, {Index3{3, 3, 7}, 3, 6}}) {
    Standing s(to_prisms_and_tetrahedra(unit_box(cells), prisms));
    s.stand_on("k_min", {Extent::layers, layers, 0});
    lean(s, [](double z) { return z; });
    expect_columns(s, [&](Vec3 const&) { return std::min(prisms, layers); });
  }
  Standing hexahedra(to_hexahedra(unit_box({3, 4, 5})));
  hexahedra.stand_on("k_min", {Extent::layers, 9, 0});
  expect_columns(hexahedra, [](Vec3 const&) { return 5; });
}

TEST(Columns, EndWhereTheyAreAsHighAsTheyMay) {
  Standing s(to_hexahedra(unit_box({3, 4, 6})));
  s.stand_on("k_min", {Extent::thickness, 0, 3.5 * std::hypot(0.1, 1)});
  lean(s, [](double z) { return z; });
  expect_columns(s, [](Vec3 const&) { return 3; });
}

TEST(Columns, EndWhereCellsAreAsThickAsHalfTheirFaceIsWide) {
  // Layers of 0.15, 0.25, 0.35, ... on faces one wide.
  Standing s(to_hexahedra(unit_box({3, 4, 6})));
  s.stand_on("k_min", {});
  lean(s, [](double z) { return 0.1 * z + 0.05 * z * z; });
  expect_columns(s, [](Vec3 const&) { return 4; });
  Standing cubes(to_hexahedra(unit_box({3, 3, 3})));
  cubes.stand_on("k_min", {});
  EXPECT_EQ(cubes.columns().size(), 0);
}

TEST(Columns, OfLinesThatLeanRiseLessThanTheyAreLong) {
  RigidTransform const place = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  for (double const lean : {0.0, 1.5, 4.0}) {
    Standing s(to_hexahedra(unit_box({3, 4, 5})));
    s.stand_on("k_min", {Extent::layers, 3, 0});
    s.move([&](Vec3 const& p) { return place({p.x + lean * p.z, p.y, p.z}); });
    Columns const leaning = s.columns();
    Standing flat(flat_box(6, 7, 4));
    flat.stand_on("j_min", {Extent::layers, 3, 0});
    flat.move([&](Vec3 const& p) { return Vec3{p.x + lean * p.y, p.y, 0}; });
    Columns const plane = flat.columns();
    double const length = 3 * std::hypot(1, lean);
    for (auto const* c : {&leaning, &plane}) {
      ASSERT_GT(c->size(), 0);
      for (Index32 const root : c->root) {
        EXPECT_NEAR(c->height[root], length, 1e-12);
        EXPECT_NEAR(c->full_rise[root], lean > std::sqrt(3) ? 6 : length, 1e-12);
      }
    }
  }
}

TEST(Columns, EndBelowKnownNodes) {
  Standing s(to_prisms_and_tetrahedra(unit_box({4, 4, 5}), 4));
  s.stand_on("k_min", {Extent::layers, 4, 0});
  s.known[s.at({2, 2, 3})] = 1;
  expect_columns(s, [](Vec3 const& p) { return p.x == 2 && p.y == 2 ? 2 : 4; });
}

TEST(Columns, InAPlaneGoThroughQuadrilaterals) {
  Mesh mesh = flat_box(6, 7, 4);
  Standing s(mesh);
  s.stand_on("j_min", {Extent::layers, 6, 0});
  Columns const c = s.columns();
  EXPECT_EQ(c.size(), 7 * 4);
  for (std::size_t k = 0; k < c.node.size(); ++k) {
    Vec3 const p = s.ijk[c.node[k]];
    EXPECT_EQ(c.root[k], s.at({p.x, 0, 0}));
    EXPECT_EQ(c.above_wall[k], p.y);
  }
}

TEST(Columns, StandOnAnySideOfTheBoxAlike) {
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Index3 const cells{5, 6, 7};
      Standing s(to_hexahedra(unit_box(cells)));
      s.stand_on(std::string(face_name(axis, side)), {Extent::layers, 2, 0});
      Columns const c = s.columns();
      Index const on_wall = s.mesh.n_nodes() / (cells[axis] + 1);
      EXPECT_EQ(c.size(), 2 * on_wall);
      for (std::size_t k = 0; k < c.node.size(); ++k) {
        Vec3 const up = s.ijk[c.node[k]] - s.ijk[c.root[k]];
        double const along[3] = {up.x, up.y, up.z};
        EXPECT_EQ(along[axis] * (side == 0 ? 1 : -1), Index(k) < on_wall ? 1 : 2);
        EXPECT_EQ(norm(up), std::abs(along[axis]));
        EXPECT_EQ(c.above_wall[k], norm(up));
      }
    }
}

TEST(Columns, InACornerEachNodeBelongsToTheNearestWallThenToTheFirst) {
  for (bool const floor_first : {true, false}) {
    Standing s(to_hexahedra(unit_box({6, 4, 6})));
    for (bool const floor : {floor_first, !floor_first}) s.stand_on(floor ? "k_min" : "i_min", {Extent::layers, 2, 0});
    Columns const c = s.columns();
    std::set<Index32> nodes(c.node.begin(), c.node.end());
    EXPECT_EQ(nodes.size(), c.node.size());
    for (std::size_t k = 0; k < c.node.size(); ++k) {
      Vec3 const p = s.ijk[c.node[k]], root = s.ijk[c.root[k]];
      EXPECT_EQ(c.above_wall[k], std::min(p.x, p.z));
      EXPECT_EQ(distance(p, root), c.above_wall[k]);
      if (p.x == 1 && p.z == 1) {
        EXPECT_EQ(root.z == 0, floor_first);
      }
    }
    // In the corner alone the two bands of two layers overlap.
    EXPECT_EQ(c.size(), 5 * (6 * 2 + 6 * 2 - 2 * 2));
  }
}

TEST(Columns, GoThroughPolyhedraAsThroughTheElementsThatTheyAre) {
  for (Mesh const& mesh : {to_hexahedra(unit_box({3, 2, 4})), to_prisms_and_tetrahedra(unit_box({3, 2, 4}), 3)}) {
    Standing typed(mesh), by_faces(as_polyhedra(mesh));
    for (Standing* s : {&typed, &by_faces}) {
      lean(*s, [](double k) { return 0.1 * k * (1 + 0.2 * k); });
      s->stand_on("k_min", {Extent::layers, 4, 0});
    }
    Columns const a = typed.columns(), b = by_faces.columns();
    EXPECT_GT(a.size(), 0);
    auto const sorted = [](Columns const& c) {
      std::set<std::array<Index32, 3>> out;
      for (std::size_t k = 0; k < c.node.size(); ++k) out.insert({c.node[k], c.root[k], c.below[k]});
      return out;
    };
    EXPECT_EQ(sorted(a), sorted(b));
    EXPECT_EQ(a.height, b.height);
  }
}

/// Prisms of that many sides on top of one another, the lowest on the patch "wall".
Mesh stack(int sides, int levels) {
  Mesh mesh;
  mesh.add_zone("zone", Index(sides) * (levels + 1));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (int k = 0; k <= levels; ++k)
    for (int c = 0; c < sides; ++c) {
      double const angle = 6.283185307179586 * c / sides;
      mesh.coordinates.set(c + sides * k, {std::cos(angle), std::sin(angle), 0.1 * k * (1 + 0.1 * k)});
    }
  mesh.polyhedra.first_face.push_back(0);
  for (int k = 0; k < levels; ++k) {
    std::vector<Index32> all, low, high;
    for (int c = 0; c < 2 * sides; ++c) all.push_back(Index32(c + sides * k));
    for (int c = 0; c < sides; ++c) {
      low.push_back(Index32(sides * k + (sides - 1 - c)));
      high.push_back(Index32(sides * (k + 1) + c));
    }
    mesh.add_element(ElementType::polyhedron, all);
    mesh.polyhedra.faces.add(low);
    for (int c = 0; c < sides; ++c) {
      int const d = (c + 1) % sides, base = sides * k;
      std::array const quad{Index32(base + c), Index32(base + d), Index32(base + sides + d), Index32(base + sides + c)};
      mesh.polyhedra.faces.add(quad);
    }
    mesh.polyhedra.faces.add(high);
    mesh.polyhedra.element.push_back(Index32(k));
    mesh.polyhedra.first_face.push_back(mesh.polyhedra.faces.size());
    if (k > 0) continue;
    Patch wall;
    wall.name = "wall";
    wall.zone = 0;
    wall.faces.add(low);
    mesh.patches.push_back(std::move(wall));
  }
  return mesh;
}

TEST(Columns, GoThroughPrismsOfManySides) {
  for (int const sides : {3, 5, 6, 9}) {
    int const levels = 4;
    Standing s(stack(sides, levels));
    s.stand_on("wall", {Extent::layers, 3, 0});
    Columns const c = s.columns();
    ASSERT_EQ(c.size(), 3 * sides);
    for (std::size_t k = 0; k < c.node.size(); ++k) {
      EXPECT_EQ(c.root[k], c.node[k] % sides);
      EXPECT_EQ(c.below[k], c.node[k] - sides);
      EXPECT_NEAR(c.above_wall[k], s.mesh.coordinates.z(c.node[k]), 1e-14);
    }
    // A pyramid in place of the top of the lowest one: no side lies over the wall.
    Mesh cut = stack(sides, 1);
    auto& item = cut.polyhedra.faces.item;
    std::replace(item.begin(), item.end(), Index32(sides + 1), Index32(sides));
    Standing other(cut);
    other.stand_on("wall", {Extent::layers, 3, 0});
    EXPECT_EQ(other.columns().size(), 0);
  }
}

}  // namespace
}  // namespace gridmorph::test
