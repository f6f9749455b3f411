#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/plan/elements/background.hpp>

#include <algorithm>
#include <map>
#include <string>

namespace gridmorph::detail {
namespace {

Vec3 between(Vec3 const& a, Vec3 const& b, double t) { return a + t * (b - a); }

/// The mesh has one pattern in all sheets across the tube: a square core, rings around it as far as the tube, rings
/// from there to the box. Its points are numbered once; a node is (sheet, point), so blocks that share nodes are found
/// by number.
class OTypeMesh {
 public:
  OTypeMesh(Tube const& tube, std::array<std::vector<double>, 3> const& box, double growth)
      : tube_(tube), side_(tube.around / 4) {
    for (std::size_t a = 0; a < 3; ++a) {
      low_[a] = box[a].front();
      high_[a] = box[a].back();
    }
    axis_ = std::size_t(tube.box_axis);
    set_spacings(growth);
  }

  Mesh run() {
    mesh_.source = "background mesh";
    mesh_.families = {"wrap", "outer"};
    int const sheets = int(sheet_.size()), ends = int(end_.size()) - 1;
    struct Segment {
      int from, to;
      bool low, high;
    };
    for (Segment const& s : {Segment{0, ends, true, false}, Segment{ends, sheets - 1 - ends, false, false},
                             Segment{sheets - 1 - ends, sheets - 1, false, true}}) {
      bool const inner = s.low || s.high;
      for (int q = 0; q < 4; ++q) add_ring_zone(q, rings_inside_, int(radial_.size()) - 1, s.from, s.to, s.low, s.high);
      if (!inner) continue;
      for (int q = 0; q < 4; ++q) add_ring_zone(q, 0, rings_inside_, s.from, s.to, s.low, s.high);
      add_core_zone(s.from, s.to, s.low, s.high);
    }
    join_faces();
    set_coordinates();
    check();
    return std::move(mesh_);
  }

 private:
  /// A face that bounds the mesh: outer box or wrap.
  enum class Limit { outer, wrap };
  struct ZonePoints {
    std::vector<Index> number;     ///< (nodes)
    std::array<Limit, 6> limit{};  ///< should the face bound the mesh
  };

  void set_spacings(double growth) {
    int const n = tube_.sections();
    double edge = 0, to_box = 0, radius = 0;
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < tube_.around; ++k) {
        double const share = 1.0 / (n * tube_.around);
        edge += share * distance(tube_.point(j, k), tube_.point(j, k + 1));
        radius += share * distance(tube_.point(j, k), tube_.centre[j]);
        to_box += share * distance(tube_.point(j, k), side_point(j, k));
      }
    // Rings, as fractions of the way from one limit to the next: core (0) to tube (1) to box (2).
    for (int r = 0; r <= rings_inside_; ++r) radial_.push_back(double(r) / rings_inside_);
    auto const outwards = growing(to_box, edge, growth);
    for (std::size_t r = 1; r < outwards.size(); ++r) radial_.push_back(1 + outwards[r] / to_box);
    // Sheets, counted in sections: from the box's lower end (-1) to the first section (0) ... to the box's upper end.
    double const step = tube_.length() / (n - 1), depth = 0.5 * (axis_gap(0) + axis_gap(1));
    end_ = growing(depth, std::min(step, radius), growth);
    for (double& e : end_) e /= depth;
    for (std::size_t e = end_.size(); e-- > 1;) sheet_.push_back(-end_[e]);
    constexpr int per_section = 2;
    for (int j = 0; j <= per_section * (n - 1); ++j) sheet_.push_back(double(j) / per_section);
    for (std::size_t e = 1; e < end_.size(); ++e) sheet_.push_back(n - 1 + end_[e]);
  }
  [[nodiscard]] double axis_gap(int side) const {
    Vec3 const& c = side == 0 ? tube_.centre.front() : tube_.centre.back();
    return side == 0 ? along(c, axis_) - low_[axis_] : high_[axis_] - along(c, axis_);
  }

  // ---- positions
  // -------------------------------------------------------------------------------------------------------

  static double along(Vec3 const& p, std::size_t axis) { return component(p, int(axis)); }

  /// Point k of the perimeter of the box, at a height along the tube's box axis.
  [[nodiscard]] Vec3 perimeter(int k, double height) const {
    std::size_t const a = (axis_ + 1) % 3, b = (axis_ + 2) % 3;
    double const t = double(k % side_) / side_;
    std::array<double, 3> x{};
    x[axis_] = height;
    switch (k / side_ % 4) {
      case 0:
        x[a] = low_[a] + t * (high_[a] - low_[a]);
        x[b] = low_[b];
        break;
      case 1:
        x[a] = high_[a];
        x[b] = low_[b] + t * (high_[b] - low_[b]);
        break;
      case 2:
        x[a] = high_[a] - t * (high_[a] - low_[a]);
        x[b] = high_[b];
        break;
      default:
        x[a] = low_[a];
        x[b] = high_[b] - t * (high_[b] - low_[b]);
        break;
    }
    return {x[0], x[1], x[2]};
  }
  /// Where the plane of a section meets a line along the box's sides, as far as there is room above and below.
  [[nodiscard]] std::array<double, 2> limits(int k) const {
    double const height = high_[axis_] - low_[axis_];
    auto in_plane = [&](Vec3 const& c) {
      Vec3 const p = perimeter(k, along(c, axis_));
      return along(c, axis_) - dot(p - c, tube_.axis) / along(tube_.axis, axis_);
    };
    Vec3 const &front = tube_.centre.front(), &back = tube_.centre.back();
    double const apart = along(back, axis_) - along(front, axis_);
    // A tenth of the box, or less where the tube ends closer to its end.
    double const below = low_[axis_] + std::min(0.1 * height, axis_gap(0)),
                 above = high_[axis_] - std::min(0.1 * height, axis_gap(1));
    double const kept = std::min(apart, 0.5 * (above - below));
    double const first = std::clamp(in_plane(front), below, above - kept);
    return {first, std::clamp(in_plane(back), first + kept, above)};
  }
  /// Where on the box's sides the line that leaves ring point k of a section ends.
  [[nodiscard]] Vec3 side_point(int section, int k) const {
    auto const [first, last] = limits(k);
    return perimeter(k, first + (last - first) * section / (tube_.sections() - 1));
  }
  /// What the ring of the tube is continued to on the box's end faces.
  [[nodiscard]] Vec3 end_middle(int end) const {
    Vec3 const& c = end == 0 ? tube_.centre.front() : tube_.centre.back();
    double const face = end == 0 ? low_[axis_] : high_[axis_];
    Vec3 const there = c + ((face - along(c, axis_)) / along(tube_.axis, axis_)) * tube_.axis;
    std::array<double, 3> x{};
    for (std::size_t a = 0; a < 3; ++a) {
      double const quarter = (high_[a] - low_[a]) / 4;
      x[a] = a == axis_ ? face : std::clamp(along(there, a), low_[a] + quarter, high_[a] - quarter);
    }
    return {x[0], x[1], x[2]};
  }

  /// A sheet's centre, ring point k and box point k. Sheets between a section and the box's end lie between theirs.
  struct Frame {
    Vec3 centre, ring, box;
  };
  [[nodiscard]] Frame frame(double sheet, int k) const {
    int const last = tube_.sections() - 1;
    if (sheet < 0 || sheet > last) {
      int const end = sheet < 0 ? 0 : 1, section = end == 0 ? 0 : last;
      double const t = end == 0 ? -sheet : sheet - last;
      Vec3 const middle = end_middle(end);
      Vec3 const corner = perimeter(k, along(middle, axis_));
      Frame const f = frame(section, k);
      return {between(f.centre, middle, t), between(f.ring, end_ring(f, middle, corner), t), between(f.box, corner, t)};
    }
    int const j = std::min(int(sheet), last - 1);
    double const t = sheet - j;
    return {between(tube_.centre[j], tube_.centre[j + 1], t), between(tube_.point(j, k), tube_.point(j + 1, k), t),
            between(side_point(j, k), side_point(j + 1, k), t)};
  }
  /// The tube's ring goes on along its axis and widens towards a ring in the middle of the end face, by no more than it
  /// is far away: in front of an end close to the box lines would lie down otherwise.
  [[nodiscard]] Vec3 end_ring(Frame const& section, Vec3 const& middle, Vec3 const& corner) const {
    Vec3 const ahead = section.ring - section.centre;
    Vec3 const across = ahead - (along(ahead, axis_) / along(tube_.axis, axis_)) * tube_.axis;
    std::array<double, 3> from{};
    for (std::size_t a = 0; a < 3; ++a) {
      double const rim = a == axis_ ? 0 : 0.1 * (high_[a] - low_[a]);
      from[a] = std::clamp(along(middle + across, a), low_[a] + rim, high_[a] - rim);
    }
    Vec3 const straight{from[0], from[1], from[2]}, wide = between(middle, corner, 0.4);
    double const reach = 0.7 * distance(section.centre, middle), way = distance(straight, wide);
    return between(straight, wide, std::min(1.0, reach / std::max(way, 1e-300)));
  }
  /// Corner q of the core: half-way to the ring.
  [[nodiscard]] Vec3 core_corner(double sheet, int q) const {
    Frame const f = frame(sheet, q * side_);
    return between(f.centre, f.ring, 0.5);
  }
  [[nodiscard]] Vec3 core_point(double sheet, int i, int j) const {
    double const a = double(i) / side_, b = double(j) / side_;
    return between(between(core_corner(sheet, 0), core_corner(sheet, 1), a),
                   between(core_corner(sheet, 3), core_corner(sheet, 2), a), b);
  }
  [[nodiscard]] Vec3 ring_point(double sheet, int ring, int k) const {
    Frame const f = frame(sheet, k % (4 * side_));
    double const r = radial_[ring];
    if (r >= 1) return between(f.ring, f.box, r - 1);
    auto const [i, j] = core_perimeter(k);
    return between(core_point(sheet, i, j), f.ring, r);
  }

  // ---- numbers
  // ---------------------------------------------------------------------------------------------------------

  /// Place in the core of point k of its perimeter.
  [[nodiscard]] std::pair<int, int> core_perimeter(int k) const {
    int const t = k % side_;
    switch (k / side_ % 4) {
      case 0: return {t, 0};
      case 1: return {side_, t};
      case 2: return {side_ - t, side_};
      default: return {0, side_ - t};
    }
  }
  [[nodiscard]] Index core_number(int i, int j) const { return i + Index(side_ + 1) * j; }
  [[nodiscard]] Index ring_number(int ring, int k) const {
    if (ring == 0) {
      auto const [i, j] = core_perimeter(k);
      return core_number(i, j);
    }
    return Index(side_ + 1) * (side_ + 1) + Index(ring - 1) * 4 * side_ + k % (4 * side_);
  }
  [[nodiscard]] Index node_number(int sheet, Index point) const {
    return sheet * (Index(side_ + 1) * (side_ + 1) + Index(radial_.size()) * 4 * side_) + point;
  }

  /// Adds a zone of rings; (ring, around, along) is right-handed.
  void add_ring_zone(int quarter, int from_ring, int to_ring, int from, int to, bool low, bool high) {
    ZonePoints zone;
    Index3 const extent{to_ring - from_ring + 1, side_ + 1, to - from + 1};
    for (int s = 0; s < extent[2]; ++s)
      for (int k = 0; k < extent[1]; ++k)
        for (int r = 0; r < extent[0]; ++r) {
          zone.number.push_back(node_number(from + s, ring_number(from_ring + r, quarter * side_ + k)));
          position_.push_back(ring_point(sheet_[from + s], from_ring + r, quarter * side_ + k));
        }
    zone.limit.fill(Limit::wrap);
    zone.limit[1] = Limit::outer;
    if (low) zone.limit[4] = Limit::outer;
    if (high) zone.limit[5] = Limit::outer;
    add_zone(extent, std::move(zone));
  }
  void add_core_zone(int from, int to, bool low, bool high) {
    ZonePoints zone;
    Index3 const extent{side_ + 1, side_ + 1, to - from + 1};
    for (int s = 0; s < extent[2]; ++s)
      for (int j = 0; j < extent[1]; ++j)
        for (int i = 0; i < extent[0]; ++i) {
          zone.number.push_back(node_number(from + s, core_number(i, j)));
          position_.push_back(core_point(sheet_[from + s], i, j));
        }
    zone.limit.fill(Limit::wrap);
    if (low) zone.limit[4] = Limit::outer;
    if (high) zone.limit[5] = Limit::outer;
    add_zone(extent, std::move(zone));
  }
  void add_zone(Index3 const& extent, ZonePoints zone) {
    mesh_.add_zone("block " + std::to_string(mesh_.zones.size() + 1), extent);
    zones_.push_back(std::move(zone));
  }

  // ---- faces
  // -----------------------------------------------------------------------------------------------------------

  struct Face {
    int zone = 0, axis = 0, side = 0;
  };
  [[nodiscard]] IndexRange range(Face const& f) const {
    auto const a = std::size_t(f.axis);
    IndexRange r{{0, 0, 0}, mesh_.zones[f.zone].extent};
    (f.side == 0 ? r.end[a] : r.begin[a]) = f.side == 0 ? 1 : r.end[a] - 1;
    return r;
  }
  [[nodiscard]] Index number(int zone, Index3 const& p) const {
    Zone const& z = mesh_.zones[zone];
    return zones_[zone].number[z.node(p) - z.first_node];
  }
  /// Corner (a, b) of a face, a and b along its two axes in ascending order.
  [[nodiscard]] Index3 corner(Face const& f, int a, int b) const {
    IndexRange const r = range(f);
    Index3 p = r.begin;
    auto const first = std::size_t(f.axis == 0 ? 1 : 0), second = std::size_t(f.axis == 2 ? 1 : 2);
    if (a == 1) p[first] = r.end[first] - 1;
    if (b == 1) p[second] = r.end[second] - 1;
    return p;
  }

  /// Faces with the same corner nodes are one face seen from two zones.
  void join_faces() {
    std::map<std::array<Index, 4>, std::vector<Face>> faces;
    for (int z = 0; z < int(mesh_.zones.size()); ++z)
      for (int axis = 0; axis < 3; ++axis)
        for (int const side : {0, 1}) {
          Face const f{z, axis, side};
          std::array<Index, 4> key{};
          for (int c = 0; c < 4; ++c) key[c] = number(z, corner(f, c & 1, c >> 1));
          std::sort(key.begin(), key.end());
          faces[key].push_back(f);
        }
    for (auto const& [key, both] : faces)
      if (both.size() == 2) {
        join(both[0], both[1]);
        join(both[1], both[0]);
      } else {
        add_patch(both[0]);
      }
  }

  void join(Face const& own, Face const& donor) {
    Interface1to1 face;
    face.name = "to " + mesh_.zones[donor.zone].name;
    face.zone = own.zone;
    face.donor_zone = donor.zone;
    face.range = range(own);
    // Where the donor has our corners (0, 0), (1, 0) and (0, 1).
    std::array<Index3, 3> there{};
    for (int c = 0; c < 4; ++c) {
      Index3 const p = corner(donor, c & 1, c >> 1);
      for (int n = 0; n < 3; ++n)
        if (number(donor.zone, p) == number(own.zone, corner(own, n & 1, n >> 1))) there[n] = p;
    }
    Orientation& o = face.to_donor.orientation;
    auto const normal = std::size_t(own.axis);
    o.axis[normal] = donor.axis;
    o.sign[normal] = own.side != donor.side ? 1 : -1;
    for (int n = 1; n < 3; ++n) {
      auto const tangent = std::size_t(n == 1 ? (own.axis == 0 ? 1 : 0) : (own.axis == 2 ? 1 : 2));
      for (std::size_t a = 0; a < 3; ++a)
        if (there[n][a] != there[0][a]) {
          o.axis[tangent] = int(a);
          o.sign[tangent] = there[n][a] > there[0][a] ? 1 : -1;
        }
    }
    face.to_donor.own_origin = corner(own, 0, 0);
    face.to_donor.donor_origin = there[0];
    mesh_.interfaces.push_back(std::move(face));
  }

  void add_patch(Face const& f) {
    bool const outer = zones_[f.zone].limit[2 * f.axis + f.side] == Limit::outer;
    std::string const family = outer ? "outer" : "wrap";
    mesh_.patches.push_back({family + " " + std::string(face_name(f.axis, f.side)),
                             outer ? "BCFarfield" : "BCWall",
                             outer ? PatchKind::farfield : PatchKind::wall,
                             {family},
                             f.zone,
                             range(f)});
  }

  void set_coordinates() {
    mesh_.coordinates = Coordinates(mesh_.n_nodes());
    // Blocks compute shared points alike but for round-off: the first one's count.
    std::map<Index, Index> first;
    for (std::size_t z = 0; z < zones_.size(); ++z)
      for (std::size_t n = 0; n < zones_[z].number.size(); ++n) {
        Index const node = mesh_.zones[z].first_node + Index(n);
        Index const from = first.try_emplace(zones_[z].number[n], node).first->second;
        mesh_.coordinates.set(node, position_[from]);
      }
  }

  /// Checks that every corner of every cell is right-handed.
  void check() const {
    for (Zone const& zone : mesh_.zones)
      for (int k = 0; k + 1 < zone.extent[2]; ++k)
        for (int j = 0; j + 1 < zone.extent[1]; ++j)
          for (int i = 0; i + 1 < zone.extent[0]; ++i)
            for (int c = 0; c < 8; ++c) {
              Index3 const at{i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)};
              std::array<Vec3, 3> edge;
              for (std::size_t a = 0; a < 3; ++a) {
                Index3 from = at, to = at;
                from[a] = Index3{i, j, k}[a];
                to[a] = from[a] + 1;
                edge[a] = mesh_.coordinates[zone.node(to)] - mesh_.coordinates[zone.node(from)];
              }
              if (!(dot(edge[0], cross(edge[1], edge[2])) > 0))
                throw MeshError("the O-type background mesh around the walls has a cell inside out at " +
                                describe_node(mesh_, zone.node(at)));
            }
  }

  static constexpr int rings_inside_ = 4;

  Tube const& tube_;
  int side_;
  std::array<double, 3> low_{}, high_{};
  std::size_t axis_ = 2;
  std::vector<double> radial_, end_, sheet_;
  std::vector<ZonePoints> zones_;
  std::vector<Vec3> position_;
  Mesh mesh_;
};

}  // namespace

Mesh o_type_mesh(Tube const& tube, std::array<std::vector<double>, 3> const& box, double growth) {
  return OTypeMesh(tube, box, growth).run();
}

}  // namespace gridmorph::detail
