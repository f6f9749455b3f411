#include <gridmorph/motion/turbomachinery/wall_curve.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double distance(MeridionalPoint const& a, MeridionalPoint const& b) {
  return std::hypot(a.axial - b.axial, a.radius - b.radius);
}

/// Arc length of a profile between two abscissae of one piece (Gauss and Legendre, five points).
double arc_length(RevolutionProfile const& profile, double a, double b) {
  constexpr std::array<double, 3> place{0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> weight{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  kernels::ProfileView const view = profile.view();
  double const middle = 0.5 * (a + b), half = 0.5 * (b - a);
  auto const stretch = [&](double x) { return std::hypot(1.0, view.derivative(x)); };
  double sum = weight[0] * stretch(middle);
  for (int n = 1; n < 3; ++n)
    sum += weight[n] * (stretch(middle - half * place[n]) + stretch(middle + half * place[n]));
  return std::abs(half) * sum;
}

/// Abscissa over arc length from piece.first to piece.last.
RevolutionProfile abscissa_over_arc_length(WallPiece const& piece) {
  constexpr int least = 33;
  double const lo = std::min(piece.first, piece.last), hi = std::max(piece.first, piece.last);
  std::vector<double> x{lo};
  for (kernels::ProfileKnot const& knot : piece.profile.knots)
    if (knot.axial > lo && knot.axial < hi) x.push_back(knot.axial);
  x.push_back(hi);
  int const parts = std::max(1, (least + int(x.size()) - 3) / (int(x.size()) - 1));
  if (piece.first > piece.last) std::reverse(x.begin(), x.end());
  std::vector<std::pair<double, double>> table{{0, x.front()}};
  for (std::size_t n = 0; n + 1 < x.size(); ++n)
    for (int part = 1; part <= parts; ++part) {
      double const next = part == parts ? x[n + 1] : x[n] + (x[n + 1] - x[n]) * part / parts;
      table.emplace_back(table.back().first + arc_length(piece.profile, table.back().second, next), next);
    }
  return RevolutionProfile::from_points(std::move(table));
}

void reverse(std::vector<WallPiece>& chain) {
  std::reverse(chain.begin(), chain.end());
  for (WallPiece& piece : chain) std::swap(piece.first, piece.last);
}

MeridionalPoint begin_of(std::vector<WallPiece> const& chain) { return chain.front().at(chain.front().first); }
MeridionalPoint end_of(std::vector<WallPiece> const& chain) { return chain.back().at(chain.back().last); }

double lowest_radius(std::vector<WallPiece> const& chain) {
  double low = inf;
  for (WallPiece const& piece : chain) low = std::min({low, piece.at(piece.first).radius, piece.at(piece.last).radius});
  return low;
}

}  // namespace

WallCurve::WallCurve(std::vector<WallPiece> pieces) {
  for (WallPiece& piece : pieces) {
    MeridionalPoint const next = piece.at(piece.first);
    if (!stretches_.empty()) {
      Stretch const& before = stretches_.back();
      MeridionalPoint const here = before.piece.at(before.piece.last);
      double const gap = distance(here, next);
      if (gap > 1e-6 * before.end) {
        stretches_.push_back({{}, length_, length_ + gap, {}, here, next});
        length_ += gap;
      }
    }
    Stretch stretch{std::move(piece), length_, 0, {}, {}, {}};
    stretch.abscissa = abscissa_over_arc_length(stretch.piece);
    length_ += stretch.abscissa.knots.back().axial;
    stretch.end = length_;
    stretches_.push_back(std::move(stretch));
  }
}

MeridionalPoint WallCurve::at(double s) const {
  std::size_t n = 0;
  while (n + 1 < stretches_.size() && s > stretches_[n].end) ++n;
  Stretch const& stretch = stretches_[n];
  if (!stretch.piece.profile.knots.empty()) return stretch.piece.at(stretch.abscissa(s - stretch.begin));
  double const t = (s - stretch.begin) / (stretch.end - stretch.begin);
  return {stretch.gap_from.axial + t * (stretch.gap_to.axial - stretch.gap_from.axial),
          stretch.gap_from.radius + t * (stretch.gap_to.radius - stretch.gap_from.radius)};
}

std::vector<WallCurve> chain_walls(std::vector<WallPiece> pieces) {
  if (pieces.size() < 2)
    throw MotionError(
        "where the flow path turns from axial to radial, hub and case must both slip on a surface of "
        "revolution; only " +
        std::to_string(pieces.size()) + " such surface was found in the zones of this row");
  std::vector<std::vector<WallPiece>> chains;
  for (WallPiece& piece : pieces) chains.push_back({std::move(piece)});
  // Hub and case are two chains: pieces are joined at the ends nearest to one another until two are left.
  while (chains.size() > 2) {
    std::size_t best_a = 0, best_b = 1;
    bool best_turn_a = false, best_turn_b = false;
    double least = inf;
    for (std::size_t a = 0; a < chains.size(); ++a)
      for (std::size_t b = a + 1; b < chains.size(); ++b)
        for (bool const turn_a : {false, true})
          for (bool const turn_b : {false, true}) {
            double const gap = distance(turn_a ? begin_of(chains[a]) : end_of(chains[a]),
                                        turn_b ? end_of(chains[b]) : begin_of(chains[b]));
            if (gap >= least) continue;
            least = gap;
            best_a = a;
            best_b = b;
            best_turn_a = turn_a;
            best_turn_b = turn_b;
          }
    auto &first = chains[best_a], &second = chains[best_b];
    if (best_turn_a) reverse(first);
    if (best_turn_b) reverse(second);
    std::move(second.begin(), second.end(), std::back_inserter(first));
    chains.erase(chains.begin() + std::ptrdiff_t(best_b));
  }
  if (lowest_radius(chains[1]) < lowest_radius(chains[0])) std::swap(chains[0], chains[1]);
  // The hub begins at its smaller axial position, and the case where it is nearer to the hub's begin.
  MeridionalPoint const a = begin_of(chains[0]), b = end_of(chains[0]);
  if (std::pair(b.axial, b.radius) < std::pair(a.axial, a.radius)) reverse(chains[0]);
  auto const apart = [&] {
    return distance(begin_of(chains[0]), begin_of(chains[1])) + distance(end_of(chains[0]), end_of(chains[1]));
  };
  double const as_is = apart();
  reverse(chains[1]);
  if (apart() >= as_is) reverse(chains[1]);
  std::vector<WallCurve> out;
  for (auto& chain : chains) out.emplace_back(std::move(chain));
  return out;
}

FlowCoordinates::FlowCoordinates(WallCurve hub, WallCurve shroud)
    : hub_(std::move(hub)), shroud_(std::move(shroud)), length_(0.5 * (hub_.length() + shroud_.length())) {
  constexpr int n_lines = 257;
  for (int n = 0; n < n_lines; ++n) {
    lines_.push_back(line(double(n) / (n_lines - 1)));
    Line const& l = lines_.back();
    if (!(std::hypot(l.axial, l.radius) > 1e-9 * length_))
      throw MotionError("hub and case meet at axial position " + std::to_string(l.from.axial) + " and radius " +
                        std::to_string(l.from.radius) + ": there is no span between them; check the slip rules");
  }
}

FlowCoordinates::Line FlowCoordinates::line(double fraction) const {
  MeridionalPoint const h = hub_.at(fraction * hub_.length()), s = shroud_.at(fraction * shroud_.length());
  return {h, s.axial - h.axial, s.radius - h.radius};
}

MeridionalPoint FlowCoordinates::point(FlowPosition const& f) const {
  Line const l = line(f.m / length_);
  return {l.from.axial + f.h * l.axial, l.from.radius + f.h * l.radius};
}

double FlowCoordinates::height(double m) const {
  Line const l = line(m / length_);
  return std::hypot(l.axial, l.radius);
}

FlowPosition FlowCoordinates::position(MeridionalPoint const& p) const {
  auto const beside = [&](double fraction) { return line(fraction).beside(p); };
  auto const off_middle = [&](Line const& l) { return std::abs(l.along(p) - 0.5); };
  int const last = int(lines_.size()) - 1;
  // Between which lines the point lies; lines that meet outside of the annulus leave several candidates.
  int found = -1;
  double nearest = inf;
  for (int n = 0; n < last; ++n) {
    double const a = lines_[n].beside(p), b = lines_[n + 1].beside(p);
    if ((a < 0) == (b < 0) && a != 0 && b != 0) continue;
    if (double const off = off_middle(lines_[n]); off < nearest) {
      nearest = off;
      found = n;
    }
  }
  double lo = double(found) / last, hi = double(found + 1) / last;
  bool const inside = found >= 0 && nearest < 1.5;
  if (!inside) {
    // Beyond an end: on the continued curves, without a bracket.
    auto const off = [&](Line const& l) {
      return std::hypot(p.axial - l.from.axial - 0.5 * l.axial, p.radius - l.from.radius - 0.5 * l.radius);
    };
    bool const before = off(lines_.front()) < off(lines_.back());
    lo = before ? 0 : 1;
    hi = before ? -1.0 / last : 1 + 1.0 / last;
  }
  // Secants through the last two places, halves of the bracket where they leave it.
  constexpr int most_steps = 60;
  constexpr double converged = 2e-16;
  double a = lo, f_a = beside(a), at = hi, f = beside(at), f_lo = f_a;
  if (f_a == 0) std::swap(a, at), std::swap(f_a, f);
  for (int n = 0; n < most_steps && f != 0 && f != f_a; ++n) {
    double next = at - f * (at - a) / (f - f_a);
    if (inside && !(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
    if (!inside && std::abs(next - 0.5) > 2) break;
    a = at;
    f_a = f;
    at = next;
    f = beside(at);
    ((f < 0) == (f_lo < 0) ? lo : hi) = at;
    if (std::abs(at - a) <= converged) break;
  }
  return {at * length_, line(at).along(p)};
}

}  // namespace gridmorph
