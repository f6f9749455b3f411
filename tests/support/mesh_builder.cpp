// The parts of mesh_builders.hpp that put zones, patches and interfaces together.
#include "support/mesh_builders.hpp"

#include <stdexcept>
#include <utility>

namespace gridmorph::test {

IndexRange face_of(IndexRange const& box, int axis, int side) {
  IndexRange r = box;
  (side == 0 ? r.end[axis] : r.begin[axis]) = side == 0 ? box.begin[axis] + 1 : box.end[axis] - 1;
  return r;
}

int face_axis(IndexRange const& range) {
  for (int a = 0; a < 3; ++a)
    if (range.extent(a) == 1) return a;
  throw std::logic_error("not a face: " + to_string(range));
}

int MeshBuilder::zone(std::string name, Index3 extent, std::function<Vec3(Index3 const&)> position) {
  position_.push_back(std::move(position));
  return mesh_.add_zone(std::move(name), extent);
}

void MeshBuilder::patch(std::string const& family, PatchKind kind, int zone, IndexRange const& range) {
  std::string const name = family + "_" + std::to_string(mesh_.patches.size() + 1);
  mesh_.patches.push_back({name, kind == PatchKind::symmetry ? "BCSymmetryPlane" : "", kind, {family}, zone, range});
}

void MeshBuilder::patch(std::string const& family, PatchKind kind, int zone, int axis, int side) {
  patch(family, kind, zone, face_of(whole(mesh_.zones[zone]), axis, side));
}

void MeshBuilder::join(int zone, IndexRange const& range, int donor_zone, IndexRange const& donor_range,
                       Orientation across, std::optional<Periodic> const& periodic) {
  int const axis = face_axis(range), donor_axis = across.axis[axis];
  int const side = range.begin[axis] == 0 ? 0 : 1, donor_side = donor_range.begin[donor_axis] == 0 ? 0 : 1;
  across.sign[axis] = side != donor_side ? 1 : -1;
  Interface1to1 face;
  face.name = "join_" + std::to_string(mesh_.interfaces.size() + 1);
  if (periodic) face.families = {"periodic"};
  face.zone = zone;
  face.donor_zone = donor_zone;
  face.range = range;
  face.periodic = periodic;
  face.to_donor.orientation = across;
  face.to_donor.own_origin = range.begin;
  for (int a = 0; a < 3; ++a) {
    int const d = across.axis[a];
    face.to_donor.donor_origin[d] = across.sign[a] > 0 || a == axis ? donor_range.begin[d] : donor_range.end[d] - 1;
  }
  mesh_.interfaces.push_back(std::move(face));
}

Mesh MeshBuilder::finish() {
  mesh_.coordinates = Coordinates(mesh_.n_nodes());
  for (std::size_t z = 0; z < mesh_.zones.size(); ++z) {
    Zone const& zone = mesh_.zones[z];
    for (Index n = 0; n < zone.size(); ++n)
      mesh_.coordinates.set(zone.first_node + n, position_[z](zone.index(zone.first_node + n)));
  }
  return std::move(mesh_);
}

Periodic rotation(Vec3 const& center, Vec3 const& unit_axis, double angle_rad) {
  return {center, angle_rad * unit_axis, {}, rotation_about(center, unit_axis, angle_rad)};
}

namespace {

/// Common nodes of two boxes; nothing unless they share a face part, at least one cell wide both ways.
std::optional<IndexRange> common_face(IndexRange const& a, IndexRange const& b) {
  IndexRange r;
  int flat = 0;
  for (int d = 0; d < 3; ++d) {
    r.begin[d] = std::max(a.begin[d], b.begin[d]);
    r.end[d] = std::min(a.end[d], b.end[d]);
    if (r.extent(d) < 1) return std::nullopt;
    flat += r.extent(d) == 1;
  }
  return flat == 1 ? std::optional(r) : std::nullopt;
}

IndexRange shifted(IndexRange r, Index3 const& by) {
  for (int d = 0; d < 3; ++d) {
    r.begin[d] += by[d];
    r.end[d] += by[d];
  }
  return r;
}

IndexRange relative(IndexRange const& r, IndexRange const& box) {
  return shifted(r, {-box.begin[0], -box.begin[1], -box.begin[2]});
}

}  // namespace

Mesh make(Bricks const& bricks) {
  MeshBuilder b(bricks.name);
  std::vector<IndexRange> zones = bricks.zones;
  if (zones.empty()) zones.push_back({{0, 0, 0}, bricks.extent});
  for (std::size_t z = 0; z < zones.size(); ++z) {
    IndexRange const& box = zones[z];
    b.zone(bricks.name + std::to_string(z + 1), {box.extent(0), box.extent(1), box.extent(2)},
           [&bricks, box](Index3 const& p) {
             double q[3];
             for (int a = 0; a < 3; ++a) q[a] = double(box.begin[a] + p[a]) / (bricks.extent[a] - 1);
             return bricks.position({q[0], q[1], q[2]});
           });
  }
  for (int z = 0; z < int(zones.size()); ++z)
    for (int axis = 0; axis < 3; ++axis) {
      IndexRange const upper = face_of(zones[z], axis, 1);
      bool const outer = upper.end[axis] == bricks.extent[axis];
      Index3 turn{0, 0, 0};
      if (outer) turn[axis] = 1 - bricks.extent[axis];
      for (int d = 0; d < int(zones.size()) && !(outer && bricks.ends[axis].kind == Ends::Kind::none); ++d) {
        auto const common = common_face(shifted(upper, turn), face_of(zones[d], axis, 0));
        if (!common) continue;
        Index3 const back{-turn[0], -turn[1], -turn[2]};
        b.join(z, relative(shifted(*common, back), zones[z]), d, relative(*common, zones[d]), {},
               outer && bricks.ends[axis].kind == Ends::Kind::periodic ? std::optional(bricks.ends[axis].periodic)
                                                                       : std::nullopt);
      }
      for (int side = 0; side < 2; ++side) {
        IndexRange const face = face_of(zones[z], axis, side);
        bool const at_limit = face.begin[axis] == (side == 0 ? 0 : bricks.extent[axis] - 1);
        int const number = 2 * axis + side;
        if (at_limit) {
          if (bricks.ends[axis].kind == Ends::Kind::none)
            b.patch(bricks.family[number], bricks.kind[number], z, axis, side);
          continue;
        }
        bool open = true;
        for (auto const& other : zones) open = open && !common_face(face, face_of(other, axis, 1 - side));
        if (open) b.patch("step", PatchKind::wall, z, axis, side);
      }
    }
  return b.finish();
}

}  // namespace gridmorph::test
