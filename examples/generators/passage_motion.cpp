#include <generators/passage_geometry.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

using Stations = std::vector<std::pair<double, double>>;

double secant(Stations const& s, std::size_t n) {
  return (s[n + 1].second - s[n].second) / (s[n + 1].first - s[n].first);
}

/// Level at extremes, harmonic mean of the secants elsewhere (Fritsch and Butland 1984); the ends have no curvature.
double slope(Stations const& s, std::size_t n) {
  auto const inner = [&](std::size_t m) {
    double const a = secant(s, m - 1), b = secant(s, m);
    return a * b > 0 ? 2 * a * b / (a + b) : 0.0;
  };
  std::size_t const last = s.size() - 1;
  if (n > 0 && n < last) return inner(n);
  std::size_t const neighbour = n == 0 ? 1 : last - 1;
  double const chord = secant(s, n == 0 ? 0 : last - 1);
  double const inside = last > 1 ? inner(neighbour) : chord;
  return 1.5 * chord - 0.5 * inside;
}

}  // namespace

PassageMotion rotated_sections() { return {"rotation", -10, {{0.5, 0.95}}, 1}; }

PassageMotion chord_redesign() { return {"chord", 0, {{0, 1}, {0.15, 0.9}, {0.5, 1.1}, {0.9, 0.9}, {1, 1}}, 1}; }

PassageMotion gap_halved() { return {"gap", 0, {}, 0.5}; }

PassageMotion passage_motion(std::string const& name) {
  for (PassageMotion const& motion : {rotated_sections(), chord_redesign(), gap_halved()})
    if (motion.name == name) return motion;
  throw ConfigError("passage demo: there is no motion '" + name + "'; choose 'rotation', 'chord' or 'gap'");
}

double chord_factor(PassageMotion const& motion, double span) {
  Stations const& s = motion.chord_factor;
  if (s.empty()) return 1;
  if (span <= s.front().first) return s.front().second;
  if (span >= s.back().first) return s.back().second;
  std::size_t const n = std::upper_bound(s.begin(), s.end(), std::pair(span, HUGE_VAL)) - s.begin() - 1;
  double const h = s[n + 1].first - s[n].first, t = (span - s[n].first) / h, q = 1 - t;
  return q * q * (1 + 2 * t) * s[n].second + t * t * (3 - 2 * t) * s[n + 1].second +
         h * t * q * (q * slope(s, n) - t * slope(s, n + 1));
}

Vec3 passage_displacement(PassageOptions const& options, PassageMotion const& motion, Vec3 const& point) {
  passage::Annulus const annulus(options);
  Vec3 const p = options.placement.inverse()(point);
  double const span = annulus.span_fraction(p.x, std::hypot(p.y, p.z)), radius = annulus.section_radius(span);
  passage::Point2 const flat{p.x, radius * std::atan2(p.z, p.y)};

  double const stagger = passage::Airfoil(options, span).stagger();
  passage::Point2 const along = passage::direction(stagger), across{-along.y, along.x};
  double const turned = stagger + motion.rotation_deg * std::numbers::pi / 180;
  passage::Point2 const new_along = passage::direction(turned), new_across{-new_along.y, new_along.x};
  double const u = flat.x * along.x + flat.y * along.y, v = flat.x * across.x + flat.y * across.y;
  passage::Point2 const moved = (chord_factor(motion, span) * u) * new_along + v * new_across;
  double const growth = (1 - motion.gap_factor * options.tip_gap) / (1 - options.tip_gap);
  double const new_span = options.tip == BladeTip::none ? span : growth * span;
  // The difference is turned, not the two ends: displacements far smaller than the coordinates keep their digits.
  return options.placement.rotation * (annulus.unroll(moved, new_span, radius) - annulus.unroll(flat, span, radius));
}

}  // namespace gridmorph
