#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace gridmorph::test {

namespace {

/// Corner numbers of a cell as i + 2 j + 4 k.
std::array<Index32, 8> cell_nodes(Zone const& zone, Index3 const& c) {
  std::array<Index32, 8> out{};
  for (int n = 0; n < 8; ++n) out[n] = Index32(zone.node({c[0] + (n & 1), c[1] + (n >> 1 & 1), c[2] + (n >> 2)}));
  return out;
}

template <class Function>
void each_cell_of(Zone const& zone, Function const& f) {
  for (int k = 0; k + 1 < zone.extent[2]; ++k)
    for (int j = 0; j + 1 < zone.extent[1]; ++j)
      for (int i = 0; i + 1 < zone.extent[0]; ++i) f(Index3{i, j, k});
}

void copy_common(Mesh const& mesh, Mesh& out) {
  out.source = mesh.source + " converted";
  out.families = mesh.families;
  out.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.coordinates.set(n, mesh.coordinates[n]);
}

/// Calls f(axis, corners 00 10 11 01, lower cell index along k) for the quads of a patch range.
template <class Function>
void each_quad(Zone const& zone, IndexRange const& range, Function const& f) {
  int axis = 0;
  for (int a = 0; a < 3; ++a)
    if (range.extent(a) == 1) axis = a;
  int const u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  for (int q = range.begin[v]; q + 1 < range.end[v]; ++q)
    for (int p = range.begin[u]; p + 1 < range.end[u]; ++p) {
      Index3 at = range.begin;
      auto const node = [&](int du, int dv) {
        at[u] = p + du;
        at[v] = q + dv;
        return Index32(zone.node(at));
      };
      std::array<Index32, 4> const corners{node(0, 0), node(1, 0), node(1, 1), node(0, 1)};
      f(axis, corners, v == 2 ? q : 0);
    }
}

Patch start(Patch const& patch) {
  Patch out;
  out.name = patch.name;
  out.bc_type = patch.bc_type;
  out.kind = patch.kind;
  out.families = patch.families;
  out.zone = patch.zone;
  return out;
}

}  // namespace

Mesh to_prisms_and_tetrahedra(Mesh const& mesh, int prism_layers) {
  // Paths from corner 0 to corner 7, one step along each axis, in all orders.
  constexpr std::array<std::array<int, 4>, 6> steps{
      {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 2, 3, 7}, {0, 4, 6, 7}, {0, 1, 5, 7}}};
  Mesh out;
  copy_common(mesh, out);
  for (auto const& zone : mesh.zones) {
    out.add_zone(zone.name, zone.size());
    each_cell_of(zone, [&](Index3 const& c) {
      auto const n = cell_nodes(zone, c);
      auto const at = [&](int k) { return n[k]; };
      if (c[2] < prism_layers) {
        out.add_element(ElementType::prism, std::array{at(0), at(1), at(3), at(4), at(5), at(7)});
        out.add_element(ElementType::prism, std::array{at(0), at(3), at(2), at(4), at(7), at(6)});
        return;
      }
      for (std::size_t t = 0; t < steps.size(); ++t) {
        auto const& s = steps[t];
        std::array tetrahedron{at(s[0]), at(s[1]), at(s[2]), at(s[3])};
        // Right-handed: paths i j k, j k i, k i j are positive, the other three negative.
        if (t >= 3) std::swap(tetrahedron[1], tetrahedron[2]);
        out.add_element(ElementType::tetrahedron, tetrahedron);
      }
    });
  }
  for (auto const& patch : mesh.patches) {
    auto faces = start(patch);
    each_quad(mesh.zones[patch.zone], patch.range, [&](int axis, std::array<Index32, 4> const& q, int k) {
      if (axis != 2 && k < prism_layers) return faces.faces.add(q);
      faces.faces.add(std::array{q[0], q[1], q[2]});
      faces.faces.add(std::array{q[0], q[2], q[3]});
    });
    out.patches.push_back(std::move(faces));
  }
  return out;
}

Mesh unit_box(Index3 cells) {
  Mesh mesh;
  mesh.source = "unit box";
  Index3 const extent{cells[0] + 1, cells[1] + 1, cells[2] + 1};
  mesh.add_zone("box", extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (int k = 0; k < extent[2]; ++k)
    for (int j = 0; j < extent[1]; ++j)
      for (int i = 0; i < extent[0]; ++i)
        mesh.coordinates.set(mesh.zones[0].node({i, j, k}), {double(i), double(j), double(k)});
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Patch patch;
      patch.name = std::string(face_name(axis, side));
      patch.kind = axis == 2 && side == 0 ? PatchKind::wall : PatchKind::other;
      patch.zone = 0;
      patch.range = {{0, 0, 0}, extent};
      patch.range.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
      patch.range.end[axis] = patch.range.begin[axis] + 1;
      mesh.patches.push_back(patch);
    }
  return mesh;
}

Mesh flat_box(int ni, int nj, int layers) {
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "flat box";
  mesh.add_zone("plane", Index(ni + 1) * (nj + 1));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const node = [&](int i, int j) { return Index32(i + (ni + 1) * j); };
  for (int j = 0; j <= nj; ++j)
    for (int i = 0; i <= ni; ++i) mesh.coordinates.set(node(i, j), {double(i), double(j), 0});
  for (int j = 0; j < nj; ++j)
    for (int i = 0; i < ni; ++i) {
      if (j < layers) {
        mesh.add_element(ElementType::quadrilateral,
                         std::array{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
      } else {
        mesh.add_element(ElementType::triangle, std::array{node(i, j), node(i + 1, j), node(i + 1, j + 1)});
        mesh.add_element(ElementType::triangle, std::array{node(i, j), node(i + 1, j + 1), node(i, j + 1)});
      }
    }
  for (int side = 0; side < 4; ++side) {
    Patch patch;
    patch.name = std::string(face_name(side / 2, side % 2));
    patch.kind = side == 2 ? PatchKind::wall : PatchKind::other;
    patch.zone = 0;
    int const n = side < 2 ? nj : ni;
    for (int k = 0; k < n; ++k)
      patch.faces.add(side == 0   ? std::array{node(0, k), node(0, k + 1)}
                      : side == 1 ? std::array{node(ni, k), node(ni, k + 1)}
                      : side == 2 ? std::array{node(k, 0), node(k + 1, 0)}
                                  : std::array{node(k, nj), node(k + 1, nj)});
    mesh.patches.push_back(std::move(patch));
  }
  return mesh;
}

Mesh periodic_flat_box(int ni, int nj, int layers) {
  Mesh mesh = flat_box(ni, nj, layers);
  Connection pair;
  pair.name = "pair";
  pair.zone = pair.donor_zone = 0;
  pair.periodic = periodic_translation({double(ni), 0, 0});
  for (Index32 n = 0; n < mesh.n_nodes(); ++n)
    for (Index32 m = 0; m < mesh.n_nodes(); ++m)
      if (mesh.coordinates.x(n) == 0 && mesh.coordinates.x(m) == ni && mesh.coordinates.y(n) == mesh.coordinates.y(m)) {
        pair.nodes.push_back(n);
        pair.donor_nodes.push_back(m);
      }
  mesh.connections.push_back(pair);
  return mesh;
}

void expect_same_mesh(Mesh const& a, Mesh const& b) {
  ASSERT_EQ(a.zones.size(), b.zones.size());
  EXPECT_EQ(a.dimension, b.dimension);
  for (std::size_t z = 0; z < a.zones.size(); ++z) {
    EXPECT_EQ(a.zones[z].name, b.zones[z].name);
    EXPECT_EQ(a.zones[z].size(), b.zones[z].size());
    EXPECT_EQ(a.zones[z].n_elements, b.zones[z].n_elements);
  }
  EXPECT_EQ(a.elements.type, b.elements.type);
  EXPECT_EQ(a.elements.nodes.first, b.elements.nodes.first);
  EXPECT_EQ(a.elements.nodes.item, b.elements.nodes.item);
  EXPECT_EQ(a.polyhedra.element, b.polyhedra.element);
  EXPECT_EQ(a.polyhedra.first_face, b.polyhedra.first_face);
  EXPECT_EQ(a.polyhedra.faces.first, b.polyhedra.faces.first);
  EXPECT_EQ(a.polyhedra.faces.item, b.polyhedra.faces.item);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t p = 0; p < a.patches.size(); ++p) {
    EXPECT_EQ(a.patches[p].name, b.patches[p].name);
    EXPECT_EQ(a.patches[p].kind, b.patches[p].kind);
    EXPECT_EQ(a.patches[p].families, b.patches[p].families);
    EXPECT_EQ(a.patches[p].faces.first, b.patches[p].faces.first);
    EXPECT_EQ(a.patches[p].faces.item, b.patches[p].faces.item);
    EXPECT_EQ(a.patches[p].nodes, b.patches[p].nodes);
  }
  ASSERT_EQ(a.connections.size(), b.connections.size());
  for (std::size_t c = 0; c < a.connections.size(); ++c) {
    EXPECT_EQ(a.connections[c].nodes, b.connections[c].nodes);
    EXPECT_EQ(a.connections[c].donor_nodes, b.connections[c].donor_nodes);
    EXPECT_EQ(a.connections[c].periodic.has_value(), b.connections[c].periodic.has_value());
  }
  ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
  for (Index n = 0; n < a.coordinates.size(); ++n) {
    EXPECT_EQ(a.coordinates.x(n), b.coordinates.x(n)) << n;
    EXPECT_EQ(a.coordinates.y(n), b.coordinates.y(n)) << n;
    EXPECT_EQ(a.coordinates.z(n), b.coordinates.z(n)) << n;
  }
}

}  // namespace gridmorph::test
