// The relative shape of a corner: derivatives against differences, what leaves it alone, and the exact update by a
// move.
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/kernels/relative_shape.hpp>

#include "support/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace gridmorph::kernels {
namespace {

/// A corner and which of its four nodes moves: 0 its own, 1 + d the end of edge d.
struct Example {
  std::array<Vec3, 4> before, now;
  int moves = 0;

  static void edges(std::array<Vec3, 4> const& x, Vec3 (&edge)[3]) {
    for (int d = 0; d < 3; ++d) edge[d] = x[d + 1] - x[0];
  }
  [[nodiscard]] BaselineCorner baseline() const {
    Vec3 edge[3];
    edges(before, edge);
    return BaselineCorner::of(edge);
  }
  [[nodiscard]] CornerChange change(Vec3 const& move = {}) const {
    auto x = now;
    x[moves] += move;
    Vec3 edge[3];
    edges(x, edge);
    double share[3];
    for (int d = 0; d < 3; ++d) share[d] = moves == 0 ? -1 : (moves == d + 1 ? 1 : 0);
    return corner_change(baseline(), edge, share);
  }
  [[nodiscard]] double f(Vec3 const& move, double delta) const {
    CornerChange const c = change(move);
    return relative_shape(c.n, c.d, delta);
  }
};

std::vector<Example> examples() {
  test::Random random(7);
  auto const vector = [&] { return random.vector(1); };
  std::vector<Example> out;
  for (int n = 0; n < 40; ++n) {
    Example e;
    Vec3 const from = vector(), stretch{1, std::pow(10.0, -n % 4), 1};
    for (int c = 0; c < 4; ++c) {
      Vec3 const unit{c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0, c == 3 ? 1.0 : 0.0};
      Vec3 const b = unit + 0.2 * vector(), m = b + 0.25 * vector();
      e.before[c] = from + Vec3{b.x, stretch.y * b.y, b.z};
      e.now[c] = from + Vec3{m.x, stretch.y * m.y, m.z};
    }
    e.moves = n % 4;
    out.push_back(e);
  }
  return out;
}

Vec3 axis(int i) { return {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}; }

TEST(RelativeShape, GradientAndHessianAreThoseOfDifferences) {
  for (Example const& e : examples())
    for (double const delta : {0.1, 0.0}) {
      CornerChange const c = e.change();
      if (delta == 0 && c.d < 0.1) continue;
      ShapeSum sum;
      sum.add(c, delta);
      EXPECT_EQ(sum.value, e.f({}, delta));
      // Steps small against the shortest edge, large against rounding.
      double const h = 1e-5 / std::sqrt(c.bend);
      double const of_gradient = norm(sum.gradient) + sum.value / h * 1e-6;
      double most = 0;
      for (auto const& row : sum.hessian)
        for (double const v : row) most = std::max(most, std::abs(v));
      for (int i = 0; i < 3; ++i) {
        double const slope = (e.f(h * axis(i), delta) - e.f(-h * axis(i), delta)) / (2 * h);
        EXPECT_NEAR(component(sum.gradient, i), slope, 1e-5 * of_gradient);
        ShapeSum up, down;
        up.add(e.change(h * axis(i)), delta);
        down.add(e.change(-h * axis(i)), delta);
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(sum.hessian[i][j], component((0.5 / h) * (up.gradient - down.gradient), j), 1e-5 * most);
      }
    }
}

TEST(RelativeShape, MoveChangesNormAndVolumeExactly) {
  for (Example const& e : examples()) {
    Vec3 const v = 0.3 * (e.now[1] - e.now[2]);
    CornerChange const before = e.change(), after = e.change(v);
    EXPECT_NEAR(before.n_after(v), after.n, 1e-11 * (before.n + after.n));
    EXPECT_NEAR(before.d_after(v), after.d, 1e-11 * (std::abs(before.d) + before.n));
  }
}

TEST(RelativeShape, RigidMotionsAndScalesHaveTheSmallestValueAndNoGradient) {
  for (Example e : examples()) {
    if (!(std::abs(e.baseline().inverse_det) > 0)) continue;
    for (Vec3 const& turn : {Vec3{}, Vec3{0.3, -1.2, 2}})
      for (double const scale : {1.0, 0.01, 30.0}) {
        Mat3 const r = rotation_by(turn);
        for (std::size_t c = 0; c < 4; ++c) e.now[c] = scale * (r * e.before[c]) + Vec3{1, 2, 3};
        CornerChange const c = e.change();
        ShapeSum sum;
        sum.add(c, 0);
        EXPECT_NEAR(sum.value, 1, 1e-9);
        EXPECT_NEAR(norm(sum.gradient) * scale / std::sqrt(c.bend), 0, 1e-8);
      }
  }
}

TEST(RelativeShape, GrowsToInfinityTowardsInversionUnlessSmoothed) {
  EXPECT_EQ(relative_shape(3, 0, 0), HUGE_VAL);
  EXPECT_EQ(relative_shape(3, -1, 0), HUGE_VAL);
  EXPECT_GT(relative_shape(3, 1e-3, 0), relative_shape(3, 1e-2, 0));
  double last = relative_shape(3, 1, 0.1);
  for (double d = 0.9; d > -3; d -= 0.1) {  // falls with the volume, however far inverted
    double const f = relative_shape(3, d, 0.1);
    EXPECT_GT(f, last) << d;
    EXPECT_LT(f, 1e9);
    last = f;
  }
}

TEST(RelativeShape, CollapsedCornersAreLeftOut) {
  Vec3 const flat[3] = {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, point[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
             left[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  EXPECT_EQ(BaselineCorner::of(flat).inverse_det, 0);
  EXPECT_EQ(BaselineCorner::of(point).inverse_det, 0);
  EXPECT_EQ(BaselineCorner::of(left).inverse_det, -1);
}

TEST(DescentStep, LeadsToTheMinimumOfAParabolaAndDownOtherwise) {
  ShapeSum sum;  // f = x^2 + 2 y^2 + 3 z^2 + x y - x - 2 z
  sum.gradient = {-1, 0, -2};
  double const h[3][3] = {{2, 1, 0}, {1, 4, 0}, {0, 0, 6}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum.hessian[i][j] = h[i][j];
  Vec3 const step = descent_step(sum);
  EXPECT_NEAR(distance(step, {4.0 / 7, -1.0 / 7, 1.0 / 3}), 0, 1e-15);
  sum.hessian[1][1] = -4;
  EXPECT_LT(dot(descent_step(sum), sum.gradient), 0);
  sum = {};
  EXPECT_EQ(norm(descent_step(sum)), 0);
}

TEST(DescentStep, StaysInTheTangents) {
  test::Random random(3);
  for (int n = 0; n < 20; ++n) {
    ShapeSum sum;
    sum.gradient = random.vector(1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) sum.hessian[i][j] = sum.hessian[j][i] = random.between(-1, 1) + (i == j ? 2 : 0);
    Vec3 const a{0.6, 0, 0.8}, across[2] = {a, {0, 1, 0}};
    for (int count = 1; count <= 2; ++count) {
      ShapeSum held = sum;
      restrict_to_tangents(held, across, count);
      Vec3 const step = descent_step(held);
      for (int k = 0; k < count; ++k) EXPECT_NEAR(dot(step, across[k]), 0, 1e-14);
      EXPECT_LT(dot(step, sum.gradient), 0);
    }
  }
}

}  // namespace
}  // namespace gridmorph::kernels
