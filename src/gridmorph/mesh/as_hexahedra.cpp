#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace gridmorph {

namespace {

/// Nodes of a cell in SIDS order, as if the zone were right-handed.
std::array<Index32, 8> cell_nodes(Zone const& zone, Index3 const& c) {
  auto const strides = zone.strides();
  Index const n = zone.node(c), i = n + strides[0], j = n + strides[1], ij = i + strides[1], up = strides[2];
  return {Index32(n),      Index32(i),      Index32(ij),      Index32(j),
          Index32(n + up), Index32(i + up), Index32(ij + up), Index32(j + up)};
}

template <class Function>
void for_each_cell(Zone const& zone, Function const& f) {
  for (int k = 0; k + 1 < zone.extent[2]; ++k)
    for (int j = 0; j + 1 < zone.extent[1]; ++j)
      for (int i = 0; i + 1 < zone.extent[0]; ++i) f(cell_nodes(zone, {i, j, k}));
}

/// Whether more cells have a negative volume than a positive one.
bool is_left_handed(Mesh const& mesh, Zone const& zone) {
  Index balance = 0;
  for_each_cell(zone, [&](std::array<Index32, 8> const& nodes) {
    kernels::ElementCorners c;
    for (std::size_t k = 0; k < nodes.size(); ++k) c.at[k] = mesh.coordinates[nodes[k]];
    double const volume = element_volume(ElementType::hexahedron, c, 1, {0, 0, 1});
    balance += volume > 0 ? 1 : volume < 0 ? -1 : 0;
  });
  return balance < 0;
}

/// The quadrilaterals of a patch range.
void add_faces(Zone const& zone, IndexRange const& range, CsrGraph& faces) {
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
      faces.add(std::array<Index32, 4>{node(0, 0), node(1, 0), node(1, 1), node(0, 1)});
    }
}

Connection connection_of(Mesh const& mesh, Interface1to1 const& face) {
  Connection c;
  c.name = face.name;
  c.families = face.families;
  c.zone = face.zone;
  c.donor_zone = face.donor_zone;
  c.periodic = face.periodic;
  Zone const& zone = mesh.zones[std::size_t(face.zone)];
  Zone const& donor = mesh.zones[std::size_t(face.donor_zone)];
  for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
    for (int j = face.range.begin[1]; j < face.range.end[1]; ++j)
      for (int i = face.range.begin[0]; i < face.range.end[0]; ++i) {
        c.nodes.push_back(Index32(zone.node({i, j, k})));
        c.donor_nodes.push_back(Index32(donor.node(face.to_donor(Index3{i, j, k}))));
      }
  return c;
}

}  // namespace

Mesh as_hexahedra(Mesh const& mesh) {
  if (mesh.n_nodes() > std::numeric_limits<Index32>::max())
    throw MeshError("'" + mesh.source + "' has " + std::to_string(mesh.n_nodes()) +
                    " nodes; as an unstructured mesh it may have at most " +
                    std::to_string(std::numeric_limits<Index32>::max()));
  Mesh out;
  out.source = mesh.source;
  out.families = mesh.families;
  out.coordinates = Coordinates(mesh.n_nodes());
  Kokkos::deep_copy(out.coordinates.x, mesh.coordinates.x);
  Kokkos::deep_copy(out.coordinates.y, mesh.coordinates.y);
  Kokkos::deep_copy(out.coordinates.z, mesh.coordinates.z);
  out.elements.type.reserve(std::size_t(mesh.n_cells()));
  out.elements.nodes.first.reserve(std::size_t(mesh.n_cells()) + 1);
  out.elements.nodes.item.reserve(8 * std::size_t(mesh.n_cells()));
  for (auto const& zone : mesh.zones) {
    int const added = out.add_zone(zone.name, zone.size());
    out.zones[std::size_t(added)].single_precision = zone.single_precision;
    bool const turn = is_left_handed(mesh, zone);
    for_each_cell(zone, [&](std::array<Index32, 8> nodes) {
      if (turn) std::swap_ranges(nodes.begin(), nodes.begin() + 4, nodes.begin() + 4);
      out.add_element(ElementType::hexahedron, nodes);
    });
  }
  for (auto const& patch : mesh.patches) {
    Patch faces;
    faces.name = patch.name;
    faces.bc_type = patch.bc_type;
    faces.kind = patch.kind;
    faces.families = patch.families;
    faces.zone = patch.zone;
    add_faces(mesh.zones[std::size_t(patch.zone)], patch.range, faces.faces);
    out.patches.push_back(std::move(faces));
  }
  for (auto const& face : mesh.interfaces) out.connections.push_back(connection_of(mesh, face));
  return out;
}

}  // namespace gridmorph
