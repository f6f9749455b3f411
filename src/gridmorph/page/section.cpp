#include <gridmorph/page/section.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph::page {

namespace {

bool crosses(double a, double b) { return (a < 0) != (b < 0); }

Flat crossing(Cut const& cut, Coordinates const& at, std::vector<double> const& level, Index32 a, Index32 b) {
  double const t = level[a] / (level[a] - level[b]);
  return cut.flat(at[a] + t * (at[b] - at[a]));
}

/// In order around their middle; the polygon of a convex cell.
void sort_around(std::vector<Flat>& points) {
  Flat middle{0, 0};
  for (Flat const& p : points)
    for (std::size_t d = 0; d < 2; ++d) middle[d] += p[d] / double(points.size());
  auto const angle = [&](Flat const& p) { return std::atan2(p[1] - middle[1], p[0] - middle[0]); };
  std::sort(points.begin(), points.end(), [&](Flat const& a, Flat const& b) { return angle(a) < angle(b); });
}

bool wraps(std::vector<Flat> const& points, double period) {
  if (period <= 0) return false;
  auto const [low, high] =
      std::minmax_element(points.begin(), points.end(), [](Flat const& a, Flat const& b) { return a[1] < b[1]; });
  return (*high)[1] - (*low)[1] > 0.5 * period;
}

void add_polygon(Section& out, Index cell, std::vector<Flat> const& points) {
  out.cell.push_back(cell);
  out.corner.insert(out.corner.end(), points.begin(), points.end());
  out.first.push_back(out.corner.size());
}

Section plane_section(PictureMesh const& mesh, Coordinates const& at, Cut const& cut,
                      std::vector<signed char> const& walls) {
  Section out;
  out.first.push_back(0);
  auto const plane = cut.index_plane ? mesh.index_plane((*cut.index_plane)[0], (*cut.index_plane)[1]) : mesh.plane();
  std::vector<Flat> points;
  for (std::size_t f = 0; f < plane.facets.size(); ++f) {
    points.clear();
    for (std::size_t c = 0; c < plane.facets[f].size(); ++c) points.push_back(cut.flat(at[plane.facets[f].node[c]]));
    add_polygon(out, plane.cell[f], points);
  }
  for (Edge const& side : plane.sides)
    if (side.patch >= 0 && walls[side.patch] >= 0)
      out.walls.push_back({cut.flat(at[side.node[0]]), cut.flat(at[side.node[1]]), walls[side.patch] > 0, side.patch});
  return out;
}

}  // namespace

Section cut_mesh(PictureMesh const& mesh, std::vector<Facet> const& boundary, Coordinates const& at, Cut const& cut,
                 std::vector<signed char> const& walls) {
  if (!cut.levels) return plane_section(mesh, at, cut, walls);
  Section out;
  out.first.push_back(0);
  std::vector<double> level(at.size());
  cut.levels(at, level);
  CellFaces faces;
  std::vector<Flat> points;
  std::vector<std::pair<Index32, Index32>> edges;
  for (Index const cell : mesh.crossed(level)) {
    mesh.faces(cell, faces);
    edges.clear();
    points.clear();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      auto const face = faces[f];
      Index32 a = face.back();
      for (Index32 const b : face) {
        if (crosses(level[a], level[b])) edges.push_back(std::minmax(a, b));
        a = b;
      }
    }
    // Each edge bounds two faces of the cell: once, and from its lower node, so that it gives one point in all cells
    // around it.
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (auto const& [a, b] : edges) points.push_back(crossing(cut, at, level, a, b));
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3 || wraps(points, cut.period)) continue;
    sort_around(points);
    add_polygon(out, cell, points);
  }
  for (Facet const& facet : boundary) {
    if (facet.patch < 0 || walls[facet.patch] < 0) continue;
    points.clear();
    for (std::size_t c = 0; c < facet.size(); ++c) {
      Index32 const a = facet.node[c], b = facet.node[(c + 1) % facet.size()];
      if (crosses(level[a], level[b])) points.push_back(crossing(cut, at, level, a, b));
    }
    if (points.size() == 2 && !wraps(points, cut.period))
      out.walls.push_back({points[0], points[1], walls[facet.patch] > 0, facet.patch});
  }
  return out;
}

void FlatBox::take(Flat const& p) {
  for (std::size_t d = 0; d < 2; ++d) {
    low[d] = std::min(low[d], p[d]);
    high[d] = std::max(high[d], p[d]);
  }
}

FlatBox moving_walls(Section const& section) {
  FlatBox box;
  for (auto const& wall : section.walls)
    if (wall.moves) {
      box.take(wall.a);
      box.take(wall.b);
    }
  return box;
}

io::Picture section_picture(Section const& section, std::span<Colour const> colour, Window const& window, int width,
                            int height, std::span<Overlay const> overlays) {
  Canvas canvas(width, height);
  double const scale = 0.5 * width / window.half_width;
  auto const place = [&](Flat const& p) -> Place {
    return {0.5 * width + scale * (p[0] - window.centre[0]), 0.5 * height - scale * (p[1] - window.centre[1]), 0};
  };
  std::vector<Place> points;
  std::vector<std::pair<std::size_t, double>> lined;  // polygons with lines around them, and how opaque these are
  for (std::size_t p = 0; p < section.cell.size(); ++p) {
    points.clear();
    bool inside = false;
    Place low{1e30, 1e30, 0}, high{-1e30, -1e30, 0};
    for (std::size_t c = section.first[p]; c < section.first[p + 1]; ++c) {
      Place const q = points.emplace_back(place(section.corner[c]));
      low = {std::min(low.x, q.x), std::min(low.y, q.y), 0};
      high = {std::max(high.x, q.x), std::max(high.y, q.y), 0};
    }
    inside = high.x > 0 && low.x < width && high.y > 0 && low.y < height;
    if (!inside) continue;
    canvas.polygon(points, colour[p]);
    // Twice the area over the longest side: how far apart its lines are.
    double area = 0, longest = 0;
    for (std::size_t c = 0; c < points.size(); ++c) {
      Place const &a = points[c], &b = points[(c + 1) % points.size()];
      area += a.x * b.y - b.x * a.y;
      longest = std::max(longest, std::hypot(a.x - b.x, a.y - b.y));
    }
    double const apart = longest > 0 ? 0.5 * std::fabs(area) / longest : 0;
    lined.emplace_back(p, 0.16 + 0.4 * std::clamp((apart - 1.5) / 6, 0.0, 1.0));
  }
  for (auto const& [p, opacity] : lined) {
    std::size_t const begin = section.first[p], n = section.first[p + 1] - begin;
    for (std::size_t c = 0; c < n; ++c)
      canvas.line(place(section.corner[begin + c]), place(section.corner[begin + (c + 1) % n]),
                  {0x22, 0x2b, 0x36, opacity}, 0.5);
  }
  for (Overlay const& overlay : overlays)
    for (auto const& [a, b] : overlay.lines) canvas.line(place(a), place(b), overlay.colour, overlay.width);
  for (auto const& wall : section.walls)
    canvas.line(place(wall.a), place(wall.b), wall.moves ? Colour{0x1d, 0x5f, 0xd1, 1} : Colour{0x4a, 0x55, 0x63, 1},
                wall.moves ? 2 : 1);
  return canvas.picture();
}

}  // namespace gridmorph::page
