#include <gridmorph/motion/target/target_mappings.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/target/edge_images.hpp>
#include <gridmorph/motion/target/feature_path.hpp>
#include <gridmorph/motion/target/target_motion.hpp>
#include <gridmorph/motion/target/target_projection.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace gridmorph {

namespace {

using Segments = std::vector<std::pair<Vec3, Vec3>>;

/// Points closer than this share of its size are one.
constexpr double same_point = 1e-7;

std::vector<FeatureEdge> lines_of(PatchSurface const& surface) {
  std::vector<FeatureEdge> out;
  for (PatchGrid const& grid : surface.grids)
    for (GridFacet const& f : grid.faces) out.push_back({std::min(f[0], f[1]), std::max(f[0], f[1]), true});
  auto const before = [](FeatureEdge const& s, FeatureEdge const& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; };
  auto const same = [](FeatureEdge const& s, FeatureEdge const& t) { return s.a == t.a && s.b == t.b; };
  std::sort(out.begin(), out.end(), before);
  out.erase(std::unique(out.begin(), out.end(), same), out.end());
  return out;
}

Segments from_sections(TargetGeometry const& target, double z, double size, bool closed, std::string const& name) {
  Segments out;
  for (TargetSection const& section : target.sections) {
    auto const [low, high] = std::minmax_element(section.points.begin(), section.points.end(),
                                                 [](Vec3 const& p, Vec3 const& q) { return p.z < q.z; });
    if (section.points.size() < 2 || high->z - low->z > 1e-6 * size)
      throw MotionError(name + ": section '" + section.name +
                        "' of the target does not lie in a plane z = constant, as the mesh "
                        "does; give the profile in the plane of the mesh");
    auto const in_plane = [z](Vec3 const& p) { return Vec3{p.x, p.y, z}; };
    for (std::size_t n = 1; n < section.points.size(); ++n)
      out.emplace_back(in_plane(section.points[n - 1]), in_plane(section.points[n]));
    if (closed && section.points.size() > 2)
      out.emplace_back(in_plane(section.points.back()), in_plane(section.points.front()));
  }
  return out;
}

/// The lines in which the plane at z cuts facets, moved to `plane`; points on it count as above it.
Segments cut(TargetTree const& facets, double z, double plane) {
  Segments out;
  for (auto const& t : facets.triangles()) {
    std::vector<Vec3> ends;
    for (int c = 0; c < 3; ++c) {
      Vec3 const a = facets.points()[t[c]], b = facets.points()[t[(c + 1) % 3]];
      if ((a.z < z) == (b.z < z)) continue;
      // From below to above, so that neighbours find the same point.
      Vec3 const low = a.z < z ? a : b, high = a.z < z ? b : a;
      double const share = (z - low.z) / (high.z - low.z);
      ends.push_back({low.x + share * (high.x - low.x), low.y + share * (high.y - low.y), plane});
    }
    if (ends.size() == 2) out.emplace_back(ends[0], ends[1]);
  }
  return out;
}

Segments from_facets(TargetGeometry const& target, double z, std::string const& name) {
  TargetTree const facets = target_facets(target, name);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (Vec3 const& p : facets.points()) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  // A surface may begin or end in the very plane.
  double const aside = 1e-6 * (high - low);
  for (double const at : {z, z + aside, z - aside})
    if (Segments found = cut(facets, at, z); !found.empty()) return found;
  throw MotionError(name + ": the plane of the mesh, z = " + std::to_string(z) +
                    ", meets no facet of the target, which goes from z = " + std::to_string(low) + " to " +
                    std::to_string(high) + "; give the profile as a section, or a surface that crosses the plane");
}

/// The profile as a strip on both sides of its plane: closest points of the plane are in the plane.
struct Strip {
  TargetTree tree;
  std::vector<FeatureEdge> profile;
};

Strip make_strip(Segments const& segments, double width) {
  std::vector<Vec3> ends;
  for (auto const& [a, b] : segments) {
    ends.push_back(a);
    ends.push_back(b);
  }
  PointNumbers numbers(same_point * box_diagonal(ends));
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  Strip strip;
  auto const number = [&](Vec3 const& p) {
    int const fresh = int(points.size()), n = numbers.find_or_add(p, fresh);
    if (n < fresh) return n;
    for (double const side : {0.0, -width, width}) points.push_back({p.x, p.y, p.z + side});
    return n;
  };
  for (auto const& [p, q] : segments) {
    int const a = number(p), b = number(q);
    if (a == b) continue;
    strip.profile.push_back({std::min(a, b), std::max(a, b), true});
    for (int const side : {1, 2}) {
      triangles.push_back({a, b, b + side});
      triangles.push_back({a, b + side, a + side});
    }
  }
  strip.tree = TargetTree(std::move(points), std::move(triangles));
  return strip;
}

Polyline polyline(std::vector<Vec3> const& points, FeatureChain const& chain) {
  std::vector<Vec3> out;
  for (int const v : chain.vertices) out.push_back(points[v]);
  return Polyline(out);
}

/// Length, middle and main direction of lines in a plane: of their moments of first and second order.
struct Moments {
  double length = 0, angle = 0;
  double slender = 0;  ///< 0: all directions are alike
  Vec3 middle;
};

Moments moments(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& lines) {
  Moments out;
  for (FeatureEdge const& e : lines) {
    double const own = distance(points[e.a], points[e.b]);
    out.length += own;
    out.middle += (0.5 * own) * (points[e.a] + points[e.b]);
  }
  out.middle = (1 / out.length) * out.middle;
  double xx = 0, xy = 0, yy = 0;
  for (FeatureEdge const& e : lines) {
    double const own = distance(points[e.a], points[e.b]);
    Vec3 const m = 0.5 * (points[e.a] + points[e.b]) - out.middle, d = points[e.b] - points[e.a];
    xx += own * (m.x * m.x + d.x * d.x / 12);
    xy += own * (m.x * m.y + d.x * d.y / 12);
    yy += own * (m.y * m.y + d.y * d.y / 12);
  }
  out.angle = 0.5 * std::atan2(2 * xy, xx - yy);
  out.slender = std::hypot(xx - yy, 2 * xy) / (xx + yy);
  return out;
}

/// Lines without a corner say nothing about how they turned, other than by their moments: the surface goes along with
/// these where that brings it at least as near to the target as its box does.
std::function<Vec3(Vec3 const&)> guess(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& lines,
                                       Strip const& strip) {
  auto const rough = rough_guess(points, strip.tree);
  Moments const own = moments(points, lines), there = moments(strip.tree.points(), strip.profile);
  if (!(own.length > 0) || !(there.length > 0) || own.slender < 0.02 || there.slender < 0.02) return rough;
  // Main directions have no sense: the smaller turn.
  double const turn = std::remainder(there.angle - own.angle, std::numbers::pi), scale = there.length / own.length;
  double const c = scale * std::cos(turn), s = scale * std::sin(turn);
  auto const along = [=](Vec3 const& p) {
    Vec3 const d = p - own.middle;
    return Vec3{there.middle.x + c * d.x - s * d.y, there.middle.y + s * d.x + c * d.y, p.z};
  };
  double by_box = 0, by_moments = 0;
  for (Vec3 const& p : points) {
    by_box += strip.tree.closest(rough(p)).distance;
    by_moments += strip.tree.closest(along(p)).distance;
  }
  if (by_moments <= by_box) return along;
  return rough;
}

/// One open line to one open line, from end to end; false for all others.
bool map_open_lines(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& lines, Strip const& strip,
                    std::vector<Vec3>& image) {
  auto const chains_of = [](std::vector<Vec3> const& p, std::vector<FeatureEdge> const& edges) {
    return feature_chains(feature_neighbours(p.size(), edges), std::vector<char>(p.size(), 0));
  };
  auto const own = chains_of(points, lines), there = chains_of(strip.tree.points(), strip.profile);
  if (own.size() != 1 || there.size() != 1 || own.front().closed() || there.front().closed()) return false;
  Polyline const from = polyline(points, own.front()), to = polyline(strip.tree.points(), there.front());
  if (!(from.length() > 0) || !(to.length() > 0)) return false;
  auto const gap = [](Vec3 const& a, Vec3 const& b) { return dot(a - b, a - b); };
  bool const turned =
      gap(from.at(0), to.at(1)) + gap(from.at(1), to.at(0)) < gap(from.at(0), to.at(0)) + gap(from.at(1), to.at(1));
  for (std::size_t n = 0; n < own.front().vertices.size(); ++n)
    image[own.front().vertices[n]] = to.at(turned ? 1 - from.fraction(n) : from.fraction(n));
  return true;
}

}  // namespace

std::vector<Vec3> project_to_profile(PatchSurface const& surface, TargetGeometry const& target,
                                     std::vector<TargetSide> const& sides, std::vector<char> const& held,
                                     std::string const& name, std::vector<std::string>& notes) {
  auto const& points = surface.points;
  auto const lines = lines_of(surface);
  auto const neighbours = feature_neighbours(points.size(), lines);
  bool const closed = std::all_of(neighbours.begin(), neighbours.end(), [](auto const& n) { return n.size() == 2; });
  double const z = points.front().z;
  Segments const profile =
      target.sections.empty() ? from_facets(target, z, name) : from_sections(target, z, surface.size, closed, name);
  Strip const strip = make_strip(cut_at_sides(profile, sides), surface.size);
  if (strip.profile.empty()) throw MotionError(name + ": the profile of the target is one point");
  std::vector<Vec3> image = points;
  std::string how = "from end to end";
  if (!map_open_lines(points, lines, strip, image)) {
    EdgeImages const edges =
        map_edges(points, lines, strip.tree, strip.profile, surface.size, guess(points, lines, strip));
    for (std::size_t v = 0; v < points.size(); ++v)
      image[v] = edges.known[v] != 0 ? edges.image[v] : strip.tree.closest(edges.guess(points[v])).point;
    how = std::to_string(edges.mapped) + " lines";
    if (edges.unmapped > 0)
      how += "; " + std::to_string(edges.unmapped) + " lines have none like them there and go to the closest point";
  }
  notes.push_back(name + ": mapped to the profile in the plane of the mesh by arc length, " + how);
  std::vector<Vec3> displacement(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (held[v] != 0 && strip.tree.closest(points[v]).distance <= held_within * surface.size) continue;
    Vec3 const u{image[v].x - points[v].x, image[v].y - points[v].y, 0};
    if (!(norm(u) <= 1e-14 * (surface.size + norm(points[v])))) displacement[v] = u;
  }
  return displacement;
}

}  // namespace gridmorph
