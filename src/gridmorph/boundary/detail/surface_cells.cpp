#include <gridmorph/boundary/detail/match_cells.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::topology {

namespace {

/// Units in the last place that coordinates of one point may differ by when they were computed in different ways.
constexpr double round_off_steps = 8;

}  // namespace

SurfaceCells::SurfaceCells(Mesh const& mesh) : mesh_(&mesh), precision_(coordinate_precisions(mesh)) {
  Index count = 0;
  for (int z = 0; z < int(mesh.zones.size()); ++z)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        ZoneFace f{z, axis, side, axis == 0 ? 1 : 0, axis == 2 ? 1 : 2, count, 0, 0};
        f.nu = mesh.zones[z].extent[f.u] - 1;
        f.nv = mesh.zones[z].extent[f.v] - 1;
        f.thick = mesh.zones[z].extent[axis] > 2;
        count += Index(f.nu) * f.nv;
        faces_.push_back(f);
      }
  for (auto const& zone : mesh.zones)
    one_layer_ = one_layer_ && std::find(zone.extent.begin(), zone.extent.end(), 2) != zone.extent.end();
  open_.assign(count, 1);
  for (auto const& patch : mesh.patches) claim(patch.zone, patch.range);
  for (auto const& interface : mesh.interfaces) {
    claim(interface.zone, interface.range);
    claim(interface.donor_zone, interface.to_donor(interface.range));
  }
}

/// Ranges that are on no face are for others to report.
void SurfaceCells::claim(int zone, IndexRange const& range) {
  if (zone < 0 || zone >= int(mesh_->zones.size())) return;
  for (int f = 6 * zone; f < 6 * zone + 6; ++f) {
    auto const& face = faces_[f];
    int const plane = face.side == 0 ? 0 : mesh_->zones[zone].extent[face.axis] - 1;
    if (range.extent(face.axis) != 1 || range.begin[face.axis] != plane) continue;
    for (int b = std::max(range.begin[face.v], 0); b < std::min(range.end[face.v] - 1, face.nv); ++b)
      for (int a = std::max(range.begin[face.u], 0); a < std::min(range.end[face.u] - 1, face.nu); ++a)
        open_[face.first + a + Index(face.nu) * b] = 0;
  }
}

int SurfaceCells::face_of(Index cell) const {
  auto const after =
      std::upper_bound(faces_.begin(), faces_.end(), cell, [](Index c, ZoneFace const& f) { return c < f.first; });
  return int(after - faces_.begin()) - 1;
}

Index3 SurfaceCells::node_index(ZoneFace const& face, int p, int q) const {
  Index3 at{};
  at[face.axis] = face.side == 0 ? 0 : mesh_->zones[face.zone].extent[face.axis] - 1;
  at[face.u] = p;
  at[face.v] = q;
  return at;
}

Index SurfaceCells::node(ZoneFace const& face, int p, int q) const {
  return mesh_->zones[face.zone].node(node_index(face, p, q));
}

CellShape SurfaceCells::shape(Index cell) const {
  ZoneFace const& face = faces_[face_of(cell)];
  Zone const& zone = mesh_->zones[face.zone];
  int const a = int((cell - face.first) % face.nu), b = int((cell - face.first) / face.nu);
  Index const step = (face.side == 0 ? 1 : -1) * zone.strides()[face.axis];
  CellShape out;
  double largest = 0;
  for (int c = 0; c < 4; ++c) {
    Index const n = node(face, a + corner_offset[c][0], b + corner_offset[c][1]);
    out.corner[c] = mesh_->coordinates[n];
    out.centre += 0.25 * out.corner[c];
    out.inward += mesh_->coordinates[n + step] - out.corner[c];
    largest = std::max({largest, std::fabs(out.corner[c].x), std::fabs(out.corner[c].y), std::fabs(out.corner[c].z)});
  }
  out.noise = round_off_steps * precision_[face.zone].at(largest);
  std::array<double, 4> length{};
  for (int c = 0; c < 4; ++c) length[c] = distance(out.corner[c], out.corner[(c + 1) % 4]);
  auto const zero = [&](int c) { return length[c] <= out.noise; };
  if ((zero(0) && zero(2)) || (zero(1) && zero(3))) return out;
  out.edge = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 4; ++c)
    if (!zero(c)) out.edge = std::min(out.edge, length[c]);
  return out;
}

}  // namespace gridmorph::topology
