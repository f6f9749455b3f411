// Profiles of revolution from scattered nodes: sort, merge what is one point up to noise, thin, then slopes and
// curvatures.
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_many.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace gridmorph {

namespace {

using Point = std::pair<double, double>;
using Points = std::vector<Point>;

/// The number of points below which they are a table somebody wrote, not nodes of a mesh: every one of them is meant.
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

/// How far point i is off the polynomial through `each_side` points on both sides of it; -1 where they are not so many
/// different ones.
double off_polynomial(Points const& p, std::size_t i, std::size_t each_side) {
  if (i < each_side || i + each_side >= p.size()) return -1;
  std::array<Point const*, 6> beside{};
  std::size_t n = 0;
  for (std::size_t k = i - each_side; k <= i + each_side; ++k) {
    if (k == i) continue;
    if (n > 0 && p[k].first <= beside[n - 1]->first) return -1;
    beside[n++] = &p[k];
  }
  return std::abs(p[i].second - interpolate(beside.data(), int(n), p[i].first));
}

/// How far points typically lie off a curve through their neighbours. Where neighbours nearly coincide the chord
/// between them tells, where they are far apart the cubic through four of them, where they lie in pairs the quintic
/// through six; of the medians the smallest is taken, so that neither curvature nor amplified noise passes for noise.
double estimate_noise(Points const& p) {
  if (p.size() < least_for_statistics) return 0;
  std::vector<double> chord(p.size() - 4), cubic(chord.size()), quintic(chord.size());
  detail::for_many("gridmorph::profile::noise", Index(chord.size()), [&](Index n) {
    std::size_t const i = std::size_t(n) + 2;
    Point const &a = p[i - 1], &b = p[i + 1];
    double const t = b.first > a.first ? (p[i].first - a.first) / (b.first - a.first) : 0.5;
    chord[n] = std::abs(p[i].second - (a.second + t * (b.second - a.second)));
    cubic[n] = off_polynomial(p, i, 2);
    quintic[n] = off_polynomial(p, i, 3);
  });
  double noise = median(chord);
  for (std::vector<double>* const off : {&cubic, &quintic}) {
    std::erase_if(*off, [](double v) { return !(v >= 0); });
    if (off->size() * 2 >= chord.size()) noise = std::min(noise, median(*off));
  }
  return noise;
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

/// Drops points nearer than `least` to the one before: a pair of them would turn noise into slope.
Points thin(Points const& p, double least) {
  if (p.size() < least_for_statistics) return p;
  Points out{p.front()};
  for (std::size_t i = 1; i < p.size(); ++i) {
    if (p[i].first - out.back().first >= least)
      out.push_back(p[i]);
    else if (i + 1 == p.size() && out.size() > 1)
      out.back() = p[i];
  }
  return out;
}

/// Least squares for a few unknowns by Householder reflections; rows in descending order of their weights.
class LeastSquares {
 public:
  static constexpr int most_unknowns = 6;
  using Row =
      std::array<double, most_unknowns + 1>;  ///< factors of the unknowns, then the right-hand side at [unknowns]

  explicit LeastSquares(int unknowns) : n_(unknowns) {}

  void add(Row const& row) { rows_.push_back(row); }

  Row solution() {
    Row x{};
    for (int c = 0; c < n_; ++c) reflect(c);
    for (int c = n_ - 1; c >= 0; --c) {
      double rest = at(c, n_);
      for (int k = c + 1; k < n_; ++k) rest -= at(c, k) * x[k];
      x[c] = at(c, c) != 0 ? rest / at(c, c) : 0;
    }
    return x;
  }

 private:
  double& at(int row, int column) { return rows_[row][column]; }

  /// Makes what is below the diagonal of one column zero.
  void reflect(int c) {
    int const m = int(rows_.size());
    double square = 0;
    for (int r = c; r < m; ++r) square += at(r, c) * at(r, c);
    double const diagonal = std::copysign(std::sqrt(square), -at(c, c));
    if (diagonal == 0) return;
    at(c, c) -= diagonal;
    double const half = -diagonal * at(c, c);  // of the square of the vector that stands in the column now
    for (int k = c + 1; k <= n_; ++k) {
      double dot = 0;
      for (int r = c; r < m; ++r) dot += at(r, c) * at(r, k);
      for (int r = c; r < m; ++r) at(r, k) -= dot / half * at(r, c);
    }
    at(c, c) = diagonal;
  }

  int n_;
  std::vector<Row> rows_;
};

/// Slopes and second derivatives at the points of a profile.
class Slopes {
 public:
  Slopes(Points const& p, double noise) : p_(p), n_(int(p.size())), noise_(noise), bend_(p.size(), 0.0) {
    find_kinks();
  }

  std::vector<double> all() {
    std::vector<double> s(p_.size());
    detail::for_many("gridmorph::profile::slopes", Index(n_), [&](Index n) {
      int const i = int(n);
      if (kink_[i]) {
        s[i] = at_kink(i);
      } else {
        Derivatives const d = derivatives(i, stencil(i));
        s[i] = d.first;
        bend_[i] = d.second;
      }
    });
    // A short table does not tell bends from kinks: it is drawn without overshoot everywhere.
    if (is_table())
      for (int i = 0; i < n_; ++i) s[i] = limited(i, s[i]);
    return s;
  }

  /// What all() leaves open, the second derivative at the lower and upper end of each piece: that of the local
  /// polynomial where the piece is smooth at both ends, otherwise that of the cubic with the same slopes, which the
  /// quintic then is.
  std::vector<double> curvatures(std::vector<double> const& slope) const {
    std::vector<double> c;
    for (int i = 0; i + 1 < n_; ++i) {
      double const h = p_[i + 1].first - p_[i].first, m = secant(i);
      bool const smooth_piece = !is_table() && !kink_[i] && !kink_[i + 1];
      c.push_back(smooth_piece ? bend_[i] : (6 * m - 4 * slope[i] - 2 * slope[i + 1]) / h);
      c.push_back(smooth_piece ? bend_[i + 1] : (2 * slope[i] + 4 * slope[i + 1] - 6 * m) / h);
    }
    return c;
  }

 private:
  /// Numbers of the points beside one, without it, that a polynomial through it also passes through: a few, kept
  /// without an allocation.
  class Stencil {
   public:
    Stencil() = default;
    Stencil(int const* first, int const* last) {
      for (; first != last; ++first) push_back(*first);
    }
    void push_back(int point) { points_[std::size_t(n_++)] = point; }
    [[nodiscard]] std::size_t size() const { return std::size_t(n_); }
    [[nodiscard]] int operator[](int n) const { return points_[std::size_t(n)]; }
    [[nodiscard]] int back() const { return points_[std::size_t(n_) - 1]; }
    [[nodiscard]] int* begin() { return points_.data(); }
    [[nodiscard]] int* end() { return points_.data() + n_; }
    [[nodiscard]] int const* begin() const { return points_.data(); }
    [[nodiscard]] int const* end() const { return points_.data() + n_; }

   private:
    std::array<int, 32> points_{};  ///< six that a polynomial passes through, and what with_skipped() adds to them
    int n_ = 0;
  };

  [[nodiscard]] bool is_table() const { return p_.size() < least_for_statistics; }

  double secant(int i) const { return (p_[i + 1].second - p_[i].second) / (p_[i + 1].first - p_[i].first); }

  /// A kink is a second difference that stands out from those beside it, alone (kink at a point) or with its neighbour
  /// (kink between two points). In a smooth profile a second difference is about the mean of those beside it.
  void find_kinks() {
    constexpr double outlier = 4;
    kink_.assign(p_.size(), false);
    std::vector<double> d(p_.size(), 0), floor(p_.size(), 0);
    for (int i = 1; i + 1 < n_; ++i) {
      double const l = p_[i].first - p_[i - 1].first, r = p_[i + 1].first - p_[i].first;
      d[i] = std::abs(secant(i) - secant(i - 1)) / (l + r);
      floor[i] = 8 * noise_ * (1 / l + 1 / r) / (l + r);
    }
    auto const beside = [&](int i) { return i >= 1 && i + 1 < n_ ? d[i] : 0.0; };
    for (int i = 1; i + 1 < n_; ++i) {
      double around = std::max(beside(i - 1), beside(i + 1));
      if (i == 1) around = std::max(around, beside(3));
      if (i + 2 == n_) around = std::max(around, beside(n_ - 4));
      if (d[i] > outlier * around + floor[i]) kink_[i] = true;
      if (i < 2 || i + 3 >= n_) continue;
      around = std::max(beside(i - 1), beside(i + 2));
      if (std::min(d[i], d[i + 1]) > outlier * around + std::max(floor[i], floor[i + 1]))
        kink_[i] = kink_[i + 1] = true;
    }
  }

  /// Distance between points of a stencil at i, at least: points much closer together than their surroundings tell
  /// little of how the wall goes on beside their noise, which their distance divides. What they do tell comes in by
  /// fitted().
  double apart(int i) const {
    if (is_table()) return 0;
    constexpr int reach = 4;
    int const a = std::max(0, i - reach), b = std::min(n_ - 1, i + reach);
    return 0.4 * (p_[b].first - p_[a].first) / (b - a);
  }

  /// Appends the points that a stencil at i may use on one side: up to `most`, up to and including the next kink, none
  /// of them nearer than `apart` to the one before; but always the last before a kink or an end if there is no other.
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

  struct Derivatives {
    double first = 0, second = 0;
  };

  Derivatives derivatives(int i, Stencil const& stencil) const {
    Stencil const all = with_skipped(i, stencil);
    if (all.size() > stencil.size()) return fitted(i, stencil, all);
    return {derivative(i, stencil), second_derivative(i, stencil)};
  }

  /// A stencil and what it skips beside its points, nearer than they are apart: the nearest of them, which fix slope
  /// and curvature in clusters of points, three on either side of point i and one on either side of the others.
  Stencil with_skipped(int i, Stencil const& stencil) const {
    constexpr int most = 3;
    Stencil all = stencil;
    if (is_table()) return all;
    double const gap = apart(i);
    auto const take = [&](int from, int n, int step) {
      for (int j = from + step, last = from; n > 0 && j >= 0 && j < n_; j += step, --n) {
        if (std::abs(p_[j].first - p_[last].first) >= gap) return;
        if (j == i) return;
        if (std::find(all.begin(), all.end(), j) == all.end()) all.push_back(j);
        if (kink_[j]) return;
        last = j;
      }
    };
    for (int const step : {-1, +1}) take(i, most, step);
    for (int const j : stencil)
      if (!kink_[j])
        for (int const step : {-1, +1}) take(j, 1, step);
    return all;
  }

  /// Derivatives at point i of the polynomial through it, of the degree of the one through `stencil`, that fits all
  /// points best, each as exactly as it can be: to the noise of points, and to what the next power that the polynomial
  /// lacks makes of its distance. Near points then fix slope and curvature as well as their noise lets them, far ones
  /// how the wall goes on. Noise counts more than what is lacking: a fit in another unit or about another axis, with
  /// another rounding, is the same.
  Derivatives fitted(int i, Stencil const& stencil, Stencil all) const {
    constexpr double noise_counts = 100;
    double const x = p_[i].first, r = p_[i].second;
    auto const far = [&](int j) { return std::abs(p_[j].first - x); };
    std::sort(all.begin(), all.end(), [&](int a, int b) { return std::pair(far(a), a) < std::pair(far(b), b); });
    int const degree = int(stencil.size());
    double const length = far(all.back()), lacking = next_coefficient(i, stencil, all) * std::pow(length, degree + 1);
    LeastSquares fit(degree);
    for (int const j : all) {
      double const t = (p_[j].first - x) / length;
      double const weight = 1 / (1 + lacking * std::pow(std::abs(t), degree + 1) / (noise_counts * noise_));
      LeastSquares::Row row{};
      double power = weight;
      for (int k = 0; k < degree; ++k) row[k] = power *= t;
      row[degree] = weight * (p_[j].second - r);
      fit.add(row);
    }
    auto const c = fit.solution();
    return {c[0] / length, degree > 1 ? 2 * c[1] / (length * length) : 0};
  }

  /// The largest coefficient of the next power, as the skipped points say beyond their noise.
  double next_coefficient(int i, Stencil const& stencil, Stencil const& all) const {
    double most = 0;
    for (int const j : all)
      if (std::find(stencil.begin(), stencil.end(), j) == stencil.end())
        most = std::max(most, beyond_noise(i, stencil, j));
    return most;
  }

  /// How much the divided difference of point i, a stencil and point j is more than what noise may make of it.
  double beyond_noise(int i, Stencil const& stencil, int j) const {
    double value = 0, noise = 0;
    auto const term = [&](int k) {
      double product = 1;
      auto const factor = [&](int m) { product *= k == m ? 1 : p_[k].first - p_[m].first; };
      for (int const m : stencil) factor(m);
      factor(i);
      factor(j);
      value += (p_[k].second - p_[i].second) / product;
      noise += noise_ / std::abs(product);
    };
    for (int const k : stencil) term(k);
    term(i);
    term(j);
    return std::abs(value) - 4 * noise;
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

  /// Second derivative at point i of the same polynomial. With divided differences q_j = (r_j - r_i) / (x_j - x_i),
  /// which are r' at x_i plus (x - x_i) / 2 times r'' and so on, it is twice the derivative there of the polynomial
  /// through q.
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

  /// Points on both sides: seven in the middle; five in all where a side is short, and up to seven while each one more
  /// says more than noise.
  Stencil stencil(int i) const {
    constexpr int each_side = 3, least = 4;
    double const gap = apart(i);
    Stencil left, right;
    reach(i, -1, 2 * each_side, gap, left);
    reach(i, +1, 2 * each_side, gap, right);
    auto const n = [&](Stencil const& one, Stencil const& other) {
      int const beside = std::min(each_side, int(other.size()));
      return std::min(int(one.size()), beside < each_side ? std::max(each_side, least - beside) : each_side);
    };
    int n_left = n(left, right), n_right = n(right, left);
    Stencil out(left.begin(), left.begin() + n_left);
    for (int k = 0; k < n_right; ++k) out.push_back(right[k]);
    bool const one_sided = n_left < each_side || n_right < each_side;
    for (bool more = one_sided && !is_table(); more && int(out.size()) < 2 * each_side;) {
      Stencil const& longer = n_left < n_right ? right : left;
      int& used = n_left < n_right ? n_right : n_left;
      more = used < int(longer.size()) && beyond_noise(i, out, longer[used]) > 0;
      if (more) out.push_back(longer[used++]);
    }
    return out;
  }

  double at_kink(int i) const {
    constexpr int one_side = 3;
    Stencil left, right;
    reach(i, -1, one_side, apart(i), left);
    reach(i, +1, one_side, apart(i), right);
    double const before = derivatives(i, left).first, after = derivatives(i, right).first;
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
  double noise_;
  std::vector<double> bend_;  ///< second derivatives, beside kinks 0
  std::vector<bool> kink_;
};

/// The first piece of each bucket, of which there are as many as pieces (see ProfileView::piece).
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
  Points const given = std::move(points);
  points = thin(merge(given, width, 1e-3 * size), std::max(1e-7 * length, std::min(300 * noise, 1e-3 * length)));
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    double const rise = std::abs(points[i + 1].second - points[i].second);
    if (rise > 1e-3 * size && rise > 100 * (points[i + 1].first - points[i].first))
      throw MotionError(place(points[i].first, points[i].second, points[i + 1].second) +
                        ": the wall is at constant axial position there, which no radius as "
                        "a function of it describes");
  }

  RevolutionProfile profile;
  // Rounding of radii, and what that of axial positions makes of them.
  double const from_origin = std::max(std::abs(points.front().first), std::abs(points.back().first));
  double const rounding = 4e-16 * std::max(size, from_origin * (r_hi - r_lo) / length);
  Slopes slopes(points, std::max(noise, rounding));
  std::vector<double> const slope = slopes.all(), curvature = slopes.curvatures(slope);
  for (std::size_t n = 0; n < points.size(); ++n) {
    kernels::ProfileKnot knot{points[n].first, points[n].second, slope[n], {0, 0}};
    if (n + 1 < points.size()) std::copy_n(curvature.begin() + std::ptrdiff_t(2 * n), 2, knot.curvature);
    profile.knots.push_back(knot);
  }
  profile.bucket_piece = bucket_pieces(profile.knots);
  std::vector<double> off(given.size());
  detail::for_many("gridmorph::profile::deviation", Index(given.size()),
                   [&](Index n) { off[n] = std::abs(given[n].second - profile(given[n].first)); });
  for (double const d : off) profile.deviation = std::max(profile.deviation, d);
  return profile;
}

}  // namespace gridmorph
