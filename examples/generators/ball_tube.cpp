#include <generators/ball_tube.hpp>

#include <cmath>
#include <numbers>

namespace gridmorph::demo {

namespace {

/// Cubic with these values and slopes at t = 0 and t = 1.
double hermite(double t, double from, double slope_from, double to, double slope_to) {
  double const s = 1 - t;
  return s * s * (1 + 2 * t) * from + s * s * t * slope_from + t * t * (3 - 2 * t) * to - t * t * s * slope_to;
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// n cells over [-1, 1] that look equally large from the origin, seen at a distance of 1.
double tangent(double fraction) { return std::tan(0.25 * std::numbers::pi * fraction); }

}  // namespace

BallTube::BallTube(BallOptions const& options, BallCounts const& counts) : counts_(counts) {
  constexpr double a = tube_half_width;
  for (int i = 0; i <= counts.side; ++i) across_.push_back(a * tangent(2.0 * i / counts.side - 1));
  across_.front() = -a;
  across_.back() = a;
  for (int j = 0; j <= counts.lower; ++j) along_.push_back(a * tangent(double(j) / counts.lower - 1));
  along_.front() = -a;
  make_rings(options);
}

// Above the equator the columns begin upright to the ball, turn over where it meets the rope, and are level along the
// rope. On the tube's side the lines run ahead of the wall along the ball, and the wall catches up along the rope. The
// constants are those that keep the angles of the tube's cells largest, from short thick ropes to long thin ones.
void BallTube::make_rings(BallOptions const& options) {
  constexpr double a = tube_half_width, lift = 0.57, neck_slope = 1.1, end_slope = 0.78;
  double const r = options.rope_radius, arc = upper_arc(options), neck = std::sqrt(1 - r * r);
  double const end = 1 + options.rope_length, length = end - neck;
  double const turn = std::max(0.15, 2.6 * counts_.layers.total());  // keeps columns apart through the layers
  double const neck_outside = neck + lift * (a - r);
  auto const on_rope = counts_.rings_on_rope.nodes(0, length, counts_.rope);
  for (int j = 1; j <= counts_.upper + counts_.rope; ++j) {
    bool const ball = j <= counts_.upper;
    double const way = ball ? arc * j / counts_.upper : arc + on_rope[j - counts_.upper];
    double const turned = smooth_step((way - arc + turn) / (2 * turn));
    Ring ring;
    ring.elevation = (1 - turned) * std::min(way, arc);
    ring.r = j < counts_.upper ? std::cos(way) : r;
    ring.z = j < counts_.upper ? std::sin(way) : j == counts_.upper ? neck : neck + (way - arc);
    double outside = ball ? hermite(way / arc, 0, a * arc, neck_outside, neck_slope * arc)
                          : hermite((way - arc) / length, neck_outside, neck_slope * length, end, end_slope * length);
    if (j == counts_.upper + counts_.rope) {
      ring.z = outside = end;
      ring.elevation = 0;
    }
    upper_.push_back(ring);
    along_.push_back(outside);
  }
}

BallTube::Corner BallTube::corner(int at) const {
  int const m = counts_.side, k = at % m;
  switch (at / m % 4) {
    case 0: return {m, k};
    case 1: return {m - k, m};
    case 2: return {0, m - k};
    default: return {k, 0};
  }
}

Index32 BallTube::ring_column(int ring, int at) const {
  int const m = counts_.side;
  if (ring == 0) return cap_column(corner(at).x, corner(at).y);
  return Index32(m + 1) * (m + 1) + Index32(ring - 1) * 4 * m + at % (4 * m);
}

WallShell BallTube::shell(BallPatches const& patches, LayerElements elements,
                          std::function<Index32(int, int, int)> const& outer) const {
  int const m = counts_.side, rings = counts_.rings();
  bool const ball_hexahedra = elements == LayerElements::hexahedra, rope_hexahedra = elements != LayerElements::prisms;
  WallShell shell;
  shell.layers = counts_.layers.n;
  shell.cells = counts_.layers.n + counts_.tetrahedral;
  shell.closed = false;
  double const way = tube_half_width - 1, face = 0.5 * std::numbers::pi / m;
  shell.aligned = first_tall_cell(counts_.layers, column_heights(counts_.layers, counts_.tetrahedral, way), way, face);
  for (int iy = 0; iy <= m; ++iy)
    for (int ix = 0; ix <= m; ++ix) {
      shell.outer.push_back(outer(ix, iy, 0));
      if (ix == m || iy == m) continue;
      shell.quads.push_back(
          {{cap_column(ix, iy), cap_column(ix, iy + 1), cap_column(ix + 1, iy + 1), cap_column(ix + 1, iy)},
           patches.ball,
           ball_hexahedra});
    }
  for (int ring = 0; ring < rings; ++ring) {
    bool const ball = ring < counts_.lower + counts_.upper;
    for (int at = 0; at < 4 * m; ++at) {
      shell.outer.push_back(outer(corner(at).x, corner(at).y, ring + 1));
      shell.quads.push_back(
          {{ring_column(ring, at), ring_column(ring, at + 1), ring_column(ring + 1, at + 1), ring_column(ring + 1, at)},
           ball ? patches.ball : patches.rope,
           ball ? ball_hexahedra : rope_hexahedra});
    }
  }
  for (int at = 0; at < 4 * m; ++at)
    shell.rims.push_back({ring_column(rings, at), ring_column(rings, at + 1), patches.crane});
  shell.n_columns = Index32(shell.outer.size());
  return shell;
}

void BallTube::append_straight(Vec3 const& end, std::vector<Vec3>& nodes) const {
  double const radius = norm(end);
  auto const heights = column_heights(counts_.layers, counts_.tetrahedral, radius - 1);
  for (std::size_t l = 0; l + 1 < heights.size(); ++l) nodes.push_back((1 + (radius - 1) * heights[l]) / radius * end);
}

// Beyond the layers a straight line to the tube's side, bent so that it arrives there more level by a share `bend`.
void BallTube::append_curved(Ring const& ring, Vec3 const& end, std::vector<Vec3>& nodes) const {
  constexpr double bend = 0.4;
  double const far_r = std::hypot(end.x, end.y), cosine = end.x / far_r, sine = end.y / far_r;
  double const up_r = std::cos(ring.elevation), up_z = std::sin(ring.elevation), thick = counts_.layers.total();
  double const from_r = ring.r + thick * up_r, from_z = ring.z + thick * up_z;
  double const way_r = far_r - from_r, way_z = end.z - from_z, way = std::hypot(way_r, way_z);
  auto const heights = column_heights(counts_.layers, counts_.tetrahedral, thick + way);
  for (int l = 0; l < int(heights.size()) - 1; ++l) {
    double r = ring.r + counts_.layers.at(l) * up_r, z = ring.z + counts_.layers.at(l) * up_z;
    if (l > counts_.layers.n) {
      double const t = (heights[l] * (thick + way) - thick) / way, bent = bend * t * t * (1 - t);
      r = from_r + t * way_r - bent * (way - way_r);
      z = from_z + t * way_z + bent * way_z;
    }
    nodes.push_back({r * cosine, r * sine, z});
  }
}

std::vector<Vec3> BallTube::nodes() const {
  int const m = counts_.side;
  std::vector<Vec3> nodes;
  auto const side = [&](int i) { return across_[i]; };
  for (int iy = 0; iy <= m; ++iy)
    for (int ix = 0; ix <= m; ++ix) append_straight({side(ix), side(iy), along_.front()}, nodes);
  for (int ring = 1; ring <= counts_.rings(); ++ring)
    for (int at = 0; at < 4 * m; ++at) {
      Vec3 const end{side(corner(at).x), side(corner(at).y), along_[ring]};
      if (ring <= counts_.lower)
        append_straight(end, nodes);
      else
        append_curved(upper_[ring - counts_.lower - 1], end, nodes);
    }
  return nodes;
}

}  // namespace gridmorph::demo
