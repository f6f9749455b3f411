#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/geometry/unit.hpp>
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/plan/elements/wrap.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph {
namespace {

Vec3 unit_vector(std::size_t axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

/// Place between sections: the lower one and the fraction to the next.
struct Level {
  int section = 0;
  double t = 0;
};

Level level_of(Tube const& tube, double s) {
  auto const above = std::upper_bound(tube.station.begin() + 1, tube.station.end() - 1, s);
  int const j = int(above - tube.station.begin()) - 1;
  double const from = tube.station[j], to = tube.station[j + 1];
  return {j, std::clamp((s - from) / (to - from), 0.0, 1.0)};
}

Vec3 between(Vec3 const& a, Vec3 const& b, double t) { return a + t * (b - a); }

constexpr double ring_start = -0.75 * std::numbers::pi;  ///< direction of a ring's first point after rounding

}  // namespace

double Tube::largest_radius() const {
  double largest = 0;
  for (int j = 0; j < sections(); ++j)
    for (int k = 0; k < around; ++k) largest = std::max(largest, distance(point(j, k), centre[j]));
  return largest;
}

bool Tube::contains(Vec3 const& p) const {
  double const s = dot(p, axis);
  if (s < station.front() || s > station.back()) return false;
  Level const level = level_of(*this, s);
  int const j = level.section;
  double const t = level.t;
  Vec3 const c = between(centre[j], centre[j + 1], t);
  double const a = dot(p - c, u), b = dot(p - c, v);
  auto corner = [&](int k) {
    Vec3 const d = between(point(j, k), point(j + 1, k), t) - c;
    return std::array<double, 2>{dot(d, u), dot(d, v)};
  };
  double const x = rounding[0] * a + rounding[1] * b, y = rounding[1] * a + rounding[2] * b;
  double turn = (std::atan2(y, x) - ring_start) / (2 * std::numbers::pi);
  turn -= std::floor(turn);
  if (!std::isfinite(turn)) return false;  // the walls are so far apart that their sections have no shape
  int const k = std::min(int(turn * around), around - 1);
  auto const p0 = corner(k), p1 = corner(k + 1);
  return (p1[0] - p0[0]) * (b - p0[1]) - (p1[1] - p0[1]) * (a - p0[0]) >= 0;
}

bool Tube::meets(LatticeBox const& box) const {
  Vec3 const low{box.low[0], box.low[1], box.low[2]}, high{box.high[0], box.high[1], box.high[2]};
  Vec3 const middle = 0.5 * (low + high);
  double const reach = 0.5 * norm(high - low), s = dot(middle, axis);
  if (s + reach < station.front() || s - reach > station.back()) return false;
  int const first = level_of(*this, s - reach).section, last = level_of(*this, s + reach).section + 1;
  // The box's ball against a cone about each piece of the centre line.
  bool close = false;
  for (int j = first; j < last && !close; ++j) {
    double radius = 0;
    for (int k = 0; k < around; ++k)
      radius = std::max({radius, distance(point(j, k), centre[j]), distance(point(j + 1, k), centre[j + 1])});
    Vec3 const from = centre[j], along = centre[j + 1] - from;
    double const t = std::clamp(dot(middle - from, along) / dot(along, along), 0.0, 1.0);
    close = distance(middle, from + t * along) <= radius + reach;
  }
  if (!close) return false;
  for (int n = 0; n < 27; ++n) {
    double const i = 0.5 * (n % 3), j = 0.5 * (n / 3 % 3), k = 0.5 * double(n / 9);
    if (contains({low.x + i * (high.x - low.x), low.y + j * (high.y - low.y), low.z + k * (high.z - low.z)}))
      return true;
  }
  auto in_box = [&](Vec3 const& p) {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  };
  for (int j = first; j <= last; ++j) {
    if (in_box(centre[j])) return true;
    for (int k = 0; k < around; ++k)
      if (in_box(point(j, k))) return true;
  }
  return false;
}

namespace {

constexpr int ring_points = 32;
constexpr int directions = 128;  ///< of the support lines of a section's hull

/// The wall faces, each as its corners, centroid and area (length in 2-D).
struct Faces {
  Mesh const& mesh;
  std::span<CsrGraph const> walls;

  template <class Function>
  void for_all(Function const& f) const {
    std::vector<Vec3> corners;
    for (CsrGraph const& list : walls)
      for (Index n = 0; n < list.size(); ++n) {
        corners.clear();
        Vec3 middle, normal;
        for (Index32 const node : list[n]) corners.push_back(mesh.coordinates[node]);
        for (Vec3 const& p : corners) middle += (1.0 / double(corners.size())) * p;
        for (std::size_t c = 0; c < corners.size(); ++c)
          normal += 0.5 * cross(corners[c] - middle, corners[(c + 1) % corners.size()] - middle);
        f(corners, middle, norm(normal));
      }
  }
};

class Fitter {
 public:
  Fitter(Mesh const& mesh, std::span<CsrGraph const> walls, double offset) : faces_{mesh, walls}, offset_(offset) {}

  std::optional<Tube> run(std::string& note) {
    find_axes();
    find_stations();
    if (!find_centres()) {
      note = "the walls leave gaps along their axis";
      return std::nullopt;
    }
    find_stretch();
    find_rings();
    if (!std::isfinite(tube_.largest_radius()) ||
        !std::isfinite(tube_.rounding[0] + tube_.rounding[1] + tube_.rounding[2])) {
      note = "the walls are too far apart for their sections to have a shape";
      return std::nullopt;
    }
    double const width = 2 * tube_.largest_radius();
    if (tube_.length() < 1.25 * width) {
      note = "the walls with their offset are " + std::to_string(tube_.length()) + " long and " +
             std::to_string(width) + " wide: no tube";
      return std::nullopt;
    }
    return std::move(tube_);
  }

 private:
  void find_axes() {
    double area = 0;
    Vec3 mean;
    faces_.for_all([&](auto const&, Vec3 const& middle, double a) {
      mean += a * middle;
      area += a;
    });
    mean = (1 / area) * mean;
    Moments spread;
    faces_.for_all([&](auto const&, Vec3 const& middle, double a) { spread.add(a, middle - mean); });
    tube_.axis = PrincipalAxes(spread).direction[0];
    std::size_t nearest = 2;
    for (std::size_t a = 0; a < 3; ++a)
      if (std::abs(component(tube_.axis, int(a))) > std::abs(component(tube_.axis, int(nearest))) + 1e-9) nearest = a;
    if (component(tube_.axis, int(nearest)) < 0) tube_.axis = -tube_.axis;
    tube_.box_axis = int(nearest);
    Vec3 const x = unit_vector((nearest + 1) % 3);
    tube_.u = unit(x - dot(x, tube_.axis) * tube_.axis);
    tube_.v = cross(tube_.axis, tube_.u);
  }

  void find_stations() {
    double low = 1e300, high = -1e300;
    double width = 0;
    Vec3 const some = faces_.mesh.coordinates[faces_.walls.front()[0][0]];
    faces_.for_all([&](auto const& corners, Vec3 const&, double) {
      for (Vec3 const& p : corners) {
        double const s = dot(p, tube_.axis);
        low = std::min(low, s);
        high = std::max(high, s);
        Vec3 const across = p - some - dot(p - some, tube_.axis) * tube_.axis;
        width = std::max(width, norm(across));
      }
    });
    low -= offset_;
    high += offset_;
    // Clamped before it is a whole number, which lengths far beyond the width are too large for.
    int const n = int(std::clamp(2 * (high - low) / (width + 2 * offset_), 6.0, 16.0));
    for (int j = 0; j <= n; ++j) tube_.station.push_back(j == n ? high : low + j * (high - low) / n);
  }

  /// First and last of the sections that a face lies between.
  [[nodiscard]] std::pair<int, int> sections_of(std::vector<Vec3> const& corners) const {
    double low = 1e300, high = -1e300;
    for (Vec3 const& p : corners) {
      low = std::min(low, dot(p, tube_.axis));
      high = std::max(high, dot(p, tube_.axis));
    }
    return {level_of(tube_, low).section, level_of(tube_, high).section + 1};
  }

  bool find_centres() {
    std::size_t const n = tube_.station.size();
    std::vector<double> weight(n, 0);
    tube_.centre.assign(n, {});
    faces_.for_all([&](auto const& corners, Vec3 const& middle, double area) {
      auto const [first, last] = sections_of(corners);
      for (auto j = std::size_t(first); j <= std::size_t(last); ++j) {
        weight[j] += area;
        tube_.centre[j] += area * middle;
      }
    });
    for (std::size_t j = 0; j < n; ++j) {
      if (!(weight[j] > 0)) return false;
      Vec3 const c = (1 / weight[j]) * tube_.centre[j];
      tube_.centre[j] = c + (tube_.station[j] - dot(c, tube_.axis)) * tube_.axis;
    }
    for (int round = 0; round < 2; ++round) {
      std::vector<Vec3> const before = tube_.centre;
      for (std::size_t j = 1; j + 1 < n; ++j)
        tube_.centre[j] = 0.25 * (before[j - 1] + 2.0 * before[j] + before[j + 1]);
    }
    return true;
  }

  /// The square root of the sections' spread about their centres: flat sections become round where it is divided out.
  void find_stretch() {
    double uu = 0, uv = 0, vv = 0, area = 0;
    faces_.for_all([&](auto const&, Vec3 const& middle, double a) {
      auto const [j, t] = level_of(tube_, dot(middle, tube_.axis));
      Vec3 const d = middle - between(tube_.centre[j], tube_.centre[j + 1], t);
      double const x = dot(d, tube_.u), y = dot(d, tube_.v);
      uu += a * x * x;
      uv += a * x * y;
      vv += a * y * y;
      area += a;
    });
    uu = uu / area + offset_ * offset_;
    vv = vv / area + offset_ * offset_;
    uv /= area;
    double const root = std::sqrt(uu * vv - uv * uv), scale = 1 / std::sqrt(uu + vv + 2 * root);
    stretch_ = {scale * (uu + root), scale * uv, scale * (vv + root)};
    double const determinant = stretch_[0] * stretch_[2] - stretch_[1] * stretch_[1];
    tube_.rounding = {stretch_[2] / determinant, -stretch_[1] / determinant, stretch_[0] / determinant};
  }
  [[nodiscard]] std::array<double, 2> stretched(double x, double y) const {
    return {stretch_[0] * x + stretch_[1] * y, stretch_[1] * x + stretch_[2] * y};
  }
  [[nodiscard]] std::array<double, 2> unstretched(double x, double y) const {
    auto const& r = tube_.rounding;
    return {r[0] * x + r[1] * y, r[1] * x + r[2] * y};
  }

  void find_rings() {
    std::size_t const n = tube_.station.size();
    tube_.around = ring_points;
    // Support of the hull of each section in each direction, about its centre; the centre counts as one of its points.
    std::vector<double> support(n * directions, 0);
    auto angle = [](double m) { return ring_start + 2 * std::numbers::pi * m; };
    std::array<double, directions> cosine{}, sine{}, shift{};
    for (std::size_t m = 0; m < directions; ++m) {
      cosine[m] = std::cos(angle(double(m) / directions));
      sine[m] = std::sin(angle(double(m) / directions));
      auto const normal = unstretched(cosine[m], sine[m]);
      shift[m] = offset_ * std::hypot(normal[0], normal[1]);
    }
    auto include = [&](Vec3 const& p, std::size_t section) {
      // Between sections that are not above one another, the centre line there is what rings are interpolated about.
      auto const [at, t] = level_of(tube_, dot(p, tube_.axis));
      Vec3 const c = between(tube_.centre[at], tube_.centre[at + 1], t);
      auto const w = unstretched(dot(p - c, tube_.u), dot(p - c, tube_.v));
      for (std::size_t m = 0; m < directions; ++m) {
        double& h = support[section * directions + m];
        h = std::max(h, w[0] * cosine[m] + w[1] * sine[m]);
      }
    };
    // Nodes of faces between two sections count for these, once; longer faces for all sections they pass.
    std::vector<char> done(faces_.mesh.n_nodes(), 0);
    std::vector<Vec3> corners;
    for (CsrGraph const& list : faces_.walls)
      for (Index f = 0; f < list.size(); ++f) {
        corners.clear();
        for (Index32 const node : list[f]) corners.push_back(faces_.mesh.coordinates[node]);
        auto const [first, last] = sections_of(corners);
        for (std::size_t c = 0; c < corners.size(); ++c) {
          char& seen = done[list[f][c]];
          if (last - first == 1 && seen != 0) continue;
          if (last - first == 1) seen = 1;
          for (int j = first; j <= last; ++j) include(corners[c], std::size_t(j));
        }
      }
    std::vector<double> radius(n * ring_points, 0);
    for (std::size_t j = 0; j < n; ++j) set_radii(&support[j * directions], shift, &radius[j * ring_points]);
    std::vector<double> const before = radius;
    for (std::size_t j = 1; j + 1 < n; ++j)
      for (std::size_t k = 0; k < ring_points; ++k) {
        auto at = [&](std::size_t section) { return before[section * ring_points + k]; };
        radius[j * ring_points + k] = std::max(at(j), 0.25 * (at(j - 1) + 2 * at(j) + at(j + 1)));
      }
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < ring_points; ++k) {
        double const r = radius[j * ring_points + k], a = angle(double(k) / ring_points);
        auto const d = stretched(r * std::cos(a), r * std::sin(a));
        tube_.ring.push_back(tube_.centre[j] + d[0] * tube_.u + d[1] * tube_.v);
      }
  }

  /// Radii of the ring's corners, so that its sides enclose the hull with its offset: the largest radius of the hull up
  /// to the neighbours on both sides, over the cosine of half a step.
  static void set_radii(double const* support, std::array<double, directions> const& shift, double* radius) {
    std::array<double, directions> hull{};
    for (std::size_t m = 0; m < directions; ++m) {
      hull[m] = 1e300;
      for (int step = -directions / 5; step <= directions / 5; ++step) {
        auto const other = std::size_t((int(m) + step + directions) % directions);
        hull[m] =
            std::min(hull[m], (support[other] + shift[other]) / std::cos(2 * std::numbers::pi * step / directions));
      }
    }
    constexpr int per_side = directions / ring_points;
    for (int k = 0; k < ring_points; ++k) {
      radius[k] = 0;
      for (int step = -per_side; step <= per_side; ++step)
        radius[k] = std::max(radius[k], hull[(k * per_side + step + directions) % directions]);
      radius[k] /= std::cos(std::numbers::pi / ring_points);
    }
  }

  Faces faces_;
  double offset_;
  Tube tube_;
  std::array<double, 3> stretch_{1, 0, 1};
};

}  // namespace

std::optional<Tube> fit_tube(Mesh const& mesh, std::span<CsrGraph const> walls, double offset, std::string& note) {
  if (mesh.dimension == 2) {
    note = "the mesh is plane";
    return std::nullopt;
  }
  return Fitter(mesh, walls, offset).run(note);
}

}  // namespace gridmorph
