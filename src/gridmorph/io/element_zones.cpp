#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/new_names.hpp>
#include <gridmorph/io/element_zones.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>

namespace gridmorph::io {

namespace {

constexpr std::int32_t mixed = 20, ngon = 22, nface = 23;

/// ElementType_t of a list of nodes; 0 for those that this writer does not know.
std::int32_t cgns_type(ElementType type, std::size_t nodes) {
  switch (type) {
    case ElementType::triangle: return nodes == 3 ? 5 : nodes == 6 ? 6 : 0;
    case ElementType::quadrilateral: return nodes == 4 ? 7 : nodes == 8 ? 8 : nodes == 9 ? 9 : 0;
    case ElementType::tetrahedron: return nodes == 4 ? 10 : nodes == 10 ? 11 : 0;
    case ElementType::pyramid: return nodes == 5 ? 12 : nodes == 13 ? 21 : nodes == 14 ? 13 : 0;
    case ElementType::prism: return nodes == 6 ? 14 : nodes == 15 ? 15 : nodes == 18 ? 16 : 0;
    case ElementType::hexahedron: return nodes == 8 ? 17 : nodes == 20 ? 18 : nodes == 27 ? 19 : 0;
    case ElementType::polyhedron: return 0;
  }
  return 0;
}

std::int32_t face_type(std::size_t corners) { return corners == 2 ? 3 : corners == 3 ? 5 : corners == 4 ? 7 : 0; }

bool has_polyhedra(Mesh const& mesh, Zone const& zone) {
  auto const& of = mesh.polyhedra.element;
  auto const first = std::lower_bound(of.begin(), of.end(), Index32(zone.first_element));
  return first != of.end() && *first < zone.first_element + zone.n_elements;
}

/// The number of numbers that are in a zone's sections by faces, at most: of each side its nodes, an offset and the
/// number that its element has of it.
std::uint64_t numbers_by_faces(Mesh const& mesh, Zone const& zone) {
  std::uint64_t out = 0;
  std::array<Index32, max_face_corners> room{};
  for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) out += side_nodes(mesh, e, s, room).size() + 2;
  return out;
}

/// Numbers in a zone, from 1 on, of the mesh's nodes.
std::vector<std::int32_t> numbers_of(std::vector<Index32> const& nodes, Zone const& zone) {
  std::vector<std::int32_t> out;
  out.reserve(nodes.size());
  for (Index32 const n : nodes) out.push_back(std::int32_t(n - zone.first_node + 1));
  return out;
}

std::vector<std::int32_t> offsets_of(CsrGraph const& lists) { return {lists.first.begin(), lists.first.end()}; }

std::pair<std::string, std::string> split(std::string const& zone_name) {
  auto const slash = zone_name.find('/');
  if (slash == std::string::npos) return {"Base", zone_name};
  return {zone_name.substr(0, slash), zone_name.substr(slash + 1)};
}

}  // namespace

ElementZoneWriter::ElementZoneWriter(cgns::File& file, Mesh const& mesh, WriteOptions const& options)
    : file_(file), mesh_(mesh), options_(options) {}

void ElementZoneWriter::begin() {
  file_.create(file_.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", {1}, &cgns::library_version);
}

double ElementZoneWriter::base(std::string const& name) {
  if (auto const known = bases_.find(name); known != bases_.end()) return known->second;
  std::array<std::int32_t, 2> const dimensions{mesh_.dimension, 3};
  double const id = file_.create(file_.root(), name, "CGNSBase_t", "I4", {2}, dimensions.data());
  bases_.emplace(name, id);
  std::set<std::string> families(mesh_.families.begin(), mesh_.families.end());
  for (auto const& patch : mesh_.patches) families.insert(patch.families.begin(), patch.families.end());
  for (auto const& family : families)
    if (family.find('/') == std::string::npos) file_.create(id, family, "Family_t");
  return id;
}

void ElementZoneWriter::zone(int z, std::array<double const*, 3> const& values) {
  auto const& zone = mesh_.zones[z];
  auto const [base_name, zone_name] = split(zone.name);
  std::array<std::int32_t, 3> const sizes{std::int32_t(zone.size()), std::int32_t(zone.n_elements), 0};
  double const id = file_.create(base(base_name), zone_name, "Zone_t", "I4", {1, 3}, sizes.data());
  file_.create_text(id, "ZoneType", "ZoneType_t", "Unstructured");
  coordinates(zone, id, values);
  std::set<std::string> sections{"ZoneType", "GridCoordinates", "ZoneBC", "ZoneGridConnectivity"};
  ZoneFaces const* const faces = has_polyhedra(mesh_, zone) ? &faces_of(zone) : nullptr;
  Index const next = faces ? elements(zone, *faces, id, sections) : elements(zone, id, sections);
  boundary(z, faces, id, next, sections);
  connections(z, id);
}

ZoneFaces const& ElementZoneWriter::faces_of(Zone const& zone) {
  auto const known = faces_.find(zone.first_element);
  return (known != faces_.end() ? known : faces_.emplace(zone.first_element, ZoneFaces(mesh_, zone)).first)->second;
}

void ElementZoneWriter::coordinates(Zone const& zone, double zone_id, std::array<double const*, 3> const& values) {
  double const grid = file_.create(zone_id, "GridCoordinates", "GridCoordinates_t");
  static constexpr std::array names{"CoordinateX", "CoordinateY", "CoordinateZ"};
  for (std::size_t c = 0; c < 3; ++c) {
    double const* source = values[c];
    if (zone.single_precision) {
      std::vector<float> const rounded(source, source + zone.size());
      file_.create(grid, names[c], "DataArray_t", "R4", {zone.size()}, rounded.data());
    } else {
      file_.create(grid, names[c], "DataArray_t", "R8", {zone.size()}, source);
    }
  }
}

double ElementZoneWriter::elements_node(double zone_id, std::string const& name, std::int32_t type, Index first,
                                        Index size) {
  std::array<std::int32_t, 2> const value{type, 0};
  double const id = file_.create(zone_id, name, "Elements_t", "I4", {2}, value.data());
  std::array<std::int32_t, 2> const range{std::int32_t(first), std::int32_t(first + size - 1)};
  file_.create(id, "ElementRange", "IndexRange_t", "I4", {2}, range.data());
  return id;
}

void ElementZoneWriter::section(double zone_id, std::string const& name, Index first,
                                std::vector<std::int32_t> const& types, std::vector<Index> const& start,
                                std::vector<std::int32_t> const& nodes) {
  bool const uniform = std::all_of(types.begin(), types.end(), [&](std::int32_t t) { return t == types.front(); });
  double const id = elements_node(zone_id, name, uniform ? types.front() : mixed, first, Index(types.size()));
  if (uniform) {
    file_.create(id, "ElementConnectivity", "DataArray_t", "I4", {Index(nodes.size())}, nodes.data());
    return;
  }
  std::vector<std::int32_t> list, offsets{0};
  for (std::size_t e = 0; e < types.size(); ++e) {
    list.push_back(types[e]);
    list.insert(list.end(), nodes.begin() + start[e], nodes.begin() + start[e + 1]);
    offsets.push_back(std::int32_t(list.size()));
  }
  file_.create(id, "ElementStartOffset", "DataArray_t", "I4", {Index(offsets.size())}, offsets.data());
  file_.create(id, "ElementConnectivity", "DataArray_t", "I4", {Index(list.size())}, list.data());
}

Index ElementZoneWriter::elements(Zone const& zone, double zone_id, std::set<std::string>& taken) {
  std::vector<std::int32_t> types, nodes;
  std::vector<Index> start{0};
  for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
    auto const list = mesh_.elements.nodes[e];
    types.push_back(cgns_type(mesh_.elements.type[e], list.size()));
    if (types.back() == 0)
      throw IoError(mesh_.source + ": " + describe_element(mesh_, e) + " of " + std::to_string(list.size()) +
                    " nodes cannot be written");
    for (Index32 const n : list) nodes.push_back(std::int32_t(n - zone.first_node + 1));
    start.push_back(Index(nodes.size()));
  }
  if (!types.empty()) section(zone_id, cgns::unique_name(taken, "Elements"), 1, types, start, nodes);
  return zone.n_elements + 1;
}

Index ElementZoneWriter::elements(Zone const& zone, ZoneFaces const& faces, double zone_id,
                                  std::set<std::string>& taken) {
  for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e)
    if (mesh_.elements.corners(e).size() < mesh_.elements.nodes[e].size())
      throw IoError(mesh_.source + ": " + describe_element(mesh_, e) +
                    " is of second order and in one zone with polyhedra, which are written by their faces: it cannot "
                    "be written");
  auto const write = [&](char const* name, std::int32_t type, Index first, CsrGraph const& lists,
                         std::vector<std::int32_t> const& items) {
    double const id = elements_node(zone_id, cgns::unique_name(taken, name), type, first, lists.size());
    auto const offsets = offsets_of(lists);
    file_.create(id, "ElementStartOffset", "DataArray_t", "I4", {Index(offsets.size())}, offsets.data());
    file_.create(id, "ElementConnectivity", "DataArray_t", "I4", {Index(items.size())}, items.data());
  };
  Index const n_faces = faces.faces().size();
  write("Faces", ngon, 1, faces.faces(), numbers_of(faces.faces().item, zone));
  write("Elements", nface, n_faces + 1, faces.elements(), faces.elements().item);
  return n_faces + zone.n_elements + 1;
}

void ElementZoneWriter::listed_faces(Patch const& patch, ZoneFaces const& faces, double bc_id) {
  std::vector<std::int32_t> list;
  for (Index f = 0; f < patch.faces.size(); ++f) {
    Index const face = faces.find(patch.faces[f]);
    if (face < 0)
      throw IoError(mesh_.source + ": patch " + describe_patch(mesh_, patch) + " has a face at node " +
                    describe_node(mesh_, patch.faces[f][0]) + " that is none of an element, which cannot be written");
    list.push_back(std::int32_t(face + 1));
  }
  file_.create_text(bc_id, "GridLocation", "GridLocation_t", "FaceCenter");
  file_.create(bc_id, "PointList", "IndexArray_t", "I4", {1, Index(list.size())}, list.data());
}

void ElementZoneWriter::family_names(double parent, std::vector<std::string> const& families) {
  for (std::size_t f = 0; f < families.size(); ++f)
    if (f == 0)
      file_.create_text(parent, "FamilyName", "FamilyName_t", families[f]);
    else
      file_.create_text(parent, "AdditionalFamilyName" + std::to_string(f), "AdditionalFamilyName_t", families[f]);
}

void ElementZoneWriter::boundary(int z, ZoneFaces const* faces, double zone_id, Index next,
                                 std::set<std::string>& sections) {
  auto const& zone = mesh_.zones[z];
  double zone_bc = 0;
  std::set<std::string> taken;
  for (auto const& patch : mesh_.patches) {
    if (patch.zone != z) continue;
    if (taken.empty()) zone_bc = file_.create(zone_id, "ZoneBC", "ZoneBC_t");
    double const id = file_.create_text(zone_bc, cgns::unique_name(taken, patch.name), "BC_t", cgns::bc_type_of(patch));
    if (patch.faces.size() > 0 && faces != nullptr) {
      options_.boundary_nodes ? points(id, "PointList", patch_nodes(patch), zone) : listed_faces(patch, *faces, id);
    } else if (patch.faces.size() > 0) {
      std::vector<std::int32_t> types;
      for (Index f = 0; f < patch.faces.size(); ++f) {
        types.push_back(face_type(patch.faces[f].size()));
        if (types.back() == 0)
          throw IoError(mesh_.source + ": patch " + describe_patch(mesh_, patch) + " has faces of " +
                        std::to_string(patch.faces[f].size()) + " corners, which cannot be written");
      }
      section(zone_id, cgns::unique_name(sections, patch.name), next, types, patch.faces.first,
              numbers_of(patch.faces.item, zone));
      std::array<std::int32_t, 2> const range{std::int32_t(next), std::int32_t(next + patch.faces.size() - 1)};
      next += patch.faces.size();
      if (options_.boundary_nodes) {
        points(id, "PointList", patch_nodes(patch), zone);
      } else {
        file_.create_text(id, "GridLocation", "GridLocation_t", mesh_.dimension == 3 ? "FaceCenter" : "EdgeCenter");
        file_.create(id, "PointRange", "IndexRange_t", "I4", {1, 2}, range.data());
      }
    } else {
      points(id, "PointList", patch.nodes, zone);
    }
    family_names(id, patch.families);
  }
}

void ElementZoneWriter::points(double parent, char const* name, std::vector<Index32> const& nodes, Zone const& zone) {
  auto const list = numbers_of(nodes, zone);
  file_.create(parent, name, "IndexArray_t", "I4", {1, Index(list.size())}, list.data());
}

void ElementZoneWriter::connections(int z, double zone_id) {
  double connectivity = 0;
  std::set<std::string> taken;
  for (auto const& c : mesh_.connections) {
    if (c.zone != z) continue;
    if (taken.empty()) connectivity = file_.create(zone_id, "ZoneGridConnectivity", "ZoneGridConnectivity_t");
    auto const& donor = mesh_.zones[c.donor_zone];
    auto const [own_base, own_name] = split(mesh_.zones[z].name);
    auto const [donor_base, donor_name] = split(donor.name);
    double const id = file_.create_text(connectivity, cgns::unique_name(taken, c.name), "GridConnectivity_t",
                                        own_base == donor_base ? donor_name : donor_base + "/" + donor_name);
    file_.create_text(id, "GridConnectivityType", "GridConnectivityType_t", "Abutting1to1");
    points(id, "PointList", c.nodes, mesh_.zones[z]);
    points(id, "PointListDonor", c.donor_nodes, donor);
    family_names(id, c.families);
    if (c.periodic) periodic(id, *c.periodic);
  }
}

void ElementZoneWriter::periodic(double connection, Periodic const& p) {
  double const property = file_.create(connection, "GridConnectivityProperty", "GridConnectivityProperty_t");
  double const id = file_.create(property, "Periodic", "Periodic_t");
  auto const vector = [&](char const* name, Vec3 const& v) {
    std::array<float, 3> const values{float(v.x), float(v.y), float(v.z)};
    file_.create(id, name, "DataArray_t", "R4", {3}, values.data());
  };
  vector("RotationCenter", p.rotation_center);
  vector("RotationAngle", p.rotation_angle_rad);
  vector("Translation", p.translation);
}

std::uint64_t bytes_of_elements(Mesh const& mesh) {
  std::uint64_t nodes = 16 + 3 * mesh.families.size() + 12 * mesh.zones.size() + 12 * mesh.connections.size();
  std::uint64_t numbers = 0, values = 0;
  auto const& first = mesh.elements.nodes.first;
  for (auto const& zone : mesh.zones) {
    values += 3 * std::uint64_t(zone.size());
    numbers += 2 * std::uint64_t(zone.n_elements);
    if (has_polyhedra(mesh, zone)) numbers += numbers_by_faces(mesh, zone);
    if (zone.n_elements > 0)
      numbers += std::uint64_t(first[zone.first_element + zone.n_elements] - first[zone.first_element]);
  }
  for (auto const& patch : mesh.patches) {
    nodes += 10 + 3 * patch.families.size();
    numbers += patch.faces.item.size() + 2 * std::uint64_t(patch.faces.size()) + patch.nodes.size();
    numbers += patch.faces.item.size();  // its nodes, where they are listed too
  }
  for (auto const& c : mesh.connections) numbers += 2 * c.nodes.size();
  return cgns::File::bytes_per_node * nodes + sizeof(std::int32_t) * numbers + sizeof(double) * values;
}

}  // namespace gridmorph::io
