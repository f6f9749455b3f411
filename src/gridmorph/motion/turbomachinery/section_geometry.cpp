#include <gridmorph/motion/turbomachinery/section_geometry.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/turbomachinery/section_interpolation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace gridmorph {

namespace {

using namespace section_interpolation;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double corner_angle = 50 * std::numbers::pi / 180;
/// Corners closer than this to the end of a section, in chords, belong to its edge.
constexpr double edge_reach = 0.1;

struct Point {
  double x = 0, y = 0;
};
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
double length(Point a) { return std::hypot(a.x, a.y); }

Sample place_at(SectionGeometry::Line const& line, double h) {
  LocalPolynomial const p([&](int n) { return line.span[n]; }, int(line.span.size()),
                          std::clamp(h, line.span.front(), line.span.back()));
  return p([&](int n) -> Sample const& { return line.place[n]; });
}

/// One section as a closed polygon in its plane.
class Section {
 public:
  Section(std::vector<SectionGeometry::Line> const& lines, double h) {
    for (auto const& line : lines) places_.push_back(place_at(line, h));
    auto const [up, down] =
        std::minmax_element(places_.begin(), places_.end(), [](auto const& a, auto const& b) { return a[0] < b[0]; });
    scale = 0.5 * ((*up)[2] + (*down)[2]);
  }
  double scale = 1;  ///< length of a unit of t

  [[nodiscard]] int size() const { return int(places_.size()); }
  [[nodiscard]] Point operator[](int n) const { return {place(n)[0], scale * place(n)[1]}; }
  /// Length of a unit of t at point n itself.
  [[nodiscard]] double unit(int n) const { return place(n)[2]; }

  [[nodiscard]] int most_upstream() const { return extreme(-1); }
  [[nodiscard]] int most_downstream() const { return extreme(+1); }
  [[nodiscard]] int farthest_from(Point const& p) const {
    int best = 0;
    for (int n = 1; n < size(); ++n)
      if (length((*this)[n] - p) > length((*this)[best] - p)) best = n;
    return best;
  }
  /// How far the outline turns at point n; 0 where nodes coincide.
  [[nodiscard]] double turn(int n) const {
    Point const a = (*this)[n] - (*this)[n - 1], b = (*this)[n + 1] - (*this)[n];
    if (length(a) == 0 || length(b) == 0) return 0;
    return std::abs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
  }

 private:
  [[nodiscard]] Sample const& place(int n) const { return places_[((n % size()) + size()) % size()]; }
  [[nodiscard]] int extreme(int sign) const {
    int best = 0;
    for (int n = 1; n < size(); ++n)
      if (sign * (places_[n][0] - places_[best][0]) > 0) best = n;
    return best;
  }

  Samples places_;  ///< s, t, unit
};

/// Where an edge of one section is. The sides of the section begin after `last` and end before `first`.
struct Edge {
  Point at;
  double unit = 0;
  int first = 0, last = 0;  ///< lines that belong to the edge, counted around; first > last when it lies between two
};

/// How to find one edge: the middle of its corners, or the roundest place where it has none.
struct EdgeFinder {
  std::vector<int> corners;  ///< ascending around the section

  [[nodiscard]] Edge operator()(Section const& section, Point const& opposite) const {
    if (!corners.empty()) {
      Edge edge{{}, 0, corners.front(), corners.back()};
      for (int c : corners) {
        edge.at.x += section[c].x / double(corners.size());
        edge.at.y += section[c].y / double(corners.size());
        edge.unit += section.unit(c) / double(corners.size());
      }
      return edge;
    }
    int const m = section.farthest_from(opposite);
    Point const a = section[m - 1], b = section[m], c = section[m + 1];
    double const fa = length(a - opposite), fb = length(b - opposite), fc = length(c - opposite);
    double const bend = fa - 2 * fb + fc;
    double const t = bend < 0 ? std::clamp(-0.5 * (fc - fa) / bend, -0.5, 0.5) : 0.0;
    auto const between = [t](double p, double q, double r) {
      return q + t * (0.5 * (r - p) + 0.5 * t * ((p - q) + (r - q)));
    };
    Edge edge{{between(a.x, b.x, c.x), between(a.y, b.y, c.y)},
              between(section.unit(m - 1), section.unit(m), section.unit(m + 1)),
              m,
              m};
    if (t > 0) edge.first = m + 1;
    if (t < 0) edge.last = m - 1;
    return edge;
  }
};

/// Line numbers in the order in which they follow one another, beginning after the largest gap.
std::vector<int> in_order_around(std::vector<int> lines, int n) {
  if (lines.size() < 2) return lines;
  std::size_t start = 0;
  int widest = -1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    int const before = i == 0 ? lines.back() - n : lines[i - 1];
    if (lines[i] - before > widest) {
      widest = lines[i] - before;
      start = i;
    }
  }
  std::rotate(lines.begin(), lines.begin() + std::ptrdiff_t(start), lines.end());
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i] < lines[i - 1]) lines[i] += n;
  return lines;
}

struct EdgeFinders {
  EdgeFinder leading, trailing;
};

EdgeFinders find_edges(Section const& middle, std::vector<double> const& turn,
                       std::vector<SectionGeometry::Line> const& lines) {
  int leading = middle.most_upstream();
  int trailing = middle.farthest_from(middle[leading]);
  for (int pass = 0; pass < 8; ++pass) {
    leading = middle.farthest_from(middle[trailing]);
    int const next = middle.farthest_from(middle[leading]);
    if (next == trailing) break;
    trailing = next;
  }
  if (middle[trailing].x < middle[leading].x) std::swap(leading, trailing);
  double const chord = length(middle[trailing] - middle[leading]);
  auto const corners = [&](int end) {
    std::vector<int> found;
    for (int n = 0; n < middle.size(); ++n)
      if ((lines[n].end || turn[n] > corner_angle) && length(middle[n] - middle[end]) < edge_reach * chord)
        found.push_back(n);
    return in_order_around(std::move(found), middle.size());
  };
  return {{corners(leading)}, {corners(trailing)}};
}

/// The nodes of one side in chord coordinates (fractions of the chord), from the leading to the trailing edge.
Samples side_of(Section const& section, Edge const& leading, Edge const& trailing, int step) {
  Point const chord = trailing.at - leading.at;
  double const c2 = chord.x * chord.x + chord.y * chord.y;
  auto const local = [&](Point const& p) -> Sample {
    Point const d = p - leading.at;
    return {(d.x * chord.x + d.y * chord.y) / c2, (d.y * chord.x - d.x * chord.y) / c2, 0, 0};
  };
  int const n = section.size();
  bool const forward = step > 0;
  // A corner is the end of its side; a point between nodes or a single corner is the edge itself.
  auto const end_of = [&](Edge const& edge, int line) {
    return edge.first < edge.last ? local(section[line]) : local(edge.at);
  };
  int at = forward ? leading.last : leading.first;
  int stop = forward ? trailing.first : trailing.last;
  while (forward && stop <= at) stop += n;
  while (!forward && stop >= at) stop -= n;
  Samples side{end_of(leading, at)};
  for (at += step; at != stop; at += step) side.push_back(local(section[at]));
  side.push_back(end_of(trailing, stop));
  return side;
}

}  // namespace

SectionGeometry::SectionGeometry(Outline outline) {
  std::vector<Line> const& lines = outline.lines;
  span_lo_ = -inf;
  span_hi_ = inf;
  std::size_t most_nodes = 0;
  for (Line const& line : lines) {
    span_lo_ = std::max(span_lo_, line.span.front());
    span_hi_ = std::min(span_hi_, line.span.back());
    most_nodes = std::max(most_nodes, line.span.size());
  }
  if (lines.size() < 3 || !(span_hi_ > span_lo_))
    throw MotionError("its spanwise grid lines have no span in common (" + to_text(span_lo_, 4) + " to " +
                      to_text(span_hi_, 4) + "); name whole sides of one blade or wing");
  n_sections_ = int(std::clamp<std::size_t>(2 * most_nodes - 1, 33, 129));
  auto const span_of = [&](int k) { return span_lo_ + (span_hi_ - span_lo_) * k / (n_sections_ - 1); };

  // Corners are those of the mean over several sections, so that all sections have their edges at the same lines.
  std::vector<double> turn(lines.size(), 0.0);
  constexpr int n_looks = 9;
  for (int look = 0; look < n_looks; ++look) {
    Section const section(lines, span_of((n_sections_ - 1) * look / (n_looks - 1)));
    for (int n = 0; n < section.size(); ++n) turn[n] += section.turn(n) / n_looks;
  }
  EdgeFinders const find = find_edges(Section(lines, span_of((n_sections_ - 1) / 2)), turn, lines);

  double shortest = inf, longest = 0;
  for (int k = 0; k < n_sections_; ++k) {
    double const h = span_of(k);
    Section section(lines, h);
    Edge leading = find.leading(section, section[section.most_downstream()]), trailing;
    // An edge without corners is the place farthest from the other one, in lengths that both edges set: a few rounds
    // settle them.
    for (int pass = 0; pass < 6; ++pass) {
      trailing = find.trailing(section, leading.at);
      leading = find.leading(section, trailing.at);
      section.scale = 0.5 * (leading.unit + trailing.unit);
    }
    trailing = find.trailing(section, leading.at);
    leading = find.leading(section, trailing.at);
    double const chord = length(trailing.at - leading.at);
    if (!(chord > 0))
      throw MotionError("at span fraction " + to_text(h, 4) + " the section has no chord; check axis, span and flow");
    shortest = std::min(shortest, chord);
    longest = std::max(longest, chord);
    edges_.add(h, {leading.at.x, leading.at.y / section.scale, trailing.at.x, trailing.at.y / section.scale});
    scales_.add(h, {section.scale, 0, 0, 0});
    if (outline.one_sided) continue;
    Side const one(side_of(section, leading, trailing, +1)), other(side_of(section, leading, trailing, -1));
    for (int j = 0; j < n_chord; ++j) camber_.push_back(0.5 * (one.table[j][1] + other.table[j][1]));
  }
  images_ = {0};
  if (outline.shift != 0) images_.push_back(outline.shift);

  Section const middle(lines, span_of((n_sections_ - 1) / 2));
  auto const edge = [&](EdgeFinder const& finder) {
    if (finder.corners.empty()) return "round";
    double wide = 0;
    for (int c : finder.corners) wide = std::max(wide, length(middle[c] - middle[finder.corners.front()]));
    return wide < 1e-6 * longest ? "sharp" : "blunt";
  };
  ChordLine const root = chord_line(span_lo_), tip = chord_line(span_hi_);
  auto const degrees = [](ChordLine const& c) {
    return to_text(std::atan2(c.sin_stagger, c.cos_stagger) * 180 / std::numbers::pi, 4);
  };
  description_ = std::to_string(lines.size()) + " spanwise lines, span fractions " + to_text(span_lo_, 4) + " to " +
                 to_text(span_hi_, 4) + ", chord " + to_text(shortest, 4) + " to " + to_text(longest, 4) +
                 ", stagger " + degrees(root) + " to " + degrees(tip) + " degrees, leading edge " + edge(find.leading) +
                 ", trailing edge " + edge(find.trailing);
}

ChordLine SectionGeometry::chord_line(double span) const {
  SpanTable::Value const e = edges_.at(span);
  double const scale = scales_.at(span)[0], ds = e[2] - e[0], dt = scale * (e[3] - e[1]), c = std::hypot(ds, dt);
  return {e[0], e[1], c, ds / c, dt / c, scale};
}

double SectionGeometry::camber(double span, double chord_length, double chord_fraction) const {
  double const x = (std::clamp(span, span_lo_, span_hi_) - span_lo_) / (span_hi_ - span_lo_) * (n_sections_ - 1);
  Convolution const over_chord(n_chord, chord_angle(chord_fraction) / std::numbers::pi * (n_chord - 1));
  double sum = 0;
  Convolution(n_sections_, x).for_each([&](int k, double wk) {
    over_chord.for_each([&](int j, double wj) { sum += wk * wj * camber_[std::size_t(k) * n_chord + std::size_t(j)]; });
  });
  return chord_length * sum;
}

namespace {

/// Spanwise lines of one contour in the section frame; t continuous along and from line to line.
std::vector<SectionGeometry::Line> lines_of(SectionFrame const& frame, BladeSurface const& surface,
                                            BladeContour const& contour) {
  double const period = frame.period();
  std::vector<SectionGeometry::Line> lines;
  for (int l : contour.lines) {
    SectionGeometry::Line line;
    for (int n : surface.lines[l]) {
      SectionPoint p = frame.at(surface.nodes[n].point);
      p.span = surface.nodes[n].span;
      if (!line.span.empty() && !(p.span > line.span.back() + 1e-9)) continue;
      if (period > 0 && !(line.span.empty() && lines.empty())) {
        double const before = line.span.empty() ? lines.back().place.front()[1] : line.place.back()[1];
        p.t = before + std::remainder(p.t - before, period);
      }
      line.span.push_back(p.span);
      line.place.push_back({p.s, p.t, p.unit, 0});
    }
    lines.push_back(std::move(line));
  }
  if (!contour.closed) lines.front().end = lines.back().end = true;
  return lines;
}

/// The outline of both sides of one blade of an H mesh, the second turned onto the first.
SectionGeometry::Outline join_sides(SectionFrame const& frame, std::vector<SectionGeometry::Line> one,
                                    std::vector<SectionGeometry::Line> other) {
  auto const upstream_first = [](std::vector<SectionGeometry::Line>& side) {
    auto const s_at_middle = [](SectionGeometry::Line const& line) {
      return place_at(line, 0.5 * (line.span.front() + line.span.back()))[0];
    };
    if (s_at_middle(side.front()) > s_at_middle(side.back())) std::reverse(side.begin(), side.end());
  };
  upstream_first(one);
  upstream_first(other);
  SectionGeometry::Outline outline;
  if (double const scale = frame.scale_of_t(); scale > 0) {
    double const period = frame.period();
    // The edge whose two lines keep their distance in t is one line and its image.
    struct Distance {
      double mean = 0, spread = inf;
    };
    auto const apart = [&](SectionGeometry::Line const& a, SectionGeometry::Line const& b) {
      double const lo = std::max(a.span.front(), b.span.front()), hi = std::min(a.span.back(), b.span.back());
      constexpr int n = 33;
      double least = inf, most = -inf, sum = 0, first = 0;
      for (int k = 0; k < n; ++k) {
        double const h = lo + (hi - lo) * k / (n - 1);
        Sample const pa = place_at(a, h), pb = place_at(b, h);
        double d = pb[1] - pa[1];
        if (k == 0) first = d;
        if (period > 0) d = first + std::remainder(d - first, period);
        // An image lies at the same place along the flow.
        double const off = std::abs(pb[0] - pa[0]);
        least = std::min(least, d - off);
        most = std::max(most, d + off);
        sum += d / n;
      }
      return Distance{sum, most - least};
    };
    Distance const leading = apart(one.front(), other.front()), trailing = apart(one.back(), other.back());
    Distance const& image = leading.spread <= trailing.spread ? leading : trailing;
    if (!(image.spread < 1e-6 * scale))
      throw MotionError(
          "its two open sides share neither leading nor trailing edge, nor lie a pitch apart (distances vary by " +
          to_text(image.spread, 4) + "); name the two sides of one blade row, or each blade in a rule of its own");
    if (std::abs(image.mean) > 1e-9 * (period > 0 ? 1 : scale)) outline.shift = image.mean;
    for (auto& line : other)
      for (auto& p : line.place) p[1] -= outline.shift;
  }
  // Where both sides end in one line the surface goes on from side to side: whether that is a corner, its turn says.
  double const extent =
      std::abs(place_at(one.back(), one.back().span.front())[0] - place_at(one.front(), one.front().span.front())[0]);
  auto const is_one_line = [extent](SectionGeometry::Line const& a, SectionGeometry::Line const& b) {
    for (int k = 0; k <= 8; ++k) {
      double const h = a.span.front() + (a.span.back() - a.span.front()) * k / 8;
      Sample const pa = place_at(a, h), pb = place_at(b, h);
      if (std::hypot(pb[0] - pa[0], pa[2] * (pb[1] - pa[1])) > 1e-4 * extent) return false;
    }
    return true;
  };
  if (is_one_line(one.front(), other.front())) {
    one.front().end = false;
    other.erase(other.begin());
  }
  if (is_one_line(one.back(), other.back())) {
    one.back().end = false;
    other.pop_back();
  }
  std::reverse(other.begin(), other.end());
  outline.lines = std::move(one);
  outline.lines.insert(outline.lines.end(), other.begin(), other.end());
  return outline;
}

}  // namespace

std::vector<SectionGeometry> find_sections(Boundary const& boundary, SectionFrame const& frame,
                                           std::vector<int> const& patches, std::vector<std::string>& notes) {
  BladeSurface const surface = stitch_blade(boundary, patches, frame.stitching(), notes);
  std::vector<SectionGeometry> found;
  std::vector<std::vector<SectionGeometry::Line>> open;
  for (BladeContour const& contour : surface.contours) {
    auto lines = lines_of(frame, surface, contour);
    bool whole = contour.closed;
    if (!whole) {
      // The two ends of a C lie together, compared with its extent.
      double const h = 0.5 * (lines.front().span.front() + lines.front().span.back());
      Section const section(lines, h);
      double size = 0;
      for (int n = 0; n < section.size(); ++n) size = std::max(size, length(section[n] - section[0]));
      whole = length(section[-1] - section[0]) < 0.3 * size;
    }
    if (whole)
      found.emplace_back(SectionGeometry::Outline{std::move(lines), 0, false});
    else
      open.push_back(std::move(lines));
  }
  if (open.size() == 2)
    found.emplace_back(join_sides(frame, std::move(open[0]), std::move(open[1])));
  else if (open.size() == 1)
    found.emplace_back(SectionGeometry::Outline{std::move(open[0]), 0, true});
  else if (open.size() > 2)
    throw MotionError("the patches make up " + std::to_string(open.size()) +
                      " open surfaces; give each blade, with its two sides, a rule of its own");
  if (found.empty()) throw MotionError("the patches make up no blade or wing; name its walls");
  for (std::size_t b = 0; b < found.size(); ++b)
    notes.push_back("sections of " + boundary.describe_patch(patches.front()) +
                    (found.size() > 1 ? ", number " + std::to_string(b + 1) : std::string()) + ": " +
                    found[b].description());
  return found;
}

}  // namespace gridmorph
