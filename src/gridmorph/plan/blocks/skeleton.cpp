#include <gridmorph/plan/blocks/chain_tables.hpp>

#include <algorithm>

namespace gridmorph {

bool same_rotation(Mat3 const& a, Mat3 const& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a.m[i][j] != b.m[i][j]) return false;
  return true;
}

std::int32_t RotationTable::number(Mat3 const& m) {
  auto const it =
      std::find_if(table_.begin(), table_.end(), [&](Mat3 const& other) { return same_rotation(other, m); });
  if (it != table_.end()) return std::int32_t(it - table_.begin());
  table_.push_back(m);
  return std::int32_t(table_.size()) - 1;
}

Mat3 onto(Vec3 const& a) {
  return {{{a.x * a.x, a.x * a.y, a.x * a.z}, {a.y * a.x, a.y * a.y, a.y * a.z}, {a.z * a.x, a.z * a.y, a.z * a.z}}};
}

int n_layers(IndexRange const& nodes) {
  int directions = 0, layers = 1;
  for (int a = 0; a < 3; ++a)
    if (nodes.extent(a) > 1 && ++directions == 3) layers = nodes.extent(a);
  return layers;
}

Skeleton::Skeleton(Mesh const& mesh, Lattice const& lattice, Blocks const& blocks)
    : mesh_(mesh), lattice_(lattice), first_slot_(lattice.n_classes(), -1) {
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const owner = lattice.copies(c).front().entity;
    if (lattice.dimension(owner) == 3 && blocks.region_of(lattice.piece_of_volume(owner)) < 0) continue;
    first_slot_[c] = n_slots_;
    n_slots_ += lattice.nodes(owner).size();
  }
}

std::optional<SkeletonRows> Skeleton::rows(int entity, int layer) const {
  int const c = lattice_.class_of(entity);
  IndexRange const own = lattice_.nodes(lattice_.copies(c).front().entity);
  if (own.size() == 0) return std::nullopt;
  IndexMap const& map = lattice_.copy_of(entity).from_owner;
  SkeletonRows rows;
  rows.slot = first_slot_[c];
  rows.at = map(own.begin);
  int used = 0;
  for (int a = 0; a < 3; ++a) {
    if (own.extent(a) == 1) continue;
    Index3 step{0, 0, 0};
    step[a] = 1;
    if (used == 2) {
      step = map.orientation.apply(step);
      for (int d = 0; d < 3; ++d) rows.at[d] += layer * step[d];
      break;
    }
    (used == 0 ? rows.n_p : rows.n_q) = own.extent(a);
    (used == 0 ? rows.step_p : rows.step_q) = map.orientation.apply(step);
    ++used;
  }
  rows.slot_q = rows.n_p;
  rows.slot += Index(layer) * rows.n_p * rows.n_q;
  return rows;
}

std::vector<kernels::NodeCopy> Skeleton::to_nodes(RotationTable& rotations) const {
  std::vector<kernels::NodeCopy> out;
  for (int c = 0; c < lattice_.n_classes(); ++c) {
    if (first_slot_[c] < 0) continue;
    bool const on_axis = lattice_.axis_of(c).has_value();  // rotations leave it alone
    for (EntityCopy const& copy : lattice_.copies(c)) {
      Zone const& zone = mesh_.zones[lattice_.zone_of(copy.entity)];
      auto const stride = zone.strides();
      auto along = [&](Index3 const& step) { return step[0] * stride[0] + step[1] * stride[1] + step[2] * stride[2]; };
      int const layers = n_layers(lattice_.nodes(lattice_.copies(c).front().entity));
      for (int layer = 0; layer < layers; ++layer) {
        auto const rows = this->rows(copy.entity, layer);
        if (!rows) continue;
        out.push_back({rows->slot, 1, rows->slot_q, zone.node(rows->at), along(rows->step_p), along(rows->step_q),
                       rows->n_p, rows->n_q, copy.moved && !on_axis ? rotations.number(copy.transform.rotation) : -1});
      }
    }
  }
  return out;
}

}  // namespace gridmorph
