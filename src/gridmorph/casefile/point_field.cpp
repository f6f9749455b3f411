#include <gridmorph/casefile/point_field.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>
#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numeric>
#include <unordered_set>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

constexpr std::size_t n_neighbours = 13;  // per level
/// A neighbourhood whose second principal variance is below this share of the first counts as a line.
constexpr double line_like = 0.1;
/// Points of each thinned level are this much farther apart than those of the level below.
constexpr double thinning = 4;
/// Variances below this share of the largest are no direction to fit a gradient in; smooth cut-off.
constexpr double flat_like = 1e-6;
/// From the centre of the neighbours no farther along a direction than this times their own reach along it.
constexpr double largest_extrapolation = 2;
constexpr double conflict = 1e-6;  // of the largest displacement

struct Points {
  std::vector<Vec3> const* position;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return position->size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    Vec3 const& p = (*position)[i];
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::size_t>;

/// Eigenvalues (in value) and eigenvectors (columns of the result) of a symmetric matrix, by Jacobi rotations.
Mat3 eigenvectors(Mat3 a, std::array<double, 3>& value) {
  Mat3 v;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double const off = std::fabs(a.m[0][1]) + std::fabs(a.m[0][2]) + std::fabs(a.m[1][2]);
    double const trace = std::fabs(a.m[0][0]) + std::fabs(a.m[1][1]) + std::fabs(a.m[2][2]);
    if (off <= 1e-17 * trace) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a.m[p][q] == 0) continue;
        double const h = (a.m[q][q] - a.m[p][p]) / (2 * a.m[p][q]);
        double const t = (h >= 0 ? 1.0 : -1.0) / (std::fabs(h) + std::sqrt(h * h + 1));
        double const c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          double const kp = a.m[k][p], kq = a.m[k][q];
          a.m[k][p] = c * kp - s * kq;
          a.m[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          double const pk = a.m[p][k], qk = a.m[q][k];
          a.m[p][k] = c * pk - s * qk;
          a.m[q][k] = s * pk + c * qk;
          double const vp = v.m[k][p], vq = v.m[k][q];
          v.m[k][p] = c * vp - s * vq;
          v.m[k][q] = s * vp + c * vq;
        }
      }
  }
  for (int k = 0; k < 3; ++k) value[k] = a.m[k][k];
  return v;
}

Vec3 column(Mat3 const& a, int c) { return {a.m[0][c], a.m[1][c], a.m[2][c]}; }

/// The points, or one point per cell of a grid: neighbours on surface meshes that are stretched a hundredfold all lie on
/// one grid line, and a thinned level finds the next lines without walking along this one.
struct Level {
  std::vector<std::size_t> number;  ///< in the cloud
  std::vector<Vec3> position;
  Points points{nullptr};
  std::unique_ptr<Tree> tree;

  Level(std::vector<std::size_t> n, std::vector<Vec3> const& all) : number(std::move(n)) {
    for (std::size_t const i : number) position.push_back(all[i]);
    points.position = &position;
    tree = std::make_unique<Tree>(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree->buildIndex();
  }
  Level(Level const&) = delete;
  Level& operator=(Level const&) = delete;
};

/// The first of the points in every cell of a grid of this spacing.
std::vector<std::size_t> thinned(Level const& level, double spacing) {
  struct Hash {
    std::size_t operator()(std::array<std::int64_t, 3> const& c) const {
      std::uint64_t h = 0;
      for (auto const v : c) h = ((h ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15ull) ^ (h >> 29);
      return std::size_t(h);
    }
  };
  std::unordered_set<std::array<std::int64_t, 3>, Hash> seen;
  std::vector<std::size_t> out;
  Vec3 const origin = level.position.front();
  for (std::size_t i = 0; i < level.number.size(); ++i) {
    Vec3 const d = (1 / spacing) * (level.position[i] - origin);
    if (seen.insert({std::int64_t(std::floor(d.x)), std::int64_t(std::floor(d.y)), std::int64_t(std::floor(d.z))})
            .second)
      out.push_back(level.number[i]);
  }
  return out;
}

/// Typical distance of a point to its nearest neighbour: the median over a sample.
double typical_spacing(Level const& level) {
  std::vector<double> nearest;
  std::size_t const step = std::max<std::size_t>(1, level.number.size() / 1000);
  for (std::size_t i = 0; i < level.number.size(); i += step) {
    Vec3 const& p = level.position[i];
    double const q[3] = {p.x, p.y, p.z};
    std::array<std::size_t, 2> number{};
    std::array<double, 2> squared{};
    if (level.tree->knnSearch(q, 2, number.data(), squared.data()) == 2) nearest.push_back(std::sqrt(squared[1]));
  }
  if (nearest.empty()) return 0;
  auto const middle = nearest.begin() + std::ptrdiff_t(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

/// The points that a fit at q uses, as offsets from q; the nearest one first.
struct Neighbours {
  std::vector<std::size_t> number;
  std::vector<Vec3> offset;

  void add(Level const& level, Vec3 const& q) {
    std::array<std::size_t, n_neighbours> found{};
    std::array<double, n_neighbours> squared{};
    double const position[3] = {q.x, q.y, q.z};
    std::size_t const n = level.tree->knnSearch(position, n_neighbours, found.data(), squared.data());
    std::size_t const before = number.size();
    for (std::size_t f = 0; f < n; ++f) {
      std::size_t const i = level.number[found[f]];
      if (std::find(number.begin(), number.begin() + std::ptrdiff_t(before), i) !=
          number.begin() + std::ptrdiff_t(before))
        continue;
      number.push_back(i);
      offset.push_back(level.position[found[f]] - q);
    }
  }
};

/// Weighted second moments about the weighted mean.
struct Moments {
  Vec3 centre;                     ///< weighted mean of the offsets
  std::array<double, 3> variance;  ///< principal
  Mat3 direction;                  ///< their directions, columns

  Moments(std::vector<Vec3> const& offset, std::vector<double> const& weight) {
    for (std::size_t i = 0; i < offset.size(); ++i) centre += weight[i] * offset[i];
    Mat3 c{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    for (std::size_t i = 0; i < offset.size(); ++i) {
      Vec3 const d = offset[i] - centre;
      double const a[3] = {d.x, d.y, d.z};
      for (int r = 0; r < 3; ++r)
        for (int s = 0; s < 3; ++s) c.m[r][s] += weight[i] * a[r] * a[s];
    }
    direction = eigenvectors(c, variance);
  }
};

bool on_a_line(Neighbours const& neighbours) {
  std::size_t const n = neighbours.number.size();
  auto variance = Moments(neighbours.offset, std::vector<double>(n, 1.0 / double(n))).variance;
  std::sort(variance.begin(), variance.end());
  return variance[1] < line_like * variance[2];
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

}  // namespace

struct PointField::Impl {
  PointCloud cloud;
  FieldOptions options;
  double coincidence = 0;
  double largest = 0;                          // displacement
  std::vector<std::unique_ptr<Level>> levels;  // all points first
  mutable std::mutex turn;
  mutable MappingDistance mapping;
  mutable double sum = 0;

  void scale();
  void drop_repeated_points();
  void measure();
  void build_levels();
  [[nodiscard]] Vec3 fit(Vec3 const& q) const;
};

void PointField::Impl::scale() {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (options.length_scale != 1) cloud.position[i] = options.length_scale * cloud.position[i];
    double const s = options.length_scale * options.factor;
    if (s != 1) cloud.displacement[i] = s * cloud.displacement[i];
    double const n = norm(cloud.displacement[i]);
    if (!std::isfinite(norm(cloud.position[i])) || !std::isfinite(n))
      throw ConfigError(cloud.where(i) + ": position or displacement is not finite after scaling");
    largest = std::max(largest, n);
  }
}

void PointField::Impl::drop_repeated_points() {
  auto const& p = cloud.position;
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  auto const before = [&](std::size_t a, std::size_t b) {
    if (p[a].x != p[b].x) return p[a].x < p[b].x;
    if (p[a].y != p[b].y) return p[a].y < p[b].y;
    if (p[a].z != p[b].z) return p[a].z < p[b].z;
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<char> keep(p.size(), 1);
  for (std::size_t n = 1, first = 0; n < order.size(); ++n) {
    std::size_t const a = order[first], b = order[n];
    if (!(p[a] == p[b])) {
      first = n;
      continue;
    }
    keep[b] = 0;
    Vec3 const ua = cloud.displacement[a], ub = cloud.displacement[b];
    if (distance(ua, ub) > conflict * largest)
      throw ConfigError(
          fmt::format("{}: the point ({:.9g}, {:.9g}, {:.9g}) moves by ({:.6g}, {:.6g}, {:.6g}), but by ({:.6g}, "
                      "{:.6g}, {:.6g}) in line {}; give each point one displacement",
                      cloud.where(b), p[b].x, p[b].y, p[b].z, ub.x, ub.y, ub.z, ua.x, ua.y, ua.z, cloud.line[a]));
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (keep[i] == 0) continue;
    cloud.position[kept] = cloud.position[i];
    cloud.displacement[kept] = cloud.displacement[i];
    cloud.line[kept] = cloud.line[i];
    ++kept;
  }
  cloud.position.resize(kept);
  cloud.displacement.resize(kept);
  cloud.line.resize(kept);
}

void PointField::Impl::measure() {
  Vec3 low = cloud.position.front(), high = low;
  double magnitude = 0;
  for (Vec3 const& p : cloud.position) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    magnitude = std::max({magnitude, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }
  coincidence = 1e-7 * std::max(distance(low, high), magnitude);
}

void PointField::Impl::build_levels() {
  std::vector<std::size_t> all(cloud.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  levels.push_back(std::make_unique<Level>(std::move(all), cloud.position));
  double spacing = typical_spacing(*levels.front());
  while (spacing > 0 && levels.back()->number.size() > 2 * n_neighbours) {
    spacing *= thinning;
    levels.push_back(std::make_unique<Level>(thinned(*levels.back(), spacing), cloud.position));
  }
}

Vec3 PointField::Impl::fit(Vec3 const& q) const {
  Neighbours near;
  for (auto const& level : levels) {
    near.add(*level, q);
    if (!on_a_line(near)) break;
  }
  std::vector<double> const w = weights(near.offset);
  Moments const m(near.offset, w);
  // Relative to the nearest point's displacement, so that constants come out exactly.
  Vec3 const u0 = cloud.displacement[near.number[0]];
  std::vector<Vec3> u(w.size());
  Vec3 mean{0, 0, 0};
  for (std::size_t i = 0; i < w.size(); ++i) {
    u[i] = cloud.displacement[near.number[i]] - u0;
    mean += w[i] * u[i];
  }
  Vec3 value = u0 + mean;
  double const cut = flat_like * std::max({m.variance[0], m.variance[1], m.variance[2]});
  for (int k = 0; k < 3; ++k) {
    double const lambda = m.variance[k];
    if (!(lambda > 0)) continue;
    Vec3 const e = column(m.direction, k);
    Vec3 slope{0, 0, 0};
    double reach = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
      double const along = dot(near.offset[i] - m.centre, e);
      reach = std::max(reach, std::fabs(along));
      slope += (w[i] * along) * u[i];
    }
    double const step = std::clamp(-dot(m.centre, e), -largest_extrapolation * reach, largest_extrapolation * reach);
    // lambda / (lambda^2 + cut^2) is 1 / lambda for directions that the points span and fades to zero for the others.
    value += (step * lambda / (lambda * lambda + cut * cut)) * slope;
  }
  return value;
}

PointField::PointField(PointCloud cloud, FieldOptions const& options) : impl_(std::make_unique<Impl>()) {
  if (cloud.size() == 0) throw ConfigError(cloud.source + ": holds no points; expected lines of x, y, z, dx, dy, dz");
  impl_->cloud = std::move(cloud);
  impl_->options = options;
  impl_->scale();
  impl_->drop_repeated_points();
  impl_->measure();
  impl_->build_levels();
}

PointField::~PointField() = default;
PointField::PointField(PointField&&) noexcept = default;
PointField& PointField::operator=(PointField&&) noexcept = default;

void PointField::operator()(std::span<Vec3 const> points, std::span<Vec3> displacement) const {
  MappingDistance here;
  double sum = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    Vec3 const q = points[n];
    double const position[3] = {q.x, q.y, q.z};
    std::size_t nearest = 0;
    double nearest_squared = 0;
    if (!std::isfinite(norm(q)))
      throw MotionError(fmt::format("{}: asked for the displacement at ({}, {}, {}), which is not finite",
                                    impl_->cloud.source, q.x, q.y, q.z));
    impl_->levels.front()->tree->knnSearch(position, 1, &nearest, &nearest_squared);
    double const d = std::sqrt(nearest_squared);
    ++here.evaluated;
    sum += d;
    if (d > here.max || here.evaluated == 1) {
      here.max = d;
      here.farthest = q;
    }
    if (d <= impl_->coincidence) {
      ++here.coincident;
      displacement[n] = impl_->cloud.displacement[nearest];
      continue;
    }
    if (impl_->options.max_distance > 0 && d > impl_->options.max_distance)
      throw MotionError(
          fmt::format("{}: the node at ({:.9g}, {:.9g}, {:.9g}) is {:.6g} from the nearest point (line {}), "
                      "farther than max_distance = {:.6g}; check units and position of the file",
                      impl_->cloud.source, q.x, q.y, q.z, d, impl_->cloud.line[nearest], impl_->options.max_distance));
    displacement[n] = impl_->fit(q);
  }
  std::lock_guard const lock(impl_->turn);
  MappingDistance& all = impl_->mapping;
  if (here.max > all.max || all.evaluated == 0) {
    all.max = here.max;
    all.farthest = here.farthest;
  }
  all.evaluated += here.evaluated;
  all.coincident += here.coincident;
  impl_->sum += sum;
}

std::size_t PointField::size() const { return impl_->cloud.size(); }
double PointField::coincidence() const { return impl_->coincidence; }
std::string const& PointField::source() const { return impl_->cloud.source; }

MappingDistance PointField::mapping() const {
  std::lock_guard const lock(impl_->turn);
  MappingDistance all = impl_->mapping;
  if (all.evaluated > 0) all.mean = impl_->sum / double(all.evaluated);
  return all;
}

std::string describe_mapping(PointField const& field) {
  auto const m = field.mapping();
  if (m.evaluated == m.coincident)
    return fmt::format("{}: all {} node positions coincide with points of the file (largest distance {:.3g})",
                       field.source(), m.evaluated, m.max);
  return fmt::format(
      "{}: {} of {} node positions coincide with points of the file, the others are interpolated; mapping "
      "distance mean {:.3g}, largest {:.3g} at ({:.6g}, {:.6g}, {:.6g})",
      field.source(), m.coincident, m.evaluated, m.mean, m.max, m.farthest.x, m.farthest.y, m.farthest.z);
}

}  // namespace gridmorph
