#include <gridmorph/boundary/detail/periodic_faces.hpp>
#include <gridmorph/kernels/box_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace gridmorph::topology {

namespace {

constexpr double sizeable = 0.02;      // of the open area, each side
constexpr double whole_number = 0.01;  // by which the number of sectors may miss one
constexpr double through = 0.9;        // share of the area from which the way leads through the mesh
constexpr double most_cut = 0.5;       // share of the outline that may run through open surface
constexpr double smooth = 0.8;         // cosine of the angle between cells that continue one another
constexpr double beyond = 0.3;         // of the height of the sides: how far the mesh may reach beyond them
constexpr double flat = 1e-6;          // of the mesh size

struct CellArea {
  double area = 0;
  Vec3 inward;  ///< unit normal into the mesh
};

CellArea area_of(CellShape const& s) {
  Vec3 const normal = cross(s.corner[2] - s.corner[0], s.corner[3] - s.corner[1]);
  double const length = norm(normal);
  if (!(length > 0)) return {};
  return {0.5 * length, (dot(normal, s.inward) < 0 ? -1 / length : 1 / length) * normal};
}

/// The distance of a point from the axis of a match.
double radius_of(PeriodicMatch const& m, Vec3 const& p) { return norm(cross(p - m.origin, m.direction)); }

bool same_axis(PeriodicMatch const& a, PeriodicMatch const& b, double size) {
  return norm(cross(a.direction, b.direction)) < 1e-4 && norm(cross(b.origin - a.origin, a.direction)) < 1e-4 * size;
}

/// Cells of a side that lie on one zone face.
struct Piece {
  std::vector<Vec3> points;
  CellArea first;  ///< of the first cell that has an area

  void add(CellShape const& shape, CellArea const& area) {
    points.insert(points.end(), shape.corner.begin(), shape.corner.end());
    if (first.area == 0) first = area;
  }
  void add(Piece const& other) {
    points.insert(points.end(), other.points.begin(), other.points.end());
    if (first.area == 0) first = other.first;
  }
  [[nodiscard]] bool is_flat(double size) const {
    return std::all_of(points.begin(), points.end(),
                       [&](Vec3 const& p) { return std::fabs(dot(p - points.front(), first.inward)) <= flat * size; });
  }
};

class Judge {
 public:
  Judge(SurfaceCells const& cells, std::vector<PeriodicMatch> const& matches, std::vector<std::uint8_t> const& open)
      : cells_(cells), matches_(matches), open_(open) {
    Box box;
    for (Index c = 0; c < cells.size(); ++c) {
      CellShape const s = cells.shape(c);
      if (open[c] != 0 && !cells.on_plane_of_layer(c)) open_area_ += area_of(s).area;
      for (Vec3 const& p : s.corner) box.include(p);
    }
    size_ = distance(box.low, box.high);
  }

  std::vector<Judgement> run() {
    std::vector<Judgement> out(matches_.size());
    std::vector<Sides> sides;
    for (auto const& m : matches_) sides.push_back(look_at(m));
    for (std::size_t m = 0; m < matches_.size(); ++m) out[m].why = doubt(matches_[m], sides[m]);
    rotations(sides, out);
    translations(sides, out);
    return out;
  }

 private:
  struct Sides {
    double area = 0;         ///< of one side
    double through = 0;      ///< share of it from which the way leads through the mesh
    double cut = 0;          ///< share of its outline that runs through open, smooth surface
    bool planes = false;     ///< the sides are flat on every zone face
    bool one_plane = false;  ///< and it is the same one
    double radius_low = 0, radius_high = 0;
  };

  [[nodiscard]] Vec3 way_at(PeriodicMatch const& m, Vec3 const& p) const {
    return m.rotation ? cross(m.direction, p - m.origin) : m.transform.translation;
  }

  [[nodiscard]] Sides look_at(PeriodicMatch const& m) const {
    Sides out;
    std::vector<std::uint8_t> own(cells_.size(), 0);
    for (auto const& pair : m.pairs) own[pair.cell] = 1;
    std::map<int, Piece> here, there;  // by zone face
    double good = 0, outline = 0, cut = 0;
    out.radius_low = std::numeric_limits<double>::infinity();
    for (auto const& pair : m.pairs) {
      CellShape const p = cells_.shape(pair.cell), q = cells_.shape(pair.other);
      CellArea const a = area_of(p), b = area_of(q);
      out.area += a.area;
      if (dot(way_at(m, p.centre), a.inward) > 0 && dot(way_at(m, q.centre), b.inward) < 0) good += a.area;
      here[cells_.face_of(pair.cell)].add(p, a);
      there[cells_.face_of(pair.other)].add(q, b);
      for (auto const& corner : p.corner) {
        out.radius_low = std::min(out.radius_low, m.rotation ? radius_of(m, corner) : 0);
        out.radius_high = std::max(out.radius_high, m.rotation ? radius_of(m, corner) : 0);
      }
      measure_outline(pair.cell, p, a, own, outline, cut);
    }
    out.through = out.area > 0 ? good / out.area : 0;
    out.cut = outline > 0 ? cut / outline : 0;
    auto const all_flat = [&](std::map<int, Piece> const& pieces) {
      return std::all_of(pieces.begin(), pieces.end(), [&](auto const& piece) { return piece.second.is_flat(size_); });
    };
    out.planes = all_flat(here) && all_flat(there);
    if (out.planes) {
      Piece all;
      for (auto const* pieces : {&here, &there})
        for (auto const& [face, piece] : *pieces) all.add(piece);
      out.one_plane = all.is_flat(size_);
    }
    return out;
  }

  /// Adds the edges of a cell beyond which the side ends; `cut` those behind which open surface goes on smoothly.
  void measure_outline(Index cell, CellShape const& shape, CellArea const& area, std::vector<std::uint8_t> const& own,
                       double& outline, double& cut) const {
    ZoneFace const& face = cells_.faces()[cells_.face_of(cell)];
    int const a = int((cell - face.first) % face.nu), b = int((cell - face.first) / face.nu);
    constexpr std::array<std::array<int, 2>, 4> step{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};  // beyond edge c, c + 1
    for (std::size_t c = 0; c < 4; ++c) {
      double const length = distance(shape.corner[c], shape.corner[(c + 1) % 4]);
      int const na = a + step[c][0], nb = b + step[c][1];
      bool const on_face = na >= 0 && na < face.nu && nb >= 0 && nb < face.nv;
      Index const next = on_face ? face.first + na + Index(face.nu) * nb : -1;
      if (on_face && own[next] != 0) continue;
      outline += length;
      if (!on_face || open_[next] == 0) continue;
      if (dot(area_of(cells_.shape(next)).inward, area.inward) > smooth) cut += length;
    }
  }

  [[nodiscard]] std::string doubt(PeriodicMatch const& m, Sides const& s) const {
    if (s.area < sizeable * open_area_) return "so small a part of the open faces is chance";
    if (m.rotation) {
      double const sectors = 2 * std::numbers::pi / m.angle_rad;
      if (sectors < 2 - whole_number || std::fabs(sectors - std::round(sectors)) > whole_number)
        return "the angle is no whole part of a full turn";
    }
    if (s.one_plane) return "both sides are parts of one plane";
    if (s.through < through) return "the mesh does not lie between the two sides";
    if (s.cut > most_cut) return "the open faces go on smoothly beyond the sides";
    if (m.rotation && reaches_beyond(m, s))
      return "the mesh is nearer to that axis, or further from it, than the sides";
    return "";
  }

  [[nodiscard]] bool reaches_beyond(PeriodicMatch const& m, Sides const& s) const {
    // Zones that lie along the axis where the sides do: other rows have sides of their own.
    double low = std::numeric_limits<double>::infinity(), high = -low;
    auto const along = [&](Vec3 const& p) { return dot(p - m.origin, m.direction); };
    for (auto const& pair : m.pairs)
      for (auto const& p : cells_.shape(pair.cell).corner) {
        low = std::min(low, along(p));
        high = std::max(high, along(p));
      }
    double const slack = beyond * (s.radius_high - s.radius_low);
    for (Index c = 0; c < cells_.size(); ++c) {
      CellShape const shape = cells_.shape(c);
      if (along(shape.centre) < low || along(shape.centre) > high) continue;
      double const r = radius_of(m, shape.centre);
      if (r > s.radius_high + slack || r < s.radius_low - slack) return true;
    }
    return false;
  }

  /// Takes those rotations that are about the axis of the largest.
  void rotations(std::vector<Sides> const& sides, std::vector<Judgement>& out) const {
    std::size_t best = matches_.size();
    for (std::size_t m = 0; m < matches_.size(); ++m)
      if (matches_[m].rotation && out[m].why.empty() && (best == matches_.size() || sides[m].area > sides[best].area))
        best = m;
    for (std::size_t m = 0; m < matches_.size(); ++m) {
      if (!matches_[m].rotation || !out[m].why.empty()) continue;
      out[m].taken = same_axis(matches_[best], matches_[m], size_);
      if (!out[m].taken) out[m].why = "the mesh is periodic about another axis";
    }
  }

  void translations(std::vector<Sides> const& sides, std::vector<Judgement>& out) const {
    bool const turns = std::any_of(out.begin(), out.end(), [](Judgement const& j) { return j.taken; });
    double covered = 0;
    for (std::size_t m = 0; m < matches_.size(); ++m)
      if (!matches_[m].rotation && out[m].why.empty()) covered += 2 * sides[m].area;
    bool const nothing_else = !cells_.mesh().patches.empty() && covered > (1 - 1e-6) * open_area_;
    for (std::size_t m = 0; m < matches_.size(); ++m) {
      if (matches_[m].rotation || !out[m].why.empty()) continue;
      if (turns)
        out[m].why = "the mesh is by a rotation";
      else if (sides[m].planes && !nothing_else)
        out[m].why =
            "inlets and outlets, end walls and far fields are planes of one shape too: declare the boundary (a side "
            "file), and what is left is taken";
      else
        out[m].taken = true;
    }
  }

  SurfaceCells const& cells_;
  std::vector<PeriodicMatch> const& matches_;
  std::vector<std::uint8_t> const& open_;
  double open_area_ = 0, size_ = 0;
};

}  // namespace

std::vector<Judgement> judge(SurfaceCells const& cells, std::vector<PeriodicMatch> const& matches,
                             std::vector<std::uint8_t> const& open) {
  return Judge(cells, matches, open).run();
}

}  // namespace gridmorph::topology
