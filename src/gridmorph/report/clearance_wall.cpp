#include <gridmorph/report/tip_clearance.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/point_numbers.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

/// A share of the extent of a wall: nodes as near as that along it are one point of the profile.
constexpr double same_station = 1e-9;
/// A share of its size: a wall whose nodes are farther from the profile than that is measured as it is, not as one of
/// revolution.
constexpr double largest_scatter = 1e-5;

}  // namespace

std::string name_of(ClearanceMeasure measure) {
  return measure == ClearanceMeasure::meridional ? "meridional" : "surface";
}

Clearance ClearanceWall::of(std::vector<Vec3> const& nodes, double side) const {
  Clearance out;
  out.smallest = std::numeric_limits<double>::infinity();
  for (Vec3 const& node : nodes) {
    double const gap = side * distance(node);
    out.mean += gap / double(nodes.size());
    if (gap >= out.smallest) continue;
    out.smallest = gap;
    out.at = node;
  }
  return out;
}

std::shared_ptr<RevolutionWall const> RevolutionWall::through(Axis const& axis, std::vector<Vec3> const& nodes) {
  std::shared_ptr<RevolutionWall> wall(new RevolutionWall({axis.origin, (1 / norm(axis.direction)) * axis.direction}));
  return wall->fit(nodes) ? wall : nullptr;
}

bool RevolutionWall::fit(std::vector<Vec3> const& nodes) {
  std::vector<std::pair<double, double>> all;
  for (Vec3 const& node : nodes) all.push_back(meridional(node));
  std::sort(all.begin(), all.end());
  if (all.empty()) return false;
  double const extent = all.back().first - all.front().first;
  double size = extent;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first;
    double low = all[first].second, high = low, sum = 0;
    for (; last < all.size() && all[last].first - all[first].first <= same_station * extent; ++last) {
      low = std::min(low, all[last].second);
      high = std::max(high, all[last].second);
      sum += all[last].second;
    }
    double const mean = low == high ? low : sum / double(last - first);
    scatter_ = std::max({scatter_, high - mean, mean - low});
    size = std::max(size, high);
    points_.emplace_back(all[first].first, mean);
    first = last;
  }
  if (scatter_ > largest_scatter * size || points_.size() < 2) return false;

  // Nodes slide on the smooth profile through the wall's nodes, not on the chords between them.
  constexpr int parts = 16;  // of a chord: its error falls by their square
  RevolutionProfile profile;
  try {
    profile = RevolutionProfile::from_points(points_);
  } catch (MotionError const&) {
    return false;
  }
  // Nodes of elements have a station each: what is off one radius there is off the profile.
  scatter_ = std::max(scatter_, profile.deviation);
  if (scatter_ > largest_scatter * size) return false;
  std::vector<std::pair<double, double>> fine;
  for (std::size_t n = 0; n + 1 < points_.size(); ++n) {
    fine.push_back(points_[n]);
    double const first = points_[n].first, step = (points_[n + 1].first - first) / parts;
    for (int p = 1; p < parts; ++p) fine.emplace_back(first + p * step, profile(first + p * step));
  }
  fine.push_back(points_.back());
  points_ = std::move(fine);
  return true;
}

std::pair<double, double> RevolutionWall::meridional(Vec3 const& point) const {
  Vec3 const d = point - axis_.origin;
  double const along = dot(d, axis_.direction);
  return {along, norm(d - along * axis_.direction)};
}

double RevolutionWall::distance(Vec3 const& point) const {
  std::pair<double, double> const place = meridional(point);
  double const axial = place.first, radius = place.second;
  // Nearest place on the line through the points, from the station of the point outwards.
  double best = std::numeric_limits<double>::infinity(), sign = 1;
  auto const look = [&](std::size_t n) {
    auto const [a, r] = points_[n];
    double const da = points_[n + 1].first - a, dr = points_[n + 1].second - r;
    double const t = std::clamp(((axial - a) * da + (radius - r) * dr) / (da * da + dr * dr), 0.0, 1.0);
    double const gap = std::hypot(axial - a - t * da, radius - r - t * dr);
    if (gap >= best) return;
    best = gap;
    sign = (axial - a) * dr - (radius - r) * da < 0 ? -1 : 1;
  };
  auto const above =
      std::upper_bound(points_.begin(), points_.end(), std::pair(axial, std::numeric_limits<double>::infinity()));
  std::size_t const pieces = points_.size() - 1;
  std::size_t const start = std::min(pieces - 1, std::size_t(std::max<std::ptrdiff_t>(0, above - points_.begin() - 1)));
  for (std::size_t n = start; n < pieces && points_[n].first - axial <= best; ++n) look(n);
  for (std::size_t n = start; n > 0 && axial - points_[n].first <= best; --n) look(n - 1);
  return sign * best;
}

SurfaceWall::SurfaceWall(FacetList const& inward, std::vector<Vec3> const& standing)
    : surface_(FacetSurface::from_facets(inward)) {
  find_sides(inward);
  if (!standing.empty()) find_holes(standing);
}

/// The surface has its normals on one side of each part that hangs together, whichever: most of the part's facets say
/// which it is.
void SurfaceWall::find_sides(FacetList const& inward) {
  DisjointSets<int> parts(surface_.facets.size());
  for (std::size_t f = 0; f < surface_.facets.size(); ++f)
    for (std::int32_t const edge : surface_.facets[f].neighbour)
      if (edge >= 0) parts.join(int(f), edge / 4);
  std::vector<int> balance(surface_.facets.size(), 0);
  auto const ask = [&](std::array<std::int32_t, 4> const& f) {
    auto const at = [&](int corner) { return inward.points[f[corner]]; };
    int const last = f[3] < 0 ? 2 : 3;
    Vec3 const middle = f[3] < 0 ? (1.0 / 3) * (at(0) + at(1) + at(2)) : 0.25 * (at(0) + at(1) + at(2) + at(3));
    auto const foot = surface_.closest_point(middle);
    double const alike = dot(cross(at(2) - at(0), at(last) - at(1)), foot.normal);
    balance[parts.root(foot.facet)] += alike < 0 ? -1 : 1;
  };
  // Some of the facets, and all of them only where these leave a part out.
  constexpr std::size_t enough = 1000;
  auto const roots = parts.roots();
  std::size_t const n = inward.facets.size();
  for (std::size_t const stride : {std::max<std::size_t>(1, n / enough), std::size_t(1)}) {
    for (std::size_t f = 0; f < n; f += stride) ask(inward.facets[f]);
    if (std::all_of(roots.begin(), roots.end(), [&](int part) { return balance[part] != 0; })) break;
  }
  for (int const part : roots) side_.push_back(balance[part] < 0 ? -1 : 1);
}

void SurfaceWall::find_holes(std::vector<Vec3> const& standing) {
  PointNumbers numbers(FacetOptions{}.weld * surface_.size());
  for (Vec3 const& p : standing) numbers.add(p, 0);
  for (Vec3 const& p : surface_.points) on_blade_.push_back(numbers.find(p) >= 0 ? 1 : 0);
}

/// Whether a foot is on a rim between two nodes that a blade has.
bool SurfaceWall::at_hole(kernels::FacetFoot const& foot) const {
  if (on_blade_.empty() || foot.place != kernels::FacetFoot::Place::rim) return false;
  kernels::Facet const& facet = surface_.facets[foot.facet];
  kernels::FacetPatch const patch = surface_.view().patch(foot.facet);
  int const corners = facet.n_corners();
  for (int q = 0; q < corners; ++q) {
    if (facet.neighbour[q] >= 0 || on_blade_[facet.corner[q]] == 0 || on_blade_[facet.corner[(q + 1) % corners]] == 0)
      continue;
    double u = 0, v = 0;
    patch.on_edge(q, patch.along_edge(q, foot.u, foot.v), u, v);
    constexpr double same = 1e-9;
    if (std::abs(u - foot.u) + std::abs(v - foot.v) < same) return true;
  }
  return false;
}

double SurfaceWall::distance(Vec3 const& point) const {
  auto const foot = surface_.closest_point(point);
  double const height = dot(point - foot.point, foot.normal);
  double const side = side_[foot.facet];
  return at_hole(foot) ? side * height : (height < 0 ? -side : side) * foot.distance;
}

std::vector<std::size_t> tip_nodes(ClearanceWall const& wall, std::vector<Vec3> const& blade, double share) {
  std::vector<double> gap;
  for (Vec3 const& node : blade) gap.push_back(std::abs(wall.distance(node)));
  std::vector<std::size_t> out;
  if (blade.empty()) return out;
  auto const [low, high] = std::minmax_element(gap.begin(), gap.end());
  double const limit = *low + share * (*high - *low);
  for (std::size_t n = 0; n < blade.size(); ++n)
    if (gap[n] <= limit) out.push_back(n);
  return out;
}

}  // namespace gridmorph
