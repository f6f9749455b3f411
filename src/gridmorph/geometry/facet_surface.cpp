#include <gridmorph/geometry/facet_surface.hpp>

#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/geometry/facet_topology.hpp>
#include <gridmorph/geometry/plane_fit.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace gridmorph {

namespace {

/// Tangents at the ends of the edges of a discrete surface, and normals at the corners of its facets.
struct FacetTangents {
  std::vector<Vec3> normals;  ///< unit; one for every fan: facets about a point without a rim or crease between them
  std::vector<std::array<int, 4>> normal_of_corner;  ///< per facet
  std::vector<Vec3>
      bends;  ///< [2 edge + end]: (length times tangent - chord) / 3, seen from that end (facet_patch.hpp)

  explicit FacetTangents(FacetTopology const& topology);
};

constexpr int line_ends = -1, no_line = -2;

class Builder {
 public:
  Builder(FacetTopology const& topology, FacetTangents& out) : t_(topology), out_(out), lines_(2 * t_.edges.size()) {}

  void run() {
    for (int e = 0; e < int(t_.edges.size()); ++e)
      for (int end = 0; end < 2; ++end) lines_[2 * e + end] = line_tangent(e, t_.edges[e].point[end]);
    out_.normal_of_corner.assign(t_.facets.size(), {-1, -1, -1, -1});
    out_.bends.assign(2 * t_.edges.size(), Vec3{});
    for (int v = 0; v < int(t_.points.size()); ++v) about(v);
  }

 private:
  Vec3 chord(int edge, int from) const { return t_.points[t_.other_end(edge, from)] - t_.points[from]; }
  int end_of(int edge, int point) const { return t_.edges[edge].point[0] == point ? 0 : 1; }

  bool touches(int edge, int point) const {
    return t_.edges[edge].point[0] == point || t_.edges[edge].point[1] == point;
  }

  bool straight(int e, int f, int v, double least_cosine = 0.5) const {
    Vec3 const in = -chord(e, v), out = chord(f, v);
    return dot(in, out) > least_cosine * norm(in) * norm(out);
  }

  bool share_a_facet(int e, int f) const {
    for (int const a : t_.edges[e].facet)
      for (int const b : t_.edges[f].facet)
        if (a >= 0 && a == b) return true;
    return false;
  }

  /// What the facets on the sides of a rim or crease say about its going on at v. A grid of quadrilaterals has a corner
  /// there, whatever its angle, where one or three of them lie between the edge and its continuation.
  enum class Grid { goes_on, corner, none };
  Grid grid_beside(int e, int v) const {
    Grid found = Grid::goes_on;
    for (int const first : t_.edges[e].facet) {
      int n = 0;
      if (first < 0) continue;
      bool quads = true;
      for (int f = first, in = e; quads && n <= int(t_.facets_of_point[v].size());) {
        ++n;
        quads = t_.n_corners(f) == 4;
        int out = -1;
        for (int const q : t_.edges_of_facet[f])
          if (q >= 0 && q != in && touches(q, v)) out = q;
        if (out < 0 || t_.edges[out].special()) break;
        f = t_.edges[out].facet[t_.edges[out].facet[0] == f ? 1 : 0];
        in = out;
      }
      if (quads && n != 2) return Grid::corner;
      if (!quads) found = Grid::none;
    }
    return found;
  }

  /// The edge that continues the line of edge e at point v.
  int next_of_line(int e, int v) const {
    auto const& here = t_.edges_of_point[v];
    int n_special = 0, other_special = -1;
    for (int const f : here)
      if (t_.edges[f].special()) {
        ++n_special;
        if (f != e) other_special = f;
      }
    if (t_.edges[e].special()) {
      Grid const grid = n_special == 2 ? grid_beside(e, v) : Grid::corner;
      bool const goes_on = grid != Grid::corner && straight(e, other_special, v, grid == Grid::none ? 0.94 : 0.5);
      return goes_on ? other_special : line_ends;
    }
    if (n_special == 0) {
      auto const& facets = t_.facets_of_point[v];
      auto const quads = std::count_if(facets.begin(), facets.end(), [&](int f) { return t_.n_corners(f) == 4; });
      if (here.size() != 4 || facets.size() != 4 || quads < 2) return no_line;
      for (int const f : here)
        if (f != e && !share_a_facet(e, f)) return straight(e, f, v) ? f : line_ends;
      return no_line;
    }
    // A line that runs into a rim or crease between two quadrilaterals.
    for (int const f : t_.edges[e].facet) {
      if (t_.n_corners(f) != 4) return no_line;
      for (int const q : t_.edges_of_facet[f])
        if (q >= 0 && q != e && touches(q, v) && !t_.edges[q].special()) return no_line;
    }
    return line_ends;
  }

  /// Points of a line beyond v, first along edge e: up to four, as long as steps do not change by more than a factor of
  /// four and no point comes twice.
  std::vector<int> along(int e, int v) const {
    std::vector<int> out;
    double step = 0;
    for (int at = v; out.size() < 4 && e >= 0;) {
      double const length = norm(chord(e, at));
      if (!out.empty() && (length > 4 * step || 4 * length < step)) break;
      step = length;
      at = t_.other_end(e, at);
      if (at == v || std::find(out.begin(), out.end(), at) != out.end()) break;
      out.push_back(at);
      e = next_of_line(e, at);
    }
    return out;
  }

  /// Derivative by chord length at v, in the direction of edge e.
  std::optional<Vec3> line_tangent(int e, int v) const {
    int const back = next_of_line(e, v);
    if (back == no_line) return std::nullopt;
    if (back >= 0 && back < e) {  // the same line the other way, to the last bit
      Vec3 const other = *line_tangent(back, v);
      return -other;
    }
    std::vector<int> const ahead = along(e, v), behind = back >= 0 ? along(back, v) : std::vector<int>{};
    std::size_t const whole = back >= 0 ? 4 : 3;
    std::size_t n_ahead = std::min<std::size_t>(back >= 0 ? 2 : 3, ahead.size());
    std::size_t n_behind = std::min<std::size_t>(2, behind.size());
    n_ahead = std::min(ahead.size(), std::max(n_ahead, whole - n_behind));
    n_behind = std::min(behind.size(), std::max(n_behind, whole - n_ahead));

    std::vector<double> s;
    std::vector<Vec3> d;
    auto const add = [&](std::vector<int> const& line, std::size_t n, double sign) {
      double length = 0;
      int before = v;
      for (std::size_t m = 0; m < n; ++m) {
        length += distance(t_.points[line[m]], t_.points[before]);
        before = line[m];
        s.push_back(sign * length);
        d.push_back(t_.points[line[m]] - t_.points[v]);
      }
    };
    add(ahead, n_ahead, 1);
    add(behind, n_behind, -1);
    Vec3 tangent;
    for (std::size_t j = 0; j < s.size(); ++j) {
      double w = 1 / s[j];
      for (std::size_t k = 0; k < s.size(); ++k)
        if (k != j) w *= -s[k] / (s[j] - s[k]);
      tangent += w * d[j];
    }
    // A line that is no smooth curve: leave along the chord.
    Vec3 const c = (1 / norm(chord(e, v))) * chord(e, v);
    return norm(tangent - c) < 0.7 ? tangent : c;
  }

  std::optional<Vec3> const& line(int e, int v) const { return lines_[2 * e + end_of(e, v)]; }

  /// Everything at one point: its fans, their normals, the bends of the edges that leave it.
  void about(int v) {
    auto const& facets = t_.facets_of_point[v];
    std::vector<int> fan(facets.size());
    for (std::size_t m = 0; m < fan.size(); ++m) fan[m] = int(m);
    for (int const e : t_.edges_of_point[v]) {
      if (t_.edges[e].special()) continue;
      std::array<int, 2> at{};
      for (int side = 0; side < 2; ++side)
        at[side] = fan[std::find(facets.begin(), facets.end(), t_.edges[e].facet[side]) - facets.begin()];
      std::replace(fan.begin(), fan.end(), std::max(at[0], at[1]), std::min(at[0], at[1]));
    }
    for (int number = 0; number < int(fan.size()); ++number) {
      std::vector<int> members;
      for (std::size_t m = 0; m < fan.size(); ++m)
        if (fan[m] == number) members.push_back(facets[m]);
      if (members.empty()) continue;
      Vec3 const n = fan_normal(v, members);
      for (int const f : members)
        for (int q = 0; q < t_.n_corners(f); ++q)
          if (t_.facets[f][q] == v) out_.normal_of_corner[f][q] = int(out_.normals.size());
      out_.normals.push_back(n);
      for (int const f : members)
        for (int const e : t_.edges_of_facet[f])
          if (e >= 0 && touches(e, v)) bend(e, v, n);
    }
  }

  void bend(int e, int v, Vec3 const& n) {
    Vec3 const c = chord(e, v);
    Vec3 tangent = line(e, v) ? norm(c) * *line(e, v) : c;
    if (!t_.edges[e].special()) tangent = tangent - dot(tangent, n) * n;
    out_.bends[2 * e + end_of(e, v)] = (1.0 / 3) * (tangent - c);
  }

  /// Normal of the facets' corners at v, by their angles (Thuermer and Wuethrich 1998).
  Vec3 mean_normal(int v, std::vector<int> const& fan) const {
    Vec3 sum;
    for (int const f : fan) {
      int const size = t_.n_corners(f);
      int const q = int(std::find(t_.facets[f].begin(), t_.facets[f].end(), v) - t_.facets[f].begin());
      Vec3 const a = t_.points[t_.facets[f][(q + 1) % size]] - t_.points[v];
      Vec3 const b = t_.points[t_.facets[f][(q + size - 1) % size]] - t_.points[v];
      Vec3 const n = cross(a, b);
      if (double const area = norm(n); area > 0) sum += (std::atan2(area, dot(a, b)) / area) * n;
    }
    if (norm(sum) > 0) return (1 / norm(sum)) * sum;
    for (int const f : fan) sum += t_.area(f);
    return norm(sum) > 0 ? (1 / norm(sum)) * sum : Vec3{0, 0, 1};
  }

  Vec3 fan_normal(int v, std::vector<int> const& fan) const {
    Vec3 const mean = mean_normal(v, fan);
    std::vector<Vec3> known, fixed;
    for (int const f : fan)
      for (int const e : t_.edges_of_facet[f]) {
        if (e < 0 || !touches(e, v) || !line(e, v)) continue;
        Vec3 const unit = (1 / norm(*line(e, v))) * *line(e, v);
        known.push_back(unit);
        if (t_.edges[e].special()) fixed.push_back(unit);
      }
    Vec3 best;
    for (Vec3 const& a : known)
      for (Vec3 const& b : known)
        if (Vec3 const n = cross(a, b); norm(n) > norm(best) * (1 + 1e-9)) best = n;
    if (norm(best) > 0.05) {
      best = (1 / norm(best)) * best;
      double const side = dot(best, mean);
      return std::abs(side) > 0.5 ? (side > 0 ? best : -best) : mean;
    }
    Vec3 n = fit_normal(t_.points[v], mean, around(v, fan, mean, fixed.empty() ? 1 : 2)).value_or(mean);
    if (!(dot(n, mean) > 0.5)) n = mean;
    if (!fixed.empty()) n = n - dot(n, fixed.front()) * fixed.front();
    return norm(n) > 0.1 ? (1 / norm(n)) * n : mean;
  }

  /// The points around v that smooth edges lead to: those of the fan and, until there are enough, those one facet
  /// farther; more at rims, where they are on one side only.
  std::vector<Vec3> around(int v, std::vector<int> fan, Vec3 const& mean, int least_rings) const {
    constexpr std::size_t enough = 14;
    std::vector<int> points;
    std::size_t begin = 0;
    for (int ring = 0; ring < 4; ++ring) {
      std::size_t const end = fan.size();
      for (; begin < end; ++begin) {
        int const f = fan[begin];
        for (int q = 0; q < t_.n_corners(f); ++q)
          if (int const p = t_.facets[f][q]; p != v && std::find(points.begin(), points.end(), p) == points.end())
            points.push_back(p);
        for (int const e : t_.edges_of_facet[f]) {
          if (e < 0 || t_.edges[e].special()) continue;
          for (int const g : t_.edges[e].facet) {
            Vec3 const area = t_.area(g);
            if (dot(area, mean) > 0.3 * norm(area) && std::find(fan.begin(), fan.end(), g) == fan.end())
              fan.push_back(g);
          }
        }
      }
      if (ring >= least_rings && points.size() >= enough) break;
    }
    std::sort(points.begin(), points.end());
    std::vector<Vec3> out;
    for (int const p : points) out.push_back(t_.points[p]);
    return out;
  }

  FacetTopology const& t_;
  FacetTangents& out_;
  std::vector<std::optional<Vec3>> lines_;  ///< [2 edge + end]
};

FacetTangents::FacetTangents(FacetTopology const& topology) { Builder(topology, *this).run(); }

}  // namespace

void FacetList::add(FacetList const& other) {
  auto const shift = std::int32_t(points.size());
  points.insert(points.end(), other.points.begin(), other.points.end());
  for (auto facet : other.facets) {
    for (std::int32_t& c : facet)
      if (c >= 0) c += shift;
    facets.push_back(facet);
  }
}

FacetSurface FacetSurface::from_facets(FacetList const& list, FacetOptions const& options) {
  FacetTopology topology(list, options);
  FacetTangents tangents(topology);

  std::vector<kernels::Facet> facets(topology.facets.size());
  for (int f = 0; f < int(facets.size()); ++f)
    for (int q = 0; q < topology.n_corners(f); ++q) {
      int const e = topology.edges_of_facet[f][q];
      FacetEdge const& edge = topology.edges[e];
      int const side = edge.facet[0] == f ? 1 : 0;
      facets[f].corner[q] = topology.facets[f][q];
      facets[f].normal[q] = tangents.normal_of_corner[f][q];
      facets[f].bend[q] = 2 * e + (edge.point[0] == topology.facets[f][q] ? 0 : 1);
      if (edge.facet[1] >= 0) facets[f].neighbour[q] = 4 * edge.facet[side] + edge.place[side];
      if (edge.crease) facets[f].creases |= 1 << q;
    }

  FacetSurface surface;
  FacetBoxes tree(topology.points, topology.facets);
  surface.boxes = std::move(tree.boxes);
  std::vector<std::int32_t> place(facets.size());
  for (std::size_t n = 0; n < facets.size(); ++n) place[tree.order[n]] = std::int32_t(n);
  for (int const f : tree.order) {
    kernels::Facet facet = facets[f];
    for (std::int32_t& neighbour : facet.neighbour)
      if (neighbour >= 0) neighbour = 4 * place[neighbour / 4] + neighbour % 4;
    surface.facets.push_back(facet);
  }
  surface.points = std::move(topology.points);
  surface.normals = std::move(tangents.normals);
  surface.bends = std::move(tangents.bends);
  return surface;
}

double FacetSurface::size() const { return empty() ? 0 : distance(boxes.front().low, boxes.front().high); }

}  // namespace gridmorph
