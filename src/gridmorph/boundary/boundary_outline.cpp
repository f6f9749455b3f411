#include <gridmorph/boundary/boundary_outline.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace gridmorph {

std::vector<std::vector<Index32>> nodes_of_patches(Mesh const& mesh, UnstructuredTopology const& topology,
                                                   BoundaryFacePatches const& face_patches) {
  std::vector<std::vector<Index32>> nodes(mesh.patches.size());
  for (Index f = 0; f < topology.boundary.size(); ++f)
    if (int const p = face_patches.patch[std::size_t(f)]; p >= 0) {
      auto const face = topology.boundary.nodes[f];
      nodes[std::size_t(p)].insert(nodes[std::size_t(p)].end(), face.begin(), face.end());
    }
  for (std::size_t p = 0; p < nodes.size(); ++p) {
    auto& list = nodes[p];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    if (list.empty()) list = patch_nodes(mesh.patches[p]);
  }
  return nodes;
}

namespace {

/// The connection that is this one seen from its donor's side, or the connection itself.
std::size_t partner_of(Mesh const& mesh, std::size_t c) {
  auto const& own = mesh.connections[c];
  for (std::size_t d = 0; d < mesh.connections.size(); ++d) {
    auto const& other = mesh.connections[d];
    if (d == c || other.zone != own.donor_zone || other.donor_zone != own.zone || !other.periodic) continue;
    if (other.nodes.size() != own.nodes.size()) continue;
    std::vector<Index32> a = own.donor_nodes, b = other.nodes;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    if (a == b) return d;
  }
  return c;
}

}  // namespace

Mesh boundary_outline(Mesh const& mesh, std::vector<std::vector<Index32>> const& nodes_of_patch) {
  Mesh outline;
  outline.source = mesh.source;
  outline.families = mesh.families;
  auto const add_zone = [&](std::string const& name, std::size_t n) {
    // A zone has two nodes at least along each axis; only those of the ranges are looked at.
    return outline.add_zone(name, {std::max(2, int(n)), 2, 2});
  };
  // The boundary of a 2-D mesh is made of lines. As the edges of strips across its plane they have planes and profiles.
  bool const flat = mesh.dimension == 2;
  Vec3 const across = flat ? mesh.size() * plane_normal(mesh) : Vec3{};
  std::vector<std::vector<Index32> const*> lists;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    Patch const& from = mesh.patches[p];
    auto const& nodes = nodes_of_patch[p];
    Patch patch{from.name, from.bc_type, from.kind, from.families, 0, {}};
    patch.zone = add_zone(mesh.zones[std::size_t(from.zone)].name, nodes.size());
    outline.zones.back().single_precision = mesh.zones[std::size_t(from.zone)].single_precision;
    patch.range = {{0, 0, 0}, {int(nodes.size()), flat ? 2 : 1, 1}};
    outline.patches.push_back(std::move(patch));
    lists.push_back(&nodes);
  }
  int const first = int(outline.zones.size());
  for (std::size_t c = 0; c < mesh.connections.size(); ++c) {
    Connection const& from = mesh.connections[c];
    Interface1to1 interface;
    interface.name = from.name;
    interface.families = from.families;
    interface.periodic = from.periodic;
    interface.zone = add_zone(mesh.zones[std::size_t(from.zone)].name, from.nodes.size());
    interface.donor_zone = first + int(from.periodic ? partner_of(mesh, c) : c);
    interface.range = {{0, 0, 0}, {int(from.nodes.size()), 1, 1}};
    outline.interfaces.push_back(std::move(interface));
    lists.push_back(&from.nodes);
  }
  outline.coordinates = Coordinates(outline.n_nodes());
  for (std::size_t z = 0; z < lists.size(); ++z) {
    auto const& nodes = *lists[z];
    for (Index n = 0; n < outline.zones[z].size(); ++n) {
      if (nodes.empty()) continue;
      Index3 const at = outline.zones[z].index(outline.zones[z].first_node + n);
      Vec3 const x = mesh.coordinates[nodes[std::min(std::size_t(at[0]), nodes.size() - 1)]];
      outline.coordinates.set(outline.zones[z].first_node + n, x + double(at[1]) * across);
    }
  }
  return outline;
}

PatchFaces patch_faces(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                       std::vector<std::vector<Index32>> const& nodes_of_patch,
                       std::vector<std::uint8_t> const& wanted) {
  PatchFaces out;
  out.lines = mesh.dimension == 2;
  out.of_patch.resize(mesh.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (wanted[p] == 0) continue;
    auto& listed = out.of_patch[p].listed;
    listed.resize(nodes_of_patch[p].size());
    std::iota(listed.begin(), listed.end(), 0);
    std::sort(listed.begin(), listed.end(), [&](int a, int b) {
      return node_number_in_file(mesh, nodes_of_patch[p][std::size_t(a)]) <
             node_number_in_file(mesh, nodes_of_patch[p][std::size_t(b)]);
    });
  }
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    int const p = face_patches.patch[std::size_t(f)];
    if (p < 0 || wanted[std::size_t(p)] == 0) continue;
    auto const face = topology.boundary.nodes[f];
    auto const& nodes = nodes_of_patch[std::size_t(p)];
    std::vector<int> place;
    Vec3 middle, normal, centre;
    for (Index32 const n : face) {
      place.push_back(int(std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin()));
      middle += (1 / double(face.size())) * mesh.coordinates[n];
    }
    auto& corners = out.of_patch[std::size_t(p)].corners;
    if (place.size() == 2) {
      corners.push_back({place[0], place[1], -1, -1});
      continue;
    }
    for (std::size_t k = 0; k < face.size(); ++k)
      normal += cross(mesh.coordinates[face[k]] - middle, mesh.coordinates[face[(k + 1) % face.size()]] - middle);
    auto const element = mesh.elements.corners(topology.boundary.element[std::size_t(f)]);
    for (Index32 const n : element) centre += (1 / double(element.size())) * mesh.coordinates[n];
    // Elements may be numbered either way around; the normal is to point into them.
    if (dot(normal, centre - middle) < 0) std::reverse(place.begin(), place.end());
    if (place.size() <= 4) {
      corners.push_back({place[0], place[1], place[2], place.size() == 4 ? place[3] : -1});
    } else {
      for (std::size_t k = 1; k + 1 < place.size(); ++k) corners.push_back({place[0], place[k], place[k + 1], -1});
    }
  }
  return out;
}

}  // namespace gridmorph
