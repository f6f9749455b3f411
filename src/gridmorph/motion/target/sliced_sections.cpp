#include <gridmorph/motion/target/section_rows.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/turbomachinery/sliced_part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace gridmorph {

namespace {

constexpr double most_along_span = 0.7;             ///< span that an edge of a rim gains at most, over its length
constexpr double end_share = 0.25;                  ///< of the span: where rims are looked for
constexpr double same_level = 1e-9;                 ///< shares of the span that differ by less are one
constexpr double least_cuts = 17, most_cuts = 512;  ///< of nodes that stand in no rows
constexpr double middle_reach = 0.1;                ///< of an edge: nodes amid edges lie that near to a cut
constexpr double row_spread = 0.2;                  ///< of the gap to the next row: shares of nodes of one row
constexpr double scattered_window = 2;              ///< see SectionProfile

/// The span coordinate of one end of the surface, by the place across the span.
class Rim {
 public:
  /// The rim at one end of the span. level: where it is taken to be if there are no edges.
  Rim(std::vector<Vec3> const& points, std::vector<std::array<int, 2>> const& edges, SpanCoordinate const& span,
      double level)
      : span_(span), level_(level) {
    if (edges.empty()) return;
    std::vector<Vec3> ends;
    std::vector<std::array<int, 3>> segments;
    for (auto const& [a, b] : edges) {
      int const n = int(ends.size());
      segments.push_back({n, n + 1, n + 1});
      for (int const v : {a, b}) {
        ends.push_back(span.moved_to(level, points[v]));
        w_.push_back(span(points[v]));
      }
    }
    tree_ = TargetTree(std::move(ends), std::move(segments));
  }

  [[nodiscard]] double operator()(Vec3 const& p) const {
    if (w_.empty()) return level_;
    auto const hit = tree_.closest(span_.moved_to(level_, p));
    auto const& segment = tree_.triangles()[hit.triangle];
    Vec3 const a = tree_.points()[segment[0]], b = tree_.points()[segment[1]];
    double const length = distance(a, b), t = length > 0 ? distance(a, hit.point) / length : 0;
    double const wa = w_[segment[0]], wb = w_[segment[1]];
    return t >= 1 ? wb : wa + t * (wb - wa);
  }

 private:
  SpanCoordinate const& span_;
  double level_;
  TargetTree tree_;
  std::vector<double> w_;  ///< per point of the tree
};

struct Ends {
  std::vector<std::array<int, 2>> lower, upper;
};

/// Edges of one facet, in lines that hang together, at the ends of the span.
Ends find_rims(std::vector<Vec3> const& points, std::vector<std::array<int, 3>> const& triangles,
               std::vector<double> const& w) {
  std::map<std::pair<int, int>, int> uses;
  for (auto const& t : triangles)
    for (int s = 0; s < 3; ++s) ++uses[std::minmax(t[s], t[(s + 1) % 3])];
  std::vector<std::array<int, 2>> edges;
  for (auto const& [ends, count] : uses) {
    auto const [a, b] = ends;
    if (count == 1 && std::fabs(w[b] - w[a]) < most_along_span * distance(points[a], points[b]))
      edges.push_back({a, b});
  }
  DisjointSets<int> lines(points.size());
  for (auto const& [a, b] : edges) lines.join(a, b);
  std::map<int, std::pair<double, int>> sums;
  for (auto const& [a, b] : edges) {
    auto& [sum, count] = sums[lines.root(a)];
    sum += w[a] + w[b];
    count += 2;
  }
  auto const [low, high] = std::minmax_element(w.begin(), w.end());
  Ends out;
  for (auto const& edge : edges) {
    auto const& [sum, count] = sums.at(lines.root(edge[0]));
    double const share = (sum / count - *low) / (*high - *low);
    if (share < end_share) out.lower.push_back(edge);
    if (share > 1 - end_share) out.upper.push_back(edge);
  }
  return out;
}

/// The place of a polygon nearest to p: the point from which it lies, the share of the way to the next one, and how
/// far.
struct OnLine {
  int after = 0;
  double t = 0, distance = std::numeric_limits<double>::infinity();
};
OnLine nearest_on(CutLine const& line, Vec3 const& p) {
  OnLine out;
  int const n = line.size();
  for (int k = 0; k < (line.closed ? n : n - 1); ++k) {
    Vec3 const a = line.points[k], d = line.points[(k + 1) % n] - a;
    double const length2 = dot(d, d), t = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
    double const gap = distance(p, a + t * d);
    if (gap < out.distance) out = {k, t, gap};
  }
  return out;
}

class Slicer {
 public:
  Slicer(PatchSurface const& surface, SpanCoordinate const& span, Vec3 const& flow, SectionProfile::Edges edges,
         std::string const& name)
      : span_(span), flow_(flow), edges_(edges), name_(name) {
    input_.points = surface.points;
    in_facet_.assign(surface.points.size(), 0);
    for (GridFacet const& f : surface.facets())
      for (int c = 2; c < (f[3] < 0 ? 3 : 4); ++c) input_.triangles.push_back({f[0], f[c - 1], f[c]});
    for (auto const& t : input_.triangles)
      for (int const v : t) in_facet_[v] = 1;
  }

  SlicedSections run() {
    measure_span();
    auto whole = one_blade();
    take_nodes(*whole);
    if (snap_rows(*whole)) {
      whole = one_blade();
      take_nodes(*whole);
    }
    set_levels(whole->part());
    return places(whole->part());
  }

 private:
  /// Shares of the span of all points, and of any place.
  void measure_span() {
    std::vector<double> w;
    for (Vec3 const& p : input_.points) w.push_back(span_(p));
    auto const [low, high] = std::minmax_element(w.begin(), w.end());
    double const range = *high - *low;
    if (!(range > 0)) throw MotionError(name_ + ": the patches have no extent along the span; check its direction");
    std::vector<std::array<int, 3>> rising;
    double length = 0;
    for (auto const& t : input_.triangles) {
      auto const [a, b, c] = t;
      length += distance(input_.points[a], input_.points[b]) / double(input_.triangles.size());
      if (gradient_in({input_.points[a], input_.points[b], input_.points[c]}, {w[a], w[b], w[c]}) > least_span_gain)
        rising.push_back(t);
    }
    edge_ = length;
    Ends const ends = find_rims(input_.points, rising, w);
    auto const lower = std::make_shared<Rim const>(input_.points, ends.lower, span_, *low);
    auto const upper = std::make_shared<Rim const>(input_.points, ends.upper, span_, *high);
    input_.height = [lower, upper](Vec3 const& p) { return (*upper)(p) - (*lower)(p); };
    input_.span = [lower, upper, this](Vec3 const& p) {
      double const at = span_(p), from = (*lower)(p), to = (*upper)(p);
      return to > from ? (at - from) / (to - from) : 0.0;
    };
    input_.along = [this](Vec3 const& p) { return dot(p, flow_); };
    share_.resize(input_.points.size());
    detail::for_all({}, "gridmorph::slice_sections::shares", Index(share_.size()), [&](Index n) {
      double const f = input_.span(input_.points[n]);
      share_[n] = std::fabs(f) < same_level ? 0 : std::fabs(f - 1) < same_level ? 1 : f;
    });
  }

  struct Whole {
    FacetCuts cuts;
    OuterParts parts;
    explicit Whole(SliceInput const& input) : cuts(input), parts(outer_parts(cuts, input)) {}
    [[nodiscard]] SlicedPart const& part() const { return parts.kept.front(); }
  };
  [[nodiscard]] std::unique_ptr<Whole const> one_blade() {
    input_.at = share_;
    auto out = std::make_unique<Whole const>(input_);
    if (auto const n = out->parts.kept.size(); n != 1)
      throw MotionError(name_ + ": the facets of the patches make up " +
                        (n == 0 ? std::string("no section") : std::to_string(n) + " surfaces with sections") +
                        "; a target of sections moves one blade or wing that is whole");
    return out;
  }

  void take_nodes(Whole const& whole) {
    SlicedPart const& part = whole.part();
    std::vector<char> has(share_.size(), 0);
    for (auto const& t : whole.cuts.corners(part.triangles()))
      for (int const v : t) has[v] = 1;
    nodes_.clear();
    for (int v = 0; v < int(share_.size()); ++v)
      if (has[v] != 0 && share_[v] >= part.first && share_[v] <= part.last) nodes_.push_back(v);
    for (int v = 0; v < int(share_.size()); ++v)
      if (in_facet_[v] == 0 && share_[v] >= part.first && share_[v] <= part.last) nodes_.push_back(v);
    std::sort(nodes_.begin(), nodes_.end(),
              [&](int a, int b) { return std::pair(share_[a], a) < std::pair(share_[b], b); });
  }

  /// Nodes as many edges from the lower end as one another are a row, where all of them lie far closer together along
  /// the span than to the next rows. They get the mean of their shares, so that cuts go through them. Whether nodes
  /// stand in rows.
  bool snap_rows(Whole const& whole) {
    auto const triangles = whole.cuts.corners(whole.part().triangles());
    std::vector<std::vector<int>> beside(share_.size());
    for (auto const& t : triangles)
      for (int s = 0; s < 3; ++s) {
        beside[t[s]].push_back(t[(s + 1) % 3]);
        beside[t[(s + 1) % 3]].push_back(t[s]);
      }
    std::vector<char> reached(share_.size(), 0);
    std::vector<std::vector<int>> rows(1);
    for (int v = 0; v < int(share_.size()); ++v)
      if (!beside[v].empty() && share_[v] == 0) {
        reached[v] = 1;
        rows.back().push_back(v);
      }
    while (!rows.back().empty()) {
      std::vector<int> next;
      for (int const v : rows.back())
        for (int const n : beside[v])
          if (std::exchange(reached[n], 1) == 0) next.push_back(n);
      rows.push_back(std::move(next));
    }
    rows.pop_back();
    if (rows.size() < 2) return false;
    struct Range {
      double low, high;
    };
    std::vector<Range> ranges;
    for (auto const& row : rows) {
      auto const [low, high] =
          std::minmax_element(row.begin(), row.end(), [&](int a, int b) { return share_[a] < share_[b]; });
      ranges.push_back({share_[*low], share_[*high]});
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      double const spread = ranges[k].high - ranges[k].low;
      if (k > 0 && !(spread < row_spread * (ranges[k].low - ranges[k - 1].high))) return false;
      if (k + 1 < rows.size() && !(spread < row_spread * (ranges[k + 1].low - ranges[k].high))) return false;
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      double sum = 0;
      for (int const v : rows[k]) sum += share_[v];
      bool const exact = ranges[k].low == ranges[k].high, top = ranges[k].high == 1;
      for (int const v : rows[k]) share_[v] = exact ? ranges[k].low : top ? 1 : sum / double(rows[k].size());
    }
    in_rows_ = true;
    return true;
  }

  void set_levels(SlicedPart const& part) {
    for (int const v : nodes_)
      if (levels_.empty() || share_[v] - levels_.back() > same_level) levels_.push_back(share_[v]);
    if (in_rows_) return;
    int const n = int(std::clamp(std::ceil(2 * (part.last - part.first) / part.step), least_cuts, most_cuts));
    levels_.clear();
    for (int k = 0; k <= n; ++k) levels_.push_back(part.first + (part.last - part.first) * k / n);
    levels_.back() = part.last;
  }

  /// A cut through the surface at one level.
  struct Cut {
    CutLine line;
    std::optional<SectionProfile> profile;
    Vec3 leading, trailing;
    std::exception_ptr problem;
  };

  [[nodiscard]] Cut cut_at(SlicedPart const& part, double level) const {
    Cut out;
    out.line = part.cut(level);
    if (out.line.size() < 3) return out;
    Vec3 middle;
    for (Vec3 const& p : out.line.points) middle += (1 / double(out.line.size())) * p;
    out.profile.emplace(out.line.points, span_.direction(middle), flow_, name_ + ", section of the mesh", edges_,
                        in_rows_ ? 0 : scattered_window);
    out.trailing = out.profile->at({0, 0});
    out.leading = out.profile->at({1, 0});
    return out;
  }

  /// Where a node that lies between two cuts would be in one of them: the chord at its span, linear between theirs,
  /// goes to the cut's chord, and what is across it turns and grows along.
  [[nodiscard]] Vec3 carried_to(Cut const& cut, Cut const& low, Cut const& high, double t, Vec3 const& p) const {
    Vec3 const from = low.leading + t * (high.leading - low.leading),
               chord = low.trailing + t * (high.trailing - low.trailing) - from, to = cut.trailing - cut.leading;
    Vec3 const span = span_.direction(p), across = cross(span, chord), there = cross(span, to);
    double const c2 = dot(chord, chord), a2 = dot(across, across);
    if (!(c2 > 0) || !(a2 > 0)) return p;
    Vec3 const q = p - from;
    // `across` and `there` are as long as their chords times the same factor, if span is across both.
    return cut.leading + (dot(q, chord) / c2) * to + (dot(q, across) / a2) * there;
  }

  /// Position in a cut; nothing for nodes amid edges that lie elsewhere.
  [[nodiscard]] std::optional<SectionPosition> position_in(Cut const& cut, int node, Vec3 const& p) const {
    OnLine const on = nearest_on(cut.line, p);
    if (in_facet_[node] == 0 && on.distance > middle_reach * edge_) return {};
    return cut.profile->position(on.after, on.t);
  }

  /// The position of a node, by the cut through it or the two beside it.
  [[nodiscard]] std::optional<SectionPosition> position_of(std::vector<Cut> const& cuts, int node) const {
    double const f = share_[node];
    Vec3 const p = input_.points[node];
    auto const above = std::lower_bound(levels_.begin(), levels_.end(), f - same_level) - levels_.begin();
    auto const at = std::size_t(std::min<std::ptrdiff_t>(above, std::ptrdiff_t(levels_.size()) - 1));
    Cut const& high = cuts[at];
    if (at == 0 || std::fabs(levels_[at] - f) <= same_level || !cuts[at - 1].profile)
      return high.profile ? position_in(high, node, p) : std::nullopt;
    Cut const& low = cuts[at - 1];
    if (!high.profile) return position_in(low, node, p);
    double const t = (f - levels_[at - 1]) / (levels_[at] - levels_[at - 1]);
    auto const a = position_in(low, node, carried_to(low, low, high, t, p)),
               b = position_in(high, node, carried_to(high, low, high, t, p));
    if (!a || !b) return {};
    return between(*a, *b, t);
  }

  SlicedSections places(SlicedPart const& part) const {
    std::vector<Cut> cuts(levels_.size());
    detail::for_all_parts({}, "gridmorph::slice_sections::cuts", Index(cuts.size()), [&](Index k) {
      try {
        cuts[k] = cut_at(part, levels_[k]);
      } catch (...) {
        cuts[k].problem = std::current_exception();
      }
    });
    for (Cut const& cut : cuts)
      if (cut.problem) std::rethrow_exception(cut.problem);
    auto const has = [](Cut const& cut) { return cut.profile.has_value(); };
    auto const first = std::find_if(cuts.begin(), cuts.end(), has);
    auto const last = std::find_if(cuts.rbegin(), cuts.rend(), has);
    if (first == cuts.end()) throw MotionError(name_ + ": the facets of the patches make up no section");
    std::vector<std::optional<SectionPosition>> positions(nodes_.size());
    detail::for_all_parts({}, "gridmorph::slice_sections::nodes", Index(nodes_.size()),
                          [&](Index n) { positions[n] = position_of(cuts, nodes_[n]); });
    SlicedSections out{{}, *first->profile, *last->profile, 0, Index(input_.triangles.size())};
    out.cuts = int(std::count_if(cuts.begin(), cuts.end(), has));
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (positions[n]) out.places.emplace_back(nodes_[n], *positions[n]);
    return out;
  }

  /// Positions of one node in two cuts: stretches follow one another around.
  static SectionPosition between(SectionPosition const& a, SectionPosition const& b, double t) {
    int const stretches = a.stretch == 2 || b.stretch == 2 ? 3 : 2;
    double from = a.stretch + a.fraction, to = b.stretch + b.fraction;
    if (std::fabs(to - from) > 0.5 * stretches) (from < to ? from : to) += stretches;
    double s = from + t * (to - from);
    if (s >= stretches) s -= stretches;
    int const stretch = std::min(int(s), stretches - 1);
    return {stretch, s - stretch};
  }

  SpanCoordinate const& span_;
  Vec3 flow_;
  SectionProfile::Edges edges_;
  std::string const& name_;
  SliceInput input_;
  std::vector<char> in_facet_;  ///< per point
  std::vector<double> share_;   ///< per point
  std::vector<int> nodes_;      ///< with a place, ascending by share
  std::vector<double> levels_;
  double edge_ = 0;  ///< mean length
  bool in_rows_ = false;
};

}  // namespace

SlicedSections slice_sections(PatchSurface const& surface, SpanCoordinate const& span, Vec3 const& flow,
                              SectionProfile::Edges edges, std::string const& name) {
  return Slicer(surface, span, flow, edges, name).run();
}

}  // namespace gridmorph
