#include <gridmorph/plan/elements/wrap.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::detail {
namespace {

struct Interval {
  double low = 0, high = 0;
  [[nodiscard]] double length() const { return high - low; }
};

/// Where along one axis there are walls, each interval wider by the offset than its walls. Gaps show where they leave a
/// thousandth of the whole empty; linear cost.
std::vector<Interval> covered(Coordinates const& q, std::span<CsrGraph const> walls, Reaches const& reach,
                              std::size_t axis) {
  auto const& x = axis == 0 ? q.x : axis == 1 ? q.y : q.z;
  std::vector<Interval> faces;
  Interval all{1e300, -1e300};
  for (CsrGraph const& list : walls)
    for (Index f = 0; f < list.size(); ++f) {
      Interval face{1e300, -1e300};
      double const offset = reach[faces.size()][axis];
      for (Index32 const n : list[f]) {
        face.low = std::min(face.low, x(n) - offset);
        face.high = std::max(face.high, x(n) + offset);
      }
      all = {std::min(all.low, face.low), std::max(all.high, face.high)};
      faces.push_back(face);
    }
  constexpr int n_bins = 1024;
  auto bin = [&](double c) {
    return std::size_t(std::clamp(int((c - all.low) / all.length() * n_bins), 0, n_bins - 1));
  };
  std::vector<int> change(n_bins + 1, 0);
  std::vector<Interval> limits(n_bins, {1e300, -1e300});
  for (Interval const& face : faces) {
    std::size_t const first = bin(face.low), last = bin(face.high);
    ++change[first];
    --change[last + 1];
    limits[first].low = std::min(limits[first].low, face.low);
    limits[last].high = std::max(limits[last].high, face.high);
  }
  std::vector<Interval> out;
  bool within = false;
  int open = 0;
  for (std::size_t b = 0; b < n_bins; ++b) {
    open += change[b];
    if (open > 0 && !within) out.push_back({1e300, -1e300});
    within = open > 0;
    if (!within) continue;
    out.back().low = std::min(out.back().low, limits[b].low);
    out.back().high = std::max(out.back().high, limits[b].high);
  }
  return out;
}

/// Takes the offset off the ends of the walls' intervals beyond which there is no element as far as the offset goes:
/// walls that end on a solid or on the end of the mesh.
void trim(Mesh const& mesh, Coordinates const& q, std::size_t n_axes, std::span<CsrGraph const> walls, double offset,
          std::array<std::vector<Interval>, 3>& intervals) {
  auto const all = [&](std::size_t a) { return Interval{intervals[a].front().low, intervals[a].back().high}; };
  // A little is left, so that nodes where the walls end lie in the wrap whatever round-off says.
  double const rest = 1e-4 * offset;
  std::array<Interval, 3> ends;
  ends.fill({1e300, -1e300});
  for (CsrGraph const& list : walls)
    for (Index32 const n : list.item)
      for (std::size_t a = 0; a < n_axes; ++a) {
        double const x = a == 0 ? q.x(n) : a == 1 ? q.y(n) : q.z(n);
        ends[a] = {std::min(ends[a].low, x), std::max(ends[a].high, x)};
      }
  std::array<std::array<bool, 2>, 3> empty{{{true, true}, {true, true}, {true, true}}};
  // Elements are looked at where nodes leave a side open.
  auto const look = [&](LatticeBox const& box) {
    for (std::size_t a = 0; a < n_axes; ++a)
      if (box.high[a] < all(a).low || box.low[a] > all(a).high) return;
    for (std::size_t a = 0; a < n_axes; ++a) {
      if (box.low[a] < ends[a].low - rest) empty[a][0] = false;
      if (box.high[a] > ends[a].high + rest) empty[a][1] = false;
    }
  };
  auto const open = [&] {
    for (std::size_t a = 0; a < n_axes; ++a)
      if (empty[a][0] || empty[a][1]) return true;
    return false;
  };
  for (Index n = 0; n < q.size() && open(); ++n) {
    std::array<double, 3> const x{q.x(n), q.y(n), q.z(n)};
    look({x, x});
  }
  for (Index e = 0; e < mesh.n_elements() && open(); ++e) {
    LatticeBox box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (Index32 const n : mesh.elements.corners(e)) {
      std::array<double, 3> const x{q.x(n), q.y(n), q.z(n)};
      for (std::size_t a = 0; a < 3; ++a) {
        box.low[a] = std::min(box.low[a], x[a]);
        box.high[a] = std::max(box.high[a], x[a]);
      }
    }
    look(box);
  }
  for (std::size_t a = 0; a < n_axes; ++a) {
    if (empty[a][0]) intervals[a].front().low = ends[a].low - rest;
    if (empty[a][1]) intervals[a].back().high = ends[a].high + rest;
  }
}

/// Joins intervals that are less than `gap` apart.
std::vector<Interval> joined(std::vector<Interval> const& intervals, double gap) {
  std::vector<Interval> out;
  for (Interval const& i : intervals)
    if (!out.empty() && i.low - out.back().high < gap * (1 - 1e-6))
      out.back().high = i.high;
    else
      out.push_back(i);
  return out;
}

/// Lengths of whole and half numbers of cells are common: round-off must not decide.
int parts(double length, double spacing) { return std::max(1, int(std::lround(length / spacing - 1e-6))); }

/// The coordinates of all planes of one axis.
std::vector<double> planes_of(std::vector<Interval> intervals, Interval const& domain, double spacing, double margin,
                              std::array<bool, 2> const& ends, std::array<bool, 2>& reaches) {
  // Where walls come close to the limits of the mesh or reach them, the wrap goes a little beyond, so that these limits
  // do not cut slivers off its surroundings; where the mesh ends on a side of the lattice, it goes just there.
  double const beyond = 0.25 * spacing, close = 0.53 * spacing;
  double &low = intervals.front().low, &high = intervals.back().high;
  reaches = {ends[0] && low < domain.low + close, ends[1] && high > domain.high - close};
  low = reaches[0] ? domain.low : std::max(low, domain.low - beyond);
  high = reaches[1] ? domain.high : std::min(high, domain.high + beyond);
  intervals = joined(intervals, spacing);
  std::vector<double> planes;
  if (ends[0] && !reaches[0]) planes.push_back(domain.low);
  if (!ends[0]) planes.push_back(std::min(domain.low - margin, intervals.front().low - 0.5 * spacing));
  for (Interval const& i : intervals) {
    int const n = parts(i.length(), spacing);
    for (int p = 0; p <= n; ++p) planes.push_back(p == n ? i.high : i.low + p * i.length() / n);
  }
  if (ends[1] && !reaches[1]) planes.push_back(domain.high);
  if (!ends[1]) planes.push_back(std::max(domain.high + margin, intervals.back().high + 0.5 * spacing));
  return planes;
}

}  // namespace

Reaches reaches_of(Coordinates const& places, Chart const& chart, std::span<CsrGraph const> walls, double offset) {
  Reaches out;
  for (CsrGraph const& list : walls)
    for (Index f = 0; f < list.size(); ++f) {
      auto& reach = out.emplace_back(std::array<double, 3>{offset, offset, offset});
      if (chart.is_identity()) continue;
      Vec3 middle;
      for (Index32 const n : list[f]) middle += (1.0 / double(list[f].size())) * places[n];
      // Over the way that is asked about, so that kinks of the chart are not overlooked.
      std::array<double, 3> squares{};
      for (Vec3 const& e : {Vec3{offset, 0, 0}, Vec3{0, offset, 0}, Vec3{0, 0, offset}}) {
        Vec3 const d = 0.5 * (chart(middle + e) - chart(middle - e));
        squares = {squares[0] + d.x * d.x, squares[1] + d.y * d.y, squares[2] + d.z * d.z};
      }
      for (std::size_t a = 0; a < 3; ++a) reach[a] = std::sqrt(squares[a]);
    }
  return out;
}

Wrap make_lattice(Mesh const& mesh, Coordinates const& coordinates, std::span<CsrGraph const> walls,
                  Reaches const& reach, LatticeBox const& domain, WrapOptions const& options) {
  Wrap wrap;
  wrap.dimension = mesh.dimension;
  wrap.offset = options.offset;
  auto const n_axes = std::size_t(mesh.dimension);
  ChartedDomain const whole = options.domain.value_or(ChartedDomain{});
  std::array<std::vector<Interval>, 3> intervals;
  double longest = 0;
  for (std::size_t a = 0; a < n_axes; ++a) intervals[a] = covered(coordinates, walls, reach, a);
  if (options.domain) trim(mesh, coordinates, n_axes, walls, options.offset, intervals);
  for (std::size_t a = 0; a < n_axes; ++a) {
    for (Interval const& i : intervals[a]) longest = std::max(longest, i.length());
  }
  // Cells much smaller than the offset would show nothing that it does not hide.
  double spacing = std::max(longest / options.resolution, 0.5 * options.offset);
  for (int attempt = 0; attempt < 100; ++attempt) {
    Index cells = 1;
    for (std::size_t a = 0; a < n_axes; ++a) {
      wrap.planes[a] = planes_of(intervals[a], {domain.low[a], domain.high[a]}, spacing, options.margin,
                                 {whole.ends(int(a), 0), whole.ends(int(a), 1)}, wrap.reaches[a]);
      cells *= Index(wrap.planes[a].size()) - 1;
    }
    if (cells <= options.max_cells) break;
    spacing *= 1.05;
  }
  wrap.spacing = 0;
  wrap.layer = 1e300;
  for (std::size_t a = 0; a < n_axes; ++a)
    for (std::size_t p = wrap.reaches[a][0] ? 1 : 2; p + (wrap.reaches[a][1] ? 0 : 1) < wrap.planes[a].size(); ++p) {
      double const size = wrap.planes[a][p] - wrap.planes[a][p - 1];
      if (size > 1.6 * spacing) continue;  // between walls far apart
      wrap.spacing = std::max(wrap.spacing, size);
      wrap.layer = std::min(wrap.layer, size);
    }
  if (mesh.dimension == 2) wrap.planes[2] = {-0.5 * wrap.spacing, 0.5 * wrap.spacing};
  wrap.inside.assign(wrap.n_cells(), 0);
  return wrap;
}

}  // namespace gridmorph::detail
