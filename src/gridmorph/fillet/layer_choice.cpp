#include <gridmorph/core/error.hpp>
#include <gridmorph/fillet/corner_lines.hpp>
#include <gridmorph/fillet/corner_stations.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace gridmorph {

namespace {

// Of the radius, that the layers off the blade and off the end wall should be high. Measured on a stage of leaning H
// meshes and an O4H passage (docs/root_fillet.md): fewer layers off the blade invert cells where lines lean by 80
// degrees.
constexpr std::array<double, 2> room{1.0, 0.6};
// Cells between the corner and the end of a line, for the rest of the arc: a sixth of it. With three of 53 off the
// blade of a passage the smallest determinant is .25, with eight .53 (docs/root_fillet.md).
int least_left(int cells) { return std::max(1, cells / 6); }
constexpr double flattest = 5;  // how much wider than high the layers in the corner may be, and the other way round

/// The most layers off a wall that there is room for, counted along the line of the other one.
int most_layers(WallSheets const& sheets, std::vector<CornerFrame> const& corners, int wall, int asked) {
  int most = std::numeric_limits<int>::max();
  CornerFrame const* thinnest = nullptr;
  for (auto const& corner : corners)
    if (int const cells = last_node(sheets, corner, 1 - wall), there = cells - least_left(cells); there < most) {
      most = there;
      thinnest = &corner;
    }
  if (most >= std::max(1, asked)) return most;
  throw MeshError("zone '" + thinnest->zone->name + "' has " + std::to_string(thinnest->cells(wall)) +
                  " cells off the " + (wall == 0 ? "blade" : "end wall") + ", room for " +
                  std::to_string(std::max(0, most)) + " layers in the corner" +
                  (asked > 0 ? "; " + std::to_string(asked) + " are asked for" : std::string()) + "; give fewer");
}

/// How many layers are as high as the room for the mean radius.
int layers_for_radius(Mesh const& mesh, std::vector<CornerFrame> const& corners, int wall, int most,
                      FilletOptions const& options) {
  std::vector<double> height(std::size_t(most) + 1, 0.0);
  double radius = 0;
  bool any = false;
  for (auto const& corner : corners) {
    auto const filled = filled_stations(mesh, corner, options);
    for (int a = 0; a < corner.stations(); ++a) {
      if (!filled[a]) continue;
      auto const points = line_points(mesh, corner, a, 1 - wall, most);
      Vec3 const normal = wall_normal(mesh, corner, a, wall);
      for (std::size_t n = 1; n < points.size(); ++n) height[n] += std::abs(dot(points[n] - points[0], normal));
      radius += checked_radius(options, points[0]);
      any = true;
    }
  }
  if (!any) throw MeshError("no node of the corner is on both the blade and the end wall");
  int n = 1;
  while (n < most && height[n] < room[wall] * radius) ++n;
  return n;
}

/// Where the corner stays sharp, layers that are much wider off one wall than off the other would meet in a mitre too
/// flat for cells: those of the other wall become more.
void even_out(Mesh const& mesh, std::vector<CornerFrame> const& corners, FilletOptions const& options,
              std::array<int, 2> const& most, std::array<int, 2>& layers) {
  for (auto const& corner : corners) {
    auto const filled = filled_stations(mesh, corner, options);
    for (int a = 0; a < corner.stations(); ++a) {
      if (filled[a]) continue;
      auto const width = [&](int wall) {
        std::array<int, 2> off{0, 0};
        off[wall] = layers[wall];
        return distance(node_at(mesh, corner, a, off), node_at(mesh, corner, a, {0, 0}));
      };
      for (int wall = 0; wall < 2; ++wall)
        while (options.layers[wall] == 0 && layers[wall] < most[wall] && width(1 - wall) > flattest * width(wall))
          ++layers[wall];
    }
  }
}

/// The wall with fewer layers gets more cells in them: they have to be high enough for first cells as they were. Where
/// that would make the corner much higher off one wall than off the other, layers stay as they are and first cells
/// become smaller.
void make_room(Mesh const& mesh, std::vector<CornerFrame> const& corners, FilletOptions const& options,
               std::array<int, 2> const& most, std::array<int, 2>& layers) {
  constexpr double spare = 1.1, highest = 2;
  std::size_t const fewer = layers[0] < layers[1] ? 0 : 1;
  int const made = layers[1 - fewer];
  if (options.layers[fewer] > 0) return;
  int enough = layers[fewer];
  bool fits = true;
  for (auto const& corner : corners)
    for (int a = 0; a < corner.stations(); ++a) {
      auto const points = line_points(mesh, corner, a, 1 - int(fewer), most[fewer]);
      auto const other = line_points(mesh, corner, a, int(fewer), made);
      double const first = distance(points[0], points[1]);
      auto const height = [&] { return distance(points[0], points[enough]); };
      while (enough < std::min(made, most[fewer]) && height() < spare * made * first) ++enough;
      fits = fits && (enough == layers[fewer] || height() <= highest * distance(other.front(), other.back()));
    }
  if (fits) layers[fewer] = enough;
}

}  // namespace

SheetLayers choose_layers(Mesh const& mesh, WallSheets const& sheets, FilletOptions const& options) {
  auto const corners = corners_of(mesh, sheets);
  SheetLayers out;
  std::array<int, 2> most{};
  for (int wall = 0; wall < 2; ++wall) {
    auto const w = std::size_t(wall);
    most[w] = most_layers(sheets, corners, wall, options.layers[w]);
    out.old[w] = options.layers[w] > 0 ? options.layers[w] : layers_for_radius(mesh, corners, wall, most[w], options);
  }
  even_out(mesh, corners, options, most, out.old);
  make_room(mesh, corners, options, most, out.old);
  out.made = std::max(out.old[0], out.old[1]);
  return out;
}

}  // namespace gridmorph
