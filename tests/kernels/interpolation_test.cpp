// Rows of means, layers of them, fields on lattices and lists of nodes, against plain loops.
#include "kernels/tables.hpp"
#include "support/random.hpp"

#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/lattice_field.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/periodic_mean.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::UniformLattice;

using Exec = Kokkos::DefaultHostExecutionSpace;
using Vectors = std::vector<Vec3>;

/// Rows r = 0, 1, ... with the weights that are given; targets `first_target` + r.
struct Rows {
  std::vector<std::int32_t> target, item;
  std::vector<Index> first{0};
  std::vector<float> weight;

  void add(std::int32_t to, std::vector<std::int32_t> const& items, std::vector<float> const& weights) {
    target.push_back(to);
    item.insert(item.end(), items.begin(), items.end());
    weight.insert(weight.end(), weights.begin(), weights.end());
    first.push_back(Index(item.size()));
  }
  [[nodiscard]] kernels::InterpolationTable<Host> table() const {
    return {view(target), view(first), view(item), view(weight)};
  }
};

Vectors random_vectors(std::size_t n, unsigned seed) {
  Random random(seed);
  Vectors v(n);
  for (Vec3& a : v) a = random.vector(1);
  return v;
}

void expect_near(Vec3 const& a, Vec3 const& b, double tolerance) { EXPECT_LT(distance(a, b), tolerance); }

TEST(InterpolationRows, AreWeightedMeans) {
  Random random(11);
  Rows rows;
  std::vector<std::vector<double>> weights;
  for (int r = 0; r < 50; ++r) {
    std::vector<std::int32_t> items;
    std::vector<double> w;
    double sum = 0;
    for (int k = 0; k <= r % 7; ++k) {
      items.push_back(random.below(20));
      w.push_back(random.between(0.1, 1));
      sum += w.back();
    }
    for (double& a : w) a /= sum;
    weights.push_back(w);
    rows.add(std::int32_t(49 - r), items, std::vector<float>(w.begin(), w.end()));
  }
  Vectors const source = random_vectors(20, 12);
  Vectors value(50);
  kernels::interpolate("test::rows", Exec(), rows.table(), source.data(), value.data());
  Exec().fence();
  for (int r = 0; r < 50; ++r) {
    Vec3 expected;
    for (std::size_t k = 0; k < weights[r].size(); ++k)
      expected += weights[r][k] * source[rows.item[std::size_t(rows.first[r]) + k]];
    expect_near(value[49 - r], expected, 1e-6);  // weights are kept in single precision
  }
}

TEST(InterpolationRows, OfEqualSourcesGiveExactlyTheirValue) {
  Rows rows;
  rows.add(0, {0, 1, 2}, {0.3f, 0.3f, 0.4f});
  Vec3 const same{0.1, -1e-300, 1e300};
  Vectors const source(3, same);
  Vectors value(1);
  kernels::interpolate("test::rows", Exec(), rows.table(), source.data(), value.data());
  Exec().fence();
  EXPECT_EQ(value[0], same);
}

TEST(InterpolationLayers, ReadWhatLayersBeforeThemWrote) {
  // A line of nodes, each the mean of the two before it: the recursion f(n) = (f(n - 1) + f(n - 2)) / 2.
  Rows rows;
  kernels::LayerTable<Host> layers;
  layers.level = {0};
  for (std::int32_t n = 2; n < 40; ++n) {
    rows.add(n, {n - 1, n - 2}, {0.5f, 0.5f});
    layers.level.push_back(n - 1);
  }
  layers.rows = rows.table();
  Vectors value(40);
  value[1] = {1, 2, 3};
  kernels::interpolate_layers("test::layers", Exec(), layers, value.data());
  Exec().fence();
  // f(n) = 2/3 + (1/3) (-1/2)^(n - 1) f(1) for f(0) = 0
  for (int n = 2; n < 40; ++n) {
    double const f = 2.0 / 3 * (1 - std::pow(-0.5, n));
    expect_near(value[n], f * Vec3{1, 2, 3}, 1e-14);
  }
}

TEST(AffineMotions, HaveMeansThatAreMotions) {
  kernels::AffineMotion const a{{1, 2, 3}, {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 2}}}},
      b{{-1, 0, 1}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  Vec3 const centre{1, 1, 1}, x{2, -1, 3};
  kernels::AffineMotion const mean = a + 0.25 * (b - a);
  expect_near(kernels::value_at(mean, centre, x),
              0.75 * kernels::value_at(a, centre, x) + 0.25 * kernels::value_at(b, centre, x), 1e-14);
}

/// A lattice with a field that is linear in x, and nodes in it.
struct OnLattice {
  UniformLattice shape{{-1, -1, -1}, 0.5, {5, 5, 5}};
  std::vector<kernels::PackedVec3> value{125};
  Arrays x{10};

  OnLattice() {
    for (Index n = 0; n < 125; ++n) kernels::put(value[n], linear(shape.position(n)));
    Random random(13);
    for (int n = 0; n < 10; ++n) x.field().set(n, random.vector(1));
  }
  static Vec3 linear(Vec3 const& p) { return {p.x + 2 * p.y, 3 - p.z, p.x * 0.5}; }
  [[nodiscard]] kernels::LatticeField field() const { return {shape, value.data()}; }
};

TEST(LatticeField, IsReadAndMissedWhereNodesAre) {
  OnLattice const on;
  Vectors const given = random_vectors(10, 14);
  auto const node = view<std::int32_t>({7, 2});
  auto const share = view<float>({0.5f, 0.25f});
  Vectors left(10), u(10), added = given;
  kernels::launch("test::misses", Exec(),
                  kernels::FieldMisses<Host>{node, on.field(), on.x.read(), given.data(), left.data()});
  kernels::launch("test::near", Exec(),
                  kernels::FieldAndMissing<Host>{node, share, on.field(), on.x.read(), left.data(), u.data()});
  Vectors start = left;
  kernels::launch(
      "test::start", Exec(),
      kernels::StartFromField<Host>{node, share, share, on.field(), on.x.read(), given.data(), start.data()});
  auto const all = view<float>({0, 0, 1, 0, 0, 0, 0, 0.5f, 0, 0}),
             detail = view<float>({0, 0, 0.5f, 0, 0, 0, 0, 0, 0, 0});
  kernels::launch("test::add", Exec(),
                  kernels::AddFieldAndMissing<Host>{all, detail, on.field(), on.x.read(), left.data(), added.data()});
  Exec().fence();
  for (int k = 0; k < 2; ++k) {
    std::size_t const n = std::size_t(node(k));
    Vec3 const smooth = OnLattice::linear(on.x.read()[Index(n)]), missed = given[n] - smooth;
    expect_near(left[n], missed, 1e-14);
    expect_near(u[n], smooth + double(share(k)) * missed, 1e-14);
    expect_near(start[n], given[n] + double(share(k)) * smooth + double(share(k)) * missed, 1e-14);
    expect_near(added[n], given[n] + double(all(Index(n))) * smooth + double(detail(Index(n))) * left[n], 1e-14);
  }
  EXPECT_EQ(left[3], Vec3{});
  EXPECT_EQ(added[3], given[3]);
}

TEST(ListedNodes, AreSetTakenCopiedAndWritten) {
  Vectors boundary = random_vectors(3, 15), u(6), asked = random_vectors(6, 16), left(6), listed(2);
  kernels::VectorArray const given{&boundary[0].x, &boundary[0].y, &boundary[0].z, 3};
  auto const nodes = view<std::int32_t>({5, 3, 1});
  kernels::launch("test::set", Exec(), kernels::SetFromSlots<Host>{view<std::int32_t>({2, 0}), nodes, given, u.data()});
  EXPECT_EQ(u[1], boundary[2]);
  EXPECT_EQ(u[5], boundary[0]);
  EXPECT_EQ(u[3], Vec3{});
  kernels::launch("test::misses", Exec(),
                  kernels::GivenResiduals<Host>{view<std::int32_t>({5, 2}), view<std::int32_t>({1, 2}), given, u.data(),
                                                left.data(), listed.data()});
  EXPECT_EQ(left[5], boundary[1] - boundary[0]);
  EXPECT_EQ(listed[1], boundary[2]);
  Vectors const wanted = asked;
  Vec3 const before = u[1];
  kernels::launch("test::take", Exec(),
                  kernels::TakePrescribed<Host>{view<std::int32_t>({4, 1}), u.data(), asked.data(), listed.data()});
  EXPECT_EQ(u[1], wanted[1]);
  EXPECT_EQ(asked[1], wanted[1] - before);
  EXPECT_EQ(listed[1], wanted[1] - before);
  kernels::launch("test::copy", Exec(),
                  kernels::CopyListed<Host>{view<std::int32_t>({2, 3}), view<std::int32_t>({1, 5}), u.data()});
  EXPECT_EQ(u[2], u[1]);
  EXPECT_EQ(u[3], u[5]);
}

TEST(PeriodicMean, IsThatOfTheClassInTheFrameOfItsOwner) {
  Mat3 const quarter{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  // Two classes: 0 with images 1 (as it is) and 2 (turned); 3 with image 4, whose displacement a rule gives.
  kernels::PeriodicTable<Host> const table{view<std::int32_t>({0, 3}),    view<std::uint8_t>({0, 1}),
                                           view<Index>({0, 2, 3}),        view<std::int32_t>({0, 1, 2}),
                                           view<std::int32_t>({1, 2, 4}), view<std::int32_t>({-1, 0, 0}),
                                           view<Mat3>({quarter})};
  Vectors const before = random_vectors(5, 17);
  Vectors u = before;
  kernels::launch("test::periodic", Exec(), kernels::PeriodicMean<Host>{table, u.data()});
  Exec().fence();
  Vec3 const mean = (1.0 / 3) * (before[0] + before[1] + transpose(quarter) * before[2]);
  expect_near(u[0], mean, 1e-15);
  EXPECT_EQ(u[1], u[0]);
  EXPECT_EQ(u[2], quarter * u[0]);
  EXPECT_EQ(u[3], before[3]);
  EXPECT_EQ(u[4], quarter * before[3]);
}

}  // namespace
}  // namespace gridmorph::test
