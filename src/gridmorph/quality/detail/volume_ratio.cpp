#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>

#include <optional>
#include <string>

namespace gridmorph::detail {

std::optional<FaceOfRange> face_of(Zone const& zone, IndexRange const& range) {
  std::optional<FaceOfRange> face;
  for (int a = 0; a < 3; ++a) {
    if (range.extent(a) != 1) continue;
    if (face) return std::nullopt;
    if (range.begin[a] == 0)
      face = FaceOfRange{a, 0};
    else if (range.begin[a] == zone.extent[a] - 1)
      face = FaceOfRange{a, 1};
    else
      return std::nullopt;
  }
  return face;
}

namespace {

void check_inside(Mesh const& mesh, Interface1to1 const& interface, int zone, IndexRange const& range) {
  bool inside = zone >= 0 && zone < int(mesh.zones.size());
  for (int a = 0; a < 3 && inside; ++a)
    inside = range.begin[a] >= 0 && range.end[a] <= mesh.zones[zone].extent[a] && range.extent(a) > 0;
  if (inside) return;
  std::string const name = zone >= 0 && zone < int(mesh.zones.size()) ? "zone '" + mesh.zones[zone].name + "'"
                                                                      : "zone number " + std::to_string(zone);
  throw MeshError("interface '" + interface.name + "': its range " + to_string(range) + " does not lie in " + name +
                  "; correct the connection in the mesh file");
}

/// Anything but a signed permutation of the axes would lead outside the donor zone.
void check_orientation(Interface1to1 const& interface) {
  auto const& o = interface.to_donor.orientation;
  int axes = 0;
  bool valid = true;
  for (int a = 0; a < 3; ++a) {
    valid = valid && o.axis[a] >= 0 && o.axis[a] < 3 && (o.sign[a] == 1 || o.sign[a] == -1);
    if (valid) axes |= 1 << o.axis[a];
  }
  if (!valid || axes != 7)
    throw MeshError("interface '" + interface.name +
                    "': its transform is no signed permutation of the three index axes; correct it in the mesh file");
}

std::optional<InterfaceCells> cells_behind(Mesh const& mesh, std::vector<Index> const& first_cell, int zone,
                                           IndexRange const& range, int donor_zone, IndexMap const& to_donor) {
  Zone const& own = mesh.zones[zone];
  Zone const& donor = mesh.zones[donor_zone];
  auto const face = face_of(own, range);
  auto const donor_face = face_of(donor, to_donor(range));
  if (!face || !donor_face) return std::nullopt;

  Index const donor_cells[3] = {donor.extent[0] - 1, donor.extent[1] - 1, donor.extent[2] - 1};
  Index const donor_stride[3] = {1, donor_cells[0], donor_cells[0] * donor_cells[1]};
  InterfaceCells c;
  c.axis = face->axis;
  c.side = face->side;
  c.donor_offset = first_cell[donor_zone];
  if (donor_face->side == 1) c.donor_offset += (donor_cells[donor_face->axis] - 1) * donor_stride[donor_face->axis];
  for (int a = 0; a < 3; ++a) {
    if (a == face->axis) {
      c.begin[a] = face->side == 0 ? 0 : own.extent[a] - 2;
      c.end[a] = c.begin[a] + 1;
      continue;
    }
    c.begin[a] = range.begin[a];
    c.end[a] = range.end[a] - 1;
    int const d = to_donor.orientation.axis[a], sign = to_donor.orientation.sign[a];
    // A cell lies between two nodes; where the index runs backwards, the higher own node is the lower donor node.
    Index const at_zero = to_donor.donor_origin[d] - Index(sign) * to_donor.own_origin[a] - (sign < 0 ? 1 : 0);
    c.donor_stride[a] = sign * donor_stride[d];
    c.donor_offset += at_zero * donor_stride[d];
  }
  return c;
}

}  // namespace

InterfaceTable interface_table(Mesh const& mesh) {
  std::vector<Index> const first_cell = first_cells(mesh);
  std::vector<std::vector<InterfaceCells>> per_zone(mesh.zones.size());
  for (Interface1to1 const& f : mesh.interfaces) {
    check_orientation(f);
    check_inside(mesh, f, f.zone, f.range);
    IndexRange const donor_range = f.to_donor(f.range);
    check_inside(mesh, f, f.donor_zone, donor_range);
    if (auto const c = cells_behind(mesh, first_cell, f.zone, f.range, f.donor_zone, f.to_donor))
      per_zone[f.zone].push_back(*c);
    if (auto const c = cells_behind(mesh, first_cell, f.donor_zone, donor_range, f.zone, f.to_donor.inverse()))
      per_zone[f.donor_zone].push_back(*c);
  }
  InterfaceTable table;
  for (auto const& list : per_zone) {
    table.first.push_back(int(table.cells.size()));
    table.cells.insert(table.cells.end(), list.begin(), list.end());
  }
  table.first.push_back(int(table.cells.size()));
  return table;
}

}  // namespace gridmorph::detail
