#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace gridmorph {

namespace {

constexpr double newton_inside = 1e-9;  ///< of the size
constexpr int newton_steps = 100;

double& along_axis(Vec3& v, int a) { return a == 0 ? v.x : a == 1 ? v.y : v.z; }

Vec3 lower_corner(Vec3 const& a, Vec3 const& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 upper_corner(Vec3 const& a, Vec3 const& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

/// The step along some of three columns that comes closest to r: Gram and Schmidt. Columns that add no direction get
/// none.
Vec3 closest_step(std::array<Vec3, 3> const& column, std::array<bool, 3> const& free, Vec3 r) {
  std::array<Vec3, 3> unit{};
  std::array<std::array<double, 3>, 3> upper{};
  std::array<double, 3> right{};
  std::array<bool, 3> used{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!free[a]) continue;
    Vec3 left = column[a];
    for (int twice = 0; twice < 2; ++twice)  // to round-off
      for (std::size_t b = 0; b < a; ++b) {
        if (!used[b]) continue;
        double const share = dot(unit[b], left);
        upper[b][a] += share;
        left = left - share * unit[b];
      }
    upper[a][a] = norm(left);
    used[a] = upper[a][a] > 1e-12 * norm(column[a]);
    if (!used[a]) continue;
    unit[a] = (1 / upper[a][a]) * left;
    right[a] = dot(unit[a], r);
  }
  Vec3 out;
  for (std::size_t n = 3; n-- > 0;) {
    if (!used[n]) continue;
    double sum = right[n];
    for (std::size_t b = n + 1; b < 3; ++b) sum -= upper[n][b] * along_axis(out, int(b));
    along_axis(out, int(n)) = sum / upper[n][n];
  }
  return out;
}

}  // namespace

LatticeInverse::LatticeInverse(std::array<BSplineBasis, 3> const& basis, std::vector<Vec3> points, std::string name)
    : basis_(basis), points_(std::move(points)), name_(std::move(name)) {
  Vec3 low = points_.front(), high = low;
  for (Vec3 const& p : points_) {
    low = lower_corner(low, p);
    high = upper_corner(high, p);
  }
  size_ = distance(low, high);
  sample();
}

void LatticeInverse::sample() {
  auto const& [a, b, c] = basis_;
  double sign = 0;
  for (int w = 0; w < c.spans(); ++w)
    for (int t = 0; t < b.spans(); ++t)
      for (int s = 0; s < a.spans(); ++s) {
        double const inf = std::numeric_limits<double>::infinity();
        Span span{{inf, inf, inf}, {-inf, -inf, -inf}, {}};
        // A span lies within the box of the control points that have a share in it: weights are positive and add up to
        // one.
        for (int k = w; k <= w + c.degree(); ++k)
          for (int j = t; j <= t + b.degree(); ++j)
            for (int i = s; i <= s + a.degree(); ++i) {
              Vec3 const& p = points_[std::size_t(i) + std::size_t(a.count()) *
                                                           (std::size_t(j) + std::size_t(b.count()) * std::size_t(k))];
              span.low = lower_corner(span.low, p);
              span.high = upper_corner(span.high, p);
            }
        Vec3 const room{newton_inside * size_, newton_inside * size_, newton_inside * size_};
        span.low = span.low - room;
        span.high = span.high + room;
        auto const at = [](BSplineBasis const& of, int number, int n) {
          return (number + double(n) / of.degree()) / of.spans();
        };
        for (int n = 0; n <= c.degree(); ++n)
          for (int m = 0; m <= b.degree(); ++m)
            for (int l = 0; l <= a.degree(); ++l) {
              Vec3 const place{at(a, s, l), at(b, t, m), at(c, w, n)};
              Derived const d = derived(place);
              double const volume = dot(cross(d.by[0], d.by[1]), d.by[2]);
              // A lattice may be left-handed, but then everywhere.
              if (sign == 0) sign = volume < 0 ? -1.0 : 1.0;
              if (!(sign * volume > 1e-12 * norm(d.by[0]) * norm(d.by[1]) * norm(d.by[2])))
                throw MotionError(
                    name_ + ": the lattice folds at " + to_text(d.x, 6) + " (s, t, w = " + to_text(place, 3) +
                    "), where it has no volume or turns over, so that places in it are not unique; move its "
                    "control points apart there");
              span.samples.push_back({place, d.x});
            }
        spans_.push_back(std::move(span));
      }
}

LatticeInverse::Derived LatticeInverse::derived(Vec3 const& place) const {
  auto const a = basis_[0].with_slopes(place.x), b = basis_[1].with_slopes(place.y), c = basis_[2].with_slopes(place.z);
  Derived out{};
  for (int k = 0; k <= basis_[2].degree(); ++k) {
    auto const nk = std::size_t(k);
    for (int j = 0; j <= basis_[1].degree(); ++j) {
      auto const nj = std::size_t(j);
      Vec3 row{}, slope{};
      Vec3 const* p = &points_[std::size_t(a.first) + std::size_t(basis_[0].count()) *
                                                          (std::size_t(b.first + j) +
                                                           std::size_t(basis_[1].count()) * std::size_t(c.first + k))];
      for (std::size_t i = 0; i <= std::size_t(basis_[0].degree()); ++i) {
        row += a.value[i] * p[i];
        slope += a.slope[i] * p[i];
      }
      out.x += b.value[nj] * c.value[nk] * row;
      out.by[0] += b.value[nj] * c.value[nk] * slope;
      out.by[1] += b.slope[nj] * c.value[nk] * row;
      out.by[2] += b.value[nj] * c.slope[nk] * row;
    }
  }
  return out;
}

LatticeInverse::End LatticeInverse::descend(Vec3 const& point, Vec3 place) const {
  Derived here = derived(place);
  Vec3 r = point - here.x;
  bool at_side = false;
  for (int n = 0; n < newton_steps && norm(r) > 1e-15 * size_; ++n) {
    std::array<bool, 3> free{};
    at_side = false;
    for (int a = 0; a < 3; ++a) {
      double const downhill = dot(here.by[a], r), s = along_axis(place, a);
      // At a side of the lattice a place moves along it, unless downhill leads back inside.
      free[a] = !((s <= 0 && downhill < 0) || (s >= 1 && downhill > 0));
      at_side = at_side || !free[a];
    }
    Vec3 const whole = closest_step(here.by, free, r);
    double const before = norm(r);
    // A whole step may lead away where the start is far off: it is halved until the distance falls.
    for (double share = 1; share > 1e-9; share /= 2) {
      Vec3 next = place + share * whole;
      for (int a = 0; a < 3; ++a) along_axis(next, a) = std::clamp(along_axis(next, a), 0.0, 1.0);
      Derived const there = derived(next);
      if (!(distance(point, there.x) < before)) continue;
      place = next;
      here = there;
      r = point - here.x;
      break;
    }
    if (!(norm(r) < (1 - 1e-12) * before)) break;
  }
  return {place, norm(r), at_side};
}

std::optional<Vec3> LatticeInverse::place(Vec3 const& point) const {
  std::vector<std::pair<double, Vec3>> starts;
  for (Span const& span : spans_) {
    if (point.x < span.low.x || point.y < span.low.y || point.z < span.low.z || point.x > span.high.x ||
        point.y > span.high.y || point.z > span.high.z)
      continue;
    auto const nearest =
        std::min_element(span.samples.begin(), span.samples.end(),
                         [&](Sample const& p, Sample const& q) { return distance(point, p.x) < distance(point, q.x); });
    starts.emplace_back(distance(point, nearest->x), nearest->place);
  }
  std::stable_sort(starts.begin(), starts.end(), [](auto const& p, auto const& q) { return p.first < q.first; });
  std::optional<End> lost;
  for (auto const& [away, start] : starts) {
    End const end = descend(point, start);
    if (end.distance <= newton_inside * size_) return end.place;
    if (!end.at_side) lost = end;
  }
  if (lost)
    throw MotionError(name_ + ": the place of the point " + to_text(point, 9) + " in the lattice is not found: after " +
                      std::to_string(newton_steps) + " steps of Newton's method at most it is " +
                      to_text(lost->distance, 3) + " away from (s, t, w) = " + to_text(lost->place, 3) +
                      "; the lattice is bent too much there, or folds: use more control points or a lower degree");
  return std::nullopt;
}

Vec3 LatticeInverse::step(Vec3 const& place, Vec3 const& step) const {
  return closest_step(derived(place).by, {true, true, true}, step);
}

}  // namespace gridmorph
