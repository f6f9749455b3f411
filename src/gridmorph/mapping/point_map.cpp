#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mapping/detail/point_clouds.hpp>
#include <gridmorph/mapping/point_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

using mapping::Level;

constexpr std::size_t n_neighbours = 13;  // per level
/// A neighbourhood whose second principal variance is below this share of the first counts as a line.
constexpr double line_like = 0.1;
/// Variances below this share of the largest are no direction to fit a gradient in; smooth cut-off.
constexpr double flat_like = 1e-6;
/// The farthest that is extrapolated from the centre of the neighbours along a direction: this times their own reach
/// along it.
constexpr double largest_extrapolation = 2;
/// Variances above this share of the largest are directions in which the points have an edge; the others are across the
/// surface that they lie on.
constexpr double spanned = 0.05;
/// The share of the neighbours' reach by less than which a place beyond them is at the edge, but for rounding.
constexpr double at_the_edge = 1e-6;

struct Neighbours {
  std::vector<std::size_t> number;
  std::vector<Vec3> offset;

  void add(Level const& level, Vec3 const& q, std::optional<std::size_t> without) {
    std::array<std::size_t, n_neighbours + 1> found{};
    std::array<double, n_neighbours + 1> squared{};
    double const position[3] = {q.x, q.y, q.z};
    std::size_t const n =
        level.tree->knnSearch(position, n_neighbours + (without ? 1 : 0), found.data(), squared.data());
    std::size_t const before = number.size();
    for (std::size_t f = 0; f < n; ++f) {
      std::size_t const i = level.number[found[f]];
      auto const end = number.begin() + std::ptrdiff_t(before);
      if (i == without || std::find(number.begin(), end, i) != end) continue;
      number.push_back(i);
      offset.push_back(level.position[found[f]] - q);
    }
  }
};

/// Weighted second moments about the weighted mean of offsets.
struct Spread {
  Vec3 centre;
  PrincipalAxes axes;
};

Spread spread_of(std::vector<Vec3> const& offset, std::vector<double> const& weight) {
  Vec3 centre;
  for (std::size_t i = 0; i < offset.size(); ++i) centre += weight[i] * offset[i];
  Moments moments;
  for (std::size_t i = 0; i < offset.size(); ++i) moments.add(weight[i], offset[i] - centre);
  return {centre, PrincipalAxes(moments)};
}

Spread even_spread(Neighbours const& near) {
  std::size_t const n = near.number.size();
  return spread_of(near.offset, std::vector<double>(n, 1.0 / double(n)));
}

bool on_a_line(Neighbours const& near) {
  auto const& moment = even_spread(near).axes.moment;
  return moment[1] < line_like * moment[0];
}

/// Franke-Little weights ((R - d) / (R d))^2, sum 1.
std::vector<double> weights(std::vector<Vec3> const& offset) {
  std::vector<double> w(offset.size());
  double farthest = 0, sum = 0;
  for (Vec3 const& o : offset) farthest = std::max(farthest, norm(o));
  double const reach = 1.05 * farthest;
  for (std::size_t i = 0; i < w.size(); ++i) {
    double const d = norm(offset[i]), ratio = (reach - d) / (reach * d);
    w[i] = ratio * ratio;
    sum += w[i];
  }
  for (double& v : w) v /= sum;
  return w;
}

/// The way from the position to the closest place among its neighbours, along the surface or through the volume that
/// they span; zero for a position between them.
Vec3 to_the_edge(Neighbours const& near) {
  PrincipalAxes const axes = even_spread(near).axes;
  std::vector<Vec3> spanned_part(near.offset.size());
  double farthest = 0;
  for (std::size_t i = 0; i < spanned_part.size(); ++i) {
    farthest = std::max(farthest, norm(near.offset[i]));
    for (int k = 0; k < 3; ++k) {
      if (axes.moment[k] < spanned * axes.moment[0]) continue;
      Vec3 const e = axes.direction[k];
      spanned_part[i] += dot(near.offset[i], e) * e;
    }
  }
  return mapping::closest_in_hull(spanned_part, at_the_edge * farthest);
}

/// The distance from the middle of the neighbours to the farthest: of 13 on a regular grid two spacings.
double reach_of(Neighbours const& near) {
  Vec3 const centre = even_spread(near).centre;
  double out = 0;
  for (Vec3 const& o : near.offset) out = std::max(out, norm(o - centre));
  return out;
}

}  // namespace

struct PointMap::Impl {
  std::vector<std::unique_ptr<Level>> levels;  // all points first
  Extrapolation extrapolation;
  double coincidence = 0;

  [[nodiscard]] Neighbours around(Vec3 const& q, std::optional<std::size_t> without) const;
  /// The stencil of a fit to the neighbours; `out` knows the nearest point.
  [[nodiscard]] Stencil fit(Neighbours const& near, Stencil out) const;
};

PointMap::PointMap(std::vector<Vec3> const& position, Extrapolation extrapolation) : impl_(std::make_unique<Impl>()) {
  impl_->extrapolation = extrapolation;
  Box box;
  double magnitude = 0;
  for (Vec3 const& p : position) {
    box.include(p);
    magnitude = std::max({magnitude, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
  impl_->coincidence = 1e-7 * std::max(distance(box.low, box.high), magnitude);
  impl_->levels = mapping::make_levels(position, 2 * n_neighbours);
}

PointMap::~PointMap() = default;
PointMap::PointMap(PointMap&&) noexcept = default;
PointMap& PointMap::operator=(PointMap&&) noexcept = default;

double PointMap::coincidence() const { return impl_->coincidence; }

std::pair<std::size_t, double> PointMap::nearest(Vec3 const& q) const {
  double const position[3] = {q.x, q.y, q.z};
  std::size_t number = 0;
  double squared = 0;
  impl_->levels.front()->tree->knnSearch(position, 1, &number, &squared);
  return {number, std::sqrt(squared)};
}

Neighbours PointMap::Impl::around(Vec3 const& q, std::optional<std::size_t> without) const {
  Neighbours near;
  for (auto const& level : levels) {
    near.add(*level, q, without);
    if (!on_a_line(near)) break;
  }
  return near;
}

Stencil PointMap::stencil(Vec3 const& q, std::optional<std::size_t> without) const {
  Stencil out;
  if (!without) {
    auto const [number, d] = nearest(q);
    out.reference = std::int32_t(number);
    out.distance = d;
    out.coincident = d <= impl_->coincidence;
    if (out.coincident) return out;
  }
  return impl_->fit(impl_->around(q, without), out);
}

Stencil PointMap::stencil(Vec3 const& q, Vec3 const& anchor) const {
  Stencil out;
  auto const [number, d] = nearest(q);
  out.reference = std::int32_t(number);
  out.distance = d;
  out.coincident = d <= impl_->coincidence;
  if (out.coincident) return out;
  Neighbours near = impl_->around(anchor, std::nullopt);
  for (Vec3& offset : near.offset) offset += anchor - q;
  return impl_->fit(near, out);
}

Stencil PointMap::Impl::fit(Neighbours const& near, Stencil out) const {
  std::vector<double> w = weights(near.offset);
  auto const [centre, axes] = spread_of(near.offset, w);
  std::vector<double> gradient(w.size(), 0.0);
  double const cut = flat_like * axes.moment[0];
  Vec3 const edge = to_the_edge(near);
  Vec3 const place = extrapolation == Extrapolation::nearest ? edge : Vec3{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    double const lambda = axes.moment[k];
    if (!(lambda > 0)) continue;
    Vec3 const e = axes.direction[k];
    double reach = 0;
    for (Vec3 const& o : near.offset) reach = std::max(reach, std::fabs(dot(o - centre, e)));
    double const limit = largest_extrapolation * reach;
    double const step = std::clamp(dot(place - centre, e), -limit, limit);
    // lambda / (lambda^2 + cut^2) is 1 / lambda for directions that the points span and fades to zero for the others.
    double const factor = step * lambda / (lambda * lambda + cut * cut);
    for (std::size_t i = 0; i < w.size(); ++i) gradient[i] += factor * dot(near.offset[i] - centre, e);
  }
  out.reference = std::int32_t(near.number.front());
  for (std::size_t i = 0; i < w.size(); ++i)
    out.terms.push_back({std::int32_t(near.number[i]), w[i] * (1 + gradient[i]), 0});
  out.beyond = norm(edge);
  double const two_spacings = reach_of(near);
  out.far_beyond = out.beyond > two_spacings;
  out.far_off = out.distance > two_spacings;
  return out;
}

}  // namespace gridmorph
