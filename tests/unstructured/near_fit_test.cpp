// The walls' motion by least squares, at the scale of the distance from them.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/host_spaces.hpp>
#include <gridmorph/kernels/least_squares.hpp>
#include <gridmorph/plan/least_squares_field.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
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

TEST(NearFit, WallsThatEndOnBoundariesGoByTheLattice) {
  Case const c(
      box_around({8, 8, 6}, [](Vec3 const& p) { return p.x > 3 && p.x < 5 && p.y > 3 && p.y < 5 && p.z < 3; }));
  auto const m = c.morph(motion_of({rule_for({"body"}, FunctionRule{"leans",
                                                                    [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                                                      for (std::size_t n = 0; n < x.size(); ++n)
                                                                        u[n] = {0.1 * x[n].z, 0, 0};
                                                                    }}),
                                    rule_for({"k_min"}, FixedRule{})}),
                         by_fit());
  EXPECT_FALSE(m.prepared.plan.walls.empty());
  EXPECT_TRUE(m.prepared.plan.fit.empty());
  EXPECT_TRUE(std::any_of(m.prepared.notes.begin(), m.prepared.notes.end(),
                          [](std::string const& n) { return n.find("in place of least squares") != n.npos; }));
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
  std::vector<kernels::MotionMoments> moment(walls.size()), group(std::size_t(field.n_groups));
  kernels::MomentsOfFrames<Host> const moments{
      view(walls), {x.x.data(), x.y.data(), x.z.data()}, field.origin, frames.data(), moment.data()};
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
      readers.push_back({Index32(n), nearest, 1});
    }
    x = Coordinates(Index(places.size()));
    for (std::size_t n = 0; n < places.size(); ++n) x.set(Index(n), to(places[n]));
  }
};

TEST(LeastSquaresField, CarriesAMotionOfAllWallsExactly) {
  Bumps const b;
  RigidTransform const r = rotation_about({1, 2, 3}, {0.6, 0, 0.8}, 1.1);
  Mat3 gradient = r.rotation;
  for (int i = 0; i < 3; ++i) gradient.m[i][i] -= 1;
  std::vector<kernels::AffineMotion> frames;
  for (Index32 const w : b.walls) frames.push_back({r(b.x[w]) - b.x[w], gradient});
  auto const field = make_least_squares_field(HostInstance(), b.x, b.walls, b.area, b.readers);
  auto const u = applied(field, b.x, b.walls, frames);
  for (std::size_t k = 0; k < u.size(); ++k) {
    Vec3 const at = b.x[b.readers[k].node];
    ASSERT_LT(distance(u[k], r(at) - at), 1e-12 * (1 + norm(at))) << k;
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
    auto const field = make_least_squares_field(HostInstance(), turned.x, turned.walls, turned.area, turned.readers);
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
