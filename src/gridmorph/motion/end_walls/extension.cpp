#include <gridmorph/motion/end_walls/extended_blades.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/arc_curve.hpp>
#include <gridmorph/motion/detail/edge_distances.hpp>
#include <gridmorph/motion/detail/spanwise_lines.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

constexpr double least_left = 0.1;  // of a line

/// How far along the line the wall is from one of its ends; exactly 0 where the end is on it. The foot of a blade may
/// come to lie beside the wall, in what was inside of the blade: there the wall goes on along the planes of its facets,
/// for as far as the foot moves.
double way_to(MovedWall const& wall, ArcCurve const& line, bool upper, std::string const& name) {
  double const start = upper ? line.length() : 0;
  double s = start;
  for (int step = 0; step < 60; ++step) {
    Vec3 const x = line.at(s);
    TargetTree::Hit const hit = wall.moved().closest(x);
    Vec3 const area = wall.moved().normal(hit.triangle), n = (1 / norm(area)) * area;
    double const away = dot(x - hit.point, n), rate = dot(line.tangent(s), n);
    bool const beside = hit.distance <= std::abs(s - start) + 1e-9 * line.length();
    if (std::abs(away) <= 1e-13 * line.length() && beside) return s - start;
    if (std::abs(rate) < 0.02) break;  // along the wall
    double const way = std::clamp(-away / rate, -0.5 * line.length(), 0.5 * line.length());
    s += way;
    if (std::abs(way) <= 1e-15 * line.length() && beside) return s - start;
  }
  throw MotionError(name + ": the grid line along the span from " + to_text(line.at(start), 9) +
                    " does not meet the wall where that has moved; move the wall less, or let it reach as far as the "
                    "line goes");
}

PatchSurface in_grids(Boundary const& boundary, std::vector<int> const& patches, std::string const& name) {
  PatchSurface surface(boundary, patches);
  if (surface.gridded) return surface;
  auto grids = surface.in_grids(boundary);
  if (!grids || surface.lines)
    throw MotionError(name +
                      ": the faces of its patches do not stand in rows, so that there are no lines along the span to "
                      "slide along; give the patches the rule free");
  return std::move(*grids);
}

/// Distances from one of the rims that every connected part of the surface has on the walls; empty where there is none.
std::vector<double> span_of(Boundary const& boundary, PatchSurface const& surface, std::vector<int> const& wall_of) {
  auto const images = vertex_images(boundary, surface);
  auto neighbours = surface.neighbours();
  for (VertexImage const& image : images) neighbours[image.vertex].push_back(image.image);
  std::vector<int> rims;
  std::vector<double> out;
  for (std::size_t v = 0; v < wall_of.size(); ++v) {
    if (wall_of[v] < 0 || (!out.empty() && std::isfinite(out[v]))) continue;
    std::vector<int> front{int(v)};
    std::vector<char> seen(wall_of.size(), 0);
    seen[v] = 1;
    while (!front.empty()) {
      int const at = front.back();
      front.pop_back();
      rims.push_back(at);
      for (int const w : neighbours[at])
        if (wall_of[w] >= 0 && std::exchange(seen[w], 1) == 0) front.push_back(w);
    }
    out = edge_distances(surface, images, rims);
  }
  return out;
}

}  // namespace

ExtensionMotion::ExtensionMotion(Boundary const& boundary, std::vector<int> const& patches,
                                 std::span<MovedWall const* const> walls, std::string const& name,
                                 std::vector<std::string>& notes)
    : name_(name), surface_(in_grids(boundary, patches, name)), displacement_(surface_.points.size()) {
  auto const& points = surface_.points;
  std::vector<int> wall_of(points.size(), -1);
  for (std::size_t v = 0; v < points.size(); ++v)
    for (std::size_t w = 0; w < walls.size() && wall_of[v] < 0; ++w)
      if (walls[w]->has(points[v])) wall_of[v] = int(w);
  std::vector<double> const span = span_of(boundary, surface_, wall_of);
  if (span.empty()) throw MotionError(name_ + ": its patches have no nodes on the walls that it names in `of`");

  detail::SpanwiseLines stitched;
  for (PatchGrid const& grid : surface_.grids) {
    int const direction = detail::spanwise_direction(
        grid.extent, [&](int n) { return points[grid.vertex[n]]; },
        [&](int a, int b) { return std::abs(span[grid.vertex[b]] - span[grid.vertex[a]]); });
    if (direction < 0) continue;
    for (int l = 0; l < grid.extent[1 - direction]; ++l) {
      auto line = detail::grid_line(grid.extent, direction, l);
      for (int& n : line) n = grid.vertex[n];
      if (span[line.front()] > span[line.back()]) std::reverse(line.begin(), line.end());
      stitched.add(std::move(line), l == 0);
    }
  }
  stitched.join_in_span();

  std::vector<char> moved(points.size(), 0);
  int ends = 0;
  double longest = 0, shortest = 0;
  for (auto const& vertices : stitched.lines()) {
    std::vector<Vec3> nodes;
    std::vector<int> kept;
    for (int const v : vertices) {
      if (!kept.empty() && kept.back() == v) continue;
      kept.push_back(v);
      nodes.push_back(points[v]);
    }
    if (nodes.size() < 2) continue;
    ArcCurve const line(std::move(nodes));
    std::array<double, 2> way{};
    for (int e = 0; e < 2; ++e) {
      int const w = wall_of[e == 0 ? kept.front() : kept.back()];
      if (w < 0) continue;
      ++ends;
      // Nodes of zones of single precision are a little off one another.
      if (walls[w]->moves()) way[e] = way_to(*walls[w], line, e == 1, name_);
    }
    double const longer = way[1] - way[0];
    longest = std::max(longest, longer / line.length());
    shortest = std::min(shortest, longer / line.length());
    if (line.length() + longer < least_left * line.length())
      throw MotionError(name_ + ": of the grid line along the span from " + to_text(line.at(0), 9) + " only " +
                        to_text(100 * (1 + longer / line.length()), 3) + " % are left between the walls");
    for (std::size_t k = 0; k < kept.size(); ++k) {
      auto const v = std::size_t(kept[k]);
      if (std::exchange(moved[v], 1) != 0) continue;
      double const share = line.arc(k) / line.length(), s = line.arc(k) + (1 - share) * way[0] + share * way[1];
      if (s != line.arc(k)) displacement_[v] = line.at(s) - points[v];
    }
  }
  if (ends == 0) throw MotionError(name_ + ": no grid line of its patches ends on the walls that it names in `of`");
  notes.push_back(name_ + ": " + std::to_string(stitched.lines().size()) + " lines along the span, " +
                  to_text(100 * shortest, 3) + " to " + to_text(100 * longest, 3) + " % longer");
}

void ExtensionMotion::displacement(std::span<Vec3 const> at, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < at.size(); ++n) {
    int const v = surface_.numbers.find(at[n]);
    if (v < 0)
      throw MotionError(name_ + ": the point " + to_text(at[n], 9) +
                        " is no node of its patches; only their lines "
                        "along the span say where it goes");
    out[n] = displacement_[v];
  }
}

}  // namespace gridmorph
