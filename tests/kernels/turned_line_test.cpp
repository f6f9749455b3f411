// Shares of rotations by quaternions, and what ends that turn add to a line, against matrices of rotation and
// differences.
#include "support/random.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/turned_row.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::DualVec3;
using kernels::Index;
using kernels::TurnedEnd;
using kernels::TurnLaw;
using Q = kernels::Quaternion<Vec3>;

/// R y - y of the rotation about `axis` by `angle`.
Vec3 turned(Vec3 const& axis, double angle, Vec3 const& y) {
  return rotation_matrix((1 / norm(axis)) * axis, angle) * y - y;
}

/// The angle of a share f of a rotation: f of the chord between the quaternions, back on the sphere.
double shared(double f, double angle) {
  return 2 * std::atan2(f * std::sin(angle / 2), 1 - f * (1 - std::cos(angle / 2)));
}

/// That of the rotation about `turn` by its length.
Q quaternion(Vec3 const& turn) {
  double const angle = norm(turn);
  return kernels::quaternion_of(angle > 0 ? (std::tan(angle / 4) / angle) * turn : turn);
}

TEST(Quaternions, TurnAsMatricesDo) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    Vec3 const turn = random.vector(1.8), y = random.vector(1);
    if (norm(turn) > std::numbers::pi) continue;
    double const f = random.between(0, 1);
    EXPECT_LT(distance(quaternion(turn).turned(y), turned(turn, norm(turn), y)), 1e-14);
    EXPECT_LT(distance(Q::share(quaternion(turn), f).turned(y), turned(turn, shared(f, norm(turn)), y)), 1e-14);
  }
  EXPECT_EQ(quaternion(Vec3{}).turned({1, 2, 3}), Vec3{});
}

TEST(Quaternions, SharesAreCloseToThoseOfTheAngle) {
  for (auto const& [angle, degrees] : {std::pair{1.0, 0.25}, {2.0, 2.0}, {std::numbers::pi, 8.2}})
    for (double f = 0; f <= 1; f += 0.01)
      EXPECT_NEAR(shared(f, angle), f * angle, degrees * std::numbers::pi / 180) << angle << " " << f;
}

TEST(Quaternions, BetweenTwoOfOneAxisTurnAboutThatAxis) {
  Vec3 const axis{0.48, -0.6, 0.64}, y{1, 2, -0.5};
  double const a = 0.3, b = 1.4;
  Q const from = quaternion(a * axis), to = quaternion(b * axis);
  for (double const f : {0.0, 0.3, 0.5, 1.0})
    EXPECT_LT(distance(Q::between(from, to, f).turned(y), turned(axis, a + shared(f, b - a), y)), 1e-14);
}

/// Ends of seven lines that turn, with rates, and nodes on them.
struct Lines {
  static constexpr int n = 7;
  std::vector<double> values, rates;
  kernels::TurnedEndsWithRates ends;
  kernels::Chain chain{};
  std::vector<double> t;
  std::vector<Vec3> x;

  explicit Lines(TurnLaw law, unsigned turned_ends, unsigned seed) : values(8 * 2 * n), rates(8 * 2 * n) {
    Random random(seed);
    kernels::TurnedEnds<double> const value{values.data(), 2 * n}, rate{rates.data(), 2 * n};
    for (Index e = 0; e < 2 * n; ++e) {
      value.set(e, {quaternion(random.vector(1)), random.vector(2), e < n ? 0.1 * random.between(-1, 1) : 0});
      rate.set(e, {{random.vector(1), random.between(-1, 1)}, {}, e < n ? random.between(-1, 1) : 0});
    }
    ends = {{values.data(), 2 * n}, {}};
    chain.n_a = n;
    chain.n_b = 1;
    chain.turn = law;
    chain.turned_ends = turned_ends;
    chain.turn_reach = 12;
    chain.turn_scale = 1 / (kernels::far_growth(12) - 1);
    for (int w = 0; w < n; ++w) {
      t.push_back(random.between(0, 1));
      x.push_back(random.vector(3));
    }
  }
  [[nodiscard]] Vec3 node(int w) const { return kernels::turned_between(ends, chain, w, 0, t[w], x[w]); }
  /// Ends moved on along their rates.
  [[nodiscard]] Lines after(double dt) const {
    Lines moved = *this;
    for (std::size_t c = 0; c < values.size(); ++c) moved.values[c] += dt * rates[c];
    moved.ends = {{moved.values.data(), 2 * n}, {}};
    return moved;
  }
  [[nodiscard]] std::vector<Vec3> row() const {
    std::vector<Vec3> out(n);
    kernels::RowEnds const row{{nullptr, nullptr, nullptr}, 0, chain.section_size(), 1, t.data(), n};
    kernels::with_turns(ends, chain, row, kernels::Constant<1>(), [&](auto const& turn) {
      for (int w = 0; w < n; ++w) out[w] += turn.at(w, x[w]);
    });
    return out;
  }
};

class TurnedLines : public ::testing::TestWithParam<std::pair<TurnLaw, unsigned>> {};

TEST_P(TurnedLines, RowsAreTheirNodes) {
  auto const [law, ends] = GetParam();
  Lines const lines(law, ends, 3);
  std::vector<Vec3> const row = lines.row();
  for (int w = 0; w < Lines::n; ++w) EXPECT_EQ(row[w], lines.node(w)) << w;
}

TEST_P(TurnedLines, RatesAreDifferences) {
  auto const [law, ends] = GetParam();
  Lines lines(law, ends, 4);
  double const dt = 1e-6;
  Lines const before = lines.after(-dt), after = lines.after(dt);
  lines.ends.rates = {lines.rates.data(), 2 * Lines::n};
  std::vector<Vec3> const row = lines.row();
  for (int w = 0; w < Lines::n; ++w) {
    Vec3 const rate = lines.node(w), difference = (0.5 / dt) * (after.node(w) - before.node(w));
    EXPECT_LT(distance(rate, difference), 1e-8 * (1 + norm(difference))) << w;
    EXPECT_EQ(row[w], rate) << w;
  }
}

TEST_P(TurnedLines, NothingIsAddedAtAnEndThatTurnsAboutItself) {
  auto const [law, ends] = GetParam();
  Lines lines(law, ends, 5);
  bool const as_one = law == TurnLaw::near_field || law == TurnLaw::common;
  for (int w = 0; w < Lines::n; ++w)
    for (unsigned end = 0; end < (as_one ? 1 : 2); ++end) {
      Index const at = Index(end) * Lines::n + w;
      lines.t[w] = end;
      lines.x[w] = lines.ends.values[at].pivot;
      bool const turns_alone = (ends & (1u + end)) != 0 && (as_one || (ends & (2u - end)) == 0);
      if (!turns_alone) continue;
      EXPECT_EQ(lines.node(w), Vec3{}) << w << " " << end;
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, TurnedLines,
                         ::testing::Values(std::pair{TurnLaw::near_field, 3u}, std::pair{TurnLaw::near_field, 1u},
                                           std::pair{TurnLaw::square, 1u}, std::pair{TurnLaw::square, 2u},
                                           std::pair{TurnLaw::square, 3u}, std::pair{TurnLaw::c1, 3u},
                                           std::pair{TurnLaw::far, 1u}, std::pair{TurnLaw::far, 2u},
                                           std::pair{TurnLaw::common, 3u}));

TEST(NearFieldLaw, FallsFromOneToNoneWithoutASlopeAtEitherEnd) {
  EXPECT_EQ(kernels::near_field_weight(0), 1);
  EXPECT_EQ(kernels::near_field_weight(1), 0);
  EXPECT_NEAR(kernels::near_field_weight(1e-3), 1, 1.1e-4);
  EXPECT_NEAR(kernels::near_field_weight(1 - 1e-3), 0, 1e-8);
  for (double t = 0; t < 1; t += 0.01) EXPECT_GT(kernels::near_field_weight(t), kernels::near_field_weight(t + 0.01));
}

TEST(FarLaw, FallsFromOneToNoneWithoutASlopeAtItsStart) {
  kernels::Chain chain{};
  chain.turn_reach = 30;
  chain.turn_scale = 1 / (kernels::far_growth(30) - 1);
  EXPECT_EQ(kernels::FarLaw(chain)(0), 1);
  EXPECT_NEAR(kernels::FarLaw(chain)(1), 0, 1e-15);
  EXPECT_NEAR(kernels::FarLaw(chain)(1e-6), 1, 1e-9);
  for (double t = 0; t < 1; t += 0.01) EXPECT_GT(kernels::FarLaw(chain)(t), kernels::FarLaw(chain)(t + 0.01));
  // r da/dr of the turn is even: between two and twenty sizes of the body it changes by less than a factor of two.
  auto const shear = [&](double t) {
    return t * (kernels::FarLaw(chain)(t - 1e-5) - kernels::FarLaw(chain)(t + 1e-5));
  };
  double least = HUGE_VAL, most = 0;
  for (double t = 2.0 / 30; t < 20.0 / 30; t += 0.01) {
    least = std::min(least, shear(t));
    most = std::max(most, shear(t));
  }
  EXPECT_LT(most, 2 * least);
}

}  // namespace
}  // namespace gridmorph::test
