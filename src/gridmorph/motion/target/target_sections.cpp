#include <gridmorph/motion/target/target_mappings.hpp>

#include <gridmorph/boundary/joined_sides.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/motion/target/section_profile.hpp>
#include <gridmorph/motion/target/section_rows.hpp>
#include <gridmorph/motion/target/span_coordinate.hpp>
#include <gridmorph/motion/target/surface_spread.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace gridmorph {

namespace {

Vec3 middle(std::vector<Vec3> const& points) {
  Vec3 sum;
  for (Vec3 const& p : points) sum += p;
  return (1 / double(points.size())) * sum;
}

/// The sections of a target as one surface.
class Loft {
 public:
  Loft(std::vector<SectionProfile> profiles, SpanCoordinate const& span)
      : profiles_(std::move(profiles)), span_(span) {}

  [[nodiscard]] int size() const { return int(profiles_.size()); }
  [[nodiscard]] SectionProfile const& profile(int k) const { return profiles_[k]; }
  [[nodiscard]] double span(int k, SectionPosition const& p) const { return span_(profiles_[k].at(p)); }

  /// The point of column p at span coordinate w; beyond the ends along the straight line through the last two.
  [[nodiscard]] Vec3 at(SectionPosition const& p, double w) const {
    double const range = span(size() - 1, p) - span(0, p), same = 1e-9 * range;
    int const lo = piece_at(
                  size(), [&](int k) { return span(k, p); }, w),
              hi = std::min(lo + 1, size() - 1);
    double const a = span(lo, p), b = span(hi, p);
    Vec3 const at_a = profiles_[lo].at(p), at_b = profiles_[hi].at(p);
    if (std::fabs(w - a) <= same) return at_a;
    if (std::fabs(w - b) <= same) return at_b;
    double const t = (w - a) / (b - a);
    if (t < 0 || t > 1 || size() == 2) return at_a + t * (at_b - at_a);
    return cubic_piece(at_a, at_b, slope(lo, p), slope(hi, p), b - a, t);
  }

  /// Flat facets between the points of neighbouring sections.
  [[nodiscard]] TargetTree facets() const {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    auto places = profiles_.front().positions();
    for (SectionProfile const& profile : profiles_) {
      auto const own = profile.positions();
      places.insert(places.end(), own.begin(), own.end());
    }
    std::sort(places.begin(), places.end(), [](SectionPosition const& a, SectionPosition const& b) {
      return a.stretch + a.fraction < b.stretch + b.fraction;
    });
    auto const same = [](SectionPosition const& a, SectionPosition const& b) {
      return std::fabs(a.stretch + a.fraction - b.stretch - b.fraction) < 1e-9;
    };
    places.erase(std::unique(places.begin(), places.end(), same), places.end());
    int const n = int(places.size());
    for (SectionProfile const& profile : profiles_)
      for (SectionPosition const& p : places) points.push_back(profile.at(p));
    for (int k = 0; k + 1 < size(); ++k)
      for (int m = 0; m < n; ++m) {
        int const a = k * n + m, b = k * n + (m + 1) % n;
        triangles.push_back({a, b, b + n});
        triangles.push_back({a, b + n, a + n});
      }
    return {std::move(points), std::move(triangles)};
  }

 private:
  [[nodiscard]] Vec3 slope(int k, SectionPosition const& p) const {
    int const m = std::clamp(k, 1, size() - 2);
    Vec3 const a = profiles_[m - 1].at(p), b = profiles_[m].at(p), c = profiles_[m + 1].at(p);
    double const h = span_(b) - span_(a), l = span_(c) - span_(b);
    Vec3 const before = (1 / h) * (b - a), after = (1 / l) * (c - b);
    Vec3 const bend = (1 / (h + l)) * (after - before);
    return before + (h + 2 * (m == k ? 0 : k < m ? -h : l)) * bend;
  }

  std::vector<SectionProfile> profiles_;
  SpanCoordinate const& span_;
};

std::vector<SectionProfile> target_profiles(TargetRule const& rule, SpanCoordinate const& span,
                                            SectionProfile::Edges edges, std::string const& name) {
  std::vector<std::pair<double, TargetSection const*>> order;
  for (TargetSection const& s : rule.target->sections) {
    if (s.points.empty()) throw MotionError(name + ": section '" + s.name + "' of the target has no points");
    order.emplace_back(span(middle(s.points)), &s);
  }
  if (order.empty()) throw MotionError(name + ": the target holds no sections");
  std::stable_sort(order.begin(), order.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
  double const range = order.back().first - order.front().first;
  for (std::size_t k = 1; k < order.size(); ++k)
    if (!(order[k].first - order[k - 1].first > 1e-6 * range))
      throw MotionError(name + ": the sections '" + order[k - 1].second->name + "' and '" + order[k].second->name +
                        "' are at the same span " + std::to_string(order[k].first) + "; check the span direction");
  std::vector<SectionProfile> out;
  for (auto const& [w, section] : order)
    out.emplace_back(section->points, span.direction(middle(section->points)), rule.flow,
                     name + ", section '" + section->name + "'", edges);
  return out;
}

/// Where the vertices of the mesh lie in its sections.
struct OwnSections {
  std::vector<std::pair<int, SectionPosition>> places;
  SectionProfile first, last;  ///< at the ends of the span
  std::string note;            ///< what they are made of
};

OwnSections sections_of_rows(Boundary const& boundary, PatchSurface const& surface, SpanCoordinate const& span,
                             Vec3 const& flow, SectionProfile::Edges edges, std::string const& name) {
  SectionRows const found = find_section_rows(
      surface, [&span](Vec3 const& p) { return span(p); }, name);
  std::vector<SectionProfile> own;
  std::vector<std::pair<int, SectionPosition>> places;
  for (auto const& row : found.rows) {
    std::vector<Vec3> points;
    for (int const v : row) points.push_back(surface.points[v]);
    own.emplace_back(points, span.direction(middle(points)), flow, name + ", section of the mesh", edges);
    auto const positions = own.back().positions();
    for (std::size_t n = 0; n < row.size(); ++n) places.emplace_back(row[n], positions[n]);
  }
  std::string note = std::to_string(own.size()) + " rows of nodes";
  for (int const p : found.left_out)
    note += "; patch " + boundary.describe_patch(p) + " has no sections and goes along with its edges";
  return {std::move(places), own.front(), own.back(), std::move(note)};
}

OwnSections sections_of_facets(PatchSurface const& surface, SpanCoordinate const& span, Vec3 const& flow,
                               SectionProfile::Edges edges, std::string const& name) {
  SlicedSections sliced = slice_sections(surface, span, flow, edges, name);
  std::string note = std::to_string(sliced.cuts) + " cuts through " + std::to_string(sliced.facets) + " facets";
  std::vector<char> placed(surface.points.size(), 0);
  for (auto const& place : sliced.places) placed[place.first] = 1;
  if (auto const without = std::count(placed.begin(), placed.end(), 0); without > 0)
    note += "; " + std::to_string(without) + " of " + std::to_string(placed.size()) +
            " nodes are in no section (tips, ends that are cut off) and go along with those that are";
  return {std::move(sliced.places), std::move(sliced.first), std::move(sliced.last), std::move(note)};
}

}  // namespace

SectionMapping map_sections(Boundary const& boundary, PatchSurface const& given, TargetRule const& rule,
                            Axis const& axis, std::string const& name, std::vector<std::string>& notes) {
  if (rule.span && !(norm(*rule.span) > 0)) throw MotionError(name + ": the span direction has no length");
  if (!(norm(rule.flow) > 0)) throw MotionError(name + ": the flow direction has no length");
  SpanCoordinate const span(rule, axis);
  std::vector<Vec3> centres;
  for (TargetSection const& s : rule.target->sections)
    if (!s.points.empty()) centres.push_back(middle(s.points));
  JoinedSides const joined = join_sides(boundary, given, centres.empty() ? Vec3{} : middle(centres));
  PatchSurface const& surface = joined.surface;
  auto const n_turned = std::count(joined.turned.begin(), joined.turned.end(), 1);
  auto const edges = n_turned > 0 ? SectionProfile::Edges::extreme : SectionProfile::Edges::farthest;
  Loft const loft(target_profiles(rule, span, edges, name), span);
  bool const single = loft.size() == 1;
  if (single && !span.straight())
    throw MotionError(name + ": one section makes no surface around an axis; give two or more, or a span direction");

  OwnSections const own = surface.gridded ? sections_of_rows(boundary, surface, span, rule.flow, edges, name)
                                          : sections_of_facets(surface, span, rule.flow, edges, name);

  std::vector<char> mapped(surface.points.size(), 0);
  std::vector<Vec3> image(surface.points.size());
  double beyond = 0;
  for (auto const& [v, p] : own.places) {
    if (mapped[v] != 0) continue;
    mapped[v] = 1;
    double const w = span(surface.points[v]);
    if (single) {
      Vec3 const at = loft.profile(0).at(p);
      double const gap = w - span(at);
      bool const flat = std::fabs(gap) <= 1e-14 * (surface.size + norm(at));
      image[v] = flat ? at : at + gap * *rule.span * (1 / norm(*rule.span));
      continue;
    }
    double const lo = loft.span(0, p), hi = loft.span(loft.size() - 1, p);
    double wanted = w;
    if (rule.span_match == TargetRule::SpanMatch::fraction) {
      double const own_lo = span(own.first.at(p)), own_hi = span(own.last.at(p));
      // Alike surfaces keep the coordinate as it is: the product would round.
      bool const alike = own_lo == lo && own_hi == hi;
      if (!alike && own_hi > own_lo) wanted = lo + (w - own_lo) / (own_hi - own_lo) * (hi - lo);
    }
    beyond = std::max({beyond, (lo - wanted) / (hi - lo), (wanted - hi) / (hi - lo)});
    image[v] = loft.at(p, wanted);
  }
  if (beyond > 0.1)
    throw MotionError(name + ": nodes lie " + std::to_string(100 * beyond) +
                      " % of the span beyond the sections of the target; give sections for the whole span, or let the "
                      "span fraction say where nodes go");
  std::string note = name + ": mapped by " + std::to_string(loft.size()) + " sections onto " + own.note;
  if (beyond > 1e-9) note += "; extended by " + std::to_string(100 * beyond) + " % of the span beyond them";
  if (n_turned > 0)
    note += "; " + std::to_string(n_turned) + " of " + std::to_string(joined.turned.size()) +
            " patches are a pitch away and go as their copies there";
  notes.push_back(note);

  SurfaceSpread::Edges const none;
  image = SurfaceSpread(surface, mapped, image, none).run([](int, Vec3 const& wanted) { return wanted; });
  SectionMapping out;
  out.displacement.resize(given.points.size());
  out.mapped.resize(given.points.size());
  for (std::size_t g = 0; g < given.grids.size(); ++g)
    for (int const v : given.grids[g].vertex) {
      int const w = joined.vertex[v];
      Vec3 const u = image[w] - surface.points[w];
      out.displacement[v] = joined.turned[g] != 0 ? transpose(joined.turn[g].rotation) * u : u;
      out.mapped[v] = mapped[w];
    }
  out.to_target = joined.turn;
  if (!single) out.facets = loft.facets();
  return out;
}

}  // namespace gridmorph
