// Profiles of revolution from scattered nodes: sort, merge what is one point up to noise, thin, then slopes and curvatures.
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace gridmorph {

namespace {

using Point = std::pair<double, double>;
using Points = std::vector<Point>;

/// Below this number the points are a table somebody wrote, not nodes of a mesh: every one of them is meant.
constexpr std::size_t least_for_statistics = 16;

double median(std::vector<double>& v) {
  if (v.empty()) return 0;
  auto const middle = v.begin() + std::ptrdiff_t(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// Value at x of the polynomial through n points (Lagrange).
double interpolate(Point const* const* p, int n, double x) {
  double sum = 0;
  for (int j = 0; j < n; ++j) {
    double w = 1;
    for (int k = 0; k < n; ++k)
      if (k != j) w *= (x - p[k]->first) / (p[j]->first - p[k]->first);
    sum += w * p[j]->second;
  }
  return sum;
}

/// How far points typically lie off a curve through their neighbours. Where neighbours nearly coincide the chord
/// between them tells, where they are far apart the cubic through four of them; of the two medians the smaller is
/// taken, so that neither curvature nor amplified noise passes for noise.
double estimate_noise(Points const& p) {
  if (p.size() < least_for_statistics) return 0;
  std::vector<double> chord, cubic;
  for (std::size_t i = 2; i + 2 < p.size(); ++i) {
    Point const &a = p[i - 1], &b = p[i + 1];
    double const t = b.first > a.first ? (p[i].first - a.first) / (b.first - a.first) : 0.5;
    chord.push_back(std::abs(p[i].second - (a.second + t * (b.second - a.second))));
    Point const* four[4] = {&p[i - 2], &a, &b, &p[i + 2]};
    if (four[0]->first < four[1]->first && four[1]->first < four[2]->first && four[2]->first < four[3]->first)
      cubic.push_back(std::abs(p[i].second - interpolate(four, 4, p[i].first)));
  }
  double const by_chord = median(chord);
  return cubic.size() * 2 < chord.size() ? by_chord : std::min(by_chord, median(cubic));
}

std::string place(double axial, double r_lo, double r_hi) {
  return "at axial position " + std::to_string(axial) + " the radius is " + std::to_string(r_lo) + " and " +
         std::to_string(r_hi);
}

/// Points closer than `width` become one, in the middle of their box (exact where they agree).
Points merge(Points const& p, double width, double allowed_spread) {
  Points out;
  for (std::size_t i = 0; i < p.size();) {
    std::size_t end = i;
    double lo = p[i].second, hi = lo;
    for (; end < p.size() && p[end].first - p[i].first <= width; ++end) {
      lo = std::min(lo, p[end].second);
      hi = std::max(hi, p[end].second);
    }
    if (hi - lo > allowed_spread)
      throw MotionError(place(p[i].first, lo, hi) +
                        ": not one function of the axial position (a wall at "
                        "constant axial position, two surfaces at "
                        "once, or no surface of revolution)");
    out.emplace_back(p[i].first + 0.5 * (p[end - 1].first - p[i].first), lo + 0.5 * (hi - lo));
    i = end;
  }
  return out;
}

/// Drops points that lie much closer together than their surroundings: a pair of them would turn noise into slope.
Points thin(Points const& p, double least) {
  if (p.size() < least_for_statistics) return p;
  constexpr std::size_t reach = 4;
  Points out{p.front()};
  for (std::size_t i = 1; i < p.size(); ++i) {
    std::size_t const a = i > reach ? i - reach : 0, b = std::min(i + reach, p.size() - 1);
    double const spacing = (p[b].first - p[a].first) / double(b - a);
    if (p[i].first - out.back().first >= std::max(0.05 * spacing, least))
      out.push_back(p[i]);
    else if (i + 1 == p.size() && out.size() > 1)
      out.back() = p[i];
  }
  return out;
}

/// Slopes and second derivatives at the points of a profile.
class Slopes {
 public:
  Slopes(Points const& p, double noise) : p_(p), n_(int(p.size())) { find_kinks(noise); }

  std::vector<double> all() const {
    std::vector<double> s(p_.size());
    for (int i = 0; i < n_; ++i) s[i] = kink_[i] ? at_kink(i) : derivative(i, stencil(i));
    // A short table does not tell bends from kinks: it is drawn without overshoot everywhere.
    if (is_table())
      for (int i = 0; i < n_; ++i) s[i] = limited(i, s[i]);
    return s;
  }

  /// Second derivative at the lower and upper end of each piece: that of the local polynomial where the piece is smooth at
  /// both ends, otherwise that of the cubic with the same slopes, which the quintic then is.
  std::vector<double> curvatures(std::vector<double> const& slope) const {
    std::vector<double> c;
    for (int i = 0; i + 1 < n_; ++i) {
      double const h = p_[i + 1].first - p_[i].first, m = secant(i);
      bool const smooth_piece = !is_table() && !kink_[i] && !kink_[i + 1];
      c.push_back(smooth_piece ? second_derivative(i, stencil(i)) : (6 * m - 4 * slope[i] - 2 * slope[i + 1]) / h);
      c.push_back(smooth_piece ? second_derivative(i + 1, stencil(i + 1))
                               : (2 * slope[i] + 4 * slope[i + 1] - 6 * m) / h);
    }
    return c;
  }

 private:
  /// Numbers of the points beside one, without it, that a polynomial through it also passes through.
  using Stencil = std::vector<int>;

  [[nodiscard]] bool is_table() const { return p_.size() < least_for_statistics; }

  double secant(int i) const { return (p_[i + 1].second - p_[i].second) / (p_[i + 1].first - p_[i].first); }

  /// A kink is a second difference that stands out from those beside it, alone (kink at a point) or with its neighbour
  /// (kink between two points). In a smooth profile a second difference is about the mean of those beside it.
  void find_kinks(double noise) {
    constexpr double stands_out = 4;
    kink_.assign(p_.size(), false);
    std::vector<double> d(p_.size(), 0), floor(p_.size(), 0);
    for (int i = 1; i + 1 < n_; ++i) {
      double const l = p_[i].first - p_[i - 1].first, r = p_[i + 1].first - p_[i].first;
      d[i] = std::abs(secant(i) - secant(i - 1)) / (l + r);
      floor[i] = 8 * noise * (1 / l + 1 / r) / (l + r);
    }
    auto const beside = [&](int i) { return i >= 1 && i + 1 < n_ ? d[i] : 0.0; };
    for (int i = 1; i + 1 < n_; ++i) {
      double around = std::max(beside(i - 1), beside(i + 1));
      if (i == 1) around = std::max(around, beside(3));
      if (i + 2 == n_) around = std::max(around, beside(n_ - 4));
      if (d[i] > stands_out * around + floor[i]) kink_[i] = true;
      if (i < 2 || i + 3 >= n_) continue;
      around = std::max(beside(i - 1), beside(i + 2));
      if (std::min(d[i], d[i + 1]) > stands_out * around + std::max(floor[i], floor[i + 1]))
        kink_[i] = kink_[i + 1] = true;
    }
  }

  /// Distance between points of a stencil at i, at least: points much closer together than their surroundings tell little about a slope
  /// beyond their noise, which their distance divides.
  double apart(int i) const {
    if (is_table()) return 0;
    constexpr int reach = 4;
    int const a = std::max(0, i - reach), b = std::min(n_ - 1, i + reach);
    return 0.4 * (p_[b].first - p_[a].first) / (b - a);
  }

  /// Appends the points that a stencil at i may use on one side: up to `most`, up to and including the next kink, none of
  /// them nearer than `apart` to the one before; but always the last before a kink or an end if there is no other.
  void reach(int i, int step, int most, double apart, Stencil& out) const {
    int last = i;
    for (int j = i + step, found = 0; j >= 0 && j < n_ && found < most; j += step) {
      bool const ends = kink_[j] || j == 0 || j == n_ - 1;
      if (std::abs(p_[j].first - p_[last].first) >= apart || (ends && found == 0)) {
        out.push_back(j);
        last = j;
        ++found;
      }
      if (kink_[j]) break;
    }
  }

  /// Derivative at point i of the polynomial through it and a stencil, from differences to the value at i.
  double derivative(int i, Stencil const& stencil) const {
    double sum = 0;
    for (int const j : stencil) {
      double w = 1 / (p_[j].first - p_[i].first);
      for (int const k : stencil)
        if (k != j) w *= (p_[i].first - p_[k].first) / (p_[j].first - p_[k].first);
      sum += w * (p_[j].second - p_[i].second);
    }
    return sum;
  }

  /// Second derivative at point i of the same polynomial. With divided differences q_j = (r_j - r_i) / (x_j - x_i), which
  /// are r' at x_i plus (x - x_i) / 2 times r'' and so on, it is twice the derivative there of the polynomial through q.
  double second_derivative(int i, Stencil const& stencil) const {
    double sum = 0;
    for (int const j : stencil) {
      double const q = (p_[j].second - p_[i].second) / (p_[j].first - p_[i].first);
      // Derivative at x_i of the Lagrange factor of node j among the nodes other than i.
      double slope = 0;
      for (int const m : stencil) {
        if (m == j) continue;
        double w = 1 / (p_[j].first - p_[m].first);
        for (int const k : stencil)
          if (k != j && k != m) w *= (p_[i].first - p_[k].first) / (p_[j].first - p_[k].first);
        slope += w;
      }
      sum += slope * q;
    }
    return 2 * sum;
  }

  /// Points on both sides: seven in the middle; five in all where a side is short.
  Stencil stencil(int i) const {
    constexpr int each_side = 3, least = 4;
    double const gap = apart(i);
    Stencil left, right;
    reach(i, -1, each_side, gap, left);
    reach(i, +1, each_side, gap, right);
    int const n_left = int(left.size()), n_right = int(right.size());
    if (n_left < each_side) {
      right.clear();
      reach(i, +1, std::max(each_side, least - n_left), gap, right);
    }
    if (n_right < each_side) {
      left.clear();
      reach(i, -1, std::max(each_side, least - n_right), gap, left);
    }
    left.insert(left.end(), right.begin(), right.end());
    return left;
  }

  double at_kink(int i) const {
    constexpr int one_side = 3;
    Stencil left, right;
    reach(i, -1, one_side, apart(i), left);
    reach(i, +1, one_side, apart(i), right);
    double const before = derivative(i, left), after = derivative(i, right);
    return before * after <= 0 ? 0 : limited(i, std::abs(before) < std::abs(after) ? before : after);
  }

  /// Fritsch and Carlson (1980): no overshoot while a slope has the sign of the secants beside it and is at most three
  /// times as large.
  double limited(int i, double slope) const {
    for (int j : {std::max(i - 1, 0), std::min(i, n_ - 2)}) {
      if (slope * secant(j) <= 0) return 0;
      slope = std::copysign(std::min(std::abs(slope), 3 * std::abs(secant(j))), slope);
    }
    return slope;
  }

  Points const& p_;
  int n_;
  std::vector<bool> kink_;
};

/// As many buckets as pieces (see ProfileView::piece).
std::vector<int> bucket_pieces(std::vector<kernels::ProfileKnot> const& knots) {
  int const pieces = int(knots.size()) - 1;
  double const first = knots.front().axial, last = knots.back().axial;
  std::vector<int> out;
  int piece = 0;
  for (int bucket = 0; bucket <= pieces; ++bucket) {
    double const lower = first + (last - first) * bucket / pieces;
    while (piece + 1 < pieces && knots[piece + 1].axial <= lower) ++piece;
    out.push_back(piece);
  }
  return out;
}

}  // namespace

RevolutionProfile RevolutionProfile::from_points(std::vector<Point> points) {
  for (auto const& [a, r] : points)
    if (!std::isfinite(a) || !std::isfinite(r))
      throw MotionError("a point of the profile, (" + std::to_string(a) + ", " + std::to_string(r) +
                        "), is not finite");
  if (points.size() < 2) throw MotionError("a profile needs at least two points at different axial positions");

  Points const original = points;
  std::sort(points.begin(), points.end());
  double const length = points.back().first - points.front().first;
  double r_lo = std::numeric_limits<double>::infinity(), r_hi = -r_lo;
  for (auto const& [a, r] : points) {
    r_lo = std::min(r_lo, r);
    r_hi = std::max(r_hi, r);
  }
  double const size = std::max({length, std::abs(r_lo), std::abs(r_hi)});
  if (!(length > 1e-9 * size))
    throw MotionError(place(points.front().first, r_lo, r_hi) +
                      " and there is no other axial position: a surface of "
                      "revolution needs an extent along the axis");

  double const noise = estimate_noise(points);
  if (noise > 0.01 * (r_hi - r_lo) && noise > 1e-6 * size)
    throw MotionError("between axial positions " + std::to_string(points.front().first) + " and " +
                      std::to_string(points.back().first) + " the radius scatters by " + std::to_string(noise) +
                      " about any curve: not one surface of revolution");

  double const width = std::min(std::max(1e-9 * length, 16 * noise), 1e-4 * length);
  points = thin(merge(points, width, 1e-3 * size), std::max(1e-7 * length, std::min(300 * noise, 1e-3 * length)));
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    double const rise = std::abs(points[i + 1].second - points[i].second);
    if (rise > 1e-3 * size && rise > 100 * (points[i + 1].first - points[i].first))
      throw MotionError(place(points[i].first, points[i].second, points[i + 1].second) +
                        ": the wall is at constant axial position there, which no radius as "
                        "a function of it describes");
  }

  RevolutionProfile profile;
  Slopes const slopes(points, std::max(noise, 4e-16 * size));
  std::vector<double> const slope = slopes.all(), curvature = slopes.curvatures(slope);
  for (std::size_t n = 0; n < points.size(); ++n) {
    kernels::ProfileKnot knot{points[n].first, points[n].second, slope[n], {0, 0}};
    if (n + 1 < points.size()) std::copy_n(curvature.begin() + std::ptrdiff_t(2 * n), 2, knot.curvature);
    profile.knots.push_back(knot);
  }
  profile.bucket_piece = bucket_pieces(profile.knots);
  for (auto const& [a, r] : original) profile.deviation = std::max(profile.deviation, std::abs(r - profile(a)));
  return profile;
}

}  // namespace gridmorph
