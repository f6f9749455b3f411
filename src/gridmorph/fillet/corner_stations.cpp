#include <gridmorph/fillet/corner_stations.hpp>

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/fillet/corner_lines.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

constexpr double furthest = 0.9;  // of the reach, at which a contact may lie
constexpr double reach_radii = 3, reach_layers = 4,
                 reach_across = 2;  // of edges, layers, and layers off the other wall

/// The direction of a row at a station, from the one before to that behind it.
Vec3 along_row(std::vector<Vec3> const& nodes, int number, bool closed) {
  int const n = int(nodes.size());
  int const before = closed ? (number + n - 1) % n : std::max(0, number - 1);
  int const behind = closed ? (number + 1) % n : std::min(n - 1, number + 1);
  return unit(nodes[behind] - nodes[before]);
}

/// Where a fillet has to end although its corner goes on: at stations beside one that is on no wall.
struct OpenEnds {
  int count = 0;
  std::vector<std::vector<double>>
      away;  ///< per row and place: along the row from the nearest of them; infinite where it has none
};

OpenEnds open_ends(std::vector<CornerFrame> const& corners, CornerRows const& rows,
                   std::vector<std::vector<char>> const& filled, std::vector<std::vector<Vec3>> const& nodes) {
  OpenEnds out;
  for (std::size_t r = 0; r < rows.rows().size(); ++r) {
    CornerRow const& row = rows.rows()[r];
    // A place that two zones share may be on the walls in one of them alone.
    std::vector<char> bare(row.places.size(), 1), on_walls(row.places.size(), 1);
    for (std::size_t c = 0; c < corners.size(); ++c)
      for (int a = 0; a < corners[c].stations(); ++a) {
        if (&rows.rows()[rows.row_of(c)] != &row) continue;
        auto const n = std::size_t(rows.number({c, a}));
        (filled[c][a] ? bare : on_walls)[n] = 0;
      }
    std::size_t const n = row.places.size();
    std::vector<double> away(n, std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < n; ++k) {
      if (bare[k]) continue;
      bool const first = k == 0 && !row.closed, last = k + 1 == n && !row.closed;
      if (on_walls[k] && (first || !bare[(k + n - 1) % n]) && (last || !bare[(k + 1) % n])) continue;
      away[k] = 0;
      ++out.count;
    }
    std::size_t const steps = row.closed ? n : n - 1;
    auto const relax = [&](std::size_t to, std::size_t from) {
      away[to] = std::min(away[to], away[from] + distance(nodes[r][from], nodes[r][to]));
    };
    for (int round = 0; round < 2; ++round) {  // twice around what is closed
      for (std::size_t k = 0; k < steps; ++k) relax((k + 1) % n, k);
      for (std::size_t k = steps; k-- > 0;) relax(k, (k + 1) % n);
    }
    out.away.push_back(std::move(away));
  }
  return out;
}

}  // namespace

CornerStations::CornerStations(Mesh const& mesh, Links const& links, WallSheets const& sheets,
                               SheetLayers const& layers, FilletOptions const& options)
    : corners_(corners_of(mesh, sheets)) {
  Boundary const boundary(mesh);
  blade_ = FacetSurface::from_facets(boundary.facets(options.blade));
  end_wall_ = FacetSurface::from_facets(boundary.facets(options.end_wall));

  std::vector<std::vector<char>> filled;
  for (auto const& corner : corners_) filled.push_back(filled_stations(mesh, corner, options));
  CornerRows const rows(corners_, links);
  double fits = std::numeric_limits<double>::max();  // share of the radius
  Vec3 where;
  auto const at_most = [&](double share, Vec3 const& p) {
    if (share < fits) where = p;
    fits = std::min(fits, share);
  };
  std::vector<std::vector<Vec3>> nodes;
  for (CornerRow const& row : rows.rows()) {
    rows_.push_back({std::vector<Ball>(row.places.size()), row.closed});
    nodes.emplace_back();
    for (CornerPlace const& place : row.places)
      nodes.back().push_back(node_at(mesh, corners_[place.corner], place.station, {0, 0}));
  }
  OpenEnds const ends = open_ends(corners_, rows, filled, nodes);
  open_ends_ = ends.count;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    CornerFrame const& corner = corners_[c];
    auto const in_row = std::size_t(rows.row_of(c));
    stations_.emplace_back();
    for (int a = 0; a < corner.stations(); ++a) {
      int const number = rows.number({c, a});
      Vec3 const root = node_at(mesh, corner, a, {0, 0});
      auto const line = [&](int wall) {
        return curve_through(line_points(mesh, corner, a, wall, last_node(sheets, corner, wall)));
      };
      CornerStation station{.number = number,
                            .line = {WallLine{line(0), layers.old[1]}, WallLine{line(1), layers.old[0]}},
                            .surface = {&blade_, &end_wall_},
                            .into_mesh = {},
                            .inner = node_at(mesh, corner, a, layers.old),
                            .along = along_row(nodes[in_row], number, rows_[in_row].closed),
                            .row = &rows_[in_row],
                            .edge = {}};
      for (int wall = 0; wall < 2; ++wall)
        station.into_mesh[wall] =
            unit(node_at(mesh, corner, a, wall == 0 ? std::array<int, 2>{1, 0} : std::array<int, 2>{0, 1}) - root);
      double radius = filled[c][a] ? checked_radius(options, root) : 0;
      double const over = options.run_out * radius;
      if (over > 0) radius *= smoothstep(ends.away[in_row][number] / over);
      std::optional<Ball> ball;
      if (radius > 1e-9 * station.line[0].curve.length()) {
        ball = rolling_ball({station.surface, &station.line[0].curve, station.into_mesh}, radius);
        if (!ball) at_most(0.5, root);
      }
      if (!ball) {
        ball.emplace();
        ball->centre = root;
      }
      // A place that two zones share has a ball if it has one in either of them.
      if (Ball& there = rows_[in_row].balls[number]; there.radius == 0) there = *ball;
      stations_.back().push_back(std::move(station));
    }
  }
  for (auto& corner : stations_)
    for (CornerStation& station : corner) {
      Vec3 const root = station.line[0].curve.point(0);
      station.find_edges();
      for (std::size_t wall = 0; wall < 2; ++wall) {
        WallLine& own = station.line[wall];
        double const edge = station.edge[wall].arc;
        own.reach = std::min(
            std::max({reach_layers * own.taken(), reach_across * station.line[1 - wall].taken(), reach_radii * edge}),
            own.curve.length());
        if (edge > furthest * own.reach) at_most(furthest * own.reach / edge, root);
      }
      if (station.sharp()) continue;
      Ball const& ball = station.ball();
      Vec3 const middle = ball.centre + ball.radius * ball.to_middle;
      double const left = -dot(station.inner - middle, ball.to_middle), filled_depth = distance(root, middle);
      if (left < 0.1 * filled_depth) at_most(0.9 * (left + filled_depth) / filled_depth, root);
    }
  if (fits < 1)
    throw MotionError(
        "the fillet does not fit at the corner's node " + to_text(where, 9) + ": its radius is " +
        to_text(checked_radius(options, where), 6) + ", and about " +
        to_text(0.97 * fits * checked_radius(options, where), 3) +
        " would do with the blocks around the blade as thick as they are; give a smaller radius, or more layers");
}

void CornerStations::describe(FilletResult& result) const {
  result.open_ends = open_ends_;
  for (auto const& corner : stations_)
    for (CornerStation const& station : corner)
      if (!station.sharp()) result.add_station(station.ball().radius, station.ball().half_angle_rad);
}

}  // namespace gridmorph
