#include <gridmorph/quality/detail/line_ratios.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>

#include <optional>
#include <utility>

namespace gridmorph::detail {

namespace {

std::optional<LinkedFace> linked_face(Mesh const& mesh, int zone, IndexRange const& range, int donor_zone,
                                      IndexMap const& to_donor) {
  Zone const& own = mesh.zones[zone];
  Zone const& donor = mesh.zones[donor_zone];
  auto const face = face_of(own, range);
  auto const donor_face = face_of(donor, to_donor(range));
  if (!face || !donor_face) return std::nullopt;
  LinkedFace out;
  out.axis = face->axis;
  out.side = face->side;
  out.donor_first_node = donor.first_node;
  auto const strides = donor.strides();
  for (int a = 0; a < 3; ++a) {
    bool const across = a == face->axis;
    out.begin[a] = !across ? range.begin[a] : face->side == 0 ? 0 : own.extent[a] - 2;
    out.end[a] = across ? out.begin[a] + 1 : range.end[a] - 1;
    out.donor_stride[a] = strides[a];
    out.to_axis[a] = to_donor.orientation.axis[a];
    out.to_sign[a] = to_donor.orientation.sign[a];
    out.own_origin[a] = to_donor.own_origin[a];
    out.donor_origin[a] = to_donor.donor_origin[a];
  }
  out.into_donor = donor_face->side == 0 ? 0 : -1;
  return out;
}

}  // namespace

LinkedFaceTable linked_face_table(Mesh const& mesh) {
  std::vector<std::vector<LinkedFace>> of_zone(mesh.zones.size());
  for (Interface1to1 const& f : mesh.interfaces) {
    if (auto const face = linked_face(mesh, f.zone, f.range, f.donor_zone, f.to_donor))
      of_zone[f.zone].push_back(*face);
    if (auto const face = linked_face(mesh, f.donor_zone, f.to_donor(f.range), f.zone, f.to_donor.inverse()))
      of_zone[f.donor_zone].push_back(*face);
  }
  LinkedFaceTable out;
  for (auto const& list : of_zone) {
    out.first.push_back(int(out.faces.size()));
    out.faces.insert(out.faces.end(), list.begin(), list.end());
  }
  out.first.push_back(int(out.faces.size()));
  return out;
}

}  // namespace gridmorph::detail
