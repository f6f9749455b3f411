#include <gridmorph/geometry/profile_smoothing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace gridmorph {

namespace {

/// How far a point may be off a polynomial, in roundings: its own, and a half for what the wall's slope makes of that
/// along the axis.
constexpr double residual_limit = 1.5;

/// Value and derivatives.
using Jet = std::array<double, 3>;

/// Points at one place, up to rounding, as one.
struct Station {
  double at = 0, value = 0;
  double count = 0;
};

std::vector<Station> stations_of(std::vector<std::pair<double, double>> const& sorted, double width) {
  std::vector<Station> out;
  for (std::size_t n = 0; n < sorted.size();) {
    Station station;
    // In differences: equal values have their own mean.
    auto const [at, value] = sorted[n];
    for (std::size_t first = n; n < sorted.size() && sorted[n].first - sorted[first].first <= width; ++n) {
      station.at += sorted[n].first - at;
      station.value += sorted[n].second - value;
      ++station.count;
    }
    station.at = at + station.at / station.count;
    station.value = value + station.value / station.count;
    out.push_back(station);
  }
  return out;
}

/// A polynomial fitted to a window of stations.
struct Fit {
  Jet jet{};  ///< at a knot
  std::array<double, 3> value{},
      uncertainty{};                ///< at the knot and beside it; standard deviations for points with one of 1
  double largest = 0, scatter = 0;  ///< residual: largest, and standard deviation of a point that it tells of
  double freedom = 0;               ///< stations more than the polynomial has coefficients
};

class Windows {
 public:
  Windows(std::vector<Station> const& stations, double rounding) : stations_(stations), rounding_(rounding) {}

  /// What the stations around a knot say there and half way to the knots beside it, `before` and `behind` from there;
  /// nothing where they contradict every polynomial, or leave it open.
  std::optional<Jet> at(double place, double value, double before, double behind) {
    constexpr std::size_t least = 2 * (degree + 1);
    constexpr double growth = 1.5, confidence = 2.5;
    if (stations_.size() < least) return {};
    auto const next = std::lower_bound(stations_.begin(), stations_.end(), place,
                                       [](Station const& s, double x) { return s.at < x; });
    begin_ = end_ = std::size_t(next - stations_.begin());
    std::optional<Jet> out;
    double noise = rounding_ / std::sqrt(3.0);  // of what is spread evenly
    std::array<double, 3> low{-infinity, -infinity, -infinity}, high{infinity, infinity, infinity};
    for (std::size_t wanted = least;; wanted = std::size_t(growth * double(wanted))) {
      widen(place, std::min(wanted, stations_.size()));
      Fit const fit = fitted(place, value, {0, -0.5 * before, 0.5 * behind});
      if (fit.largest > residual_limit * rounding_) break;
      if (fit.freedom >= 24) noise = std::min(noise, 1.8 * fit.scatter);
      bool agrees = true;
      double most_uncertain = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        double const off = confidence * noise * fit.uncertainty[e] + 1e-3 * rounding_;
        low[e] = std::max(low[e], fit.value[e] - off);
        high[e] = std::min(high[e], fit.value[e] + off);
        agrees = agrees && low[e] <= high[e];
        most_uncertain = std::max(most_uncertain, noise * fit.uncertainty[e]);
      }
      if (!agrees) break;
      if (most_uncertain <= rounding_) out = fit.jet;
      if (wanted >= stations_.size() || (wanted >= most && most_uncertain <= 0.1 * rounding_)) break;
    }
    if (out) (*out)[0] += value;
    return out;
  }

 private:
  static constexpr int degree = 5;
  static constexpr std::size_t most = 300;  ///< stations of a window; of more, some are taken evenly
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Takes in the stations nearest to a place.
  void widen(double place, std::size_t wanted) {
    while (end_ - begin_ < wanted)
      if (end_ == stations_.size() || (begin_ > 0 && place - stations_[begin_ - 1].at <= stations_[end_].at - place))
        --begin_;
      else
        ++end_;
    length_ = std::max(place - stations_[begin_].at, stations_[end_ - 1].at - place);
  }

  /// Least squares by polynomials orthogonal over the stations, each from the two before.
  Fit fitted(double place, double value, std::array<double, 3> const& places) {
    std::size_t const step = (end_ - begin_ + most - 1) / most, n = (end_ - begin_ + step - 1) / step;
    auto const station = [&](std::size_t j) -> Station const& { return stations_[begin_ + j * step]; };
    t_.resize(n);
    rest_.resize(n);
    before_.assign(n, 0);
    now_.assign(n, 1);
    for (std::size_t j = 0; j < n; ++j) {
      t_[j] = (station(j).at - place) / length_;
      rest_[j] = station(j).value - value;
    }
    Fit out;
    Jet p{1, 0, 0}, p_before{0, 0, 0};
    std::array<double, 3> q{1, 1, 1}, q_before{0, 0, 0};
    double square_before = 1;
    for (int k = 0; k <= degree; ++k) {
      double square = 0, product = 0, middle = 0;
      for (std::size_t j = 0; j < n; ++j) {
        double const w = station(j).count * now_[j];
        square += w * now_[j];
        product += w * rest_[j];
        middle += w * t_[j] * now_[j];
      }
      double const factor = product / square, a = middle / square, b = k == 0 ? 0 : square / square_before;
      for (std::size_t d = 0; d < 3; ++d) out.jet[d] += factor * p[d];
      for (std::size_t j = 0; j < n; ++j) {
        rest_[j] -= factor * now_[j];
        double const following = (t_[j] - a) * now_[j] - b * before_[j];
        before_[j] = now_[j];
        now_[j] = following;
      }
      for (std::size_t e = 0; e < 3; ++e) {
        out.value[e] += factor * q[e];
        out.uncertainty[e] += q[e] * q[e] / square;
        double const following = (places[e] / length_ - a) * q[e] - b * q_before[e];
        q_before[e] = q[e];
        q[e] = following;
      }
      Jet const following{-a * p[0] - b * p_before[0], p[0] - a * p[1] - b * p_before[1],
                          2 * p[1] - a * p[2] - b * p_before[2]};
      p_before = p;
      p = following;
      square_before = square;
    }
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      out.largest = std::max(out.largest, std::abs(rest_[j]));
      sum += station(j).count * rest_[j] * rest_[j];
    }
    out.freedom = double(n) - degree - 1;
    out.scatter = std::sqrt(sum / out.freedom);
    for (double& u : out.uncertainty) u = std::sqrt(u);
    out.jet[1] /= length_;
    out.jet[2] /= length_ * length_;
    return out;
  }

  std::vector<Station> const& stations_;
  double rounding_;
  std::size_t begin_ = 0, end_ = 0;
  double length_ = 0;
  std::vector<double> t_, rest_, before_, now_;
};

/// Fits at the knots of a profile: at some of them first, and at those between only where the pieces between these do
/// not go through them.
class KnotFits {
 public:
  KnotFits(std::vector<kernels::ProfileKnot> const& knots, std::vector<Station> const& stations, double rounding)
      : knots_(knots), windows_(stations, rounding), rounding_(rounding), found_(knots.size()) {}

  std::vector<std::optional<Jet>> run() {
    constexpr std::size_t enough = 1000;
    std::size_t const last = knots_.size() - 1, step = 1 + last / enough;
    for (std::size_t n = 0; n <= last; n = n == last ? last + 1 : std::min(n + step, last))
      fit(n, n - std::min(n, step), std::min(n + step, last));
    for (std::size_t n = 0; n < last; n = std::min(n + step, last)) fill(n, std::min(n + step, last));
    return std::move(found_);
  }

 private:
  void fit(std::size_t n, std::size_t before, std::size_t behind) {
    double const at = knots_[n].axial;
    found_[n] = windows_.at(at, knots_[n].radius, at - knots_[before].axial, knots_[behind].axial - at);
  }

  void fill(std::size_t lo, std::size_t hi) {
    if (found_[lo] && found_[hi]) {
      Jet const &a = *found_[lo], &b = *found_[hi];
      std::array<kernels::ProfileKnot, 2> const ends{kernels::ProfileKnot{knots_[lo].axial, a[0], a[1], {a[2], b[2]}},
                                                     kernels::ProfileKnot{knots_[hi].axial, b[0], b[1], {0, 0}}};
      kernels::ProfileView const piece{ends.data(), 2, nullptr, 0};
      std::vector<std::size_t> off;
      double largest = 0;
      for (std::size_t n = lo + 1; n < hi; ++n) {
        kernels::ProfileSample const s = piece.sample(knots_[n].axial);
        double const away = std::abs(s.value - knots_[n].radius);
        if (away > residual_limit * rounding_) off.push_back(n);
        largest = std::max(largest, away);
        found_[n] = Jet{s.value, s.slope, s.bend};
      }
      // A point here and there may be further off by itself; where the wall is elsewhere, many are.
      if (10 * off.size() <= hi - lo && largest <= 2 * residual_limit * rounding_) {
        for (std::size_t const n : off) fit(n, n - 1, n + 1);
        return;
      }
    }
    for (std::size_t n = lo + 1; n < hi; ++n) fit(n, n - 1, n + 1);
  }

  std::vector<kernels::ProfileKnot> const& knots_;
  Windows windows_;
  double rounding_;
  std::vector<std::optional<Jet>> found_;
};

}  // namespace

void smooth(RevolutionProfile& profile, std::vector<std::pair<double, double>> points, double rounding) {
  if (!(rounding > 0)) return;
  std::sort(points.begin(), points.end());
  std::vector<Station> const stations = stations_of(points, 4 * rounding);
  auto& knots = profile.knots;
  auto const found = KnotFits(knots, stations, rounding).run();
  for (std::size_t n = 0; n < knots.size(); ++n) {
    if (!found[n]) continue;
    knots[n].radius = (*found[n])[0];
    knots[n].slope = (*found[n])[1];
    knots[n].curvature[0] = (*found[n])[2];
    if (n > 0) knots[n - 1].curvature[1] = (*found[n])[2];
  }
  profile.deviation = 0;
  for (auto const& [a, r] : points) profile.deviation = std::max(profile.deviation, std::abs(r - profile(a)));
}

}  // namespace gridmorph
