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

/// A corner of the ring and the outward normal there.
struct RingCorner {
  Point2 at, normal;
};

Point2 normal_at(Airfoil const& airfoil, double phi) {
  Point2 const t = unit(airfoil.tangent(phi));
  return {-t.y, t.x};
}

/// The direction of an edge that leaves the ring: half by the rule, half straight to its other end.
Point2 leaving(Point2 rule, Point2 straight) { return unit(unit(rule) + unit(straight)); }

/// The edge from a corner to a point; `turn`: from the normal [degrees].
Line from_corner(RingCorner const& corner, double turn, Point2 to, Point2 to_direction, Fractions const& fractions) {
  return curve(corner.at, leaving(rotated(corner.normal, turn), to - corner.at), to, to_direction, fractions);
}

/// The same the other way round.
Line to_corner(Point2 from, Point2 from_direction, RingCorner const& corner, double turn, Fractions const& fractions) {
  return curve(from, from_direction, corner.at, -1.0 * leaving(rotated(corner.normal, turn), from - corner.at),
               fractions);
}

/// A straight line with its nodes at these fractions.
Line pitch_line(Point2 a, Point2 b, Fractions const& s) {
  Line line(s.size());
  for (std::size_t n = 0; n < s.size(); ++n) line[n] = a + s[n] * (b - a);
  line.back() = b;
  return line;
}

Fractions even(std::size_t nodes) { return towards_even(Fractions(nodes), 0); }

/// The pieces of one section but those over the tip: first the ring, then the edges that leave its corners, then what
/// lies between them.
class PassageSection {
 public:
  PassageSection(PassageOptions const& options, PassageCounts const& counts, Annulus const& annulus, double span)
      : options_(options),
        counts_(counts),
        airfoil_(options, span),
        up_(airfoil_, BladeSide::Side::upper),
        down_(airfoil_, BladeSide::Side::lower),
        half_pitch_(pi * annulus.section_radius(span) / options.blades) {}

  void fill_pieces(std::array<PieceNodes, n_pieces>& pieces, std::array<std::vector<double>, 4>& ring_phi) {
    fill_ring(pieces, ring_phi);
    find_corners();
    draw_pitchwise_edges();
    draw_streamwise_edges();
    fill_beside_blade(pieces);
    fill_inlet(pieces);
    fill_outlet(pieces);
  }

  [[nodiscard]] Airfoil const& airfoil() const { return airfoil_; }

 private:
  /// phi of the wall's nodes, counted from the leading edge.
  [[nodiscard]] double phi_up(int n) const {
    return up_.phi(double(n) / (counts_.leading_upper + counts_.side + counts_.trailing_upper));
  }
  /// Continues past the trailing edge (n < 0 from there on), so phi stays ascending round the blade.
  [[nodiscard]] double phi_down(int n) const {
    return down_.phi(double(n) / (counts_.leading_lower + counts_.side + counts_.trailing_lower));
  }

  /// Fills the ring with straight normals off the wall.
  void fill_ring(std::array<PieceNodes, n_pieces>& pieces, std::array<std::vector<double>, 4>& ring_phi) {
    PassageCounts const& c = counts_;
    double const thickness = options_.ring_thickness * airfoil_.chord();
    int const n_up = c.leading_upper + c.side + c.trailing_upper, n_down = c.leading_lower + c.side + c.trailing_lower;
    double const first = std::max(options_.first_cell / options_.ring_thickness,
                                  demo::first_of_geometric(c.layers, options_.max_growth));
    Fractions const off_wall = demo::geometric_spacing(c.layers, first);
    last_layer_ = thickness * (1 - off_wall[c.layers - 1]);
    auto const ring = [&](Piece piece, auto const& phi_of) {
      PieceNodes& nodes = pieces[piece];
      std::vector<double>& places = ring_phi[piece];
      places.resize(nodes.ni);
      for (int i = 0; i < nodes.ni; ++i) {
        double const phi = places[i] = phi_of(i);
        Point2 const wall = airfoil_.point(phi), normal = normal_at(airfoil_, phi);
        for (int k = 0; k < nodes.nk; ++k) nodes.at(i, k) = wall + (off_wall[k] * thickness) * normal;
      }
      Line outer(nodes.ni);
      for (int i = 0; i < nodes.ni; ++i) outer[i] = nodes.at(i, nodes.nk - 1);
      return outer;
    };
    le_ = ring(ring_le, [&](int i) {
      int const n = i - c.leading_lower;
      return n >= 0 ? phi_up(n) : phi_down(-n);
    });
    top_side_ = ring(ring_upper, [&](int i) { return phi_up(c.leading_upper + i); });
    te_ = ring(ring_te, [&](int i) {
      int const n = i - c.trailing_upper;
      return n <= 0 ? phi_up(n_up + n) : phi_down(n_down - n);
    });
    bottom_side_ = reversed(ring(ring_lower, [&](int i) { return phi_down(c.leading_lower + c.side - i); }));
  }

  void find_corners() {
    PassageCounts const& c = counts_;
    leading_upper_ = {le_.back(), normal_at(airfoil_, phi_up(c.leading_upper))};
    leading_lower_ = {le_.front(), normal_at(airfoil_, phi_down(c.leading_lower))};
    trailing_upper_ = {te_.front(), normal_at(airfoil_, phi_up(c.leading_upper + c.side))};
    trailing_lower_ = {te_.back(), normal_at(airfoil_, phi_down(c.leading_lower + c.side))};
  }

  /// A point so much of half the pitch above the camber line: 1 and -1 on the periodics.
  [[nodiscard]] Point2 station(double x, double fraction) const {
    return {x, airfoil_.camber(x) + fraction * half_pitch_};
  }

  /// Draws one edge upstream and one downstream of the blade, each from periodic to periodic.
  void draw_pitchwise_edges() {
    Point2 const c1 = leading_upper_.at, c2 = leading_lower_.at, c3 = trailing_upper_.at, c4 = trailing_lower_.at;
    x_up_ = 0.5 * (c1.x + c2.x);
    x_down_ = 0.5 * (c3.x + c4.x);
    Point2 const u1 = station(x_up_, 1), l1 = station(x_up_, -1), u2 = station(x_down_, 1), l2 = station(x_down_, -1);
    Point2 const cross1 = unit((u1 - c1) + (c2 - l1)), cross2 = unit((u2 - c3) + (c4 - l2));
    from_ring_up_ = demo::geometric_spacing(counts_.upper, last_layer_ / (0.5 * (length(u1 - c1) + length(u2 - c3))));
    to_ring_low_ =
        reversed(demo::geometric_spacing(counts_.lower, last_layer_ / (0.5 * (length(l1 - c2) + length(l2 - c4)))));
    upper_1_ = from_corner(leading_upper_, -30, u1, cross1, from_ring_up_);
    upper_2_ = from_corner(trailing_upper_, 30, u2, cross2, from_ring_up_);
    lower_1_ = to_corner(l1, cross1, leading_lower_, 30, to_ring_low_);
    lower_2_ = to_corner(l2, cross2, trailing_lower_, -30, to_ring_low_);
  }

  /// Draws the edges from inlet to ring and from ring to outlet.
  void draw_streamwise_edges() {
    PassageCounts const& c = counts_;
    auto const share = [](int corner, int beyond) { return 0.15 + 0.5 * corner / double(corner + beyond); };
    Point2 const flow_in = direction(airfoil_.inlet_angle()), flow_out = direction(airfoil_.outlet_angle());
    Point2 const i1 = station(options_.inlet, share(c.leading_upper, c.upper));
    Point2 const i2 = station(options_.inlet, -share(c.leading_lower, c.lower));
    Point2 const o1 = station(options_.outlet, share(c.trailing_upper, c.upper));
    Point2 const o2 = station(options_.outlet, -share(c.trailing_lower, c.lower));
    in_ = reversed(demo::geometric_spacing(
        c.inlet, 1.5 * last_layer_ / (0.5 * (length(leading_upper_.at - i1) + length(leading_lower_.at - i2)))));
    out_ = demo::geometric_spacing(
        c.outlet, 1.5 * last_layer_ / (0.5 * (length(o1 - trailing_upper_.at) + length(o2 - trailing_lower_.at))));
    inlet_up_ = to_corner(i1, flow_in, leading_upper_, 30, in_);
    inlet_low_ = to_corner(i2, flow_in, leading_lower_, -30, in_);
    outlet_up_ = from_corner(trailing_upper_, -30, o1, flow_out, out_);
    outlet_low_ = from_corner(trailing_lower_, 30, o2, flow_out, out_);
  }

  [[nodiscard]] Line periodic_line(double x0, double x1, Fractions const& s, double side) const {
    Line line(s.size());
    for (std::size_t n = 0; n < s.size(); ++n) line[n] = station(x0 + (x1 - x0) * s[n], side);
    return line;
  }

  /// The periodics take the mean spacing of both blade sides.
  void fill_beside_blade(std::array<PieceNodes, n_pieces>& pieces) const {
    Fractions along = arc_fractions(top_side_);
    Fractions const along_low = arc_fractions(bottom_side_);
    for (std::size_t n = 0; n < along.size(); ++n) along[n] = 0.5 * (along[n] + along_low[n]);
    along = towards_even(along, 0.6);
    fill(pieces[upper], top_side_, periodic_line(x_up_, x_down_, along, 1), upper_1_, upper_2_);
    fill(pieces[lower], periodic_line(x_up_, x_down_, along, -1), bottom_side_, lower_1_, lower_2_);
  }

  /// The inlet itself is straight along theta, as the outlet is.
  void fill_inlet(std::array<PieceNodes, n_pieces>& pieces) const {
    double const x = options_.inlet;
    Point2 const i1 = inlet_up_.front(), i2 = inlet_low_.front();
    Line const middle = pitch_line(i2, i1, even(le_.size()));
    Line const up = pitch_line(i1, station(x, 1), towards_even(from_ring_up_, 0.3));
    Line const low = pitch_line(station(x, -1), i2, towards_even(to_ring_low_, 0.3));
    fill(pieces[inlet_middle], inlet_low_, inlet_up_, middle, le_);
    fill(pieces[inlet_upper], inlet_up_, periodic_line(x, x_up_, in_, 1), up, upper_1_);
    fill(pieces[inlet_lower], periodic_line(x, x_up_, in_, -1), inlet_low_, low, lower_1_);
  }

  void fill_outlet(std::array<PieceNodes, n_pieces>& pieces) const {
    double const x = options_.outlet;
    Point2 const o1 = outlet_up_.back(), o2 = outlet_low_.back();
    Line const middle = pitch_line(o2, o1, even(te_.size()));
    Line const up = pitch_line(o1, station(x, 1), towards_even(from_ring_up_, 0.3));
    Line const low = pitch_line(station(x, -1), o2, towards_even(to_ring_low_, 0.3));
    fill(pieces[outlet_middle], outlet_low_, outlet_up_, reversed(te_), middle);
    fill(pieces[outlet_upper], outlet_up_, periodic_line(x_down_, x, out_, 1), upper_2_, up);
    fill(pieces[outlet_lower], periodic_line(x_down_, x, out_, -1), outlet_low_, lower_2_, low);
  }

  PassageOptions const& options_;
  PassageCounts const& counts_;
  Airfoil airfoil_;
  BladeSide up_, down_;
  double half_pitch_;
  double last_layer_ = 0;                  ///< height of the ring's outermost cells
  Line le_, top_side_, te_, bottom_side_;  ///< the outer edge of the ring
  RingCorner leading_upper_, leading_lower_, trailing_upper_, trailing_lower_;
  double x_up_ = 0, x_down_ = 0;                ///< of the pitchwise edges on the periodics
  Fractions from_ring_up_, to_ring_low_;        ///< of pitchwise edges
  Fractions in_, out_;                          ///< of streamwise edges
  Line upper_1_, upper_2_, lower_1_, lower_2_;  ///< pitchwise edges upstream (1) and downstream (2) of the blade
  Line inlet_up_, inlet_low_, outlet_up_, outlet_low_;  ///< streamwise edges
};

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
  PassageSection section(options_, counts_, annulus_, span);
  section.fill_pieces(pieces_, ring_phi_);
  if (options_.tip != BladeTip::none) fill_tip(options_, section.airfoil(), ring_phi_, pieces_);
  return pieces_;
}

}  // namespace gridmorph::passage
