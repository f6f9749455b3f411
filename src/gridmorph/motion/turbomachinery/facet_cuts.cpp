#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/turbomachinery/facet_cuts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double widest_gap = 0.1;  ///< of the extent: between pieces of a contour

/// Where a corner of a facet lies at the span itself several edges have the same point: one is kept.
void thin_out(CutLine& line, double same) {
  std::size_t kept = 1;
  for (std::size_t n = 1; n < line.points.size(); ++n) {
    bool const again = distance(line.points[n], line.points[kept - 1]) <= same ||
                       (line.closed && distance(line.points[n], line.points.front()) <= same);
    if (again) continue;
    line.points[kept] = line.points[n];
    line.edges[kept++] = line.edges[n];
  }
  line.points.resize(kept);
  line.edges.resize(kept);
}

/// Joins pieces over gaps, nearest ends first, and takes the one that reaches farthest.
CutLine longest(std::vector<CutLine> pieces) {
  CutLine all;
  for (CutLine const& p : pieces) all.points.insert(all.points.end(), p.points.begin(), p.points.end());
  double const limit = widest_gap * all.extent();
  for (CutLine& p : pieces) thin_out(p, 1e-9 * all.extent());
  auto const end = [](CutLine const& p, bool last) { return last ? p.points.back() : p.points.front(); };
  for (;;) {
    double least = limit;
    std::size_t best_a = 0, best_b = 0;
    bool last_a = false, last_b = false;
    for (std::size_t a = 0; a < pieces.size(); ++a)
      for (std::size_t b = a + 1; b < pieces.size(); ++b) {
        if (pieces[a].closed || pieces[b].closed) continue;
        for (bool const la : {false, true})
          for (bool const lb : {false, true})
            if (double const d = distance(end(pieces[a], la), end(pieces[b], lb)); d < least) {
              least = d;
              best_a = a;
              best_b = b;
              last_a = la;
              last_b = lb;
            }
      }
    // b comes after a, so 0 says that no two ends are near enough.
    if (best_b == 0) break;
    CutLine &one = pieces[best_a], &other = pieces[best_b];
    if (!last_a) one.reverse();
    if (last_b) other.reverse();
    one.edges.insert(one.edges.end(), other.edges.begin(), other.edges.end());
    one.points.insert(one.points.end(), other.points.begin(), other.points.end());
    pieces.erase(pieces.begin() + std::ptrdiff_t(best_b));
  }
  auto const most = std::max_element(pieces.begin(), pieces.end(),
                                     [](CutLine const& a, CutLine const& b) { return a.extent() < b.extent(); });
  if (most == pieces.end()) return {};
  most->closed = most->closed || distance(most->points.front(), most->points.back()) < limit;
  return std::move(*most);
}

}  // namespace

double gradient_in(std::array<Vec3, 3> const& corners, std::array<double, 3> const& values) {
  Vec3 const b = corners[1] - corners[0], c = corners[2] - corners[0], n = cross(b, c);
  double const area2 = dot(n, n);
  if (!(area2 > 0)) return 0;
  return norm((1 / area2) * ((values[1] - values[0]) * cross(c, n) + (values[2] - values[0]) * cross(n, b)));
}

double CutLine::extent() const {
  Vec3 low{inf, inf, inf}, high = -1.0 * low;
  for (Vec3 const& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return points.empty() ? 0 : norm(high - low);
}

Vec3 CutLine::area() const {
  Vec3 sum;
  for (std::size_t n = 1; n + 1 < points.size(); ++n)
    sum += cross(points[n] - points.front(), points[n + 1] - points.front());
  return sum;
}

void CutLine::reverse() {
  std::reverse(edges.begin(), edges.end());
  std::reverse(points.begin(), points.end());
}

FacetCuts::FacetCuts(SliceInput const& input) : input_(input) {
  span_ = input.at;
  if (span_.empty())
    for (Vec3 const& p : input.points) span_.push_back(input.span(p));
  // Ends of the span are whole lines of nodes but for round-off.
  auto const [low, high] = std::minmax_element(span_.begin(), span_.end());
  double const same = 1e-9 * (*high - *low);
  double const lo = std::abs(*low) <= same ? 0 : *low, hi = std::abs(*high - 1) <= same ? 1 : *high;
  for (double& f : span_) f = f - lo <= same ? lo : hi - f <= same ? hi : f;
  for (auto const& t : input.triangles)
    if (rises(t)) triangles_.push_back(t);
  if (triangles_.empty())
    throw MotionError("no part of the blade's surface runs spanwise: check the axis, and that `of` names its sides");
  find_edges();
}

std::vector<SurfacePart> FacetCuts::parts() const {
  DisjointSets<int> sets(triangles_.size());
  std::vector<int> first(edges_.size(), -1);
  for (int t = 0; t < int(triangles_.size()); ++t)
    for (int const e : edges_of_[t]) {
      if (first[e] < 0)
        first[e] = t;
      else
        sets.join(first[e], t);
    }
  std::map<int, std::vector<int>> out;
  for (int t = 0; t < int(triangles_.size()); ++t) out[sets.root(t)].push_back(t);
  std::vector<SurfacePart> list;
  for (auto& [root, part] : out) {
    std::stable_sort(part.begin(), part.end(), [&](int a, int b) { return range(a).first < range(b).first; });
    SurfacePart& own = list.emplace_back();
    for (int const t : part) {
      auto const [lo, hi] = range(t);
      own.low.push_back(lo);
      own.rise = std::max(own.rise, hi - lo);
    }
    own.triangles = std::move(part);
  }
  return list;
}

std::pair<double, double> FacetCuts::range(int t) const {
  auto const& [a, b, c] = triangles_[t];
  return std::minmax({span_[a], span_[b], span_[c]});
}

std::pair<double, double> FacetCuts::range(SurfacePart const& part) const {
  double hi = -inf;
  for (int const t : part.triangles) hi = std::max(hi, range(t).second);
  return {part.low.front(), hi};
}

std::vector<std::array<int, 3>> FacetCuts::corners(SurfacePart const& part) const {
  std::vector<std::array<int, 3>> out;
  for (int const t : part.triangles) out.push_back(triangles_[t]);
  return out;
}

double FacetCuts::step(SurfacePart const& part) const {
  double sum = 0;
  for (int const t : part.triangles) {
    auto const [lo, hi] = range(t);
    sum += hi - lo;
  }
  return sum / double(part.triangles.size());
}

CutLine FacetCuts::cut(SurfacePart const& part, double h, bool upper) const {
  std::unordered_map<int, std::array<int, 2>> beside;
  auto const join = [&](int a, int b) {
    auto& list = beside.try_emplace(a, std::array{-1, -1}).first->second;
    if (list[0] < 0)
      list[0] = b;
    else if (list[1] < 0)
      list[1] = b;
  };
  std::vector<int> order;  // of the part, so that nothing depends on the table
  auto const begin = std::lower_bound(part.low.begin(), part.low.end(), h - part.rise);
  auto const end = std::upper_bound(part.low.begin(), part.low.end(), h);
  for (auto at = begin; at != end; ++at) {
    int const t = part.triangles[at - part.low.begin()];
    std::array<int, 2> crossed{-1, -1};
    int n = 0;
    for (int const e : edges_of_[t])
      if (above(edges_[e][0], h, upper) != above(edges_[e][1], h, upper) && n < 2) crossed[n++] = e;
    if (n < 2) continue;
    join(crossed[0], crossed[1]);
    join(crossed[1], crossed[0]);
    order.push_back(crossed[0]);
    order.push_back(crossed[1]);
  }
  std::unordered_map<int, char> used;
  std::vector<CutLine> pieces;
  auto const walk = [&](int start, bool closed) {
    CutLine line;
    line.closed = closed;
    for (int at = start; at >= 0;) {
      used[at] = 1;
      line.edges.push_back(at);
      line.points.push_back(between(at, linear_fraction(at, h)));
      int following = -1;
      for (int const e : beside.at(at))
        if (e >= 0 && following < 0 && !used.contains(e)) following = e;
      at = following;
    }
    pieces.push_back(std::move(line));
  };
  for (int const e : order)
    if (beside.at(e)[1] < 0 && !used.contains(e)) walk(e, false);
  for (int const e : order)
    if (!used.contains(e)) walk(e, true);
  return longest(std::move(pieces));
}

SlicePlace FacetCuts::place(int e, double h) const {
  auto const [a, b] = edges_[e];
  double const t = fraction(e, h);
  return {{{a, 1 - t}, {b, t}}, between(e, t), h};
}

bool FacetCuts::rises(std::array<int, 3> const& t) const {
  auto const at = [&](int k) { return input_.points[t[k]]; };
  auto const span = [&](int k) { return span_[t[k]]; };
  Vec3 const middle = (1.0 / 3) * (at(0) + at(1) + at(2));
  return gradient_in({at(0), at(1), at(2)}, {span(0), span(1), span(2)}) * input_.height(middle) > least_span_gain;
}

void FacetCuts::find_edges() {
  std::map<std::pair<int, int>, int> number;
  for (auto const& t : triangles_) {
    auto& own = edges_of_.emplace_back();
    for (int s = 0; s < 3; ++s) {
      std::pair<int, int> const ends = std::minmax(t[s], t[(s + 1) % 3]);
      auto const [at, fresh] = number.try_emplace(ends, int(edges_.size()));
      if (fresh) edges_.push_back({ends.first, ends.second});
      own[s] = at->second;
    }
  }
}

double FacetCuts::linear_fraction(int e, double h) const {
  auto const [a, b] = edges_[e];
  double const fa = span_[a], fb = span_[b];
  return fb != fa ? std::clamp((h - fa) / (fb - fa), 0.0, 1.0) : 0.0;
}

Vec3 FacetCuts::between(int e, double t) const {
  auto const [a, b] = edges_[e];
  return (1 - t) * input_.points[a] + t * input_.points[b];
}

double FacetCuts::fraction(int e, double h) const {
  auto const [a, b] = edges_[e];
  double lo = 0, hi = 1, f_lo = span_[a] - h, f_hi = span_[b] - h;
  double t = linear_fraction(e, h);
  if (f_lo == 0 || f_hi == 0 || (f_lo < 0) == (f_hi < 0)) return t;
  constexpr int steps = 3;
  for (int n = 0; n < steps; ++n) {
    double const f = input_.span(between(e, t)) - h;
    if (f == 0) break;
    ((f < 0) == (f_lo < 0) ? lo : hi) = t;
    ((f < 0) == (f_lo < 0) ? f_lo : f_hi) = f;
    t = lo + (hi - lo) * (-f_lo) / (f_hi - f_lo);
  }
  return t;
}

}  // namespace gridmorph
