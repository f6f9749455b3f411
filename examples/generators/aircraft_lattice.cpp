#include <generators/aircraft_lattice.hpp>
#include <generators/aircraft_shape.hpp>
#include <generators/spacing.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gridmorph::aircraft {

namespace {

double between(double a, double b, double t) { return a + (b - a) * std::clamp(t, 0.0, 1.0); }

// Corners of cells. Planes pass the bodies at some distance; where a plane passes no body it goes on from those beside
// it.

double corner_y(int i, int j) {
  constexpr double side[] = {2, 2, 2.8, 2.8, 2.8, 2.8, 2.8, 2.05, 1.25, 1.1, 1.1};
  bool const tail = i >= i_tail_leading;
  double const all[] = {0, 0.62, side[i], tail ? 3.2 : 4.4, tail ? 6.75 : 7.7, 11.8, 16, 17.55, 170};
  return all[j];
}

/// Of the wing and the horizontal tail at y: leading edge, chord, height; held beyond the tips.
struct Section {
  double x, chord, z;
};
Section section(LiftingSurface const& surface, double y) {
  double const t = (y - surface.root.y) / (surface.tip.y - surface.root.y);
  return {between(surface.root.x, surface.tip.x, t), between(surface.root_chord, surface.tip_chord, t),
          between(surface.root.z, surface.tip.z, t)};
}

double corner_x(Shape const& shape, int i, double y, int j, int k) {
  Section const wing = section(shape.wing, y), htail = section(shape.htail, y);
  double const outboard = (y - 2) / 15;
  bool const above = k >= k_fin_tip, beside_fin = k >= k_crown;
  bool const beside_nacelle = (k == k_nacelle || k == k_belly) && (j == j_nacelle_in || j == j_nacelle_out);
  switch (i) {
    case i_front: return -170;
    case i_nose: return -0.7;
    case i_shoulder: return 5;
    case i_nacelle: return j <= j_side ? 8.5 : between(8.8, 14, (y - 7.7) / 9.3);
    case i_leading: return beside_nacelle ? (j == j_nacelle_in ? 13.9 : 14.4) : wing.x - between(0.9, 0.4, outboard);
    case i_hinge: return wing.x + 0.75 * wing.chord;
    case i_trailing: return wing.x + wing.chord + between(0.6, 0.35, outboard);
    case i_tail_leading: return above ? 33.8 : beside_fin ? between(28.8, htail.x - 0.9, (y - 2) / 4.7) : htail.x - 0.6;
    case i_tail_trailing: return above ? 36.7 : beside_fin ? 35.6 : htail.x + htail.chord + 0.4;
    case i_end: return above ? 38 : 37;
    default: return 200;
  }
}

double corner_z(Shape const& shape, int i, double y, int j, int k) {
  if (k == k_low) return -170;
  if (k == k_fin_tip) return 8.4;
  if (k == k_high) return 170;
  if (j <= j_side) {
    if (k == k_nacelle) return -4.9;
    constexpr double beside_fuselage[6][11] = {
        {-1.9, -1.9, -2.85, -2.85, -2.85, -2.85, -2.85, -1.76, -0.45, -0.2, -0.2},
        {-1.1, -1.1, -1.75, -1.75, -1.7, -1.7, -1.7, -0.9, -0.15, 0.1, 0.1},
        {-0.3, -0.3, 0.25, 0.25, 0.3, 0.3, 0.3, -0.3, 0.1, 0.4, 0.4},
        {0.3, 0.3, 0.9, 0.9, 0.95, 0.95, 0.95, 0.25, 0.33, 0.75, 0.75},
        {0.9, 0.9, 1.75, 1.75, 1.75, 1.75, 1.75, 1.35, 1.25, 1.15, 1.15},
        {1.8, 1.8, 2.85, 2.85, 2.85, 2.85, 2.85, 2.42, 2.05, 1.95, 1.95}};
    return beside_fuselage[k - k_belly][i];
  }
  bool const beside_nacelle = j <= j_nacelle_out;
  if (i <= i_trailing || !beside_nacelle) {
    Section const wing = section(shape.wing, y);
    double const half = 0.065 * wing.chord + between(0.55, 0.33, (y - 2) / 15);
    switch (k) {
      case k_nacelle: return beside_nacelle ? -4.8 : wing.z - 4;
      case k_belly: return beside_nacelle ? -1.85 : wing.z - 1.4;
      case k_wing_lower: return wing.z - half;
      case k_wing_upper: return wing.z + half;
      case k_tail_lower: return wing.z + 1.65;
      case k_tail_upper: return wing.z + 2.45;
      default: return wing.z + 3.55;
    }
  }
  double const z = section(shape.htail, y).z;
  switch (k) {
    case k_nacelle: return z - 5;
    case k_belly: return z - 2;
    case k_wing_lower: return z - 1.4;
    case k_wing_upper: return z - 0.9;
    case k_tail_lower: return z - 0.5;
    case k_tail_upper: return z + 0.5;
    default: return z + 1.3;
  }
}

Vec3 corner(Index3 const& p) {
  static Shape const shape;
  double const y = corner_y(p[0], p[1]);
  return {corner_x(shape, p[0], y, p[1], p[2]), y, corner_z(shape, p[0], y, p[1], p[2])};
}

std::vector<double> reversed(std::vector<double> s) {
  std::reverse(s.begin(), s.end());
  for (double& t : s) t = 1 - t;
  return s;
}

/// Even up to the tip's section but finer towards it, even beside its rounding.
std::vector<double> with_tip(int n, double begin) {
  int const tip = tip_cells(n);
  std::vector<double> s = reversed(demo::geometric_spacing(n - tip, 0.4 / (n - tip)));
  for (double& t : s) t *= begin;
  for (int l = 1; l <= tip; ++l) s.push_back(begin + (1 - begin) * l / tip);
  return s;
}

std::vector<double> shares(int axis, int slab, int n) {
  constexpr int last[] = {i_back - 1, j_far - 1, k_high - 1};
  double const far = 0.05 / n;  // the first cell: about as large as those beside it
  if (slab == last[axis]) return demo::geometric_spacing(n, far);
  if (axis == 0 && slab == i_leading) return demo::geometric_spacing(n, 0.4 / n);
  if (axis == 0 && slab == i_hinge) return reversed(demo::geometric_spacing(n, 0.3 / n));
  if (axis == 0 && slab == i_trailing) return demo::tanh_spacing(n, 0.3 / n);
  if (axis == 0 && slab == i_tail_leading) return demo::tanh_spacing(n, 0.4 / n);
  if (axis == 1 && slab == j_nacelle_in) return with_tip(n, htail_tip_begin);
  if (axis == 1 && slab == j_tip_begin) return with_tip(n, wing_tip_begin);
  if (axis == 2 && slab == k_crown) return with_tip(n, vtail_tip_begin);
  if (slab == 0 && axis != 1) return reversed(demo::geometric_spacing(n, far));
  return demo::geometric_spacing(n, 1.0 / n);
}

}  // namespace

Lattice::Lattice(double scale) {
  std::array<std::vector<int>, 3> const cells{
      {{10, 10, 6, 8, 14, 8, 16, 12, 6, 12}, {3, 5, 5, 9, 8, 8, 6, 12}, {12, 6, 4, 6, 4, 5, 4, 9, 12}}};
  for (int a = 0; a < 3; ++a) {
    plane[a] = {0};
    for (int s = 0; s < int(cells[a].size()); ++s) {
      int const n = std::max(2, int(std::lround(cells[a][s] * scale)));
      auto const t = shares(a, s, n);
      for (int l = 0; l < n; ++l) {
        slab[a].push_back(s);
        share[a].push_back(l == 0 ? 0 : t[l]);
      }
      plane[a].push_back(plane[a].back() + n);
    }
    slab[a].push_back(int(cells[a].size()) - 1);
    share[a].push_back(1);
  }
  layers = std::max(4, int(std::lround(14 * scale)));
}

Vec3 Lattice::position(Index3 const& p) const {
  Index3 const cell{slab[0][p[0]], slab[1][p[1]], slab[2][p[2]]};
  double const t[3] = {share[0][p[0]], share[1][p[1]], share[2][p[2]]};
  Vec3 x;
  for (int k : {0, 1})
    for (int j : {0, 1})
      for (int i : {0, 1}) {
        double const w = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2]);
        if (w != 0) x += w * corner({cell[0] + i, cell[1] + j, cell[2] + k});
      }
  return x;
}

IndexRange Lattice::nodes(Index3 const& from, Index3 const& to) const {
  IndexRange range;
  for (int a = 0; a < 3; ++a) {
    range.begin[a] = plane[a][from[a]];
    range.end[a] = plane[a][to[a]] + 1;
  }
  return range;
}

Part body(Index3 const& cell) {
  struct Box {
    Part part;
    Index3 from, to;
  };
  constexpr Box boxes[] = {
      {Part::fuselage, {i_nose, j_symmetry, k_belly}, {i_end, j_side, k_crown}},
      {Part::wing, {i_leading, j_side, k_wing_lower}, {i_trailing, j_tip, k_wing_upper}},
      {Part::htail, {i_tail_leading, j_side, k_tail_lower}, {i_tail_trailing, j_nacelle_out, k_tail_upper}},
      {Part::vtail, {i_tail_leading, j_symmetry, k_crown}, {i_tail_trailing, j_fin, k_fin_tip}},
      {Part::nacelle, {i_nacelle, j_nacelle_in, k_nacelle}, {i_leading, j_nacelle_out, k_belly}}};
  auto const inside = [&](Box const& b) {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < b.from[a] || cell[a] >= b.to[a]) return false;
    return true;
  };
  auto const found = std::find_if(std::begin(boxes), std::end(boxes), inside);
  return found == std::end(boxes) ? Part::none : found->part;
}

}  // namespace gridmorph::aircraft
