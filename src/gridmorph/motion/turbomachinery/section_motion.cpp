#include <gridmorph/motion/turbomachinery/section_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/detail/slip_correction.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

/// Gauss-Legendre, five points: exact to the ninth degree.
constexpr std::array<std::pair<double, double>, 5> gauss{{{0.0, 0.5688888888888889},
                                                          {-0.5384693101056831, 0.4786286704993665},
                                                          {0.5384693101056831, 0.4786286704993665},
                                                          {-0.9061798459386640, 0.2369268850561891},
                                                          {0.9061798459386640, 0.2369268850561891}}};

double integral_of_tangent(SpanwiseTable const& angle, double from, double to) {
  double sum = 0;
  for (auto const& [x, w] : gauss) sum += w * std::tan(angle.at(0.5 * (from + to) + 0.5 * (to - from) * x));
  return 0.5 * (to - from) * sum;
}

}  // namespace

EdgeTrim::EdgeTrim(Boundary const& boundary, SectionFrame const& frame, std::vector<int> const& patches,
                   SlipSurfaces const& surfaces) {
  std::set<int> touched;
  for (std::size_t q = 0; q < boundary.patches().size(); ++q) {
    int const s = surfaces.of_patch[q];
    if (s < 0 || surfaces.surfaces[s].kind == SlipSurface::Kind::axial) continue;
    for (int p : patches)
      if (boundary.share_nodes(p, int(q))) touched.insert(s);
  }
  if (touched.empty()) return;

  std::vector<Vec3> const points = boundary.points(patches);
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (Vec3 const& p : points) {
    double const span = frame.at(p).span;
    lo = std::min(lo, span);
    hi = std::max(hi, span);
  }
  height_ = frame.height();
  bool root = false, tip = false;
  for (int s : touched) {
    surfaces_.push_back(&surfaces.surfaces[s]);
    // Which end of the span it closes: the one its nearest points are at.
    Vec3 const* nearest = &points.front();
    for (Vec3 const& p : points)
      if (std::abs(signed_distance(*surfaces_.back(), p)) < std::abs(signed_distance(*surfaces_.back(), *nearest)))
        nearest = &p;
    (frame.at(*nearest).span < 0.5 * (lo + hi) ? root : tip) = true;
  }
  if (!root) free_ends_.push_back(lo);
  if (!tip) free_ends_.push_back(hi);
}

Vec3 EdgeTrim::operator()(Vec3 const& point, double span, Vec3 const& u) const {
  if (surfaces_.empty() || u == Vec3{0, 0, 0}) return u;
  double sum = 0;
  Vec3 weighted;
  for (SlipSurface const* surface : surfaces_) {
    double const d = std::abs(signed_distance(*surface, point));
    // On a surface it decides alone.
    if (d <= surface->baseline_deviation + 1e-14 * surface->size) return u + slip_correction(*surface, point, u);
    weighted += (1 / d) * slip_correction(*surface, point, u);
    sum += 1 / d;
  }
  for (double end : free_ends_) {
    double const d = std::abs(span - end) * height_;
    if (d == 0) return u;
    sum += 1 / d;
  }
  return u + (1 / sum) * weighted;
}

SectionMotion::SectionMotion(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
                             std::vector<int> const& patches, SlipSurfaces const& surfaces,
                             std::vector<std::string>& notes)
    : rule_(rule),
      places_(boundary, motion, rule, patches, surfaces, notes),
      trim_(boundary, places_.frame(), patches, surfaces),
      thickens_(!rule.thickness.is_zero()),
      bows_(!rule.bow_rad.is_zero()) {
  if (thickens_ && !places_.have_camber())
    throw MotionError("thickness needs both sides of the blade: its camber line lies between them; name both");
  if (!bows_) return;
  std::set<double> knots{0};
  for (auto const& station : rule.bow_rad.stations) knots.insert(station.first);
  bow_knots_.assign(knots.begin(), knots.end());
  bow_sums_.assign(bow_knots_.size(), 0.0);
  std::size_t const zero = std::size_t(std::find(bow_knots_.begin(), bow_knots_.end(), 0.0) - bow_knots_.begin());
  for (std::size_t k = zero; k + 1 < bow_knots_.size(); ++k)
    bow_sums_[k + 1] = bow_sums_[k] + integral_of_tangent(rule.bow_rad, bow_knots_[k], bow_knots_[k + 1]);
  for (std::size_t k = zero; k > 0; --k)
    bow_sums_[k - 1] = bow_sums_[k] - integral_of_tangent(rule.bow_rad, bow_knots_[k - 1], bow_knots_[k]);
}

double SectionMotion::bow_integral(double span) const {
  auto const above = std::upper_bound(bow_knots_.begin(), bow_knots_.end(), span);
  std::size_t const k = above == bow_knots_.begin() ? 0 : std::size_t(above - bow_knots_.begin()) - 1;
  return bow_sums_[k] + integral_of_tangent(rule_.bow_rad, bow_knots_[k], span);
}

Vec3 SectionMotion::displacement(Vec3 const& point) const {
  SectionPoint const p = places_.frame().at(point);
  auto const [blade, line, at] = places_.nearest(p);
  double const h = p.span;

  // In chord coordinates from the pivot; every term is a product with a parameter, so that zero moves nothing.
  double const x = at.along - rule_.pivot * line.length, y = at.across;
  double dx = 0, dy = 0;
  if (thickens_) dy = rule_.thickness.at(h) * (y - blade->camber(h, line.length, at.along / line.length));
  dx = rule_.chord.at(h) * x;
  double const scale = rule_.scale.at(h);
  dx += scale * (x + dx);
  dy += scale * (y + dy);
  double const twist = rule_.twist_rad.at(h);
  double const s = std::sin(twist), half = std::sin(0.5 * twist), c1 = -2 * half * half;  // cos(twist) - 1
  double const x1 = x + dx, y1 = y + dy;
  dx += c1 * x1 - s * y1;
  dy += s * x1 + c1 * y1;

  // Along the flow and across it.
  double const sweep = rule_.sweep.at(h);
  double ds = line.cos_stagger * dx - line.sin_stagger * dy;
  double dt = line.sin_stagger * dx + line.cos_stagger * dy;
  if (double const turn = rule_.stagger_rad.at(h); turn != 0) {
    double const downstream = line.cos_stagger * x - line.sin_stagger * y + ds;
    double const angle = std::atan2(line.sin_stagger, line.cos_stagger) + twist;
    dt += downstream * std::sin(turn) / (std::cos(angle) * std::cos(angle + turn));  // tan(angle + turn) - tan(angle)
  }
  ds += line.cos_stagger * sweep;
  dt += line.sin_stagger * sweep + rule_.lean.at(h);
  if (bows_) dt += places_.frame().height() * bow_integral(h);
  return trim_(point, h, places_.frame().displacement(point, ds, dt / line.scale));
}

}  // namespace gridmorph
