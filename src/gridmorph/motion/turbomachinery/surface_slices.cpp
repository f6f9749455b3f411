#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/turbomachinery/surface_slices.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double corner_angle = 50 * std::numbers::pi / 180;
constexpr double edge_reach = 0.1;  ///< in chords: corners nearer than this to the end of a section are of its edge
constexpr double widest_gap = 0.1;  ///< in chords: between pieces of a contour
constexpr double near_ends = 0.3;   ///< in chords: open contours whose ends are nearer go around the blade (C)
constexpr double least_rise = 0.3;  ///< span gained over length, of facets that have sections
constexpr int points_of_stretch = 65, points_of_base = 5;

/// Points of one section in their order.
struct Polyline {
  std::vector<int> edges;  ///< of the surface that the points lie on
  std::vector<Vec3> points;
  bool closed = false;

  [[nodiscard]] int size() const { return int(points.size()); }
  [[nodiscard]] double extent() const {
    Vec3 low{inf, inf, inf}, high = -1.0 * low;
    for (Vec3 const& p : points) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return points.empty() ? 0 : norm(high - low);
  }
  /// Twice its area vector; an open one is closed by a straight line.
  [[nodiscard]] Vec3 area() const {
    Vec3 sum;
    for (std::size_t n = 1; n + 1 < points.size(); ++n)
      sum += cross(points[n] - points.front(), points[n + 1] - points.front());
    return sum;
  }
  void reverse() {
    std::reverse(edges.begin(), edges.end());
    std::reverse(points.begin(), points.end());
  }
};

/// Which places of a section get points of their own: of its edges corners or one place; see Part::anchors.
struct Anchors {
  std::vector<int> at;     ///< ascending numbers of points; of open sections the ends too
  std::vector<char> base;  ///< per stretch from one to the next: the blunt base between two corners of one edge
  [[nodiscard]] bool alike(Anchors const& other) const { return at.size() == other.at.size() && base == other.base; }
};

/// Triangles of one part of the surface, by the lower end of their span.
struct Triangles {
  std::vector<int> list;
  std::vector<double> low;  ///< per member of the list, ascending
  double rise = 0;          ///< the most span that one of them takes up
};

class Slicer {
 public:
  explicit Slicer(SliceInput const& input) : input_(input) {
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

  /// Triangles that hang together.
  [[nodiscard]] std::vector<Triangles> parts() const {
    DisjointSets<int> sets(triangles_.size());
    std::vector<int> first(edges_.size(), -1);
    for (int t = 0; t < int(triangles_.size()); ++t)
      for (int const e : edges_of_[std::size_t(t)]) {
        if (first[std::size_t(e)] < 0)
          first[std::size_t(e)] = t;
        else
          sets.join(first[std::size_t(e)], t);
      }
    std::map<int, std::vector<int>> out;
    for (int t = 0; t < int(triangles_.size()); ++t) out[sets.root(t)].push_back(t);
    std::vector<Triangles> list;
    for (auto& [root, part] : out) {
      std::stable_sort(part.begin(), part.end(), [&](int a, int b) { return range(a).first < range(b).first; });
      Triangles& own = list.emplace_back();
      for (int const t : part) {
        auto const [lo, hi] = range(t);
        own.low.push_back(lo);
        own.rise = std::max(own.rise, hi - lo);
      }
      own.list = std::move(part);
    }
    return list;
  }

  /// Span of one triangle.
  [[nodiscard]] std::pair<double, double> range(int t) const {
    auto const& [a, b, c] = triangles_[std::size_t(t)];
    return std::minmax({span_[std::size_t(a)], span_[std::size_t(b)], span_[std::size_t(c)]});
  }
  [[nodiscard]] std::pair<double, double> range(Triangles const& part) const {
    double hi = -inf;
    for (int const t : part.list) hi = std::max(hi, range(t).second);
    return {part.low.front(), hi};
  }
  /// Mean span that a triangle takes up.
  [[nodiscard]] double step(Triangles const& part) const {
    double sum = 0;
    for (int const t : part.list) {
      auto const [lo, hi] = range(t);
      sum += hi - lo;
    }
    return sum / double(part.list.size());
  }

  /// The contour of a part at a span fraction, without points where it has none. `upper`: points at it are above it.
  [[nodiscard]] Polyline cut(Triangles const& part, double h, bool upper) const {
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
      int const t = part.list[std::size_t(at - part.low.begin())];
      std::array<int, 2> crossed{-1, -1};
      int n = 0;
      for (int const e : edges_of_[std::size_t(t)])
        if (above(edges_[std::size_t(e)][0], h, upper) != above(edges_[std::size_t(e)][1], h, upper) && n < 2)
          crossed[std::size_t(n++)] = e;
      if (n < 2) continue;
      join(crossed[0], crossed[1]);
      join(crossed[1], crossed[0]);
      order.push_back(crossed[0]);
      order.push_back(crossed[1]);
    }
    std::unordered_map<int, char> used;
    std::vector<Polyline> pieces;
    auto const walk = [&](int start, bool closed) {
      Polyline line;
      line.closed = closed;
      for (int at = start; at >= 0;) {
        used[at] = 1;
        line.edges.push_back(at);
        line.points.push_back(crossing(at, h));
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

  /// Points of the edges at the span fraction itself.
  [[nodiscard]] SlicePlace place(int e, double h) const {
    auto const [a, b] = edges_[std::size_t(e)];
    double const t = fraction(e, h);
    return {{{a, 1 - t}, {b, t}}, (1 - t) * input_.points[std::size_t(a)] + t * input_.points[std::size_t(b)], h};
  }

 private:
  [[nodiscard]] bool above(int v, double h, bool upper) const {
    return upper ? span_[std::size_t(v)] >= h : span_[std::size_t(v)] > h;
  }

  /// Whether a triangle gains span: the length of the gradient of span in it, in lengths per length.
  [[nodiscard]] bool rises(std::array<int, 3> const& t) const {
    Vec3 const a = input_.points[std::size_t(t[0])], b = input_.points[std::size_t(t[1])] - a,
               c = input_.points[std::size_t(t[2])] - a;
    Vec3 const n = cross(b, c);
    double const area2 = dot(n, n);
    if (!(area2 > 0)) return false;
    double const fb = span_[std::size_t(t[1])] - span_[std::size_t(t[0])],
                 fc = span_[std::size_t(t[2])] - span_[std::size_t(t[0])];
    Vec3 const gradient = (1 / area2) * (fb * cross(c, n) + fc * cross(n, b));
    return norm(gradient) * input_.height(a + (1.0 / 3) * (b + c)) > least_rise;
  }

  void find_edges() {
    std::map<std::pair<int, int>, int> number;
    for (auto const& t : triangles_) {
      auto& own = edges_of_.emplace_back();
      for (int s = 0; s < 3; ++s) {
        std::pair<int, int> const ends = std::minmax(t[std::size_t(s)], t[std::size_t((s + 1) % 3)]);
        auto const [at, fresh] = number.try_emplace(ends, int(edges_.size()));
        if (fresh) edges_.push_back({ends.first, ends.second});
        own[std::size_t(s)] = at->second;
      }
    }
  }

  [[nodiscard]] double linear_fraction(int e, double h) const {
    auto const [a, b] = edges_[std::size_t(e)];
    double const fa = span_[std::size_t(a)], fb = span_[std::size_t(b)];
    return fb != fa ? std::clamp((h - fa) / (fb - fa), 0.0, 1.0) : 0.0;
  }
  [[nodiscard]] Vec3 crossing(int e, double h) const {
    auto const [a, b] = edges_[std::size_t(e)];
    double const t = linear_fraction(e, h);
    return (1 - t) * input_.points[std::size_t(a)] + t * input_.points[std::size_t(b)];
  }
  /// Span is not linear along an edge where hub or case are curved: secants from the linear place.
  [[nodiscard]] double fraction(int e, double h) const {
    auto const [a, b] = edges_[std::size_t(e)];
    double lo = 0, hi = 1, f_lo = span_[std::size_t(a)] - h, f_hi = span_[std::size_t(b)] - h;
    double t = linear_fraction(e, h);
    if (f_lo == 0 || f_hi == 0 || (f_lo < 0) == (f_hi < 0)) return t;
    constexpr int steps = 3;
    for (int n = 0; n < steps; ++n) {
      double const f = input_.span((1 - t) * input_.points[std::size_t(a)] + t * input_.points[std::size_t(b)]) - h;
      if (f == 0) break;
      ((f < 0) == (f_lo < 0) ? lo : hi) = t;
      ((f < 0) == (f_lo < 0) ? f_lo : f_hi) = f;
      t = lo + (hi - lo) * (-f_lo) / (f_hi - f_lo);
    }
    return t;
  }

  /// Where a corner of a facet lies at the span itself several edges have the same point: one is kept.
  static void thin_out(Polyline& line, double same) {
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
  static Polyline longest(std::vector<Polyline> pieces) {
    Polyline all;
    for (Polyline const& p : pieces) all.points.insert(all.points.end(), p.points.begin(), p.points.end());
    double const limit = widest_gap * all.extent();
    for (Polyline& p : pieces) thin_out(p, 1e-9 * all.extent());
    auto const end = [](Polyline const& p, bool last) { return last ? p.points.back() : p.points.front(); };
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
      if (best_b == 0) break;
      Polyline &one = pieces[best_a], &other = pieces[best_b];
      if (!last_a) one.reverse();
      if (last_b) other.reverse();
      one.edges.insert(one.edges.end(), other.edges.begin(), other.edges.end());
      one.points.insert(one.points.end(), other.points.begin(), other.points.end());
      pieces.erase(pieces.begin() + std::ptrdiff_t(best_b));
    }
    auto const most = std::max_element(pieces.begin(), pieces.end(),
                                       [](Polyline const& a, Polyline const& b) { return a.extent() < b.extent(); });
    if (most == pieces.end()) return {};
    most->closed = most->closed || distance(most->points.front(), most->points.back()) < limit;
    return std::move(*most);
  }

  SliceInput const& input_;
  std::vector<double> span_;  ///< per point
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 2>> edges_;  ///< points, the lower number first
  std::vector<std::array<int, 3>> edges_of_;
};

/// One part of the surface, and how its sections are made alike.
class Part {
 public:
  Part(Slicer const& slicer, SliceInput const& input, Triangles triangles)
      : slicer_(slicer), input_(input), triangles_(std::move(triangles)) {
    auto const [lo, hi] = slicer.range(triangles_);
    middle = 0.5 * (lo + hi);
    first = last = middle;
    reference_ = slicer.cut(triangles_, middle, false);
    if (reference_.size() < 3 || !(reference_.extent() > 0)) return;
    around_ = reference_.closed ||
              distance(reference_.points.front(), reference_.points.back()) < near_ends * reference_.extent();
    if (!around_ && input_.along(reference_.points.front()) > input_.along(reference_.points.back()))
      reference_.reverse();
    first = limit(lo);
    last = limit(hi);
    step = slicer.step(triangles_);
  }

  double middle = 0;
  double first = 0, last = 0;  ///< span fractions between which its sections are whole
  double step = 1;             ///< span of a facet
  [[nodiscard]] double span() const { return last - first; }
  [[nodiscard]] Polyline const& section() const { return reference_; }

  /// Whether the other part's section at mid span lies inside this one's.
  [[nodiscard]] bool holds(Part const& other) const {
    if (!around_ || other.reference_.size() == 0) return false;
    Vec3 const area = reference_.area();
    Vec3 const n = (1 / norm(area)) * area;
    Vec3 const axis = reference_.points[1] - reference_.points[0];
    Vec3 const x = (1 / norm(axis)) * axis;
    Vec3 const y = cross(n, x);
    Vec3 const p = other.reference_.points.front();
    bool inside = false;
    for (int k = 0, j = reference_.size() - 1; k < reference_.size(); j = k++) {
      Vec3 const a = reference_.points[std::size_t(k)] - p, b = reference_.points[std::size_t(j)] - p;
      double const ay = dot(a, y), by = dot(b, y);
      if ((ay > 0) == (by > 0)) continue;
      if (dot(a, x) + (dot(b, x) - dot(a, x)) * ay / (ay - by) > 0) inside = !inside;
    }
    return inside;
  }

  [[nodiscard]] SlicedContour contour(std::vector<double> const& levels) const {
    std::vector<Section> sections;
    for (double const h : levels)
      if (auto section = section_at(h)) sections.push_back(std::move(*section));
    // Sections with other edges than most have are left out: their points would be others.
    auto const votes = [&](Anchors const& own) {
      return std::count_if(sections.begin(), sections.end(), [&](Section const& s) { return s.anchors.alike(own); });
    };
    Anchors const* favourite = nullptr;
    for (Section const& s : sections)
      if (favourite == nullptr || votes(s.anchors) > votes(*favourite)) favourite = &s.anchors;
    SlicedContour out;
    out.closed = reference_.closed;
    if (favourite == nullptr) return out;
    Anchors const most = *favourite;
    std::erase_if(sections, [&](Section const& s) { return !s.anchors.alike(most); });
    if (auto first = nearer(sections.front().span, levels.front(), most))
      sections.insert(sections.begin(), std::move(*first));
    if (auto last = nearer(sections.back().span, levels.back(), most)) sections.push_back(std::move(*last));
    for (Section const& s : sections) {
      auto const places = resample(s.line, s.anchors, s.span);
      out.lines.resize(places.size());
      for (std::size_t n = 0; n < places.size(); ++n) out.lines[n].push_back(places[n]);
    }
    return out;
  }

 private:
  struct Section {
    double span;
    Polyline line;
    Anchors anchors;
  };

  [[nodiscard]] std::optional<Section> section_at(double h) const {
    Polyline line = oriented(slicer_.cut(triangles_, h, h > middle));
    if (line.size() < 3 || line.closed != reference_.closed) return std::nullopt;
    Anchors at = anchors(line);
    return Section{h, std::move(line), std::move(at)};
  }

  /// Between a section and the end of the span, where those are others, the last one that is alike: halves of the stretch.
  [[nodiscard]] std::optional<Section> nearer(double span, double end, Anchors const& alike) const {
    constexpr int halvings = 10;
    std::optional<Section> out;
    double bad = end;
    for (int n = 0; n < halvings && span != end; ++n) {
      double const h = 0.5 * (span + bad);
      auto section = section_at(h);
      if (section && section->anchors.alike(alike)) {
        span = h;
        out = std::move(section);
      } else {
        bad = h;
      }
    }
    return out;
  }

  /// Whether a section follows another one closely along the span, or one of them is cut off.
  [[nodiscard]] static bool alike(Polyline const& line, Polyline const& other) {
    double const size = line.extent(), before = other.extent();
    return line.size() >= 3 && line.closed == other.closed && size > 0.9 * before && size < 1.1 * before;
  }

  /// How far towards the end of its range a part has sections like its middle one.
  [[nodiscard]] double limit(double end) const {
    constexpr int steps = 64, halvings = 24;
    double good = middle;
    Polyline line = reference_;
    auto const try_at = [&](double h) {
      Polyline next = slicer_.cut(triangles_, h, h > middle);
      if (!alike(next, line) || gap_opened(next)) return false;
      line = std::move(next);
      good = h;
      return true;
    };
    for (int n = 1; n <= steps; ++n) {
      double bad = n == steps ? end : middle + (end - middle) * n / steps;
      if (try_at(bad)) continue;
      for (int k = 0; k < halvings; ++k) {
        double const h = 0.5 * (good + bad);
        if (!try_at(h)) bad = h;
      }
      // Not where the nodes at the end scatter.
      return good + 1e-4 * (middle - end);
    }
    return good;
  }
  /// The ends of a section that goes around have come apart.
  [[nodiscard]] bool gap_opened(Polyline const& line) const {
    return around_ && !line.closed && distance(line.points.front(), line.points.back()) >= near_ends * line.extent();
  }

  [[nodiscard]] Polyline oriented(Polyline line) const {
    if (line.size() < 2) return line;
    bool const against = around_ ? dot(line.area(), reference_.area()) < 0
                                 : input_.along(line.points.front()) > input_.along(line.points.back());
    if (against) line.reverse();
    return line;
  }

  /// The ends of the chord: the two points farthest apart, the upstream one first.
  [[nodiscard]] std::array<int, 2> chord_ends(Polyline const& line) const {
    auto const farthest = [&](int from) {
      int best = from;
      for (int n = 0; n < line.size(); ++n)
        if (distance(line.points[std::size_t(n)], line.points[std::size_t(from)]) >
            distance(line.points[std::size_t(best)], line.points[std::size_t(from)]))
          best = n;
      return best;
    };
    int one = farthest(0), other = farthest(one);
    for (int pass = 0; pass < 8; ++pass) {
      int const next = farthest(other);
      if (next == one) break;
      one = next;
      other = farthest(one);
    }
    if (input_.along(line.points[std::size_t(one)]) > input_.along(line.points[std::size_t(other)]))
      std::swap(one, other);
    return {one, other};
  }

  [[nodiscard]] static double turn(Polyline const& line, int n) {
    int const size = line.size();
    if (!line.closed && (n == 0 || n == size - 1)) return std::numbers::pi;
    auto const at = [&](int k) { return line.points[std::size_t((k + size) % size)]; };
    // Points that a corner of a facet brings together have no direction between them.
    double const small = 1e-9 * distance(line.points.front(), line.points[std::size_t(size / 2)]);
    int before = n - 1, after = n + 1;
    while (n - before < size && distance(at(before), at(n)) <= small) --before;
    while (after - n < size && distance(at(after), at(n)) <= small) ++after;
    Vec3 const a = at(n) - at(before), b = at(after) - at(n);
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }

  [[nodiscard]] Anchors anchors(Polyline const& line) const {
    Anchors out;
    if (!around_) {
      out.at = {0, line.size() - 1};
      out.base = {0};
      return out;
    }
    auto const ends = chord_ends(line);
    double const chord = distance(line.points[std::size_t(ends[0])], line.points[std::size_t(ends[1])]);
    std::vector<std::pair<int, int>> found;  // point, edge
    for (int edge = 0; edge < 2; ++edge) {
      std::vector<int> corners;
      for (int n = 0; n < line.size(); ++n)
        if (distance(line.points[std::size_t(n)], line.points[std::size_t(ends[std::size_t(edge)])]) <
                edge_reach * chord &&
            turn(line, n) > corner_angle)
          corners.push_back(n);
      if (corners.empty()) corners = {ends[std::size_t(edge)]};
      if (corners.size() > 2) {
        // The two that the sides of the blade end at: on both sides of the longest way around that has no corner.
        std::size_t widest = 0;
        double longest = -1;
        for (std::size_t n = 0; n < corners.size(); ++n) {
          int const next = n + 1 < corners.size() ? corners[n + 1] : corners[0] + line.size();
          if (double const gap = next - corners[n]; gap > longest) {
            longest = gap;
            widest = n;
          }
        }
        corners = {corners[widest], corners[(widest + 1) % corners.size()]};
      }
      for (int const n : corners) found.emplace_back(n, edge);
    }
    std::sort(found.begin(), found.end());
    found.erase(
        std::unique(found.begin(), found.end(), [](auto const& a, auto const& b) { return a.first == b.first; }),
        found.end());
    // A closed one begins at the leading edge, after its base.
    if (line.closed) {
      auto const leading = std::count_if(found.begin(), found.end(), [](auto const& f) { return f.second == 0; });
      for (std::size_t n = 0; n < found.size(); ++n)
        if (found[n].second == 0 && (leading == 1 || found[(n + found.size() - 1) % found.size()].second == 0)) {
          std::rotate(found.begin(), found.begin() + std::ptrdiff_t(n), found.end());
          break;
        }
      found.push_back({found.front().first, found.front().second});
      for (std::size_t n = 1; n < found.size(); ++n)
        if (found[n].first <= found[n - 1].first) found[n].first += line.size();
    }
    for (std::size_t n = 0; n < found.size(); ++n) {
      out.at.push_back(found[n].first);
      if (n > 0) out.base.push_back(found[n].second == found[n - 1].second ? 1 : 0);
    }
    return out;
  }

  [[nodiscard]] std::vector<SlicePlace> resample(Polyline const& line, Anchors const& anchors, double h) const {
    std::vector<SlicePlace> out;
    int const size = line.size();
    std::vector<SlicePlace> exact;
    for (int const e : line.edges) exact.push_back(slicer_.place(e, h));
    auto const at = [&](int n) -> SlicePlace const& { return exact[std::size_t(n % size)]; };
    for (std::size_t s = 0; s + 1 < anchors.at.size(); ++s) {
      int const from = anchors.at[s], to = anchors.at[s + 1];
      std::vector<double> length{0};
      for (int n = from; n < to; ++n) length.push_back(length.back() + distance(at(n).point, at(n + 1).point));
      int const parts = (anchors.base[s] != 0 ? points_of_base : points_of_stretch) - 1;
      for (int k = 0; k < parts; ++k) {
        double const wanted = length.back() * 0.5 * (1 - std::cos(std::numbers::pi * k / parts));
        auto const above = std::upper_bound(length.begin(), length.end(), wanted);
        int const n = std::min(int(above - length.begin()), int(length.size()) - 1) - 1;
        double const piece = length[std::size_t(n) + 1] - length[std::size_t(n)];
        double const t = piece > 0 ? (wanted - length[std::size_t(n)]) / piece : 0;
        out.push_back(between(at(from + n), at(from + n + 1), k == 0 ? 0 : t));
      }
    }
    if (!line.closed) out.push_back(at(size - 1));
    return out;
  }

  [[nodiscard]] static SlicePlace between(SlicePlace const& a, SlicePlace const& b, double t) {
    if (t == 0) return a;
    SlicePlace out{{}, (1 - t) * a.point + t * b.point, a.span};
    for (auto const& [v, w] : a.weights) out.weights.emplace_back(v, (1 - t) * w);
    for (auto const& [v, w] : b.weights) out.weights.emplace_back(v, t * w);
    return out;
  }

  Slicer const& slicer_;
  SliceInput const& input_;
  Triangles triangles_;
  Polyline reference_;   ///< at mid span
  bool around_ = false;  ///< it goes around the blade: closed, or its ends lie together
};

}  // namespace

std::vector<SlicedContour> slice_surface(SliceInput const& input, std::vector<std::string>& notes) {
  Slicer const slicer(input);
  std::vector<Part> parts;
  int passed_over = 0;
  for (auto& triangles : slicer.parts()) {
    Part part(slicer, input, std::move(triangles));
    if (part.span() > 0)
      parts.push_back(std::move(part));
    else
      ++passed_over;
  }
  double longest = 0;
  for (Part const& p : parts) longest = std::max(longest, p.span());
  std::vector<Part const*> kept;
  for (Part const& p : parts) {
    bool const inside = std::any_of(parts.begin(), parts.end(), [&](Part const& other) {
      return &other != &p && other.section().extent() > p.section().extent() && other.holds(p);
    });
    if (p.span() >= 0.5 * longest && !inside)
      kept.push_back(&p);
    else
      ++passed_over;
  }
  double lo = -inf, hi = inf, step = inf;
  for (Part const* p : kept) {
    lo = std::max(lo, p->first);
    hi = std::min(hi, p->last);
    step = std::min(step, p->step);
  }
  if (kept.empty() || !(hi > lo))
    throw MotionError("the facets of the blade make up no sections; name whole sides of one blade or wing");
  int const n = int(std::clamp(std::ceil(2 * (hi - lo) / step), 17.0, 129.0));
  std::vector<double> levels;
  for (int k = 0; k < n; ++k) levels.push_back(k + 1 == n ? hi : lo + (hi - lo) * k / (n - 1));
  std::vector<SlicedContour> out;
  for (Part const* p : kept) {
    out.push_back(p->contour(levels));
    if (out.back().lines.empty() || out.back().lines.front().size() < 2)
      throw MotionError("the facets of the blade make up no sections that are alike along its span");
  }
  notes.push_back("sections by cutting " + std::to_string(input.triangles.size()) + " facets at " + std::to_string(n) +
                  " span fractions" +
                  (passed_over > 0 ? "; " + std::to_string(passed_over) +
                                         " parts of the surface inside them or without sections go along"
                                   : std::string()));
  return out;
}

}  // namespace gridmorph
