#include <gridmorph/core/for_all.hpp>
#include <gridmorph/plan/elements/fit_domain.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

namespace gridmorph::detail {
namespace {

using Side = ChartedDomain::Side;
using Point = std::array<double, 3>;

constexpr double unset = 1e300;

Point array_of(Vec3 const& p) { return {p.x, p.y, p.z}; }

/// The boundary of a mesh as charts see it.
class Boundary {
 public:
  Boundary(HostInstance const& host, Mesh const& mesh, BoundaryFaces const& faces, std::span<std::uint8_t const> moving)
      : host_(host), mesh_(mesh), faces_(faces), moving_(moving), dimension_(std::size_t(mesh.dimension)) {
    std::vector<Index32> number(mesh.n_nodes(), -1);
    std::vector<Index32> corners;
    for (Index f = 0; f < faces.size(); ++f) {
      auto const face = faces.nodes[f];
      corners.clear();
      for (Index32 const n : face) {
        Index32& k = number[n];
        if (k < 0) {
          k = Index32(nodes_.size());
          nodes_.push_back(n);
        }
        corners.push_back(k);
      }
      corners_.add(corners);
      area_.push_back(boundary_face_size(mesh, faces, f));
    }
  }

  /// The box of a chart and what of the boundary lies on its sides.
  [[nodiscard]] FittedDomain judged(Chart chart) const {
    FittedDomain out;
    out.domain.chart = std::move(chart);
    std::vector<Point> const q = places(out.domain.chart);
    LatticeBox& box = out.domain.box;
    box = box_of(q);
    for (std::size_t c = 0; c < dimension_; ++c)
      if (auto const& l = out.domain.chart.limits[c]) {
        box.low[c] = 0;
        box.high[c] = l->width;
      }
    std::array<std::array<double, 2>, 3> on{};
    double on_sides = 0, elsewhere = 0;
    for (Index f = 0; f < faces_.size(); ++f) {
      int const side = side_of(q, f, box);
      out.side_of_face.push_back(std::int8_t(side));
      double const area = area_[f];
      if (side >= 0) {
        on[side / 2][side % 2] += area;
        on_sides += area;
      } else if (moving_[f] == 0) {
        elsewhere += area;
      }
    }
    out.share = on_sides > 0 ? on_sides / (on_sides + elsewhere) : 0;
    for (std::size_t c = 0; c < dimension_; ++c) {
      double whole = 1;
      for (std::size_t a = 0; a < dimension_; ++a)
        if (a != c) whole *= box.high[a] - box.low[a];
      for (std::size_t s = 0; s < 2; ++s)
        // The box along the axes is there for any mesh: such a mesh ends on a side only if boundary covers most of it.
        if (!out.domain.chart.is_identity() || on[c][s] > 0.5 * whole) out.domain.side[c][s] = Side::stands;
    }
    return out;
  }

  /// Limits of the second and third coordinate of an order; nothing where they meet.
  [[nodiscard]] std::optional<Chart> fitted(Chart chart) const {
    for (std::size_t k = 1; k < dimension_; ++k) {
      auto limits = envelope(chart, k);
      if (!limits) return {};
      chart.limits[chart.order[k]] = std::move(*limits);
    }
    return chart;
  }

  /// Cylindrical about an axis, angles from the middle of the mesh; nothing where it holds the axis or goes round it.
  [[nodiscard]] std::optional<Chart> sector(Axis const& axis) const {
    Chart chart;
    chart.frame = Chart::Frame::cylindrical;
    chart.origin = axis.origin;
    double const length = norm(axis.direction);
    if (!(length > 0)) return {};
    chart.axis = (1 / length) * axis.direction;
    Vec3 mean;
    double least = unset, most = 0, radii = 0;
    for (Index32 const n : nodes_) {
      Vec3 const d = mesh_.coordinates[n] - axis.origin, r = d - dot(d, chart.axis) * chart.axis;
      double const radius = norm(r);
      least = std::min(least, radius);
      most = std::max(most, radius);
      radii += radius;
      if (radius > 0) mean += (1 / radius) * r;
    }
    if (!(least > 0.1 * most) || norm(mean) < 0.3 * double(nodes_.size())) return {};
    chart.zero = (1 / norm(mean)) * mean;
    chart.quarter = cross(chart.axis, chart.zero);
    chart.radius = radii / double(nodes_.size());
    LatticeBox const box = box_of(places(chart));
    if (box.high[2] - box.low[2] > 1.7 * std::numbers::pi * chart.radius) return {};
    return chart;
  }

  /// A disc across coordinate axis `along`: the circle through what lies farthest from its centre, which begins in the
  /// middle of the mesh's box. In the two coordinates after `along` the centre may lie at an end of the mesh (-1, 1: of
  /// half a disc) instead. Nothing where the mesh reaches beyond the circle.
  [[nodiscard]] std::optional<Chart> disc(std::size_t along, std::array<int, 2> const& end) const {
    Chart chart;
    std::vector<Point> const q = places(chart);
    LatticeBox const box = box_of(q);
    std::array<std::size_t, 2> const across{(along + 1) % 3, (along + 2) % 3};
    std::array<double, 2> centre{};
    for (std::size_t k = 0; k < 2; ++k) {
      double const low = box.low[across[k]], high = box.high[across[k]];
      centre[k] = end[k] == 0 ? 0.5 * (low + high) : end[k] < 0 ? low : high;
    }
    auto const from_centre = [&](std::size_t n) {
      return std::array<double, 2>{q[n][across[0]] - centre[0], q[n][across[1]] - centre[1]};
    };
    double radius = 0;
    auto const farthest = [&] {
      double r = 0;
      for (std::size_t n = 0; n < q.size(); ++n) r = std::max(r, std::hypot(from_centre(n)[0], from_centre(n)[1]));
      return r;
    };
    for (double const from : {0.8, 0.9, 0.97, 0.99}) {
      // Least squares of x^2 + y^2 - 2 a x - 2 b y - c (I. Kasa, 1976), about the mean; one unknown where the other is
      // at an end.
      double const least = from * (radius > 0 ? radius : farthest());
      double count = 0, mx = 0, my = 0, xx = 0, xy = 0, yy = 0, xr = 0, yr = 0, mr = 0;
      for (int const pass : {0, 1})
        for (std::size_t n = 0; n < q.size(); ++n) {
          auto const [x, y] = from_centre(n);
          if (!(std::hypot(x, y) > least)) continue;
          double const r = x * x + y * y;
          if (pass == 0) {
            ++count;
            mx += x;
            my += y;
            mr += r;
            continue;
          }
          double const dx = x - mx / count, dy = y - my / count, dr = r - mr / count;
          xx += dx * dx;
          xy += dx * dy;
          yy += dy * dy;
          xr += 0.5 * dx * dr;
          yr += 0.5 * dy * dr;
        }
      if (count < 3) return {};
      double const det = xx * yy - xy * xy;
      double a = 0, b = 0;
      if (end[0] == 0 && end[1] == 0 && det > 1e-12 * xx * yy) {
        a = (xr * yy - yr * xy) / det;
        b = (yr * xx - xr * xy) / det;
      } else if (end[0] == 0 && end[1] != 0 && xx > 0) {
        a = xr / xx;
      } else if (end[1] == 0 && end[0] != 0 && yy > 0) {
        b = yr / yy;
      }
      radius = std::sqrt(std::max(0.0, mr / count - 2 * (a * mx + b * my) / count + a * a + b * b));
      centre[0] += a;
      centre[1] += b;
    }
    if (!(radius > 0) || farthest() > 1.02 * radius) return {};
    auto const unit = [](std::size_t a) { return Vec3{a == 0 ? 1.0 : 0.0, a == 1 ? 1.0 : 0.0, a == 2 ? 1.0 : 0.0}; };
    chart.frame = Chart::Frame::disc;
    chart.origin = centre[0] * unit(across[0]) + centre[1] * unit(across[1]);
    chart.radius = radius;
    chart.axis = unit(along);
    chart.zero = unit(across[0]);
    chart.quarter = unit(across[1]);
    return chart;
  }

 private:
  /// Chart coordinates of the boundary's nodes, in their order here.
  [[nodiscard]] std::vector<Point> places(Chart const& chart) const {
    std::vector<Point> q(nodes_.size());
    for_all(host_, "gridmorph::fit_domain", Index(nodes_.size()),
            [&](Index k) { q[k] = array_of(chart(mesh_.coordinates[nodes_[k]])); });
    return q;
  }
  static LatticeBox box_of(std::vector<Point> const& q) {
    LatticeBox box{{unset, unset, unset}, {-unset, -unset, -unset}};
    for (Point const& p : q)
      for (std::size_t c = 0; c < 3; ++c) {
        box.low[c] = std::min(box.low[c], p[c]);
        box.high[c] = std::max(box.high[c], p[c]);
      }
    return box;
  }

  /// The side that all nodes of a face lie on.
  [[nodiscard]] int side_of(std::vector<Point> const& q, Index face, LatticeBox const& box) const {
    for (std::size_t c = 0; c < dimension_; ++c) {
      double const slack = 0.02 * (box.high[c] - box.low[c]);
      for (int const s : {0, 1}) {
        auto on = [&](Index32 n) {
          double const x = q[n][c];
          return s == 0 ? x < box.low[c] + slack : x > box.high[c] - slack;
        };
        auto const nodes = corners_[face];
        if (std::all_of(nodes.begin(), nodes.end(), on)) return int(2 * c) + s;
      }
    }
    return -1;
  }

  /// Where the boundary ends in coordinate number k of the order, over those before it.
  [[nodiscard]] std::optional<Chart::Limits> envelope(Chart const& chart, std::size_t k) const {
    std::vector<Point> const q = places(chart);
    LatticeBox const box = box_of(q);
    auto const c = std::size_t(chart.order[k]);
    Chart::Limits limits;
    for (std::size_t a = 0; a < k; ++a) {
      auto const over = std::size_t(chart.order[a]);
      limits.over[a] = int(over);
      limits.knots[a] = dimension_ == 2 ? 129 : a == 0 ? 65 : 33;
      limits.first[a] = box.low[over];
      limits.step[a] = (box.high[over] - box.low[over]) / (limits.knots[a] - 1);
      if (!(limits.step[a] > 0) || !std::isfinite(limits.step[a])) return {};
    }
    auto const size = std::size_t(limits.knots[0] * limits.knots[1]);
    limits.low.assign(size, unset);
    limits.high.assign(size, -unset);
    for (Index f = 0; f < faces_.size(); ++f) {
      auto const face = corners_[f];
      if (k == 1)
        for (std::size_t n = 0; n < face.size(); ++n) span(limits, q[face[n]], q[face[(n + 1) % face.size()]], c);
      else
        for (std::size_t n = 1; n + 1 < face.size(); ++n) span(limits, q[face[0]], q[face[n]], q[face[n + 1]], c);
    }
    if (!fill(limits) || !widen(limits) || !fill(limits)) return {};
    double least = unset, most = 0, sum = 0;
    for (std::size_t n = 0; n < size; ++n) {
      double const width = limits.high[n] - limits.low[n];
      least = std::min(least, width);
      most = std::max(most, width);
      sum += width;
    }
    // Where the room in a coordinate shrinks too much, a lattice in it would be squeezed as much.
    if (!(least > most / 6)) return {};
    limits.width = sum / double(size);
    return limits;
  }

  /// The place of a knot: those at the ends a little inside, where the boundary surely is.
  static double knot(Chart::Limits const& limits, std::size_t a, int i) {
    constexpr double inside = 1e-3;
    int const last = limits.knots[a] - 1;
    return limits.first[a] + limits.step[a] * std::clamp(double(i), inside, last - inside);
  }
  static std::pair<int, int> knots_in(Chart::Limits const& limits, std::size_t a, double low, double high) {
    // Clamped before they are whole numbers, which places far away are too large for.
    double const last = limits.knots[a] - 1;
    return {int(std::clamp(std::floor((low - limits.first[a]) / limits.step[a]), 0.0, last)),
            int(std::clamp(std::ceil((high - limits.first[a]) / limits.step[a]), 0.0, last))};
  }
  static void include(Chart::Limits& limits, int i, int j, double value) {
    auto const n = std::size_t(i + limits.knots[0] * j);
    limits.low[n] = std::min(limits.low[n], value);
    limits.high[n] = std::max(limits.high[n], value);
  }

  /// Takes an edge into the limits over one coordinate.
  static void span(Chart::Limits& limits, Point const& p, Point const& q, std::size_t c) {
    auto const over = std::size_t(limits.over[0]);
    auto const [first, last] = knots_in(limits, 0, std::min(p[over], q[over]), std::max(p[over], q[over]));
    for (int i = first; i <= last; ++i) {
      double const s = knot(limits, 0, i) - p[over], length = q[over] - p[over];
      if (length == 0) continue;
      double const t = s / length;
      if (t >= 0 && t <= 1) include(limits, i, 0, p[c] + t * (q[c] - p[c]));
    }
  }
  /// Takes a triangle into the limits over two.
  static void span(Chart::Limits& limits, Point const& p, Point const& q, Point const& r, std::size_t c) {
    auto const a = std::size_t(limits.over[0]), b = std::size_t(limits.over[1]);
    double const twice = (q[a] - p[a]) * (r[b] - p[b]) - (q[b] - p[b]) * (r[a] - p[a]);
    if (twice == 0) return;
    auto const [i0, i1] = knots_in(limits, 0, std::min({p[a], q[a], r[a]}), std::max({p[a], q[a], r[a]}));
    auto const [j0, j1] = knots_in(limits, 1, std::min({p[b], q[b], r[b]}), std::max({p[b], q[b], r[b]}));
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        double const x = knot(limits, 0, i) - p[a], y = knot(limits, 1, j) - p[b];
        double const s = (x * (r[b] - p[b]) - y * (r[a] - p[a])) / twice,
                     t = ((q[a] - p[a]) * y - (q[b] - p[b]) * x) / twice;
        constexpr double slack = 1e-9;
        if (s >= -slack && t >= -slack && s + t <= 1 + slack)
          include(limits, i, j, p[c] + s * (q[c] - p[c]) + t * (r[c] - p[c]));
      }
  }

  /// Leaves out knots between which there is much less room than usual, which are where an end of the mesh that is no
  /// plane cuts the sides off; false where these are more than a few.
  static bool widen(Chart::Limits& limits) {
    std::vector<double> widths;
    for (std::size_t n = 0; n < limits.low.size(); ++n) widths.push_back(limits.high[n] - limits.low[n]);
    std::vector<double> sorted = widths;
    auto const middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    double const least = 0.4 * *middle;
    std::size_t narrow = 0;
    for (std::size_t n = 0; n < widths.size(); ++n)
      if (widths[n] < least) {
        limits.low[n] = unset;
        limits.high[n] = -unset;
        ++narrow;
      }
    return double(narrow) <= 0.04 * double(widths.size());
  }

  /// Knots beside which the boundary is not take the mean of their neighbours'; whether there were any to begin with. A
  /// knot is filled once, also with a mean that leaves no room between its ends (the ends of a folded mesh may differ
  /// by round-off alone): so each round fills some.
  static bool fill(Chart::Limits& limits) {
    auto const size = limits.low.size();
    std::vector<std::uint8_t> known(size);
    std::size_t left = 0;
    for (std::size_t n = 0; n < size; ++n) {
      known[n] = limits.high[n] > limits.low[n] ? 1 : 0;
      left += 1 - known[n];
    }
    std::vector<std::pair<std::size_t, std::array<double, 2>>> found;
    while (left > 0) {
      found.clear();
      for (std::size_t n = 0; n < size; ++n) {
        if (known[n] != 0) continue;
        int const i = int(n) % limits.knots[0], j = int(n) / limits.knots[0];
        std::array<double, 2> sum{};
        int count = 0;
        for (auto const& [di, dj] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
          if (i + di < 0 || i + di >= limits.knots[0] || j + dj < 0 || j + dj >= limits.knots[1]) continue;
          auto const m = std::size_t(i + di + limits.knots[0] * (j + dj));
          if (known[m] == 0) continue;
          sum[0] += limits.low[m];
          sum[1] += limits.high[m];
          ++count;
        }
        if (count > 0) found.push_back({n, {sum[0] / count, sum[1] / count}});
      }
      if (found.empty()) return false;
      for (auto const& [n, ends] : found) {
        limits.low[n] = ends[0];
        limits.high[n] = ends[1];
        known[n] = 1;
      }
      left -= found.size();
    }
    return true;
  }

  HostInstance const& host_;
  Mesh const& mesh_;
  BoundaryFaces const& faces_;
  std::span<std::uint8_t const> moving_;
  std::size_t dimension_;
  std::vector<Index32> nodes_;
  CsrGraph corners_;  ///< of the faces, numbers in nodes_
  std::vector<double> area_;
};

}  // namespace

double boundary_face_size(Mesh const& mesh, BoundaryFaces const& faces, Index face) {
  auto const nodes = faces.nodes[face];
  Vec3 const a = mesh.coordinates[nodes[0]];
  if (mesh.dimension == 2) return distance(a, mesh.coordinates[nodes[1]]);
  double size = 0;
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k)
    size += 0.5 * norm(cross(mesh.coordinates[nodes[k]] - a, mesh.coordinates[nodes[k + 1]] - a));
  return size;
}

FittedDomain fit_domain(HostInstance const& host, Mesh const& mesh, BoundaryFaces const& faces,
                        std::span<std::uint8_t const> moving, std::span<Axis const> axes) {
  constexpr double enough = 0.8, gain = 0.2;
  Boundary const boundary(host, mesh, faces, moving);
  FittedDomain const plain = boundary.judged({});
  if (plain.share >= enough) return plain;
  std::vector<Chart> charts;
  if (mesh.dimension == 3)
    for (Axis const& axis : axes)
      if (auto const chart = boundary.sector(axis)) charts.push_back(*chart);
  std::array<int, 3> order{0, 1, 2};
  do {
    if (mesh.dimension == 2 && order[2] != 2) continue;
    charts.emplace_back().order = order;
  } while (std::next_permutation(order.begin(), order.end()));
  FittedDomain best = plain;
  auto const take = [&](std::optional<Chart> const& chart) {
    if (!chart) return;
    FittedDomain found = boundary.judged(*chart);
    // Round-off does not decide between charts that do as well.
    if (found.share > best.share + (best.domain.chart.is_identity() ? gain : 0.01)) best = std::move(found);
  };
  for (Chart const& chart : charts) take(boundary.fitted(chart));
  for (std::size_t const along : {2u, 0u, 1u})
    for (int const v : {0, -1, 1})
      for (int const u : {0, -1, 1})
        if (mesh.dimension == 3 || along == 2) take(boundary.disc(along, {u, v}));
  return best;
}

}  // namespace gridmorph::detail
