#include <gridmorph/fillet/wall_path.hpp>

#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

double falling(double t) { return 1 - smoothstep(t); }

/// A fillet with a radius far below the layers is a sharp corner to the lines above it.
double roundness(CornerStation const& station) {
  double const layers = std::min(station.line[0].taken(), station.line[1].taken());
  return std::min(1.0, 2 * station.ball().radius / layers);
}

/// How far a direction goes along the corner for one unit of length across.
double lean(Vec3 const& direction, Vec3 const& along) {
  double const part = dot(direction, along);
  return part / std::max(0.05, norm(direction - part * along));
}

}  // namespace

double WallLine::share(int node) const { return falling((curve.arc(std::size_t(node)) - taken()) / (reach - taken())); }

namespace {

/// Values between those of the balls around.
template <class Value>
Vec3 between(BallRow const& row, double station, Value const& value) {
  int const low = int(std::floor(station));
  double const share = station - low;
  Ball const *a = row.from(low, 0), *b = row.from(low, 1);
  if (a == nullptr) return value(row.balls.front());
  if (b == nullptr) return value(*a);
  return share == 0 ? value(*a) : (1 - share) * value(*a) + share * value(*b);
}

}  // namespace

Ball const* BallRow::from(int number, int steps) const {
  int const n = int(balls.size());
  int k = number + steps;
  if (closed) k = ((k % n) + n) % n;
  return k < 0 || k >= n ? nullptr : &balls[k];
}

Vec3 BallRow::point(double station, int wall, double share) const {
  return between(*this, station,
                 [&](Ball const& ball) { return ball.centre + ball.radius * ball.to_arc(wall, share); });
}

Vec3 BallRow::normal(double station, int wall, double share) const {
  return between(*this, station, [&](Ball const& ball) { return -ball.to_arc(wall, share); });
}

void CornerStation::find_edges() {
  edge = {};
  if (sharp()) return;
  edge[0] = {double(number), ball().blade_arc, {}, ball().half_arc()};
  // The line of the end wall crosses the curve of contacts where these change sides.
  ArcCurve const& own = line[1].curve;
  auto const side = [&](Ball const& of) {
    Vec3 const contact = of.contact(1);
    return dot(contact - own.at(nearest_arc(own, contact)), along);
  };
  double const here = side(ball());
  int const step = here < 0 ? 1 : -1;
  double station = number, before = here;
  for (int k = step; here != 0 && std::abs(k) < int(row->balls.size()); k += step) {
    Ball const* next = row->from(number, k);
    if (next == nullptr) break;
    double const now = side(*next);
    if (here * now <= 0) {
      station = number + k - step * now / (now - before);
      break;
    }
    if (std::abs(now) > std::abs(before)) break;  // away from it: the corner turns
    station = number + k;
    before = now;
  }
  FilletEdge& end = edge[1];
  end.station = station;
  Vec3 const contact = row->point(station, 1, 1);
  end.arc = nearest_arc(own, contact);
  end.beside = contact - own.at(end.arc);
  constexpr int pieces = 16;
  for (int n = 0; n < pieces; ++n) {
    auto const at = [&](double share) { return row->point(number + share * (station - number), 1, share); };
    end.way += distance(at(double(n) / pieces), at(double(n + 1) / pieces));
  }
}

Vec3 CornerStation::mitre() const { return unit(inner - line[0].curve.point(0)); }

Vec3 CornerStation::leaning(Vec3 const& normal, double share, Vec3 const& off_wall) const {
  Vec3 const across = normal - dot(normal, along) * along;
  return unit(unit(across) + (share * lean(mitre(), along) + (1 - share) * lean(off_wall, along)) * along);
}

WallPlace CornerStation::middle() const {
  if (sharp()) return {line[0].curve.point(0), mitre(), true};
  double const round = roundness(*this);
  return {ball().centre + ball().radius * ball().to_middle,
          unit((1 - round) * mitre() + round * leaning(-ball().to_middle, 1, mitre())), true};
}

WallPlace CornerStation::place(int wall, int node, Vec3 const& off_wall) const {
  auto const w = std::size_t(wall);
  WallLine const& own = line[w];
  double const g = own.share(node), s = own.curve.arc(std::size_t(node));
  if (g == 0) return {own.curve.point(std::size_t(node)), off_wall};
  Vec3 const between_walls = unit(g * mitre() + (1 - g) * off_wall);
  if (sharp()) return {own.curve.at(s - g * own.taken()), between_walls};

  FilletEdge const& end = edge[w];
  double const shorter = end.arc - end.way;
  double const way = std::max(0.0, (s - shorter) - g * (own.taken() - shorter));
  Vec3 point, normal;
  if (way <= end.way) {
    double const share = way / end.way, at = number + share * (end.station - number);
    point = row->point(at, wall, share);
    normal = row->normal(at, wall, share);
  } else {
    double const on_line = way + shorter;
    double const beside = falling((on_line - end.arc) / (own.reach - end.arc));
    point = own.curve.at(on_line);
    kernels::FacetFoot const foot = surface[w]->closest_point(point + beside * end.beside);
    if (norm(end.beside) > 1e-12 * ball().radius) point = foot.point;
    normal = dot(foot.normal, into_mesh[w]) < 0 ? -foot.normal : foot.normal;
  }
  double const round = roundness(*this);
  return {point, unit(round * leaning(normal, g, off_wall) + (1 - round) * between_walls), way <= end.way};
}

}  // namespace gridmorph
