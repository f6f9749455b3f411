// The walls' motion by least squares, at the scale of the distance from them.
#include "support/made_bodies.hpp"
#include "support/plane_cascade.hpp"
#include "support/random.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/kernels/least_squares.hpp>
#include <gridmorph/plan/least_squares_field.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;

PlanOptions by_fit() {
  PlanOptions options;
  options.elements.method = NearFieldMethod::least_squares;
  return options;
}

constexpr double degrees = std::numbers::pi / 180;

Case section() { return Case(airfoil(96, 6, 0.004, 1.3, 5)); }
Motion by_places(std::string const& patch, std::function<Vec3(Vec3 const&)> const& moves) {
  return motion_of({rule_for({patch}, FunctionRule{"moves", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                                                     for (std::size_t n = 0; n < x.size(); ++n) u[n] = moves(x[n]);
                                                   }})});
}
/// The rear half up by a share of the chord.
std::function<Vec3(Vec3 const&)> bent(double by) {
  return [=](Vec3 const& x) {
    double const s = std::max(0.0, x.x - 0.5) / 0.5;
    return Vec3{0, by * s * s, 0};
  };
}
std::function<Vec3(Vec3 const&)> thicker(double by) {
  return [=](Vec3 const& x) { return Vec3{0, by * x.y, 0}; };
}

TEST(NearFit, WithoutMotionNothingChangesBitForBit) {
  Case const c = section();
  auto const m = c.morph(by_places("airfoil", bent(0)), by_fit());
  EXPECT_FALSE(m.prepared.plan.fit.empty());
  for (Index n = 0; n < m.x.size(); ++n) ASSERT_EQ(m.x[n], c.mesh.coordinates[n]) << n;
}

TEST(NearFit, PrescribedDisplacementsHoldExactlyAndElementsStayAsTheyAre) {
  Case const c = section();
  for (auto const& moves : {bent(0.2), bent(-0.3), thicker(0.7)}) {
    auto const m = c.morph(by_places("airfoil", moves), by_fit());
    EXPECT_EQ(c.largest_miss(m), 0);
    EXPECT_EQ(c.inverted(m.x), 0);
    EXPECT_FALSE(m.prepared.plan.background);
    EXPECT_TRUE(m.prepared.plan.walls.empty());
  }
}

/// A body that leans on the wall that it stands on.
Motion leaning() {
  return motion_of({rule_for({"body"}, FunctionRule{"leans",
                                                    [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                                      for (std::size_t n = 0; n < x.size(); ++n)
                                                        u[n] = {0.1 * x[n].z * x[n].z, 0, 0};
                                                    }}),
                    rule_for({"k_min"}, FixedRule{})});
}

TEST(NearFit, CarriesWallsThatEndOnBoundaries) {
  Case const c(
      box_around({8, 8, 6}, [](Vec3 const& p) { return p.x > 3 && p.x < 5 && p.y > 3 && p.y < 5 && p.z < 3; }));
  auto const m = c.morph(leaning(), by_fit());
  EXPECT_TRUE(m.prepared.plan.walls.empty());
  EXPECT_FALSE(m.prepared.plan.fit.empty());
  EXPECT_EQ(c.largest_miss(m), 0);
  EXPECT_EQ(c.inverted(m.x), 0);
  // Above the body nodes go along, and less the farther they are.
  auto const moved = [&](double z) {
    for (Index n = 0; n < m.x.size(); ++n)
      if (distance(c.mesh.coordinates[n], {4, 4, z}) < 1e-9) return m.x[n].x - 4;
    return 0.0;
  };
  EXPECT_GT(moved(4), 0.5 * 0.9);
  EXPECT_LT(moved(4), 0.9);
  EXPECT_LT(moved(5), moved(4));
}

/// Cambered blades that turn more the farther out they are, in a wheel around z.
Motion bent_blades() {
  return motion_of(
      {rule_for({"blade"}, FunctionRule{"bends with the radius",
                                        [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                          for (std::size_t n = 0; n < x.size(); ++n) {
                                            double const r = std::hypot(x[n].x, x[n].y);
                                            u[n] = rotation_about({}, {0, 0, 1}, 0.03 * r * r)(x[n]) - x[n];
                                          }
                                        }}),
       rule_for({"inlet", "outlet"}, FixedRule{})});
}

/// Bodies one behind the other, each between periodic sides.
Mesh row_of_bodies() {
  Mesh mesh = box_around({8, 8, 6}, [](Vec3 const& p) { return norm(p - Vec3{4, 4, 3}) < 2; });
  std::erase_if(mesh.patches, [](Patch const& p) { return p.name == "i_min" || p.name == "i_max"; });
  Connection sides;
  sides.name = "sides";
  sides.zone = sides.donor_zone = 0;
  sides.periodic = periodic_translation({8, 0, 0});
  for (Index32 n = 0; n < mesh.n_nodes(); ++n)
    for (Index32 m = 0; m < mesh.n_nodes() && mesh.coordinates.x(n) == 0; ++m)
      if (mesh.coordinates[m] == mesh.coordinates[n] + Vec3{8, 0, 0}) {
        sides.nodes.push_back(n);
        sides.donor_nodes.push_back(m);
      }
  mesh.connections.push_back(sides);
  return mesh;
}

TEST(NearFit, IsTakenByItselfWhereWallsAreFreeBodies) {
  auto const fits = [](Case const& c, Motion const& motion, PlanOptions const& options = {}) {
    auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion, options);
    EXPECT_EQ(prepared.plan.fit.empty(), !prepared.report.by_least_squares);
    return prepared.report.by_least_squares;
  };
  Case const c = section();
  EXPECT_TRUE(fits(c, by_places("airfoil", bent(0.1))));
  PlanOptions tube;
  tube.elements.tube = true;
  EXPECT_FALSE(fits(c, by_places("airfoil", bent(0.1)), tube));
  // Walls all around a mesh.
  EXPECT_FALSE(fits(Case(to_hexahedra(unit_box({6, 6, 6}))), by_places("*", [](Vec3 const& p) {
                      return Vec3{0, 0.01 * p.x * p.x, 0};
                    })));
  auto const stands = [](Vec3 const& p) { return p.x > 3 && p.x < 5 && p.y > 3 && p.y < 5 && p.z < 3; };
  EXPECT_FALSE(fits(Case(box_around({8, 8, 6}, stands)), leaning()));
  // Between periodic sides, unless other boundaries move too.
  Case const row(row_of_bodies());
  MotionRule const bends = rule_for({"body"}, rotation({4, 4, 3}, {0, 1, 0}, 0.1));
  EXPECT_TRUE(fits(row, motion_of({bends, rule_for({"j_*", "k_*"}, FixedRule{})})));
  EXPECT_FALSE(fits(row, motion_of({bends, rule_for({"j_*", "k_*"}, translation({0.1, 0, 0}))})));
}

/// The wall turns as a whole about an axis across the one that a body on a plane may turn about.
TEST(NearFit, FarNodesDoNotTurnWithWallsOnAPlane) {
  Case const c(box_around({24, 24, 16},
                          [](Vec3 const& p) { return std::abs(p.x - 12) < 2 && std::abs(p.y - 12) < 1 && p.z < 5; }));
  Motion motion = by_places("body", [](Vec3 const& p) { return Vec3{0, 0.02 * p.z * p.z, 0}; });
  motion.rules.push_back(rule_for({"k_min"}, SlipRule{}));
  auto const m = c.morph(motion);
  EXPECT_TRUE(m.prepared.report.by_least_squares);
  EXPECT_EQ(c.inverted(m.x), 0);
  double largest = 0;
  for (Index n = 0; n < m.x.size(); ++n) largest = std::max(largest, distance(m.x[n], c.mesh.coordinates[n]));
  EXPECT_LT(largest, 1.6 * 0.02 * 25);
}

TEST(NearFit, GoesByTheLatticeAmidABackgroundMeshOfTheUsers) {
  Case const c = section();
  PlanOptions options = by_fit();
  options.elements.background = std::make_shared<Background const>(
      *c.morph(by_places("airfoil", bent(0.05)), by_lattice()).prepared.plan.background);
  auto const m = c.morph(by_places("airfoil", bent(0.05)), options);
  EXPECT_FALSE(m.prepared.plan.walls.empty());
  EXPECT_TRUE(m.prepared.plan.fit.empty());
  EXPECT_TRUE(std::any_of(m.prepared.notes.begin(), m.prepared.notes.end(),
                          [](std::string const& n) { return n.find("in place of least squares") != n.npos; }));
}

TEST(NearFit, BladesComeAgainBehindPeriodicSides) {
  constexpr int blades = 11;
  Periodic const sides = turned_sides(2 * std::numbers::pi / blades);
  Case const c(plane_cascade(section_of_wheel(blades), sides));
  auto const m = c.morph(bent_blades(), by_fit());
  EXPECT_EQ(m.prepared.plan.fit.images.size(), 4u);
  EXPECT_EQ(c.largest_miss(m), 0);
  EXPECT_EQ(c.inverted(m.x), 0);
  RigidTransform const to = rotation_about({}, {0, 0, 1}, 2 * std::numbers::pi / blades);
  double moved = 0;
  for (auto const& connection : c.mesh.connections)
    for (std::size_t k = 0; k < connection.nodes.size(); ++k) {
      Vec3 const a = m.x[connection.nodes[k]], b = m.x[connection.donor_nodes[k]];
      ASSERT_LT(std::min(distance(to(a), b), distance(to(b), a)), 1e-12) << k;
      moved = std::max(moved, distance(a, c.mesh.coordinates[connection.nodes[k]]));
    }
  EXPECT_GT(moved, 0.01);
}

TEST(NearFit, PartsMoveByThemselves) {
  auto const parted = [](double x) { return x < 7 || x > 8; };
  Mesh const mesh = part_of(
      box_around({15, 7, 7},
                 [](Vec3 const& p) {
                   return std::fmod(p.x, 8) > 2 && std::fmod(p.x, 8) < 4 && p.y > 2 && p.y < 5 && p.z > 2 && p.z < 5;
                 }),
      [&](Vec3 const& p) { return parted(p.x); }, "side", PatchKind::inflow);
  Case const c(mesh);
  auto const bends = [&](double behind) {
    return by_places("body", [=](Vec3 const& p) {
      return Vec3{0, 0, (p.x < 7 ? 0.05 : behind) * (p.y - 2) * (p.y - 2)};
    });
  };
  auto const both = c.morph(bends(0.03), by_fit()), one = c.morph(bends(0), by_fit());
  EXPECT_EQ(c.largest_miss(both), 0);
  EXPECT_EQ(std::ssize(both.prepared.report.layer), c.mesh.n_nodes());
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const x = c.mesh.coordinates[n];
    ASSERT_EQ(one.x[n], x.x < 7.5 ? both.x[n] : x) << n;
  }
}

/// What a field makes of the motion of walls around a point at rest, at all its readers.
std::vector<Vec3> applied(LeastSquaresField const& field, Coordinates const& x, std::vector<Index32> const& walls,
                          std::vector<kernels::AffineMotion> const& frames) {
  using Host = Kokkos::HostSpace;
  auto const view = [](auto const& list) {
    using T = typename std::decay_t<decltype(list)>::value_type;
    return Kokkos::View<T const*, Host>(list.data(), list.size());
  };
  auto const table = [&](InterpolationOperator const& rows) {
    return kernels::InterpolationTable<Host>{view(rows.target), view(rows.first), view(rows.item), view(rows.weight)};
  };
  std::vector<kernels::WallImage> images;
  for (RigidTransform const& image : field.images) images.push_back({image.rotation, image.translation});
  std::vector<kernels::MotionMoments> moment(walls.size() * (1 + images.size())), group(std::size_t(field.n_groups));
  kernels::MomentsOfFrames<Host> const moments{view(walls),  view(images),  {x.x.data(), x.y.data(), x.z.data()},
                                               field.origin, frames.data(), moment.data()};
  for (Index k = 0; k < moments.size(); ++k) moments(k);
  using Rows = kernels::InterpolateRows<Host, kernels::MotionMoments const*, kernels::MotionMoments>;
  for (Index r = 0; r < field.leaves.size(); ++r) Rows{table(field.leaves), moment.data(), group.data()}(r);
  for (Index r = 0; r < field.groups.rows.size(); ++r) Rows{table(field.groups.rows), group.data(), group.data()}(r);
  kernels::LeastSquaresTable<Host> const nodes{table(field.nodes), view(field.lean), view(field.level),
                                               view(field.room)};
  std::vector<Vec3> out;
  for (Index r = 0; r < field.nodes.size(); ++r) out.push_back(nodes.at(group.data(), r));
  return out;
}

/// Walls over a bumpy patch, and readers above it at all distances.
struct Bumps {
  Coordinates x;
  std::vector<Index32> walls;
  std::vector<double> area;
  std::vector<FieldReader> readers;

  explicit Bumps(std::function<Vec3(Vec3 const&)> const& to = [](Vec3 const& p) { return p; }) {
    std::vector<Vec3> places;
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) {
        double const a = i / 23.0, b = j / 23.0;
        walls.push_back(Index32(places.size()));
        area.push_back(1 + 0.5 * std::sin(3 * a));
        places.push_back({a, b, 0.1 * std::sin(5 * a) * std::cos(4 * b)});
      }
    std::size_t const n_walls = places.size();
    for (int k = 0; k < 40; ++k)
      for (int i = 0; i < 40; ++i) places.push_back({-0.2 + 0.035 * i, 0.45, 0.12 * std::pow(1.15, k) - 0.02});
    for (std::size_t n = n_walls; n < places.size(); ++n) {
      double nearest = 1e9;
      for (std::size_t w = 0; w < n_walls; ++w) nearest = std::min(nearest, distance(places[n], places[w]));
      readers.push_back({Index32(n), nearest});
    }
    x = Coordinates(Index(places.size()));
    for (std::size_t n = 0; n < places.size(); ++n) x.set(Index(n), to(places[n]));
  }
};

FieldSources sources(Bumps const& of, std::vector<RigidTransform> images = {}) {
  return {of.walls, of.walls.size(), of.area, std::move(images)};
}

TEST(LeastSquaresField, CarriesAMotionOfAllWallsExactly) {
  Bumps const b;
  RigidTransform const r = rotation_about({1, 2, 3}, {0.6, 0, 0.8}, 1.1);
  Mat3 gradient = r.rotation;
  for (int i = 0; i < 3; ++i) gradient.m[i][i] -= 1;
  std::vector<kernels::AffineMotion> frames;
  for (Index32 const w : b.walls) frames.push_back({r(b.x[w]) - b.x[w], gradient});
  auto const field = make_least_squares_field(HostInstance(), b.x, sources(b), MeanTurn::taken_off, b.readers);
  auto const u = applied(field, b.x, b.walls, frames);
  for (std::size_t k = 0; k < u.size(); ++k) {
    Vec3 const at = b.x[b.readers[k].node];
    ASSERT_LT(distance(u[k], r(at) - at), 1e-12 * (1 + norm(at))) << k;
  }
}

TEST(LeastSquaresField, HasImagesAsIfTheyWereWalls) {
  Bumps const b;
  RigidTransform const to = rotation_about({1.2, -0.3, 0}, {0.6, 0, 0.8}, 0.9);
  auto const moves = [](Vec3 const& p) { return Vec3{0.1 * p.z, 0.2 * std::sin(3 * p.x) * p.y, p.x * p.y}; };
  auto const turns = [](Vec3 const& p) { return Mat3{{{0, 0.1, p.x}, {0, p.y, -0.2}, {0.3, 0, 0.1 * p.z}}}; };
  Bumps all = b;
  std::vector<kernels::AffineMotion> frames, frames_of_all;
  for (Index32 const w : b.walls) frames.push_back({moves(b.x[w]), turns(b.x[w])});
  frames_of_all = frames;
  std::vector<Vec3> places;
  for (Index n = 0; n < b.x.size(); ++n) places.push_back(b.x[n]);
  for (std::size_t k = 0; k < b.walls.size(); ++k) {
    all.walls.push_back(Index32(places.size()));
    all.area.push_back(b.area[k]);
    places.push_back(to(b.x[b.walls[k]]));
    frames_of_all.push_back({to.rotation * frames[k].u, to.rotation * (frames[k].gradient * transpose(to.rotation))});
  }
  all.x = Coordinates(Index(places.size()));
  for (std::size_t n = 0; n < places.size(); ++n) all.x.set(Index(n), places[n]);
  for (FieldReader& r : all.readers)
    for (Index32 const w : all.walls) r.distance = std::min(r.distance, distance(all.x[w], all.x[r.node]));
  auto const u =
      applied(make_least_squares_field(HostInstance(), b.x, sources(b, {to}), MeanTurn::taken_off, b.readers), b.x,
              b.walls, frames);
  auto const v =
      applied(make_least_squares_field(HostInstance(), all.x, sources(all), MeanTurn::taken_off, all.readers), all.x,
              all.walls, frames_of_all);
  ASSERT_EQ(u.size(), v.size());
  for (std::size_t k = 0; k < u.size(); ++k) ASSERT_LT(distance(u[k], v[k]), 1e-12) << k;
}

/// Of boundaries that move beside walls no turns are known; those of the walls stand for them.
TEST(LeastSquaresField, CarriesAMotionOfWallsAndOfWhatMovesBesideThemExactly) {
  Bumps const b;
  std::vector<Index32> nodes, beside;
  for (std::size_t k = 0; k < b.walls.size(); ++k) (k % 4 == 3 ? beside : nodes).push_back(b.walls[k]);
  std::size_t const n_walls = nodes.size();
  nodes.insert(nodes.end(), beside.begin(), beside.end());
  RigidTransform const r = rotation_about({1, 2, 3}, {0.6, 0, 0.8}, 1.1);
  Mat3 gradient = r.rotation;
  for (int i = 0; i < 3; ++i) gradient.m[i][i] -= 1;
  std::vector<kernels::AffineMotion> frames;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    frames.push_back({r(b.x[nodes[k]]) - b.x[nodes[k]]});
    if (k < n_walls) frames.back().gradient = gradient;
  }
  std::vector<double> area;
  for (Index32 const n : nodes) area.push_back(b.area[n]);
  auto const field =
      make_least_squares_field(HostInstance(), b.x, {nodes, n_walls, area, {}}, MeanTurn::taken_off, b.readers);
  auto const u = applied(field, b.x, nodes, frames);
  for (std::size_t k = 0; k < u.size(); ++k) {
    Vec3 const at = b.x[b.readers[k].node];
    ASSERT_LT(distance(u[k], r(at) - at), 1e-11 * (1 + norm(at))) << k;
  }
}

TEST(LeastSquaresField, IsSmoothAndDoesNotDependOnTheAxes) {
  // Walls that bend: how far neighbouring readers are from a straight line between their neighbours says whether groups
  // come and go at once.
  auto const bends = [](Vec3 const& p) { return Vec3{0, 0.1 * p.z, 0.2 * std::sin(3 * p.x) * p.y}; };
  auto const carried = [&](RigidTransform const& turn) {
    Bumps const plain, turned([&](Vec3 const&p) { return turn(p); });
    std::vector<kernels::AffineMotion> frames;
    for (Index32 const w : plain.walls) frames.push_back({RigidTransform{turn.rotation, {}}(bends(plain.x[w])), {}});
    for (auto& f : frames)
      for (auto& row : f.gradient.m)
        for (double& entry : row) entry = 0;
    auto const field =
        make_least_squares_field(HostInstance(), turned.x, sources(turned), MeanTurn::taken_off, turned.readers);
    auto u = applied(field, turned.x, turned.walls, frames);
    Mat3 const back = transpose(turn.rotation);
    for (Vec3& v : u) v = back * v;
    return u;
  };
  auto const u = carried({}), v = carried(rotation_about({0.3, 0.1, 2}, {0.48, 0.6, 0.64}, 37 * degrees));
  double largest = 0, apart = 0, kink = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    largest = std::max(largest, norm(u[k]));
    apart = std::max(apart, distance(u[k], v[k]));
    if (k % 40 > 0 && k % 40 < 39) kink = std::max(kink, norm(u[k - 1] - 2 * u[k] + u[k + 1]));
  }
  EXPECT_GT(largest, 0.05);
  EXPECT_LT(apart, 0.03 * largest);
  EXPECT_LT(kink, 0.05 * largest);
}

TEST(NearFit, DoesNotDependOnNumbersUnitOrNoise) {
  Case const c = section();
  auto const of = [&](Mesh mesh, std::function<Vec3(Vec3 const&)> const& moves) {
    return Case(std::move(mesh)).morph(by_places("airfoil", moves), by_fit()).x;
  };
  Coordinates const x = of(c.mesh, bent(0.1));
  Mesh noisy = c.mesh, small = c.mesh;
  small.coordinates = Coordinates(c.mesh.n_nodes());
  noisy.coordinates = Coordinates(c.mesh.n_nodes());
  Random random(5);
  for (Index n = 0; n < x.size(); ++n) {
    Vec3 const p = c.mesh.coordinates[n], r = random.vector(1e-14);
    noisy.coordinates.set(n, p + Vec3{r.x, r.y, 0});
    small.coordinates.set(n, 1e-3 * p);
  }
  Coordinates const y = of(noisy, bent(0.1)), z = of(small, [](Vec3 const&p) { return 1e-3 * bent(0.1)(1e3 * p); });
  for (Index n = 0; n < x.size(); ++n) {
    ASSERT_LT(distance(x[n], y[n]), 1e-9) << n;
    ASSERT_LT(distance(x[n], 1e3 * z[n]), 1e-9) << n;
  }
}

TEST(NearFit, HasTheVelocityOfItsDifferences) {
  Case const c = section();
  auto const prepared = [&](double by) {
    return prepare(c.mesh, c.topology, c.face_patches, by_places("airfoil", bent(by)), by_fit());
  };
  auto const at = prepared(0.1);
  auto const [error, largest] =
      rate_error(c, at.plan, [&](double t) { return prepared(0.1 + t).boundary_displacement(); });
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(error, 1e-7 * largest);
}

#ifdef GRIDMORPH_WITH_SERIAL
TEST(NearFit, GivesTheSameBitsWithAnyThreads) {
  Case const c = section();
  auto const with = [&](auto const& exec) { return positions_on(exec, c, by_places("airfoil", bent(0.1)), by_fit()); };
  Coordinates const serial = with(Kokkos::Serial()), host = with(Case::Host());
  for (Index n = 0; n < serial.size(); ++n) ASSERT_EQ(serial[n], host[n]) << n;
}
#endif

}  // namespace
}  // namespace gridmorph::test
