#include <generators/node_joints.hpp>
#include <generators/zone_joints.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

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
        extent(mesh.zones[zone].extent),
        cells_u(extent[along_u] - 1),
        cells_v(extent[along_v] - 1) {}
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

/// A rectangle of cells of a face that have one face beside them, or none.
struct Rectangle {
  int u, v, end_u, end_v;
};

/// Cells of faces and those beside them, by their nodes.
class NodeJoints {
 public:
  using Identity = std::function<Index(int zone, Index3 const&)>;

  NodeJoints(Mesh& mesh, Identity const& identity)
      : mesh_(mesh),
        identity_(identity),
        n_faces_(6 * int(mesh.zones.size())),
        partner_(std::size_t(n_faces_)),
        joints_(mesh.zones.size(), 0) {}

  std::vector<OpenFace> run() {
    find_partners();
    for (int f = 0; f < n_faces_; ++f) take_face(f);
    return std::move(open_);
  }

 private:
  void find_partners() {
    std::vector<FaceCell> cells = sorted_cells();
    for (int f = 0; f < n_faces_; ++f) {
      Face const face(mesh_, f);
      partner_[f].resize(std::size_t(face.cells_u) * std::size_t(face.cells_v));
    }
    for (std::size_t c = 1; c < cells.size(); ++c)
      if (cells[c].nodes == cells[c - 1].nodes) {
        at(cells[c].face, cells[c].u, cells[c].v) = {cells[c - 1].face, cells[c - 1].u, cells[c - 1].v};
        at(cells[c - 1].face, cells[c - 1].u, cells[c - 1].v) = {cells[c].face, cells[c].u, cells[c].v};
      }
  }

  /// The cells of all faces, those with the same nodes one after the other.
  [[nodiscard]] std::vector<FaceCell> sorted_cells() const {
    std::vector<FaceCell> cells;
    for (int f = 0; f < n_faces_; ++f) {
      Face const face(mesh_, f);
      for (int v = 0; v < face.cells_v; ++v)
        for (int u = 0; u < face.cells_u; ++u) {
          FaceCell cell{{}, f, u, v};
          for (int c = 0; c < 4; ++c) cell.nodes[c] = identity_(face.zone, face.node(u + c % 2, v + c / 2));
          std::sort(cell.nodes.begin(), cell.nodes.end());
          cells.push_back(cell);
        }
    }
    std::sort(cells.begin(), cells.end());
    return cells;
  }

  Partner& at(int f, int u, int v) {
    return partner_[f][std::size_t(u) + std::size_t(v) * std::size_t(Face(mesh_, f).cells_u)];
  }

  /// Covers a face with rectangles: each is joined or open.
  void take_face(int f) {
    Face const face(mesh_, f);
    std::vector<char> done(partner_[f].size(), 0);
    auto const number = [&](int u, int v) { return std::size_t(u) + std::size_t(v) * std::size_t(face.cells_u); };
    for (int v = 0; v < face.cells_v; ++v)
      for (int u = 0; u < face.cells_u; ++u) {
        if (done[number(u, v)]) continue;
        int const donor = at(f, u, v).face;
        auto const fits = [&](int a, int b) { return !done[number(a, b)] && at(f, a, b).face == donor; };
        Rectangle const cells = grow(face, u, v, fits);
        for (int b = v; b < cells.end_v; ++b)
          for (int a = u; a < cells.end_u; ++a) done[number(a, b)] = 1;
        if (donor < 0)
          open_.push_back({face.zone, face.axis, face.side, nodes(face, cells)});
        else if (donor >= f)  // else joined from there
          join_rectangle(face, cells, Face(mesh_, donor), at(f, u, v));
      }
  }

  /// Grows from a cell as far as cells fit along u, then as far as whole rows of them do along v.
  template <class Fits>
  static Rectangle grow(Face const& face, int u, int v, Fits const& fits) {
    int end_u = u, end_v = v + 1;
    while (end_u < face.cells_u && fits(end_u, v)) ++end_u;
    for (bool all = true; end_v < face.cells_v; ++end_v) {
      for (int a = u; a < end_u; ++a) all = all && fits(a, end_v);
      if (!all) break;
    }
    return {u, v, end_u, end_v};
  }

  static IndexRange nodes(Face const& face, Rectangle const& cells) {
    Index3 last = face.node(cells.end_u, cells.end_v);
    for (int& x : last) ++x;
    return {face.node(cells.u, cells.v), last};
  }

  /// `first`: the cell beside the first one of the rectangle.
  void join_rectangle(Face const& face, Rectangle const& cells, Face const& other, Partner const& first) {
    Interface1to1 joint;
    joint.zone = face.zone;
    joint.donor_zone = other.zone;
    joint.name = "joint_" + std::to_string(++joints_[face.zone]);
    joint.range = nodes(face, cells);
    joint.to_donor.own_origin = face.node(cells.u, cells.v);
    // Where three corners of the first cell are in the donor.
    auto const in_donor = [&](int a, int b) { return node_of(other, first, identity_(face.zone, face.node(a, b))); };
    joint.to_donor.donor_origin = in_donor(cells.u, cells.v);
    auto& orientation = joint.to_donor.orientation;
    auto const follow = [&](int axis, Index3 const& to) {
      for (int a = 0; a < 3; ++a)
        if (int const step = to[a] - joint.to_donor.donor_origin[a]; step != 0) {
          orientation.axis[axis] = a;
          orientation.sign[axis] = step;
        }
    };
    follow(face.along_u, in_donor(cells.u + 1, cells.v));
    follow(face.along_v, in_donor(cells.u, cells.v + 1));
    orientation.axis[face.axis] = other.axis;
    orientation.sign[face.axis] = face.side != other.side ? 1 : -1;
    join(mesh_, joint, "joint_" + std::to_string(++joints_[other.zone]));
  }

  /// The corner of a cell that is a node.
  [[nodiscard]] Index3 node_of(Face const& face, Partner const& cell, Index wanted) const {
    Index3 p{};
    for (int c = 0; c < 4; ++c) {
      Index3 const q = face.node(cell.u + c % 2, cell.v + c / 2);
      if (identity_(face.zone, q) == wanted) p = q;
    }
    return p;
  }

  Mesh& mesh_;
  Identity const& identity_;
  int n_faces_;                                ///< of all zones
  std::vector<std::vector<Partner>> partner_;  ///< of every cell of every face
  std::vector<int> joints_;                    ///< so many each zone has
  std::vector<OpenFace> open_;
};

}  // namespace

std::vector<OpenFace> join_by_nodes(Mesh& mesh, std::function<Index(int zone, Index3 const&)> const& identity) {
  return NodeJoints(mesh, identity).run();
}

}  // namespace gridmorph::demo
