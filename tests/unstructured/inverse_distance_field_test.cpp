// The smooth field between boundary values: the sum over all of them, constants, and the same field however they are
// numbered.
#include "support/random.hpp"

#include <gridmorph/morph/stages/smooth_field.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gridmorph::test {
namespace {

using kernels::UniformLattice;

using Exec = Kokkos::DefaultHostExecutionSpace;

/// The lattice points on the surface of a cube of side n: full of equal distances.
std::vector<Vec3> cube_surface(int n) {
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        if (i == 0 || i == n || j == 0 || j == n || k == 0 || k == n)
          points.push_back({double(i), double(j), double(k)});
  return points;
}

/// Boundary nodes with their areas; node number k is points[order[k]].
struct Sources {
  std::vector<Vec3> point;
  std::vector<double> area;

  explicit Sources(std::vector<Vec3> const& points, std::vector<int> const& order = {}) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      Vec3 const p = points[order.empty() ? k : std::size_t(order[k])];
      point.push_back(p);
      area.push_back(1 + 0.1 * std::sin(p.x + 2 * p.y + 3 * p.z));
    }
  }
  [[nodiscard]] InverseDistanceField planned(int dimension, Vec3 const& low, Vec3 const& high, Index most_nodes,
                                             std::vector<Index32> const& readers = {}) const {
    Coordinates x(Index(point.size()));
    std::vector<Index32> nodes;
    for (std::size_t k = 0; k < point.size(); ++k) {
      x.set(Index(k), point[k]);
      nodes.push_back(Index32(k));
    }
    ScatterLattice lattice{low, high, most_nodes};
    lattice.readers = readers;
    return make_scatter_lattice(x, nodes, area, dimension, lattice);
  }
};

/// Values at the nodes of the lattice.
template <class Value = Vec3>
std::vector<Vec3> on_lattice(InverseDistanceField const& planned, std::vector<Value> const& values) {
  Exec const exec;
  stages::SmoothField<Exec, Value> const smooth(exec, planned, "gridmorph::test::smooth");
  smooth.enqueue(exec, values.data());
  exec.fence();
  std::vector<Vec3> out;
  for (std::size_t n = 0; n < smooth.values().extent(0); ++n) out.push_back(kernels::as<Vec3>(smooth.values()(n)));
  return out;
}

using Function = Vec3 (*)(Vec3 const&);

std::vector<Vec3> values_at(std::vector<Vec3> const& points, Function value) {
  std::vector<Vec3> out;
  for (Vec3 const& p : points) out.push_back(value(p));
  return out;
}

/// Values on the lattice over twice the cube.
std::vector<Vec3> field(std::vector<Vec3> const& points, std::vector<int> const& order, Function value) {
  Sources const sources(points, order);
  return on_lattice(sources.planned(3, {-4, -4, -4}, {12, 12, 12}, 4000), values_at(sources.point, value));
}

std::vector<int> in_order(std::size_t n) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// Against the sum over all sources. A group of radius r that counts as one at distance d has r <= d / 2. Its weight w'
/// = A / d^p stands for weights w = A_n / |x - x_n|^p with (1/2)^p <= w' / w <= (3/2)^p, and the mean v' of the whole
/// obeys sum w' (v - v') = 0, so
///
///     |sum w v / sum w - v'| = |sum (w - w') (v - v')| / sum w <= ((3/2)^p - 1) sum w |v - v'| / sum w
///
/// at nodes of the lattice where even the smallest groups, whose nodes are never looked at one by one, are that far.
/// `typical`: root mean square of the error over that of the mean deviation sum w |v - v'| / sum w. It is no small
/// share of it: across a group at twice its radius weights change by 3^p, and its mean takes no notice. The field is
/// meant to be smooth and between its values, not to be that sum.
void expect_direct_sum(Sources const& sources, int dimension, Function value, double spacing, double typical) {
  int const p = dimension == 2 ? 3 : 4;
  auto const planned =
      sources.planned(dimension, {-4, -4, dimension == 2 ? 0. : -4}, {12, 12, dimension == 2 ? 0. : 12}, 1000);
  auto const values = values_at(sources.point, value);
  auto const found = on_lattice(planned, values);
  double squares = 0, spread = 0;
  Index far = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    Vec3 const x = planned.shape.position(std::int64_t(n));
    double sum = 0, away = 0, nearest = 1e300;
    Vec3 direct;
    for (std::size_t k = 0; k < values.size(); ++k) {
      double const d = distance(x, sources.point[k]), w = sources.area[k] / std::pow(d, p);
      nearest = std::min(nearest, d);
      sum += w;
      direct += w * values[k];
      away += w * distance(values[k], found[n]);
    }
    if (nearest < 4 * spacing) continue;
    ++far;
    double const error = distance((1 / sum) * direct, found[n]);
    EXPECT_LE(error, (std::pow(1.5, p) - 1) * away / sum + 1e-6);
    squares += error * error;
    spread += away * away / (sum * sum);
  }
  ASSERT_GT(far, 100);
  EXPECT_LT(std::sqrt(squares / spread), typical);
  EXPECT_GT(squares, 0) << "no group counts as one";
}

TEST(InverseDistanceField, IsTheSumOverAllSourcesNearlyEnough) {
  Function const smooth = [](Vec3 const& x) { return Vec3{x.x, 0.1 * x.y * x.z, std::sin(0.5 * x.x + 0.3 * x.y)}; };
  for (int const n : {8, 12}) {
    std::vector<Vec3> cube;
    for (Vec3 const& q : cube_surface(n)) cube.push_back((8. / n) * q);
    expect_direct_sum(Sources(cube), 3, smooth, 8. / n, 0.25);
    // A curve in a plane.
    std::vector<Vec3> ellipse;
    for (int k = 0; k < 12 * n; ++k)
      ellipse.push_back({4 + 4 * std::cos(k * 0.5236 / n), 4 + 2 * std::sin(k * 0.5236 / n), 0});
    expect_direct_sum(Sources(ellipse), 2, smooth, 2. / n, 0.5);
  }
}

TEST(InverseDistanceField, OfOneSourceIsItsValueAndOfTwoTheirMean) {
  Function const itself = [](Vec3 const& x) { return x; };
  for (Vec3 const& v : on_lattice(Sources({{1, 2, 3}}).planned(3, {0, 0, 0}, {4, 4, 4}, 200), {{5, 6, 7}}))
    EXPECT_EQ(v, (Vec3{5, 6, 7}));
  // Up to four are one group where they are closer together than cells of the lattice show.
  Sources const two({{1, 2, 3}, {1.1, 2, 2.9}});
  Vec3 const mean = 1 / (two.area[0] + two.area[1]) * (two.area[0] * two.point[0] + two.area[1] * two.point[1]);
  for (Vec3 const& v : on_lattice(two.planned(3, {0, 0, 0}, {4, 4, 4}, 200), values_at(two.point, itself)))
    EXPECT_LT(distance(v, mean), 1e-6);
  // Further apart each is the nearer one somewhere: the value beside it is its own.
  Sources const apart({{1, 2, 3}, {3, 2, 1}});
  auto const planned = apart.planned(3, {0, 0, 0}, {4, 4, 4}, 1000);
  auto const found = on_lattice(planned, values_at(apart.point, itself));
  for (std::size_t n = 0; n < found.size(); ++n)
    for (Vec3 const& p : apart.point)
      if (distance(planned.shape.position(std::int64_t(n)), p) < planned.shape.spacing) {
        EXPECT_LT(distance(found[n], p), 0.02) << n;
      }
  EXPECT_TRUE(Sources({}).planned(3, {0, 0, 0}, {4, 4, 4}, 200).empty());
}

TEST(InverseDistanceField, TheLatticeCoversItsBoxWithAtMostTheNodesAllowed) {
  Sources const sources({{1, 2, 0}, {3, 2, 0}});
  for (Index const most : {200, 5000})
    for (int const dimension : {2, 3}) {
      Vec3 const low{-1, 0, 0}, high{7, 2, dimension == 2 ? 0. : 3.};
      UniformLattice const lattice = sources.planned(dimension, low, high, most).shape;
      EXPECT_LE(lattice.size(), most);
      EXPECT_GT(lattice.size(), most / 3);
      EXPECT_EQ(lattice.position(0), low);
      Vec3 const beyond = lattice.position(lattice.size() - 1) - high;
      for (double const b : {beyond.x, beyond.y, beyond.z}) {
        EXPECT_GE(b, -1e-12);
        EXPECT_LT(b, lattice.spacing);
      }
    }
}

TEST(InverseDistanceField, HasRowsWhereNodesReadItAndTheSameValuesThere) {
  Sources const sources(cube_surface(8));
  // Two nodes of the mesh: one at a corner of its cell, one amid a face of its own.
  std::vector<Index32> const readers{0, 40};
  for (int const dimension : {2, 3}) {
    Vec3 const low{-4, -4, dimension == 2 ? 0. : -4}, high{12, 12, dimension == 2 ? 0. : 12};
    auto const all = sources.planned(dimension, low, high, 4000);
    auto const few = sources.planned(dimension, low, high, 4000, readers);
    ASSERT_EQ(all.lattice.size(), all.shape.size());
    EXPECT_EQ(few.shape.size(), all.shape.size());
    EXPECT_LT(few.lattice.size(), 40);
    auto const values = values_at(sources.point, [](Vec3 const& x) { return Vec3{x.x, x.y * x.z, std::sin(x.y)}; });
    auto const everywhere = on_lattice(all, values), there = on_lattice(few, values);
    for (Index32 const n : few.lattice.target) EXPECT_EQ(there[n], everywhere[n]);
    std::vector<kernels::PackedVec3> packed_all(everywhere.size()), packed_few(there.size());
    for (std::size_t n = 0; n < there.size(); ++n) {
      kernels::put(packed_all[n], everywhere[n]);
      kernels::put(packed_few[n], there[n]);
    }
    kernels::LatticeReader<Vec3> const lattice(all.shape);
    for (Index32 const n : readers) {
      Vec3 const x = sources.point[n], value = lattice.at(packed_all.data(), x);
      EXPECT_EQ(lattice.at(packed_few.data(), x), value);
      // Whoever has the mesh in single precision reads about the same.
      for (double const off : {-1e-7, 1e-7})
        EXPECT_LT(distance(lattice.at(packed_few.data(), x + off * Vec3{1, 1, 1}), value), 1e-5);
    }
  }
}

TEST(InverseDistanceField, HasRowsForWhatIsReadInSinglePrecisionFarFromTheOrigin) {
  Vec3 const far{12345.678, -54321.09, 33333.3};
  auto const shifted = [&](std::vector<Vec3> points) {
    for (Vec3& p : points) p = p + far;
    return points;
  };
  Vec3 const low = far - Vec3{4, 4, 4}, high = far + Vec3{12, 12, 12};
  auto const cube = shifted(cube_surface(8));
  UniformLattice const shape = Sources(cube).planned(3, low, high, 4000).shape;
  // Nodes of the mesh on faces of the lattice's cells, where round-off decides which of two cells they are in.
  std::vector<Vec3> points = cube;
  std::vector<Index32> readers;
  for (Index n = 0; n < shape.size(); n += 61)
    for (Vec3 const& within : {Vec3{0, 0.3, 0.6}, Vec3{0.6, 0, 0.3}, Vec3{0.3, 0.6, 0}}) {
      readers.push_back(Index32(points.size()));
      points.push_back(shape.position(n) + shape.spacing * within);
    }
  Coordinates x(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) x.set(Index(n), points[n]);
  std::vector<Index32> sources(cube.size());
  std::iota(sources.begin(), sources.end(), 0);
  ScatterLattice lattice{low, high, 4000};
  lattice.readers = readers;
  auto const planned = make_scatter_lattice(x, sources, std::vector<double>(cube.size(), 1), 3, lattice);
  ASSERT_LT(planned.lattice.size(), planned.shape.size()) << "a row for all says nothing";
  std::vector<kernels::PackedVec3> values(planned.shape.size());
  double const none = std::numeric_limits<double>::quiet_NaN();
  for (auto& v : values) kernels::put(v, Vec3{none, none, none});
  for (Index32 const n : planned.lattice.target) kernels::put(values[n], Vec3{1, 2, 3});
  kernels::LatticeReader<Vec3> const at(planned.shape);
  for (Index32 const n : readers) {
    Vec3 const rounded{double(float(points[n].x)), double(float(points[n].y)), double(float(points[n].z))};
    EXPECT_LT(distance(at.at(values.data(), rounded), Vec3{1, 2, 3}), 1e-12) << n;
  }
}

TEST(InverseDistanceField, ConstantsStayConstant) {
  auto const points = cube_surface(8);
  for (Vec3 const& v : field(points, in_order(points.size()), [](Vec3 const&) { return Vec3{1, -2, 0.5}; })) {
    EXPECT_LT(norm(v - Vec3{1, -2, 0.5}), 1e-12);
  }
}

TEST(InverseDistanceField, OfOneRigidMotionIsThatMotion) {
  Mat3 const gradient{{{-0.1, -0.4, 0.2}, {0.4, -0.1, 0}, {-0.2, 0.1, -0.05}}};
  Sources const sources(cube_surface(6));
  std::vector<kernels::AffineMotion> motions;
  for (Vec3 const& p : sources.point) motions.push_back({Vec3{1, 2, 3} + gradient * p, gradient});
  InverseDistanceField const planned = sources.planned(3, {-4, -4, -4}, {12, 12, 12}, 4000);
  auto const found = on_lattice(planned, motions);
  for (Index n = 0; n < planned.shape.size(); ++n)
    EXPECT_LT(distance(found[n], Vec3{1, 2, 3} + gradient * planned.shape.position(n)), 1e-6) << n;
}

TEST(InverseDistanceField, NumberingOfTheNodesDoesNotMatter) {
  auto const points = cube_surface(8);
  auto const value = [](Vec3 const& p) { return Vec3{std::sin(p.x), p.y * p.z / 10, std::cos(p.x + p.y)}; };
  auto const expected = field(points, in_order(points.size()), value);
  Random random(7);
  for (int trial = 0; trial < 3; ++trial) {
    auto order = in_order(points.size());
    random.shuffle(order);
    auto const found = field(points, order, value);
    ASSERT_EQ(found.size(), expected.size());
    // Weights are kept in single precision.
    for (std::size_t n = 0; n < found.size(); ++n) EXPECT_LT(norm(found[n] - expected[n]), 1e-6);
  }
}

TEST(InverseDistanceField, ValuesLieBetweenThoseGiven) {
  auto const points = cube_surface(6);
  for (Vec3 const& v : field(points, in_order(points.size()), [](Vec3 const& p) { return Vec3{p.x, 0, 1}; })) {
    EXPECT_GE(v.x, 0);
    EXPECT_LE(v.x, 6);
    EXPECT_LT(std::abs(v.y), 1e-14);
  }
}

}  // namespace
}  // namespace gridmorph::test
