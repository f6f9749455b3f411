#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>

namespace gridmorph {

namespace {

/// Which directions of a block have cells, and how far apart their nodes are.
struct Directions {
  std::array<int, 3> axis{};
  int n = 0;  ///< 3, or 2 of a plane

  explicit Directions(Zone const& block) {
    for (int a = 0; a < 3; ++a)
      if (block.extent[a] > 1) axis[n++] = a;
  }
};

/// Calls f(first node of the cell) for every cell.
template <class Function>
void for_each_cell(Zone const& block, Function const& f) {
  Index3 cells{};
  for (int a = 0; a < 3; ++a) cells[a] = std::max(block.extent[a] - 1, 1);
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) f(block.node({i, j, k}));
}

/// Nodes of the cells of a block in SIDS order, as if it were right-handed.
template <std::size_t N>
std::array<Index32, N> cell_nodes(std::array<Index, 3> const& step, Index n) {
  std::array<Index32, N> out{};
  for (std::size_t c = 0; c < N; ++c) {
    Index const corner = Index(c % 4);
    out[c] =
        Index32(n + (corner == 1 || corner == 2 ? step[0] : 0) + (corner >= 2 ? step[1] : 0) + (c >= 4 ? step[2] : 0));
  }
  return out;
}

template <std::size_t N>
void add_cells(Mesh& mesh, Zone const& block, Coordinates const& coordinates, Directions const& along) {
  constexpr ElementType type = N == 8 ? ElementType::hexahedron : ElementType::quadrilateral;
  auto const strides = block.strides();
  std::array<Index, 3> step{};
  for (int d = 0; d < along.n; ++d) step[d] = strides[along.axis[d]];
  Vec3 const up = N == 8 ? Vec3{0, 0, 1} : plane_normal(mesh);
  Index balance = 0;
  for_each_cell(block, [&](Index n) {
    auto const nodes = cell_nodes<N>(step, n);
    kernels::ElementCorners c;
    for (std::size_t k = 0; k < N; ++k) c.at[k] = coordinates[nodes[k]];
    double const volume = element_volume(type, c, 1, up);
    balance += volume > 0 ? 1 : volume < 0 ? -1 : 0;
  });
  for_each_cell(block, [&](Index n) {
    auto nodes = cell_nodes<N>(step, n);
    if (balance < 0) {
      if constexpr (N == 8)
        std::swap_ranges(nodes.begin(), nodes.begin() + 4, nodes.begin() + 4);
      else
        std::swap(nodes[1], nodes[3]);
    }
    mesh.add_element(type, nodes);
  });
}

bool has_node(Zone const& block, Index3 const& p) {
  for (int a = 0; a < 3; ++a)
    if (p[a] < 0 || p[a] >= block.extent[a]) return false;
  return true;
}

}  // namespace

void add_cells(Mesh& mesh, Zone const& block, Coordinates const& coordinates) {
  Directions const along(block);
  if (along.n == 3) add_cells<8>(mesh, block, coordinates, along);
  if (along.n == 2) add_cells<4>(mesh, block, coordinates, along);
}

void add_faces(Zone const& block, IndexRange const& range, CsrGraph& faces) {
  Directions const along(block);
  int axis = 0;
  for (int d = 0; d < along.n; ++d)
    if (int const a = along.axis[d]; range.extent(a) == 1) axis = a;
  Index3 at = range.begin;
  if (along.n == 2) {
    int const u = along.axis[0] == axis ? along.axis[1] : along.axis[0];
    auto const node = [&](int p) {
      at[u] = p;
      return Index32(block.node(at));
    };
    for (int p = range.begin[u]; p + 1 < range.end[u]; ++p) faces.add(std::array<Index32, 2>{node(p), node(p + 1)});
    return;
  }
  int const u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  for (int q = range.begin[v]; q + 1 < range.end[v]; ++q)
    for (int p = range.begin[u]; p + 1 < range.end[u]; ++p) {
      auto const node = [&](int du, int dv) {
        at[u] = p + du;
        at[v] = q + dv;
        return Index32(block.node(at));
      };
      faces.add(std::array<Index32, 4>{node(0, 0), node(1, 0), node(1, 1), node(0, 1)});
    }
}

Patch as_faces(Mesh const& mesh, Patch patch) {
  add_faces(mesh.zones[patch.zone], patch.range, patch.faces);
  patch.range = {};
  return patch;
}

Connection node_pairs(Mesh const& mesh, Interface1to1 const& face) {
  Connection c;
  c.name = face.name;
  c.families = face.families;
  c.zone = face.zone;
  c.donor_zone = face.donor_zone;
  c.periodic = face.periodic;
  Zone const& zone = mesh.zones[face.zone];
  Zone const& donor = mesh.zones[face.donor_zone];
  for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
    for (int j = face.range.begin[1]; j < face.range.end[1]; ++j)
      for (int i = face.range.begin[0]; i < face.range.end[0]; ++i) {
        Index3 const other = face.to_donor(Index3{i, j, k});
        if (!has_node(zone, {i, j, k}) || !has_node(donor, other)) continue;
        c.nodes.push_back(Index32(zone.node({i, j, k})));
        c.donor_nodes.push_back(Index32(donor.node(other)));
      }
  return c;
}

}  // namespace gridmorph
