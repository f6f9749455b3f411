#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/blocks/lattice.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

namespace gridmorph {
namespace {

Index3 lattice_extent(ZoneCuts const& cuts) {
  return {2 * int(cuts[0].size()) - 1, 2 * int(cuts[1].size()) - 1, 2 * int(cuts[2].size()) - 1};
}

int cut_number(std::vector<int> const& cuts, int index) {
  auto const it = std::lower_bound(cuts.begin(), cuts.end(), index);
  return it != cuts.end() && *it == index ? int(it - cuts.begin()) : -1;
}

double deviation_from_identity(Mat3 const& r) {
  double d = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) d = std::max(d, std::abs(r.m[i][j] - (i == j ? 1.0 : 0.0)));
  return d;
}

Vec3 rotation_axis(Mat3 const& r) {
  Vec3 const v{r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
  if (norm(v) > 1e-6) return (1 / norm(v)) * v;
  // Half a turn: R + I = 2 a a^T, take its largest column.
  Vec3 best;
  for (int c = 0; c < 3; ++c) {
    Vec3 const column{r.m[0][c] + (c == 0), r.m[1][c] + (c == 1), r.m[2][c] + (c == 2)};
    if (norm(column) > norm(best)) best = column;
  }
  return (1 / norm(best)) * best;
}

}  // namespace

Lattice::Lattice(Mesh const& mesh, Links const& links, std::vector<ZoneCuts> cuts) : cuts_(std::move(cuts)) {
  offset_.push_back(0);
  for (ZoneCuts const& c : cuts_) {
    Index3 const n = lattice_extent(c);
    Index const next = offset_.back() + Index(n[0]) * n[1] * n[2];
    if (next > std::numeric_limits<int>::max()) throw MeshError(mesh.source + ": too many blocks after cutting");
    offset_.push_back(int(next));
  }
  piece_of_volume_.assign(n_entities(), -1);
  for (int z = 0; z < int(cuts_.size()); ++z) {
    ZoneCuts const& c = cuts_[z];
    for (int k = 0; k + 1 < int(c[2].size()); ++k)
      for (int j = 0; j + 1 < int(c[1].size()); ++j)
        for (int i = 0; i + 1 < int(c[0].size()); ++i) {
          piece_of_volume_[entity(z, {2 * i + 1, 2 * j + 1, 2 * k + 1})] = int(pieces_.size());
          pieces_.push_back(
              {z, {i, j, k}, {{c[0][i], c[1][j], c[2][k]}, {c[0][i + 1] + 1, c[1][j + 1] + 1, c[2][k + 1] + 1}}});
        }
  }
  identify(mesh, links);
}

int Lattice::zone_of(int entity) const {
  return int(std::upper_bound(offset_.begin(), offset_.end(), entity) - offset_.begin()) - 1;
}

Index3 Lattice::position(int entity) const {
  int const z = zone_of(entity);
  Index3 const n = lattice_extent(cuts_[z]);
  int const local = entity - offset_[z];
  return {local % n[0], (local / n[0]) % n[1], local / (n[0] * n[1])};
}

int Lattice::entity(int zone, Index3 const& position) const {
  Index3 const n = lattice_extent(cuts_[zone]);
  return offset_[zone] + position[0] + n[0] * (position[1] + n[1] * position[2]);
}

int Lattice::entity_of_piece(int piece, Index3 const& which) const {
  Piece const& p = pieces_[piece];
  return entity(p.zone, {2 * p.lattice[0] + which[0], 2 * p.lattice[1] + which[1], 2 * p.lattice[2] + which[2]});
}

int Lattice::dimension(int entity) const {
  Index3 const p = position(entity);
  return p[0] % 2 + p[1] % 2 + p[2] % 2;
}

IndexRange Lattice::nodes(int entity) const {
  ZoneCuts const& c = cuts_[zone_of(entity)];
  Index3 const p = position(entity);
  IndexRange r;
  for (int a = 0; a < 3; ++a) {
    int const cut = p[a] / 2;
    bool const plane = p[a] % 2 == 0;
    r.begin[a] = plane ? c[a][cut] : c[a][cut] + 1;
    r.end[a] = plane ? c[a][cut] + 1 : c[a][cut + 1];
  }
  return r;
}

int Lattice::image(Link const& link, int entity) const {
  ZoneCuts const& own = cuts_[link.zone];
  ZoneCuts const& donor = cuts_[link.donor_zone];
  Index3 const p = position(entity);
  // Map the two bounding planes of the entity; the donor has the same cuts, so they bound one donor entity.
  Index3 lower, upper;
  for (int a = 0; a < 3; ++a) {
    lower[a] = own[a][p[a] / 2];
    upper[a] = own[a][(p[a] + 1) / 2];
  }
  Index3 const q0 = link.to_donor(lower), q1 = link.to_donor(upper);
  Index3 position;
  for (int a = 0; a < 3; ++a) {
    int const c0 = cut_number(donor[a], std::min(q0[a], q1[a]));
    int const c1 = cut_number(donor[a], std::max(q0[a], q1[a]));
    position[a] = c0 + c1;
  }
  return this->entity(link.donor_zone, position);
}

void Lattice::identify(Mesh const& mesh, Links const& links) {
  int const n = n_entities();
  // Entities on each link, as (entity, link) sorted by entity.
  std::vector<std::pair<int, int>> on_link;
  for (int l = 0; l < int(links.all.size()); ++l) {
    Link const& link = links.all[l];
    ZoneCuts const& c = cuts_[link.zone];
    Index3 lo, hi;
    for (int a = 0; a < 3; ++a) {
      lo[a] = 2 * cut_number(c[a], link.range.begin[a]);
      hi[a] = 2 * cut_number(c[a], link.range.end[a] - 1);
    }
    for (int r = lo[2]; r <= hi[2]; ++r)
      for (int q = lo[1]; q <= hi[1]; ++q)
        for (int p = lo[0]; p <= hi[0]; ++p) on_link.emplace_back(entity(link.zone, {p, q, r}), l);
  }
  std::sort(on_link.begin(), on_link.end());

  class_of_.assign(n, -1);
  copy_of_.assign(n, -1);
  class_begin_.push_back(0);
  for (int seed = 0; seed < n; ++seed) {
    if (class_of_[seed] >= 0) continue;
    int const number = n_classes();
    std::optional<Vec3> axis;
    auto reach = [&](EntityCopy const& copy) {
      class_of_[copy.entity] = number;
      copy_of_[copy.entity] = int(copies_.size());
      copies_.push_back(copy);
    };
    reach({seed, {}, {}, false});
    // Returns true when it came through a periodic interface to a copy not seen before: the plain neighbours of that
    // copy come next, so that they share its transform to the bit.
    auto expand = [&](EntityCopy const from, bool through_periodic) {
      auto it = std::lower_bound(on_link.begin(), on_link.end(), std::pair<int, int>{from.entity, -1});
      for (; it != on_link.end() && it->first == from.entity; ++it) {
        Link const& link = links.all[it->second];
        if (link.periodic != through_periodic) continue;
        EntityCopy to;
        to.entity = image(link, from.entity);
        to.from_owner = from.from_owner.then(link.to_donor);
        to.moved = from.moved || link.periodic;
        to.transform = link.periodic ? from.transform.then(link.transform) : from.transform;
        if (class_of_[to.entity] < 0) {
          reach(to);
          if (through_periodic) return true;
          continue;
        }
        // Reached twice: both ways round must agree, up to a rotation about an axis the nodes lie on.
        EntityCopy const& known = copies_[copy_of_[to.entity]];
        IndexRange const own = nodes(seed);
        if (own.size() > 0 && (known.from_owner(own.begin) != to.from_owner(own.begin) ||
                               known.from_owner(Index3{own.end[0] - 1, own.end[1] - 1, own.end[2] - 1}) !=
                                   to.from_owner(Index3{own.end[0] - 1, own.end[1] - 1, own.end[2] - 1})))
          throw MeshError("interface '" + mesh.interfaces[link.interface].name + "' (" +
                          describe_range(mesh, link.zone, link.range) +
                          ") folds nodes onto others of the same edge or face; split the interface at the fold");
        Mat3 const loop = transpose(known.transform.rotation) * to.transform.rotation;
        if (deviation_from_identity(loop) > 1e-6) axis = rotation_axis(loop);
      }
      return false;
    };
    // Plain interfaces first, so that a copy that has a way round without rotation is never rotated forth and back.
    std::size_t plain = class_begin_.back(), periodic = plain;
    while (periodic < copies_.size())
      if (plain < copies_.size())
        expand(copies_[plain++], false);
      else if (!expand(copies_[periodic], true))
        ++periodic;
    class_begin_.push_back(int(copies_.size()));
    axis_.push_back(axis);
  }
}

std::vector<FaceSide> Lattice::face_sides(int entity_class) const {
  std::vector<FaceSide> sides;
  for (EntityCopy const& copy : copies(entity_class)) {
    int const z = zone_of(copy.entity);
    Index3 const p = position(copy.entity);
    for (int a = 0; a < 3; ++a) {
      if (p[a] % 2 != 0) continue;
      Index3 const n = lattice_extent(cuts_[z]);
      for (int side = 0; side < 2; ++side) {
        // side 0: the face is the lower plane of the piece above it.
        Index3 volume = p;
        volume[a] += side == 0 ? 1 : -1;
        if (volume[a] < 0 || volume[a] >= n[a]) continue;
        sides.push_back({piece_of_volume_[entity(z, volume)], a, side, copy.entity});
      }
    }
  }
  return sides;
}

IndexRange closed_nodes(Lattice const& lattice, int face_entity) {
  Index3 const p = lattice.position(face_entity);
  ZoneCuts const& cuts = lattice.cuts()[lattice.zone_of(face_entity)];
  IndexRange r;
  for (int a = 0; a < 3; ++a) {
    r.begin[a] = cuts[a][p[a] / 2];
    r.end[a] = cuts[a][(p[a] + 1) / 2] + 1;
  }
  return r;
}

}  // namespace gridmorph
