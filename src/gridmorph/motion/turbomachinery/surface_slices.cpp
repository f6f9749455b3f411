#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/turbomachinery/blade_surface.hpp>
#include <gridmorph/motion/turbomachinery/sliced_part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double corner_angle = 50 * std::numbers::pi / 180;
constexpr double edge_reach = 0.1;  ///< in chords: corners nearer than this to the end of a section are of its edge
constexpr int points_of_stretch = 65, points_of_base = 5;

/// Which places of a section get points of their own: of its edges corners or one place; see ContourMaker::anchors.
struct Anchors {
  std::vector<int> at;     ///< ascending numbers of points; of open sections the ends too
  std::vector<char> base;  ///< per stretch from one to the next: the blunt base between two corners of one edge
  [[nodiscard]] bool alike(Anchors const& other) const { return at.size() == other.at.size() && base == other.base; }
};

/// Makes the sections of one part alike.
class ContourMaker {
 public:
  ContourMaker(SlicedPart const& part, FacetCuts const& cuts, SliceInput const& input)
      : part_(part), cuts_(cuts), input_(input) {}

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
    out.closed = part_.section().closed;
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
    CutLine line;
    Anchors anchors;
  };

  [[nodiscard]] std::optional<Section> section_at(double h) const {
    CutLine line = part_.cut(h);
    if (line.size() < 3 || line.closed != part_.section().closed) return std::nullopt;
    Anchors at = anchors(line);
    return Section{h, std::move(line), std::move(at)};
  }

  /// The last section that is alike, between one that is and the end of the span, where sections are not: found by
  /// halving the stretch.
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

  /// The ends of the chord: the two points farthest apart, the upstream one first.
  [[nodiscard]] std::array<int, 2> chord_ends(CutLine const& line) const {
    auto const farthest = [&](int from) {
      int best = from;
      for (int n = 0; n < line.size(); ++n)
        if (distance(line.points[n], line.points[from]) > distance(line.points[best], line.points[from])) best = n;
      return best;
    };
    int one = farthest(0), other = farthest(one);
    for (int pass = 0; pass < 8; ++pass) {
      int const next = farthest(other);
      if (next == one) break;
      one = next;
      other = farthest(one);
    }
    if (input_.along(line.points[one]) > input_.along(line.points[other])) std::swap(one, other);
    return {one, other};
  }

  [[nodiscard]] static double turn(CutLine const& line, int n) {
    int const size = line.size();
    if (!line.closed && (n == 0 || n == size - 1)) return std::numbers::pi;
    auto const at = [&](int k) { return line.points[(k + size) % size]; };
    // Points that a corner of a facet brings together have no direction between them.
    double const small = 1e-9 * distance(line.points.front(), line.points[size / 2]);
    int before = n - 1, after = n + 1;
    while (n - before < size && distance(at(before), at(n)) <= small) --before;
    while (after - n < size && distance(at(after), at(n)) <= small) ++after;
    Vec3 const a = at(n) - at(before), b = at(after) - at(n);
    return std::atan2(norm(cross(a, b)), dot(a, b));
  }

  [[nodiscard]] Anchors anchors(CutLine const& line) const {
    Anchors out;
    if (!part_.around()) {
      out.at = {0, line.size() - 1};
      out.base = {0};
      return out;
    }
    auto const ends = chord_ends(line);
    double const chord = distance(line.points[ends[0]], line.points[ends[1]]);
    std::vector<std::pair<int, int>> found;  // point, edge
    for (int edge = 0; edge < 2; ++edge) {
      std::vector<int> corners;
      for (int n = 0; n < line.size(); ++n)
        if (distance(line.points[n], line.points[ends[edge]]) < edge_reach * chord && turn(line, n) > corner_angle)
          corners.push_back(n);
      if (corners.empty()) corners = {ends[edge]};
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

  [[nodiscard]] std::vector<SlicePlace> resample(CutLine const& line, Anchors const& anchors, double h) const {
    std::vector<SlicePlace> out;
    int const size = line.size();
    std::vector<SlicePlace> exact;
    for (int const e : line.edges) exact.push_back(cuts_.place(e, h));
    auto const at = [&](int n) -> SlicePlace const& { return exact[n % size]; };
    for (std::size_t s = 0; s + 1 < anchors.at.size(); ++s) {
      int const from = anchors.at[s], to = anchors.at[s + 1];
      std::vector<double> length{0};
      for (int n = from; n < to; ++n) length.push_back(length.back() + distance(at(n).point, at(n + 1).point));
      int const parts = (anchors.base[s] != 0 ? points_of_base : points_of_stretch) - 1;
      for (int k = 0; k < parts; ++k) {
        double const wanted = length.back() * 0.5 * (1 - std::cos(std::numbers::pi * k / parts));
        auto const above = std::upper_bound(length.begin(), length.end(), wanted);
        int const n = std::min(int(above - length.begin()), int(length.size()) - 1) - 1;
        double const piece = length[n + 1] - length[n];
        double const t = piece > 0 ? (wanted - length[n]) / piece : 0;
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

  SlicedPart const& part_;
  FacetCuts const& cuts_;
  SliceInput const& input_;
};

}  // namespace

std::vector<SlicedContour> slice_surface(SliceInput const& input, std::vector<std::string>& notes) {
  FacetCuts const cuts(input);
  auto const [parts, passed_over] = outer_parts(cuts, input);
  double lo = -inf, hi = inf, step = inf;
  for (SlicedPart const& p : parts) {
    lo = std::max(lo, p.first);
    hi = std::min(hi, p.last);
    step = std::min(step, p.step);
  }
  if (parts.empty() || !(hi > lo))
    throw MotionError("the facets of the blade make up no sections; name whole sides of one blade or wing");
  int const n = int(std::clamp(std::ceil(2 * (hi - lo) / step), 17.0, 129.0));
  std::vector<double> levels;
  for (int k = 0; k < n; ++k) levels.push_back(k + 1 == n ? hi : lo + (hi - lo) * k / (n - 1));
  std::vector<SlicedContour> out;
  for (SlicedPart const& p : parts) {
    out.push_back(ContourMaker(p, cuts, input).contour(levels));
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
