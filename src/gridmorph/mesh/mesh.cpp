#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/core/large_pages.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gridmorph {

std::string to_string(IndexRange const& range) {
  std::string text = "[";
  for (int a = 0; a < 3; ++a) {
    if (a > 0) text += ", ";
    text += std::to_string(range.begin[a] + 1) + ":" + std::to_string(range.end[a]);
  }
  return text + "]";
}

Periodic periodic_rotation(Vec3 const& center, Vec3 const& direction, double angle_rad) {
  Periodic out;
  out.rotation_center = center;
  out.declared = rotation_about(center, direction, angle_rad);
  Vec3 const unit = (1 / norm(direction)) * direction;
  if (std::max({std::fabs(unit.x), std::fabs(unit.y), std::fabs(unit.z)}) == 1) {
    out.rotation_angle_rad = angle_rad * unit;
  } else {
    auto const& m = out.declared.rotation.m;
    out.rotation_angle_rad = {std::atan2(m[2][1], m[2][2]), std::asin(std::clamp(-m[2][0], -1.0, 1.0)),
                              std::atan2(m[1][0], m[0][0])};
  }
  return out;
}

Periodic periodic_translation(Vec3 const& translation) {
  Periodic out;
  out.translation = translation;
  out.declared.translation = translation;
  return out;
}

std::string_view to_string(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall: return "wall";
    case PatchKind::inflow: return "inflow";
    case PatchKind::outflow: return "outflow";
    case PatchKind::symmetry: return "symmetry";
    case PatchKind::farfield: return "farfield";
    case PatchKind::degenerate: return "degenerate";
    case PatchKind::connection: return "connection";
    case PatchKind::other: return "other";
    case PatchKind::periodic: return "periodic";
    case PatchKind::region: return "region";
  }
  return "other";
}

Coordinates::Coordinates(Index n_nodes) {
  require_kokkos("gridmorph::Coordinates");
  auto const allocate = [&](char const* label) {
    return View(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), n_nodes);
  };
  x = allocate("gridmorph::Coordinates::x");
  y = allocate("gridmorph::Coordinates::y");
  z = allocate("gridmorph::Coordinates::z");
  for (View const* component : {&x, &y, &z})
    prefer_large_pages(component->data(), std::size_t(n_nodes) * sizeof(double));
}

bool Mesh::is_structured() const {
  return n_elements() == 0 && std::all_of(zones.begin(), zones.end(), [](Zone const& z) { return z.is_block(); });
}

Index Mesh::n_cells() const {
  Index n = 0;
  for (auto const& z : zones)
    if (z.is_block()) n += Index(z.extent[0] - 1) * (z.extent[1] - 1) * (z.extent[2] - 1);
  return n;
}

int Mesh::add_zone(std::string name, Index3 extent) {
  Zone zone;
  zone.name = std::move(name);
  zone.extent = extent;
  zone.first_node = n_nodes();
  zone.first_element = n_elements();
  zones.push_back(std::move(zone));
  return int(zones.size()) - 1;
}

int Mesh::add_zone(std::string name, Index n_nodes) {
  Zone zone;
  zone.name = std::move(name);
  zone.first_node = this->n_nodes();
  zone.n_nodes = n_nodes;
  zone.first_element = n_elements();
  zones.push_back(std::move(zone));
  return int(zones.size()) - 1;
}

void Mesh::add_element(ElementType type, std::span<Index32 const> nodes) {
  elements.type.push_back(type);
  elements.nodes.add(nodes);
  zones.back().n_elements = n_elements() - zones.back().first_element;
}

int Mesh::zone_of_element(Index element) const {
  auto const after =
      std::upper_bound(zones.begin(), zones.end(), element, [](Index e, Zone const& z) { return e < z.first_element; });
  return int(after - zones.begin()) - 1;
}

int BoundaryMesh::zone_of(Index node) const {
  auto const after =
      std::upper_bound(zones.begin(), zones.end(), node, [](Index n, Zone const& z) { return n < z.first_node; });
  return int(after - zones.begin()) - 1;
}

double BoundaryMesh::size() const { return extent_of(coordinates).size(); }

std::string describe_node(BoundaryMesh const& mesh, Index node) {
  int const z = mesh.zone_of(node);
  if (!mesh.zones[z].is_block())
    return "zone '" + mesh.zones[z].name + "' node " + std::to_string(node_number_in_file(mesh, node));
  Index3 const p = mesh.zones[z].index(node);
  return "zone '" + mesh.zones[z].name + "' node (i " + std::to_string(p[0] + 1) + ", j " + std::to_string(p[1] + 1) +
         ", k " + std::to_string(p[2] + 1) + ")";
}

std::string_view face_name(int axis, int side) {
  static constexpr std::array<std::string_view, 6> names{"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"};
  return names[2 * axis + side];
}

std::string describe_range(BoundaryMesh const& mesh, int zone, IndexRange const& range) {
  Zone const& z = mesh.zones[zone];
  std::string text = "zone '" + z.name + "' ";
  for (int a = 0; a < 3; ++a)
    if (range.extent(a) == 1 && (range.begin[a] == 0 || range.begin[a] == z.extent[a] - 1)) {
      text += std::string(face_name(a, range.begin[a] == 0 ? 0 : 1)) + " ";
      break;
    }
  return text + to_string(range);
}

std::string describe_patch(BoundaryMesh const& mesh, Patch const& patch) {
  if (patch.kind == PatchKind::region)
    return "'" + patch.name + "' (region, zone '" + mesh.zones[patch.zone].name + "')";
  std::string text = "'" + (patch.families.empty() ? patch.name : patch.families.front()) + "'";
  return text + " (BC '" + patch.name + "', zone '" + mesh.zones[patch.zone].name + "')";
}

}  // namespace gridmorph
