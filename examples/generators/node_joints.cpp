#include <generators/node_joints.hpp>
#include <generators/zone_joints.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace gridmorph::demo {

namespace {

/// One cell of a zone's face: u and v are the axes after the face's own.
struct FaceCell {
  std::array<Index, 4> nodes;  ///< ascending
  int face;                    ///< 6 zone + 2 axis + side
  int u, v;
  friend bool operator<(FaceCell const& a, FaceCell const& b) { return a.nodes < b.nodes; }
};

struct Face {
  int zone, axis, side, along_u, along_v;
  Index3 extent;
  int cells_u, cells_v;

  Face(Mesh const& mesh, int number)
      : zone(number / 6),
        axis(number % 6 / 2),
        side(number % 2),
        along_u((axis + 1) % 3),
        along_v((axis + 2) % 3),
        extent(mesh.zones[std::size_t(zone)].extent),
        cells_u(extent[std::size_t(along_u)] - 1),
        cells_v(extent[std::size_t(along_v)] - 1) {}
  [[nodiscard]] Index3 node(int u, int v) const {
    Index3 p{};
    p[axis] = side ? extent[axis] - 1 : 0;
    p[along_u] = u;
    p[along_v] = v;
    return p;
  }
};

struct Partner {
  int face = -1, u = 0, v = 0;
};

}  // namespace

std::vector<OpenFace> join_by_nodes(Mesh& mesh, std::function<Index(int zone, Index3 const&)> const& identity) {
  int const n_faces = 6 * int(mesh.zones.size());
  std::vector<FaceCell> cells;
  for (int f = 0; f < n_faces; ++f) {
    Face const face(mesh, f);
    for (int v = 0; v < face.cells_v; ++v)
      for (int u = 0; u < face.cells_u; ++u) {
        FaceCell cell{{}, f, u, v};
        for (int c = 0; c < 4; ++c) cell.nodes[std::size_t(c)] = identity(face.zone, face.node(u + c % 2, v + c / 2));
        std::sort(cell.nodes.begin(), cell.nodes.end());
        cells.push_back(cell);
      }
  }
  std::vector<std::vector<Partner>> partner(static_cast<std::size_t>(n_faces));
  for (int f = 0; f < n_faces; ++f) {
    Face const face(mesh, f);
    partner[std::size_t(f)].resize(std::size_t(face.cells_u) * std::size_t(face.cells_v));
  }
  auto const at = [&](int f, int u, int v) -> Partner& {
    return partner[std::size_t(f)][std::size_t(u) + std::size_t(v) * std::size_t(Face(mesh, f).cells_u)];
  };
  std::sort(cells.begin(), cells.end());
  for (std::size_t c = 1; c < cells.size(); ++c)
    if (cells[c].nodes == cells[c - 1].nodes) {
      at(cells[c].face, cells[c].u, cells[c].v) = {cells[c - 1].face, cells[c - 1].u, cells[c - 1].v};
      at(cells[c - 1].face, cells[c - 1].u, cells[c - 1].v) = {cells[c].face, cells[c].u, cells[c].v};
    }

  std::vector<OpenFace> open;
  std::vector<int> joints(mesh.zones.size(), 0);
  for (int f = 0; f < n_faces; ++f) {
    Face const face(mesh, f);
    std::vector<char> done(partner[std::size_t(f)].size(), 0);
    auto const number = [&](int u, int v) { return std::size_t(u) + std::size_t(v) * std::size_t(face.cells_u); };
    for (int v = 0; v < face.cells_v; ++v)
      for (int u = 0; u < face.cells_u; ++u) {
        if (done[number(u, v)]) continue;
        int const donor = at(f, u, v).face;
        auto const fits = [&](int a, int b) { return !done[number(a, b)] && at(f, a, b).face == donor; };
        int end_u = u, end_v = v + 1;
        while (end_u < face.cells_u && fits(end_u, v)) ++end_u;
        for (bool all = true; end_v < face.cells_v; ++end_v) {
          for (int a = u; a < end_u; ++a) all = all && fits(a, end_v);
          if (!all) break;
        }
        for (int b = v; b < end_v; ++b)
          for (int a = u; a < end_u; ++a) done[number(a, b)] = 1;
        IndexRange const range{face.node(u, v), [&] {
                                 Index3 last = face.node(end_u, end_v);
                                 for (int& x : last) ++x;
                                 return last;
                               }()};
        if (donor < 0) {
          open.push_back({face.zone, face.axis, face.side, range});
          continue;
        }
        if (donor < f) continue;  // joined from there
        // Where three corners of the first cell are in the donor.
        Face const other(mesh, donor);
        Partner const first = at(f, u, v);
        auto const in_donor = [&](int a, int b) {
          Index const wanted = identity(face.zone, face.node(a, b));
          Index3 p{};
          for (int c = 0; c < 4; ++c) {
            Index3 const q = other.node(first.u + c % 2, first.v + c / 2);
            if (identity(other.zone, q) == wanted) p = q;
          }
          return p;
        };
        Interface1to1 joint;
        joint.zone = face.zone;
        joint.donor_zone = other.zone;
        joint.name = "joint_" + std::to_string(++joints[std::size_t(face.zone)]);
        joint.range = range;
        joint.to_donor.own_origin = face.node(u, v);
        joint.to_donor.donor_origin = in_donor(u, v);
        auto& orientation = joint.to_donor.orientation;
        auto const follow = [&](int axis, Index3 const& to) {
          for (int a = 0; a < 3; ++a)
            if (int const step = to[a] - joint.to_donor.donor_origin[a]; step != 0) {
              orientation.axis[axis] = a;
              orientation.sign[axis] = step;
            }
        };
        follow(face.along_u, in_donor(u + 1, v));
        follow(face.along_v, in_donor(u, v + 1));
        orientation.axis[face.axis] = other.axis;
        orientation.sign[face.axis] = face.side != other.side ? 1 : -1;
        join(mesh, joint, "joint_" + std::to_string(++joints[std::size_t(other.zone)]));
      }
  }
  return open;
}

}  // namespace gridmorph::demo
