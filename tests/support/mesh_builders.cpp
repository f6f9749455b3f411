#include "support/mesh_builders.hpp"

#include "support/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

struct Frame {
  Vec3 x, y, z;  ///< x along the axis
};

Frame frame_of(Vec3 const& axis) {
  Vec3 const x = (1 / norm(axis)) * axis;
  Vec3 y = std::abs(x.x) < 0.6 ? cross(x, {1, 0, 0}) : cross(x, {0, 1, 0});
  y = (1 / norm(y)) * y;
  return {x, y, cross(x, y)};
}

Vec3 curved(Vec3 const& q) {
  return {2 * q.x + 0.3 * q.y + 0.1 * std::sin(2 * q.y), q.y + 0.2 * q.x * q.x + 0.1 * q.z,
          1.2 * q.z + 0.15 * q.x + 0.1 * q.y * q.z};
}

/// Ranges [first, last] of node planes, as a box.
IndexRange planes(int i0, int i1, int j0, int j1, int k0, int k1) { return {{i0, j0, k0}, {i1 + 1, j1 + 1, k1 + 1}}; }

}  // namespace

Distortion::Distortion(unsigned seed, double amplitude) : amplitude_(amplitude) {
  Random random(seed);
  for (double& p : phase_) p = two_pi * random.unit();
}

Vec3 Distortion::operator()(Vec3 const& q) const {
  double const c[3] = {q.x, q.y, q.z};
  double out[3];
  for (int a = 0; a < 3; ++a) {
    double const b = c[(a + 1) % 3], d = c[(a + 2) % 3];
    double const wave = std::cos(two_pi * b + phase_[3 * a]) * std::cos(two_pi * d + phase_[3 * a + 1]);
    out[a] = c[a] + amplitude_ / two_pi * std::sin(two_pi * c[a]) * (0.5 * wave + 0.5 * std::cos(phase_[3 * a + 2]));
  }
  return {out[0], out[1], out[2]};
}

Mesh box(Index3 extent, Shape shape, unsigned seed) {
  Bricks b;
  b.name = "box";
  b.extent = extent;
  if (shape == Shape::straight)
    b.position = [](Vec3 const& q) { return Vec3{2 * q.x, q.y, 1.2 * q.z}; };
  else
    b.position = [d = Distortion(seed)](Vec3 const& q) { return curved(d(q)); };
  return make(b);
}

Mesh bricks_with_t_junctions(unsigned seed) {
  Bricks b;
  b.name = "bricks";
  b.extent = {9, 10, 6};
  b.zones = {planes(0, 3, 0, 5, 0, 5), planes(3, 8, 0, 2, 0, 5), planes(3, 8, 2, 5, 0, 5), planes(0, 5, 5, 9, 0, 5),
             planes(5, 8, 5, 9, 0, 5)};
  b.position = [d = Distortion(seed)](Vec3 const& q) { return curved(d(q)); };
  return make(b);
}

Mesh l_shape(unsigned seed) {
  Bricks b;
  b.name = "L";
  b.extent = {8, 7, 5};
  b.zones = {planes(0, 3, 0, 3, 0, 4), planes(3, 7, 0, 3, 0, 4), planes(0, 3, 3, 6, 0, 4)};
  b.position = [d = Distortion(seed)](Vec3 const& q) { return curved(d(q)); };
  return make(b);
}

Mesh around_a_box(unsigned seed) {
  Bricks b;
  b.name = "around";
  b.extent = {12, 11, 4};
  int const i[4] = {0, 4, 7, 11}, j[4] = {0, 3, 7, 10};
  for (int q = 0; q < 3; ++q)
    for (int p = 0; p < 3; ++p)
      if (p != 1 || q != 1) b.zones.push_back(planes(i[p], i[p + 1], j[q], j[q + 1], 0, 3));
  b.position = [d = Distortion(seed)](Vec3 const& q) { return curved(d(q)); };
  b.kind = {PatchKind::inflow,   PatchKind::outflow,  PatchKind::farfield,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::symmetry};
  return make(b);
}

Vec3 sector_position(Sector const& sector, double axial, double radius, double theta) {
  Frame const f = frame_of(sector.axis);
  return sector.origin + axial * f.x + (radius * std::cos(theta)) * f.y + (radius * std::sin(theta)) * f.z;
}

Vec3 sector_coordinates(Sector const& sector, Vec3 const& p) {
  Frame const f = frame_of(sector.axis);
  Vec3 const d = p - sector.origin;
  double const y = dot(d, f.y), z = dot(d, f.z);
  return {dot(d, f.x), std::hypot(y, z), std::atan2(z, y)};
}

Mesh annulus_sector(Sector const& sector, unsigned seed) {
  Bricks b;
  b.name = "sector";
  b.extent = {7, 6, 5};
  double const pitch = two_pi / sector.copies;
  b.position = [=, d = Distortion(seed)](Vec3 const& uvw) {
    Vec3 q = d(uvw);
    // Nodes that meet on the axis have one axial position.
    if (sector.inner_radius == 0) q.x = uvw.x + q.y * (q.x - uvw.x);
    double const inner = sector.inner_radius * (1 + 0.05 * q.x);
    double const radius = inner + (2 + 0.1 * q.x * q.x - inner) * q.y;
    return sector_position(sector, 1.5 * q.x, radius, pitch * q.z + 0.2 * q.x);
  };
  double angle = -pitch;
  if (sector.single_precision_angle) angle = float(angle);
  b.ends[2] = {Ends::Kind::periodic, rotation(sector.origin, (1 / norm(sector.axis)) * sector.axis, angle)};
  b.family = {"inlet", "outlet", sector.inner_radius > 0 ? "hub" : "pole", "case", "", ""};
  b.kind = {PatchKind::inflow, PatchKind::outflow, sector.inner_radius > 0 ? PatchKind::wall : PatchKind::degenerate,
            PatchKind::wall,   PatchKind::other,   PatchKind::other};
  return make(b);
}

Mesh bend_sector(Sector const& sector, unsigned seed) {
  Bricks b;
  b.name = "bend";
  b.extent = {9, 6, 5};
  double const pitch = two_pi / sector.copies;
  b.position = [=, d = Distortion(seed)](Vec3 const& uvw) {
    Vec3 const q = d(uvw);
    double const bend = 1.2 - 0.5 * q.y, phi = 0.25 * two_pi * q.x;
    return sector_position(sector, bend * std::sin(phi), 1.8 - bend * std::cos(phi), pitch * q.z + 0.2 * q.x);
  };
  double angle = -pitch;
  if (sector.single_precision_angle) angle = float(angle);
  b.ends[2] = {Ends::Kind::periodic, rotation(sector.origin, (1 / norm(sector.axis)) * sector.axis, angle)};
  b.family = {"inlet", "outlet", "hub", "case", "", ""};
  b.kind = {PatchKind::inflow, PatchKind::outflow, PatchKind::wall,
            PatchKind::wall,   PatchKind::other,   PatchKind::other};
  return make(b);
}

Mesh o_grid(double inner_radius, unsigned seed) {
  Bricks b;
  b.name = "O";
  b.extent = {13, 6, 4};
  b.position = [=, d = Distortion(seed)](Vec3 const& uvw) {
    Vec3 q = d(uvw);
    if (inner_radius == 0) q.z = uvw.z + q.y * (q.z - uvw.z);  // nodes that meet on the pole have one position
    double const r = inner_radius + (2 - inner_radius) * q.y;
    return Vec3{r * std::cos(two_pi * q.x) + 0.2 * q.z, 0.8 * r * std::sin(two_pi * q.x), q.z};
  };
  b.ends[0].kind = Ends::Kind::closed;
  b.family = {"", "", inner_radius > 0 ? "body" : "pole", "far", "w_min", "w_max"};
  b.kind = {PatchKind::other,    PatchKind::other,    inner_radius > 0 ? PatchKind::wall : PatchKind::degenerate,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::symmetry};
  return make(b);
}

Mesh c_grid(unsigned seed) {
  // z = w^2 folds the half plane Im w >= 0 about the wake Re z > 0; the body is a bump on the fold.
  Index3 const n{17, 6, 4};
  int const wake = 4;
  double const edge = 1.0, length = 2.0;
  auto const position = [=, d = Distortion(seed, 0.25)](Index3 const& p) {
    Vec3 const q = d({p[0] / (n[0] - 1.0), p[1] / (n[1] - 1.0), p[2] / (n[2] - 1.0)});
    // The wall and the wake are not distorted along i, so that both sides of the wake coincide.
    double const s0 = p[0] / (n[0] - 1.0), blend = q.y * q.y;
    double const s = length * (2 * ((1 - blend) * s0 + blend * q.x) - 1);
    double const inside = std::max(0.0, 1 - s * s / (edge * edge));
    double const t = 1.2 * q.y + 0.15 * inside * inside * (1 - q.y);
    double const z = p[1] == 0 ? p[2] / (n[2] - 1.0) : q.z;
    return Vec3{s * s - t * t, 2 * s * t + 0.05 * z, z};
  };
  MeshBuilder b("C");
  int const zone = b.zone("C", n, position);
  IndexRange const first{{0, 0, 0}, {wake + 1, 1, n[2]}}, second{{n[0] - 1 - wake, 0, 0}, {n[0], 1, n[2]}};
  b.join(zone, first, zone, second, {{0, 1, 2}, {-1, 1, 1}});
  b.patch("body", PatchKind::wall, zone, {{wake, 0, 0}, {n[0] - wake, 1, n[2]}});
  b.patch("far", PatchKind::farfield, zone, 1, 1);
  b.patch("exit", PatchKind::outflow, zone, 0, 0);
  b.patch("exit", PatchKind::outflow, zone, 0, 1);
  b.patch("front", PatchKind::symmetry, zone, 2, 0);
  b.patch("back", PatchKind::symmetry, zone, 2, 1);
  return b.finish();
}

namespace {

/// Quarter number q of a star with n points: from the inner edge (u = v = 0) to the rim, faces u = 0 and v = 0 radial.
std::function<Vec3(Index3 const&)> star_zone(int n, int q, unsigned seed, bool leaning) {
  auto const at = [n](double turn, double r) {
    return Vec3{r * std::cos(two_pi * turn / n), r * std::sin(two_pi * turn / n), 0};
  };
  return [=, distort = Distortion(seed, 0.2)](Index3 const& p) {
    Vec3 const uvw = distort({p[0] / 4.0, p[1] / 4.0, p[2] / 3.0});
    // The two inner faces stay undistorted: their neighbour's parameters are others.
    double const w = p[0] == 0 || p[1] == 0 ? p[2] / 3.0 : uvw.z;
    double const u = p[1] == 0 ? p[0] / 4.0 : uvw.x, v = p[0] == 0 ? p[1] / 4.0 : uvw.y;
    Vec3 const flat = u * (1 - v) * at(q, 1.0) + u * v * at(q + 0.5, 1.3) + (1 - u) * v * at((q + 1) % n, 1.0);
    return leaning ? Vec3{flat.x + 0.1 * w, flat.y + 0.05 * w * w, w} : Vec3{flat.x, flat.y, w};
  };
}

constexpr Index3 star_extent{5, 5, 4};

void star_patches(MeshBuilder& b, int zone) {
  b.patch("rim", PatchKind::wall, zone, 0, 1);
  b.patch("rim", PatchKind::wall, zone, 1, 1);
  b.patch("front", PatchKind::farfield, zone, 2, 0);
  b.patch("back", PatchKind::farfield, zone, 2, 1);
}

}  // namespace

Mesh star(int n, unsigned seed) {
  MeshBuilder b("star" + std::to_string(n));
  for (int q = 0; q < n; ++q)
    star_patches(b, b.zone("star" + std::to_string(q + 1), star_extent, star_zone(n, q, seed, true)));
  // The v axis of each zone is the u axis of the next one.
  IndexRange const all{{0, 0, 0}, star_extent};
  for (int q = 0; q < n; ++q) b.join(q, face_of(all, 0, 0), (q + 1) % n, face_of(all, 1, 0), {{1, 0, 2}, {1, 1, 1}});
  return b.finish();
}

Mesh star_sector(int n, unsigned seed) {
  MeshBuilder b("star_sector" + std::to_string(n));
  star_patches(b, b.zone("sector", star_extent, star_zone(n, 0, seed, false)));
  IndexRange const all{{0, 0, 0}, star_extent};
  b.join(0, face_of(all, 0, 0), 0, face_of(all, 1, 0), {{1, 0, 2}, {1, 1, 1}}, rotation({}, {0, 0, 1}, -two_pi / n));
  return b.finish();
}

Mesh translational(int directions, unsigned seed) {
  Bricks b;
  b.name = "translational";
  b.extent = {7, 6, 5};
  Vec3 const along_v{0.1, 1, 0.05}, along_w{0, 0.2, 1.2};
  b.position = [=, d = Distortion(seed)](Vec3 const& uvw) {
    Vec3 const q = d(uvw);
    double const wave = std::sin(two_pi * (q.y + q.z));
    return 2 * q.x * Vec3{1, 0.1, 0} + q.y * along_v + q.z * along_w + 0.05 * wave * Vec3{1, 1, -1};
  };
  b.ends[2] = {Ends::Kind::periodic, periodic_translation(-along_w)};
  if (directions == 2) b.ends[1] = {Ends::Kind::periodic, periodic_translation(-along_v)};
  b.family = {"bottom", "top", directions == 2 ? "" : "side", directions == 2 ? "" : "side", "", ""};
  return make(b);
}

}  // namespace gridmorph::test
