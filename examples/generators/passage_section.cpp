#include <generators/blade_contour.hpp>
#include <generators/passage_section.hpp>
#include <generators/spacing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::passage {

namespace {

using Line = std::vector<Point2>;
using Fractions = std::vector<double>;
using std::numbers::pi;

Point2 unit(Point2 a) { return (1 / length(a)) * a; }

Point2 rotated(Point2 a, double degrees) {
  Point2 const d = direction(degrees * pi / 180);
  return {a.x * d.x - a.y * d.y, a.x * d.y + a.y * d.x};
}

/// Fraction of arc length at every node.
Fractions arc_fractions(Line const& line) {
  Fractions s(line.size());
  for (std::size_t n = 1; n < line.size(); ++n) s[n] = s[n - 1] + length(line[n] - line[n - 1]);
  double const total = s.back();
  for (double& f : s) f /= total;
  return s;
}

Fractions reversed(Fractions s) {
  std::reverse(s.begin(), s.end());
  for (double& f : s) f = 1 - f;
  return s;
}

Line reversed(Line line) {
  std::reverse(line.begin(), line.end());
  return line;
}

/// weight * a + (1 - weight) * even spacing.
Fractions towards_even(Fractions a, double weight) {
  double const n = double(a.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = weight * a[i] + (1 - weight) * double(i) / n;
  return a;
}

/// Cubic from a to b with unit end directions, nodes at these fractions of its length.
Line curve(Point2 a, Point2 from_direction, Point2 b, Point2 to_direction, Fractions const& fractions) {
  constexpr int n_samples = 200;
  double const pull = length(b - a);
  Point2 const da = pull * from_direction, db = pull * to_direction;
  auto const at = [&](double t) {
    double const s = 1 - t;
    return (s * s * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (t * s * s) * da + (-t * t * s) * db;
  };
  Line samples(n_samples + 1);
  for (int n = 0; n <= n_samples; ++n) samples[n] = at(double(n) / n_samples);
  Fractions const s = arc_fractions(samples);
  Line line(fractions.size());
  std::size_t n = 1;
  for (std::size_t i = 0; i < line.size(); ++i) {
    while (n + 1 < s.size() && s[n] < fractions[i]) ++n;
    line[i] = at((double(n - 1) + (fractions[i] - s[n - 1]) / (s[n] - s[n - 1])) / n_samples);
  }
  line.front() = a;
  line.back() = b;
  return line;
}

/// Transfinite interpolation (Boolean sum) between four edges. Every node is blended by its place along the lines that
/// join the arc-length fractions of opposite edges, so the spacing of each edge is kept next to it.
void fill(PieceNodes& nodes, Line const& bottom, Line const& top, Line const& left, Line const& right) {
  int const ni = nodes.ni, nk = nodes.nk;
  Fractions const sb = arc_fractions(bottom), st = arc_fractions(top), sl = arc_fractions(left),
                  sr = arc_fractions(right);
  Point2 const c00 = bottom.front(), c10 = bottom.back(), c01 = top.front(), c11 = top.back();
  for (int k = 0; k < nk; ++k)
    for (int i = 0; i < ni; ++i) {
      // u = sb + v (st - sb), v = sl + u (sr - sl)
      double const du = st[i] - sb[i], dv = sr[k] - sl[k];
      double const u = (sb[i] + sl[k] * du) / (1 - du * dv), v = sl[k] + u * dv;
      nodes.at(i, k) = (1 - v) * bottom[i] + v * top[i] + (1 - u) * left[k] + u * right[k] -
                       ((1 - u) * ((1 - v) * c00 + v * c01) + u * ((1 - v) * c10 + v * c11));
    }
  // The edges themselves, bit for bit.
  for (int i = 0; i < ni; ++i) {
    nodes.at(i, 0) = bottom[i];
    nodes.at(i, nk - 1) = top[i];
  }
  for (int k = 0; k < nk; ++k) {
    nodes.at(0, k) = left[k];
    nodes.at(ni - 1, k) = right[k];
  }
}

}  // namespace

std::string_view name(Piece piece) {
  static constexpr std::array<std::string_view, n_pieces> names{
      "ring_le",     "ring_upper", "ring_te", "ring_lower",   "inlet_lower",   "inlet_middle",
      "inlet_upper", "lower",      "upper",   "outlet_lower", "outlet_middle", "outlet_upper",
      "tip_le",      "tip_upper",  "tip_te",  "tip_lower",    "tip_core"};
  return names[piece];
}

std::array<int, 2> piece_cells(PassageCounts const& c, Piece piece) {
  int const le = c.leading_upper + c.leading_lower, te = c.trailing_upper + c.trailing_lower;
  switch (piece) {
    case ring_le: return {le, c.layers};
    case ring_te: return {te, c.layers};
    case ring_upper:
    case ring_lower: return {c.side, c.layers};
    case inlet_lower: return {c.inlet, c.lower};
    case inlet_middle: return {c.inlet, le};
    case inlet_upper: return {c.inlet, c.upper};
    case lower: return {c.side, c.lower};
    case upper: return {c.side, c.upper};
    case outlet_lower: return {c.outlet, c.lower};
    case outlet_middle: return {c.outlet, te};
    case outlet_upper: return {c.outlet, c.upper};
    case tip_le: return {le, c.rim};
    case tip_te: return {te, c.rim};
    case tip_upper:
    case tip_lower: return {c.side, c.rim};
    case tip_core: return {c.side, le};
    case n_pieces: break;
  }
  return {0, 0};
}

namespace {

/// Corners sit where the normal has turned this far from the camber direction; half the camber angle is added so that
/// they face the passage, whose pitch lines run along theta whatever the stagger.
constexpr double corner_turn = 50 * pi / 180;

}  // namespace

CornerFractions corner_fractions(PassageOptions const& options) {
  Airfoil const airfoil(options, 0.5);
  BladeSide const up(airfoil, BladeSide::Side::upper), down(airfoil, BladeSide::Side::lower);
  double const in = 0.5 * airfoil.inlet_angle(), out = 0.5 * airfoil.outlet_angle();
  auto const bounded = [](double turn) { return std::clamp(turn, pi / 9, 4 * pi / 9); };
  return {up.fraction_of_turn(bounded(corner_turn + in)), down.fraction_of_turn(bounded(corner_turn - in)),
          up.fraction_before_end(bounded(corner_turn - out)), down.fraction_before_end(bounded(corner_turn + out))};
}

SectionMesher::SectionMesher(PassageOptions const& options, PassageCounts const& counts)
    : options_(options), counts_(counts), annulus_(options) {
  for (int n = 0; n < n_pieces; ++n) {
    auto const [ni, nk] = piece_cells(counts, Piece(n));
    pieces_[n].ni = ni + 1;
    pieces_[n].nk = nk + 1;
    pieces_[n].p.resize(std::size_t(ni + 1) * (nk + 1));
  }
}

std::array<PieceNodes, n_pieces> const& SectionMesher::operator()(double span) {
  PassageCounts const& c = counts_;
  Airfoil const airfoil(options_, span);
  BladeSide const up(airfoil, BladeSide::Side::upper), down(airfoil, BladeSide::Side::lower);
  double const half_pitch = pi * annulus_.section_radius(span) / options_.blades;

  // Ring: straight normals off the wall.
  double const thickness = options_.ring_thickness * airfoil.chord();
  int const n_up = c.leading_upper + c.side + c.trailing_upper, n_down = c.leading_lower + c.side + c.trailing_lower;
  double const first =
      std::max(options_.first_cell / options_.ring_thickness, demo::first_of_geometric(c.layers, options_.max_growth));
  Fractions const off_wall = demo::geometric_spacing(c.layers, first);
  double const last_layer = thickness * (1 - off_wall[c.layers - 1]);
  auto const ring = [&](Piece piece, auto phi_of) {
    PieceNodes& nodes = pieces_[piece];
    std::vector<double>& places = ring_phi_[piece];
    places.resize(std::size_t(nodes.ni));
    for (int i = 0; i < nodes.ni; ++i) {
      double const phi = places[std::size_t(i)] = phi_of(i);
      Point2 const wall = airfoil.point(phi), t = unit(airfoil.tangent(phi)), normal{-t.y, t.x};
      for (int k = 0; k < nodes.nk; ++k) nodes.at(i, k) = wall + (off_wall[k] * thickness) * normal;
    }
    Line outer(nodes.ni);
    for (int i = 0; i < nodes.ni; ++i) outer[i] = nodes.at(i, nodes.nk - 1);
    return outer;
  };
  auto const phi_up = [&](int n) { return up.phi(double(n) / n_up); };
  // Continues past the trailing edge (n < 0 from there on), so phi stays ascending round the blade.
  auto const phi_down = [&](int n) { return down.phi(double(n) / n_down); };
  Line const le = ring(ring_le, [&](int i) {
    int const n = i - c.leading_lower;
    return n >= 0 ? phi_up(n) : phi_down(-n);
  });
  Line const top_side = ring(ring_upper, [&](int i) { return phi_up(c.leading_upper + i); });
  Line const te = ring(ring_te, [&](int i) {
    int const n = i - c.trailing_upper;
    return n <= 0 ? phi_up(n_up + n) : phi_down(n_down - n);
  });
  Line const bottom_side = reversed(ring(ring_lower, [&](int i) { return phi_down(c.leading_lower + c.side - i); }));

  // Corners of the ring: outward normal, the edge towards the periodic and the edge towards inlet or outlet.
  auto const normal_at = [&](double phi) {
    Point2 const t = unit(airfoil.tangent(phi));
    return Point2{-t.y, t.x};
  };
  Point2 const c1 = le.back(), c2 = le.front(), c3 = te.front(), c4 = te.back();
  Point2 const n1 = normal_at(phi_up(c.leading_upper)), n2 = normal_at(phi_down(c.leading_lower));
  Point2 const n3 = normal_at(phi_up(c.leading_upper + c.side)), n4 = normal_at(phi_down(c.leading_lower + c.side));

  // Pitchwise edges, one upstream and one downstream of the blade, each from periodic to periodic.
  auto const periodic = [&](double x, double side) { return Point2{x, airfoil.camber(x) + side * half_pitch}; };
  double const x_up = 0.5 * (c1.x + c2.x), x_down = 0.5 * (c3.x + c4.x);
  Point2 const u1 = periodic(x_up, 1), l1 = periodic(x_up, -1), u2 = periodic(x_down, 1), l2 = periodic(x_down, -1);
  Point2 const cross1 = unit((u1 - c1) + (c2 - l1)), cross2 = unit((u2 - c3) + (c4 - l2));
  Fractions const from_ring_up =
      demo::geometric_spacing(c.upper, last_layer / (0.5 * (length(u1 - c1) + length(u2 - c3))));
  Fractions const to_ring_low =
      reversed(demo::geometric_spacing(c.lower, last_layer / (0.5 * (length(l1 - c2) + length(l2 - c4)))));
  auto const leaving = [](Point2 rule, Point2 straight) { return unit(unit(rule) + unit(straight)); };
  Line const upper_1 = curve(c1, leaving(rotated(n1, -30), u1 - c1), u1, cross1, from_ring_up);
  Line const upper_2 = curve(c3, leaving(rotated(n3, 30), u2 - c3), u2, cross2, from_ring_up);
  Line const lower_1 = curve(l1, cross1, c2, -1.0 * leaving(rotated(n2, 30), l1 - c2), to_ring_low);
  Line const lower_2 = curve(l2, cross2, c4, -1.0 * leaving(rotated(n4, -30), l2 - c4), to_ring_low);

  // Streamwise edges from inlet to ring and from ring to outlet.
  auto const station = [&](double x, double fraction) { return Point2{x, airfoil.camber(x) + fraction * half_pitch}; };
  Point2 const flow_in = direction(airfoil.inlet_angle()), flow_out = direction(airfoil.outlet_angle());
  double const share_in_up = 0.15 + 0.5 * c.leading_upper / double(c.leading_upper + c.upper);
  double const share_in_low = 0.15 + 0.5 * c.leading_lower / double(c.leading_lower + c.lower);
  double const share_out_up = 0.15 + 0.5 * c.trailing_upper / double(c.trailing_upper + c.upper);
  double const share_out_low = 0.15 + 0.5 * c.trailing_lower / double(c.trailing_lower + c.lower);
  double const x_in = options_.inlet, x_out = options_.outlet;
  Point2 const i1 = station(x_in, share_in_up), i2 = station(x_in, -share_in_low);
  Point2 const o1 = station(x_out, share_out_up), o2 = station(x_out, -share_out_low);
  Fractions const in =
      reversed(demo::geometric_spacing(c.inlet, 1.5 * last_layer / (0.5 * (length(c1 - i1) + length(c2 - i2)))));
  Fractions const out =
      demo::geometric_spacing(c.outlet, 1.5 * last_layer / (0.5 * (length(o1 - c3) + length(o2 - c4))));
  Line const inlet_up = curve(i1, flow_in, c1, -1.0 * leaving(rotated(n1, 30), i1 - c1), in);
  Line const inlet_low = curve(i2, flow_in, c2, -1.0 * leaving(rotated(n2, -30), i2 - c2), in);
  Line const outlet_up = curve(c3, leaving(rotated(n3, -30), o1 - c3), o1, flow_out, out);
  Line const outlet_low = curve(c4, leaving(rotated(n4, 30), o2 - c4), o2, flow_out, out);

  // Periodics: the passage part takes the mean spacing of both blade sides.
  auto const periodic_line = [&](double x0, double x1, Fractions const& s, double side) {
    Line line(s.size());
    for (std::size_t n = 0; n < s.size(); ++n) line[n] = periodic(x0 + (x1 - x0) * s[n], side);
    return line;
  };
  Fractions along = arc_fractions(top_side);
  Fractions const along_low = arc_fractions(bottom_side);
  for (std::size_t n = 0; n < along.size(); ++n) along[n] = 0.5 * (along[n] + along_low[n]);
  along = towards_even(along, 0.6);

  // Inlet and outlet: straight along theta.
  auto const pitch_line = [](Point2 a, Point2 b, Fractions const& s) {
    Line line(s.size());
    for (std::size_t n = 0; n < s.size(); ++n) line[n] = a + s[n] * (b - a);
    line.back() = b;
    return line;
  };
  auto const even = [](std::size_t nodes) { return towards_even(Fractions(nodes), 0); };

  Line const in_mid = pitch_line(i2, i1, even(le.size()));
  Line const in_up = pitch_line(i1, station(x_in, 1), towards_even(from_ring_up, 0.3));
  Line const in_low = pitch_line(station(x_in, -1), i2, towards_even(to_ring_low, 0.3));
  Line const out_mid = pitch_line(o2, o1, even(te.size()));
  Line const out_up = pitch_line(o1, station(x_out, 1), towards_even(from_ring_up, 0.3));
  Line const out_low = pitch_line(station(x_out, -1), o2, towards_even(to_ring_low, 0.3));

  fill(pieces_[upper], top_side, periodic_line(x_up, x_down, along, 1), upper_1, upper_2);
  fill(pieces_[lower], periodic_line(x_up, x_down, along, -1), bottom_side, lower_1, lower_2);
  fill(pieces_[inlet_middle], inlet_low, inlet_up, in_mid, le);
  fill(pieces_[inlet_upper], inlet_up, periodic_line(x_in, x_up, in, 1), in_up, upper_1);
  fill(pieces_[inlet_lower], periodic_line(x_in, x_up, in, -1), inlet_low, in_low, lower_1);
  fill(pieces_[outlet_middle], outlet_low, outlet_up, reversed(te), out_mid);
  fill(pieces_[outlet_upper], outlet_up, periodic_line(x_down, x_out, out, 1), upper_2, out_up);
  fill(pieces_[outlet_lower], periodic_line(x_down, x_out, out, -1), outlet_low, lower_2, out_low);
  if (options_.tip != BladeTip::none) fill_tip(options_, airfoil, ring_phi_, pieces_);
  return pieces_;
}

}  // namespace gridmorph::passage
