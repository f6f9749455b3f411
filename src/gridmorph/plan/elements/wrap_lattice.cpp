#include <gridmorph/plan/elements/wrap_lattice.hpp>

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
std::vector<Interval> covered(Mesh const& mesh, std::span<CsrGraph const> walls, std::size_t axis, double offset) {
  auto const& x = axis == 0 ? mesh.coordinates.x : axis == 1 ? mesh.coordinates.y : mesh.coordinates.z;
  std::vector<Interval> faces;
  Interval all{1e300, -1e300};
  for (CsrGraph const& list : walls)
    for (Index f = 0; f < list.size(); ++f) {
      Interval face{1e300, -1e300};
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

/// Joins intervals less than `gap` apart.
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

/// All planes of one axis.
std::vector<double> planes_of(std::vector<Interval> intervals, Interval const& domain, double spacing, double margin) {
  // Where walls come close to the limits of the mesh or reach them, the wrap goes a little beyond, so that these limits do not
  // cut slivers off its surroundings.
  double const beyond = 0.25 * spacing;
  intervals.front().low = std::max(intervals.front().low, domain.low - beyond);
  intervals.back().high = std::min(intervals.back().high, domain.high + beyond);
  intervals = joined(intervals, spacing);
  std::vector<double> planes{std::min(domain.low - margin, intervals.front().low - 0.5 * spacing)};
  for (Interval const& i : intervals) {
    int const n = parts(i.length(), spacing);
    for (int p = 0; p <= n; ++p) planes.push_back(p == n ? i.high : i.low + p * i.length() / n);
  }
  planes.push_back(std::max(domain.high + margin, intervals.back().high + 0.5 * spacing));
  return planes;
}

}  // namespace

Wrap make_lattice(Mesh const& mesh, std::span<CsrGraph const> walls, LatticeBox const& domain,
                  WrapOptions const& options) {
  Wrap wrap;
  wrap.dimension = mesh.dimension;
  wrap.offset = options.offset;
  auto const dimension = std::size_t(mesh.dimension);
  std::array<std::vector<Interval>, 3> intervals;
  double longest = 0;
  for (std::size_t a = 0; a < dimension; ++a) {
    intervals[a] = covered(mesh, walls, a, options.offset);
    for (Interval const& i : intervals[a]) longest = std::max(longest, i.length());
  }
  // Cells much smaller than the offset would show nothing that it does not hide.
  double spacing = std::max(longest / options.resolution, 0.5 * options.offset);
  for (int attempt = 0; attempt < 100; ++attempt) {
    Index cells = 1;
    for (std::size_t a = 0; a < dimension; ++a) {
      wrap.planes[a] = planes_of(intervals[a], {domain.low[a], domain.high[a]}, spacing, options.margin);
      cells *= Index(wrap.planes[a].size()) - 1;
    }
    if (cells <= options.max_cells) break;
    spacing *= 1.05;
  }
  wrap.spacing = 0;
  wrap.layer = 1e300;
  for (std::size_t a = 0; a < dimension; ++a)
    for (std::size_t p = 2; p + 1 < wrap.planes[a].size(); ++p) {
      double const size = wrap.planes[a][p] - wrap.planes[a][p - 1];
      if (size > 1.6 * spacing) continue;  // between walls far apart
      wrap.spacing = std::max(wrap.spacing, size);
      wrap.layer = std::min(wrap.layer, size);
    }
  if (dimension == 2) wrap.planes[2] = {-0.5 * wrap.spacing, 0.5 * wrap.spacing};
  wrap.inside.assign(std::size_t(wrap.n_cells()), 0);
  return wrap;
}

}  // namespace gridmorph::detail
