#include <generators/spacing.hpp>
#include <generators/stand_ins.hpp>
#include <generators/zone_joints.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace gridmorph {

namespace {

namespace slotted_airfoil {

struct Point {
  double x = 0, z = 0;
  friend Point operator+(Point a, Point b) { return {a.x + b.x, a.z + b.z}; }
  friend Point operator-(Point a, Point b) { return {a.x - b.x, a.z - b.z}; }
  friend Point operator*(double s, Point a) { return {s * a.x, s * a.z}; }
};
using Line = std::vector<Point>;

/// n cells on [0, 1], the first and the last one about as long as asked: M. Vinokur's two-sided stretching; uniform
/// where that would have to gather nodes in the middle. Nodes 0 ... n.
std::vector<double> two_sided(int n, double first, double last) {
  double const ratio = std::sqrt(last / first), crowd = 1 / (n * std::sqrt(first * last));
  std::vector<double> out;
  double low = 1e-6, high = 50;
  for (int step = 0; step < 100; ++step) {
    double const middle = 0.5 * (low + high);
    (std::sinh(middle) / middle > crowd ? high : low) = middle;
  }
  for (int i = 0; i <= n; ++i) {
    double const t = double(i) / n;
    double const u = crowd <= 1 ? t : 0.5 + std::tanh(low * (t - 0.5)) / (2 * std::tanh(low / 2));
    out.push_back(crowd <= 1 ? u : u / (ratio + (1 - ratio) * u));
  }
  out.front() = 0;
  out.back() = 1;
  return out;
}

/// n cells on the smooth curve through the points (cubic pieces, tangents of the parabola through three neighbours).
Line curve(Line const& through, int n, double first, double last) {
  std::size_t const m = through.size() - 1;
  std::vector<double> length(m), at{0};
  for (std::size_t i = 0; i < m; ++i) {
    Point const d = through[i + 1] - through[i];
    length[i] = std::hypot(d.x, d.z);
    at.push_back(at.back() + length[i]);
  }
  auto const slope = [&](std::size_t i) { return 1 / length[i] * (through[i + 1] - through[i]); };
  auto const tangent = [&](std::size_t i) {
    if (i == 0 || i == m) return slope(i == 0 ? 0 : m - 1);
    return 1 / (length[i - 1] + length[i]) * (length[i] * slope(i - 1) + length[i - 1] * slope(i));
  };
  Line out;
  for (double const t : two_sided(n, first, last)) {
    double const s = t * at.back();
    std::size_t i = 0;
    while (i + 1 < m && s > at[i + 1]) ++i;
    double const u = (s - at[i]) / length[i], v = 1 - u;
    out.push_back((v * v * (1 + 2 * u)) * through[i] + (u * v * v * length[i]) * tangent(i) +
                  (u * u * (1 + 2 * v)) * through[i + 1] - (u * u * v * length[i]) * tangent(i + 1));
  }
  out.front() = through.front();
  out.back() = through.back();
  return out;
}

Line reversed(Line line) {
  std::reverse(line.begin(), line.end());
  return line;
}

/// One after another; each begins where the one before ends.
Line chain(std::vector<Line> const& lines) {
  Line out = lines.front();
  for (std::size_t i = 1; i < lines.size(); ++i) out.insert(out.end(), lines[i].begin() + 1, lines[i].end());
  return out;
}

/// An airfoil: chord from nose to tail, largest thickness about `thickness` and camber of a parabola, in chords; round
/// nose, sharp tail.
struct Element {
  Point nose, tail;
  double thickness, camber;

  /// side: -1 lower, 1 upper. c: along the chord, 0 at the nose.
  [[nodiscard]] Point at(double c, int side) const {
    Point const e = tail - nose;
    double const y = side * thickness * 2.6 * std::sqrt(c) * (1 - c) * (1 - 0.35 * c) + 4 * camber * c * (1 - c);
    return nose + c * e + y * Point{-e.z, e.x};
  }
  /// n cells of one side from chord position w0^2 to w1^2: even steps in w keep up with the curvature of the nose.
  [[nodiscard]] Line wall(int side, double w0, double w1, int n, double first, double last) const {
    Line out;
    for (double const t : two_sided(n, first, last)) {
      double const w = w0 + t * (w1 - w0);
      out.push_back(at(w * w, side));
    }
    return out;
  }
};

/// The lines that bound the four zones. Wakes reach from each tail to x = 10: part A beyond the flap, B above the flap,
/// C above the main element. Zones meet on three lines: `flap`, around the flap's C grid above and before it; `slat`,
/// below and behind the slat's; and the inner side of the outermost zone, in pieces.
struct Outlines {
  Element slat{{-0.070, -0.045}, {0.030, 0.045}, 0.10, 0.10};
  Element main{{0, -0.02}, {0.88, 0.02}, 0.075, 0.01};
  Element flap{{0.885, -0.028}, {1.20, -0.12}, 0.075, 0.02};

  static constexpr int a = 24, b = 32, c = 36;  ///< cells along the parts of wakes

  static Line to_outflow(Point from, Point over, Point end) { return curve({from, over, end}, a, 0.003, 0.15); }
  static constexpr Point under_nose{0.848, -0.05};   ///< flap, main element and outermost zone meet
  static constexpr Point between{0.888, 0};          ///< below the main element's tail
  static constexpr Point under_slat{-0.05, -0.075};  ///< main element, slat and outermost zone meet
  static constexpr Point in_slot{0.04, 0.037};
  static constexpr Point over_slat{0.03, 0.10};
  static constexpr double end = 1.23;  ///< a little behind the flap

  Line flap_wake = to_outflow(flap.tail, {2.5, -0.3}, {10, -0.7});
  Line main_wake = chain({curve({main.tail, {1, 0.012}, {end, -0.035}}, b, 0.015, 0.03),
                          to_outflow({end, -0.035}, {2.5, -0.05}, {10, 0})});
  Line slat_wake = chain({curve({slat.tail, {0.12, 0.115}, {0.35, 0.155}, {0.90, 0.115}}, c, 0.006, 0.03),
                          curve({{0.90, 0.115}, {1, 0.11}, {end, 0.075}}, b, 0.03, 0.03),
                          to_outflow({end, 0.075}, {2.5, 0.15}, {10, 0.7})});

  Line flap_line = chain({curve({under_nose, {0.862, -0.018}, between}, 10, 0.1, 0.1),
                          curve({between, {1, -0.018}, {end, -0.075}}, b, 0.015, 0.03),
                          to_outflow({end, -0.075}, {2.5, -0.17}, {10, -0.35})});
  Line slat_line = chain({curve({under_slat, {-0.02, -0.02}, in_slot}, 24, 0.04, 0.04),
                          curve({in_slot, {0.14, 0.085}, {0.35, 0.11}, {0.90, 0.065}}, c, 0.006, 0.02),
                          curve({{0.90, 0.065}, {1, 0.062}, {end, 0.02}}, b, 0.02, 0.03),
                          to_outflow({end, 0.02}, {2.5, 0.05}, {10, 0.35})});

  Line below_flap = chain({reversed(to_outflow({end, -0.19}, {2.5, -0.45}, {10, -1.1})),
                           curve({{end, -0.19}, {1, -0.145}, under_nose}, b, 0.03, 0.025)});
  Line below_main = curve({under_nose, {0.5, -0.125}, {0.1, -0.13}, under_slat}, 92, 0.006, 0.004);
  Line above = chain(
      {curve({under_slat, {-0.1, -0.085}, {-0.12, -0.05}, {-0.1, 0.02}, {-0.05, 0.072}, over_slat}, 80, 0.012, 0.012),
       curve({over_slat, {0.12, 0.15}, {0.35, 0.21}, {0.90, 0.18}}, c, 0.01, 0.03),
       curve({{0.90, 0.18}, {1, 0.172}, {end, 0.15}}, b, 0.03, 0.03), to_outflow({end, 0.15}, {2.5, 0.3}, {10, 1.2})});

  /// C of the far field, from below to above.
  static Line far_field() {
    auto const straight = [](double z) { return curve({{end, z}, {10, z}}, a, 0.02, 0.08); };
    auto const arc = [](double from, double to, int n, double spacing) {
      Line out;
      for (double const t : two_sided(n, spacing, spacing)) {
        double const angle = (from + t * (to - from)) * std::numbers::pi / 180;
        out.push_back({end + 11.23 * std::cos(angle), 10 * std::sin(angle)});
      }
      return out;
    };
    return chain({reversed(straight(-10)), arc(270, 258, b, 0.03), arc(258, 222, 92, 0.01), arc(222, 115, 80, 0.012),
                  arc(115, 100, c, 0.03), arc(100, 90, b, 0.03), straight(10)});
  }
};

/// A C grid: from the inner line (wake, wall, wake) to the outer one, along straight lines.
struct Grid {
  Line inner, outer;
  int cells;      ///< across
  double first;   ///< cell, as a share of the line
  int wall_from;  ///< first and last node of the wall; wakes before and behind; -1: none
  int wall_to;
};

std::array<Grid, 4> grids(Outlines const& l) {
  constexpr double thin = 1.8e-4;
  return {Grid{chain({reversed(l.flap_wake), l.flap.wall(-1, 1, 0.16, 32, 0.03, 0.03),
                      l.flap.wall(-1, 0.16, 0, 5, 0.2, 0.2), l.flap.wall(1, 0, 0.2, 5, 0.2, 0.2),
                      l.flap.wall(1, 0.2, 1, 32, 0.025, 0.03), l.flap_wake}),
               chain({l.below_flap, l.flap_line}), 24, thin, 24, 98},
          Grid{chain({reversed(l.main_wake), l.main.wall(-1, 1, 0.97, 10, 0.05, 0.14),
                      l.main.wall(-1, 0.97, 0.17, 92, 0.007, 0.004), l.main.wall(-1, 0.17, 0, 12, 0.06, 0.085),
                      l.main.wall(1, 0, 0.22, 12, 0.06, 0.06), l.main.wall(1, 0.22, 1, 36, 0.015, 0.015), l.main_wake}),
               chain({reversed(l.flap_line), l.below_main, l.slat_line}), 44, thin, 56, 218},
          Grid{chain({reversed(l.slat_wake), l.slat.wall(-1, 1, 0.1, 24, 0.03, 0.03),
                      l.slat.wall(-1, 0.1, 0, 10, 0.1, 0.1), l.slat.wall(1, 0, 1, 70, 0.004, 0.012), l.slat_wake}),
               chain({reversed(l.slat_line), l.above}), 28, thin, 92, 196},
          Grid{chain({l.below_flap, l.below_main, l.above}), Outlines::far_field(), 16, 2e-3, -1, -1}};
}

void place_nodes(Mesh& mesh, Zone const& zone, Grid const& grid) {
  auto const across = demo::geometric_spacing(grid.cells, grid.first);
  for (int k = 0; k <= grid.cells; ++k)
    for (int j = 0; j < zone.extent[1]; ++j) {
      double const s = k == 0 ? 0 : k == grid.cells ? 1 : across[k];
      Point const p = (1 - s) * grid.inner[j] + s * grid.outer[j];
      for (int i : {0, 1}) mesh.coordinates.set(zone.node({i, j, k}), {p.x, -double(i), p.z});
    }
}

/// Joins j nodes from ... of k_min (side 0) or k_max of a zone to as many of a donor; forward: both ascending.
struct Joint {
  int zone, side, from, to, donor, donor_side, donor_from;
  bool forward;
};

constexpr Joint joints[] = {{0, 0, 0, 24, 0, 0, 122, false},    {1, 0, 0, 56, 1, 0, 274, false},
                            {2, 0, 0, 92, 2, 0, 288, false},    {0, 1, 0, 56, 3, 0, 0, true},
                            {0, 1, 56, 122, 1, 1, 66, false},   {1, 1, 66, 158, 3, 0, 56, true},
                            {1, 1, 158, 274, 2, 1, 116, false}, {2, 1, 116, 288, 3, 0, 148, true}};

void add_interface(Mesh& mesh, Joint const& joint) {
  Zone const& own = mesh.zones[joint.zone];
  Zone const& donor = mesh.zones[joint.donor];
  Interface1to1 face;
  face.name = "to_" + donor.name + "_from_" + std::to_string(joint.from + 1);
  face.zone = joint.zone;
  face.donor_zone = joint.donor;
  face.range = demo::whole_face(own, 2, joint.side);
  face.range.begin[1] = joint.from;
  face.range.end[1] = joint.to + 1;
  face.to_donor.orientation.sign = {1, joint.forward ? 1 : -1, joint.side != joint.donor_side ? 1 : -1};
  face.to_donor.own_origin = face.range.begin;
  face.to_donor.donor_origin = {0, joint.donor_from, joint.donor_side == 0 ? 0 : donor.extent[2] - 1};
  demo::join(mesh, face, "back_to_" + own.name + "_at_" + std::to_string(joint.from + 1));
}

void add_patches(Mesh& mesh, int z, Grid const& grid) {
  Zone const& zone = mesh.zones[z];
  auto const add = [&](char const* name, char const* type, PatchKind kind, IndexRange const& range) {
    mesh.patches.push_back({name, type, kind, {}, z, range});
  };
  add("Ilo_Seg   1", "BCSymmetryPlane", PatchKind::symmetry, demo::whole_face(zone, 0, 0));
  add("Ihi_Seg   1", "BCExtrapolate", PatchKind::other, demo::whole_face(zone, 0, 1));
  add("Jlo_Seg   1", "BCFarfield", PatchKind::farfield, demo::whole_face(zone, 1, 0));
  add("Jhi_Seg   1", "BCFarfield", PatchKind::farfield, demo::whole_face(zone, 1, 1));
  if (grid.wall_from < 0) {
    add("Khi_Seg   1", "BCFarfield", PatchKind::farfield, demo::whole_face(zone, 2, 1));
    return;
  }
  IndexRange wall = demo::whole_face(zone, 2, 0);
  wall.begin[1] = grid.wall_from;
  wall.end[1] = grid.wall_to + 1;
  add("Klo_Seg   2", "BCWallViscous", PatchKind::wall, wall);
}

}  // namespace slotted_airfoil

}  // namespace

Mesh make_slotted_airfoil() {
  using namespace slotted_airfoil;
  auto const all = grids(Outlines());
  Mesh mesh;
  mesh.source = "slotted airfoil";
  for (std::size_t z = 0; z < all.size(); ++z)
    mesh.add_zone("Zone   " + std::to_string(z + 1), {2, int(all[z].inner.size()), all[z].cells + 1});
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t z = 0; z < all.size(); ++z) {
    place_nodes(mesh, mesh.zones[z], all[z]);
    add_patches(mesh, int(z), all[z]);
  }
  for (Joint const& joint : joints) add_interface(mesh, joint);
  return mesh;
}

}  // namespace gridmorph
