#include <gridmorph/boundary/boundary.hpp>

#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

/// What is left of a mesh without its elements.
BoundaryMesh without_elements(Mesh const& mesh) {
  BoundaryMesh out;
  out.dimension = mesh.dimension;
  out.zones = mesh.zones;
  for (Patch const& patch : mesh.patches)
    out.patches.push_back({patch.name, patch.bc_type, patch.kind, patch.families, patch.zone, patch.range, {}, {}});
  out.interfaces = mesh.interfaces;
  out.connections = mesh.connections;
  out.families = mesh.families;
  out.coordinates = mesh.coordinates;
  out.source = mesh.source;
  out.first_number = mesh.first_number;
  out.file_order.node = mesh.file_order.node;
  return out;
}

BoundarySurface surface_of(Mesh const& mesh, Patch const& patch) {
  BoundarySurface out;
  if (!is_box(patch)) {
    out.grid = {1, 1};
    for (int axis = 0, d = 0; axis < 3 && d < 2; ++axis)
      if (patch.range.extent(axis) > 1) (*out.grid)[d++] = patch.range.extent(axis);
  }
  out.nodes.reserve(std::size_t(patch.range.size()));
  for_each_node(mesh.zones[patch.zone], patch.range, [&](Index n) { out.nodes.push_back(n); });
  return out;
}

/// The face as places among the nodes of its patch, so that its normal points into its element: elements may be
/// numbered either way around. That of a line is across x line, `across` being the normal of the plane.
std::vector<int> inward_face(Mesh const& mesh, UnstructuredTopology const& topology, Index f,
                             std::vector<Index> const& nodes, Vec3 const& across) {
  auto const face = topology.boundary.nodes[f];
  std::vector<int> place;
  Vec3 middle, normal, centre;
  for (Index32 const n : face) {
    place.push_back(int(std::lower_bound(nodes.begin(), nodes.end(), Index(n)) - nodes.begin()));
    middle += (1 / double(face.size())) * mesh.coordinates[n];
  }
  bool const line = place.size() == 2;
  if (line) normal = cross(across, mesh.coordinates[face[1]] - mesh.coordinates[face[0]]);
  for (std::size_t k = 0; k < face.size() && !line; ++k)
    normal += cross(mesh.coordinates[face[k]] - middle, mesh.coordinates[face[(k + 1) % face.size()]] - middle);
  auto const element = mesh.elements.corners(topology.boundary.element[f]);
  for (Index32 const n : element) centre += (1 / double(element.size())) * mesh.coordinates[n];
  if (dot(normal, centre - middle) < 0) std::reverse(place.begin(), place.end());
  return place;
}

void add_face(std::vector<int> const& corners, std::vector<GridFacet>& faces) {
  if (corners.size() == 2) {
    faces.push_back({corners[0], corners[1], -1, -1});
  } else if (corners.size() <= 4) {
    faces.push_back({corners[0], corners[1], corners[2], corners.size() == 4 ? corners[3] : -1});
  } else {
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) faces.push_back({corners[0], corners[k], corners[k + 1], -1});
  }
}

}  // namespace

Boundary::Boundary(Mesh const& mesh, std::optional<double> size)
    : mesh_(without_elements(mesh)), size_(size ? *size : mesh.size()), precision_(coordinate_precision(mesh)) {
  for (Patch const& patch : mesh.patches) surfaces_.push_back(surface_of(mesh, patch));
}

Boundary::Boundary(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                   std::optional<double> size, std::span<Patch const> regions)
    : mesh_(without_elements(mesh)),
      size_(size ? *size : mesh.size()),
      precision_(coordinate_precision(mesh)),
      plane_(mesh.dimension == 2),
      surfaces_(mesh.patches.size() + regions.size()) {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    auto const& nodes = regions[r].nodes;
    surfaces_[mesh.patches.size() + r].nodes.assign(nodes.begin(), nodes.end());
    mesh_.patches.push_back(regions[r]);
    mesh_.patches.back().nodes.clear();
  }
  if (plane_) across_ = size_ * plane_normal(mesh);
  auto const each_face = [&](auto&& visit) {
    for (Index f = 0; f < topology.boundary.size(); ++f)
      if (int const p = face_patches.patch[f]; p >= 0) visit(f, surfaces_[p]);
  };
  each_face([&](Index f, BoundarySurface& surface) {
    auto const face = topology.boundary.nodes[f];
    surface.nodes.insert(surface.nodes.end(), face.begin(), face.end());
    for (auto const& m : side_middle_nodes(mesh, topology.boundary.element[f], topology.boundary.side[f]))
      surface.nodes.push_back(m.node);
  });
  for (std::size_t p = 0; p < surfaces_.size(); ++p) {
    auto& [nodes, grid, faces, in_file_order] = surfaces_[p];
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.empty() && p < mesh.patches.size()) {
      auto const listed = patch_nodes(mesh.patches[p]);
      nodes.assign(listed.begin(), listed.end());
    }
    in_file_order.resize(nodes.size());
    std::iota(in_file_order.begin(), in_file_order.end(), 0);
    if (mesh.file_order.node.empty()) continue;
    std::sort(in_file_order.begin(), in_file_order.end(), [&, &list = nodes](int a, int b) {
      return mesh.file_order.node[list[a]] < mesh.file_order.node[list[b]];
    });
  }
  // Both sides of a surface inside the mesh that are one patch are one surface.
  auto const is_back = [&](Index f) {
    auto const& behind = topology.boundary.behind;
    Index32 const other = behind.empty() ? -1 : behind[f];
    return other >= 0 && other < f && face_patches.patch[other] == face_patches.patch[f];
  };
  each_face([&](Index f, BoundarySurface& surface) {
    if (is_back(f)) return;
    add_face(inward_face(mesh, topology, f, surface.nodes, across_), surface.faces);
  });
}

std::vector<Vec3> Boundary::points(std::span<int const> patches) const {
  if (patches.size() == 1) return points_of(surface(patches.front()).nodes);
  std::vector<Vec3> out;
  for (int const p : patches) {
    auto const own = points_of(surface(p).nodes);
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

std::vector<Vec3> Boundary::points_of(std::vector<Index> const& nodes) const {
  std::vector<Vec3> out;
  out.reserve(plane_ ? 2 * nodes.size() : nodes.size());
  for (Index const n : nodes) out.push_back(mesh_.coordinates[n]);
  if (plane_)
    for (Index const n : nodes) out.push_back(mesh_.coordinates[n] + across_);
  return out;
}

FacetList Boundary::facets(std::span<int const> patches) const {
  FacetList list;
  for (int const p : patches) {
    auto const first = std::int32_t(list.points.size());
    BoundarySurface const& own = surface(p);
    for (Index const n : own.nodes) list.points.push_back(mesh_.coordinates[n]);
    if (own.grid) {
      std::int32_t const n_a = (*own.grid)[0], n_b = (*own.grid)[1];
      for (std::int32_t b = 0; b + 1 < n_b; ++b)
        for (std::int32_t a = 0; a + 1 < n_a; ++a) {
          std::int32_t const at = first + a + n_a * b;
          list.facets.push_back({at, at + 1, at + 1 + n_a, at + n_a});
        }
    }
    for (GridFacet const& face : own.faces)
      if (face[2] >= 0)
        list.facets.push_back({first + face[0], first + face[1], first + face[2], face[3] < 0 ? -1 : first + face[3]});
  }
  return list;
}

bool Boundary::share_nodes(int patch, int other) const {
  Patch const& a = mesh_.patches[patch];
  Patch const& b = mesh_.patches[other];
  if (a.zone != b.zone) return false;
  if (surface(patch).grid) return overlap(a.range, b.range);
  auto const& own = surface(patch).nodes;
  auto const& theirs = surface(other).nodes;
  return std::any_of(own.begin(), own.end(),
                     [&](Index n) { return std::binary_search(theirs.begin(), theirs.end(), n); });
}

std::vector<std::array<Index, 2>> Boundary::pairs(int connection) const {
  std::vector<std::array<Index, 2>> out;
  auto const n = int(mesh_.interfaces.size());
  if (connection < n) {
    for_each_pair(mesh_, mesh_.interfaces[connection], [&](Index own, Index donor) { out.push_back({own, donor}); });
  } else {
    Connection const& c = mesh_.connections[connection - n];
    for (std::size_t k = 0; k < c.nodes.size(); ++k) out.push_back({c.nodes[k], c.donor_nodes[k]});
  }
  return out;
}

bool Boundary::touches(int connection, int patch) const {
  Patch const& p = mesh_.patches[patch];
  auto const n = int(mesh_.interfaces.size());
  if (connection < n) {
    Interface1to1 const& i = mesh_.interfaces[connection];
    return (p.zone == i.zone && overlap(p.range, i.range)) ||
           (p.zone == i.donor_zone && overlap(p.range, i.to_donor(i.range)));
  }
  Connection const& c = mesh_.connections[connection - n];
  auto const& nodes = surface(patch).nodes;
  auto const has = [&](std::vector<Index32> const& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](Index32 m) { return std::binary_search(nodes.begin(), nodes.end(), Index(m)); });
  };
  return (p.zone == c.zone && has(c.nodes)) || (p.zone == c.donor_zone && has(c.donor_nodes));
}

RigidTransform Boundary::transform(int connection) const {
  std::vector<Vec3> from, to;
  for (auto const& [own, donor] : pairs(connection)) {
    from.push_back(mesh_.coordinates[own]);
    to.push_back(mesh_.coordinates[donor]);
  }
  auto const n = mesh_.interfaces.size();
  // Nodes of blocks fill a face; those of a plane mesh's side lie on a line, about which only the file knows.
  if (std::size_t(connection) < n) return fit_rigid_transform(from, to);
  return fit_periodic(*mesh_.connections[std::size_t(connection) - n].periodic, from, to, size_);
}

std::vector<RigidTransform> Boundary::periodic_transforms() const {
  std::vector<RigidTransform> out;
  for (auto const& c : connections())
    if (c.periodic) out.push_back(transform(c.number));
  return out;
}

std::vector<RigidTransform> Boundary::periodic_transforms(std::span<int const> patches) const {
  std::vector<RigidTransform> out;
  for (auto const& c : connections())
    if (c.periodic && std::any_of(patches.begin(), patches.end(), [&](int p) { return touches(c.number, p); }))
      out.push_back(transform(c.number));
  return out;
}

}  // namespace gridmorph
