#include <gridmorph/fillet/corner_lines.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph {

std::vector<char> filled_stations(Mesh const& mesh, CornerFrame const& corner, FilletOptions const& options) {
  auto const on = [&](std::vector<int> const& patches, Index3 const& p) {
    return std::any_of(patches.begin(), patches.end(), [&](int n) {
      return mesh.patches[n].zone == corner.zone_number() && mesh.patches[n].range.contains(p);
    });
  };
  std::vector<char> out;
  for (int a = 0; a < corner.stations(); ++a)
    out.push_back(on(options.blade, corner.index(a, {0, 1})) && on(options.blade, corner.index(a, {0, 0})) &&
                  on(options.end_wall, corner.index(a, {1, 0})));
  return out;
}

std::vector<Vec3> line_points(Mesh const& mesh, CornerFrame const& corner, int station, int wall, int last) {
  std::vector<Vec3> out;
  for (int n = 0; n <= last; ++n)
    out.push_back(node_at(mesh, corner, station, wall == 0 ? std::array<int, 2>{0, n} : std::array<int, 2>{n, 0}));
  return out;
}

ArcCurve curve_through(std::vector<Vec3> points) {
  for (std::size_t n = 1; n < points.size(); ++n)
    if (points[n] == points[n - 1])
      throw MeshError("a grid line along the walls of the corner has two nodes at " + to_text(points[n], 9) +
                      ": a pole, around which layers cannot be laid; fill corners of zones without one");
  return ArcCurve(std::move(points));
}

Vec3 wall_normal(Mesh const& mesh, CornerFrame const& corner, int station, int wall) {
  int const before = std::max(0, station - 1), behind = std::min(corner.stations() - 1, station + 1);
  Vec3 const along = node_at(mesh, corner, behind, {0, 0}) - node_at(mesh, corner, before, {0, 0});
  std::array<int, 2> next{0, 0};
  next[1 - wall] = 1;
  return unit(cross(along, node_at(mesh, corner, station, next) - node_at(mesh, corner, station, {0, 0})));
}

int last_node(WallSheets const& sheets, CornerFrame const& corner, int wall) {
  Sheet const& across = *corner.sheet[1 - wall];  // its layers are what the line runs through
  int const cells = corner.cells(1 - wall);
  auto const& own = sheets.of_zone[corner.zone_number()];
  bool const opposite = std::any_of(own.begin(), own.end(), [&](int n) {
    return sheets.all[n].axis == across.axis && sheets.all[n].side != across.side;
  });
  return opposite ? cells / 2 : cells;
}

double checked_radius(FilletOptions const& options, Vec3 const& node) {
  double const radius = options.radius(node);
  if (!(radius >= 0) || !std::isfinite(radius))
    throw MotionError("the radius of the fillet at " + to_text(node, 9) + " is " + to_text(radius, 6) +
                      "; give a length, 0 where the corner stays sharp");
  return radius;
}

}  // namespace gridmorph
