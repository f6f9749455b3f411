// Laws of the user's own, as tables and in messages.
#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/plan/law_table.hpp>

#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace gridmorph::test {
namespace {

double largest_error(LawTable const& table, OwnLaw const& law) {
  double worst = 0;
  for (int k = 0; k <= 9973; ++k) {
    double const t = k / 9973.0;
    worst = std::max(worst, std::abs(kernels::table_weight(table.knots.data(), table.n_intervals, t) - law.weight(t)));
  }
  return worst;
}

TEST(LawTable, OfACubicIsTheCubic) {
  OwnLaw const law{[](double t) { return t * (0.5 + t * (2 - 1.5 * t)); }, "cubic"};
  LawTable const table = tabulate(law);
  EXPECT_EQ(table.n_intervals, 64);
  EXPECT_LT(largest_error(table, law), 1e-15);
}

TEST(LawTable, OfASmoothLawKeepsItsBound) {
  using std::numbers::pi;
  OwnLaw const law{[](double t) { return t + 0.1 * std::sin(8 * pi * t); }, "wave"};
  LawTable const table = tabulate(law);
  double const bound = 0.1 * std::pow(8 * pi, 4) / (384 * std::pow(table.n_intervals, 4));
  double const worst = largest_error(table, law);
  EXPECT_LT(worst, 1.05 * bound + 1e-15);
  EXPECT_GT(worst, 0.2 * bound) << "the bound is no other than that of cubics";
  EXPECT_NEAR(table.error, worst, 0.1 * worst);
  EXPECT_LE(table.error, 1e-12);
}

TEST(LawTable, OfALawWithAKinkStopsAtTheMostKnots) {
  OwnLaw const law{[](double t) { return t < 0.3 ? 0.0 : (t - 0.3) / 0.7; }, "kink"};
  LawTable const table = tabulate(law);
  EXPECT_EQ(table.n_intervals, 4096);
  EXPECT_LT(largest_error(table, law), 1.0 / 4096);
  EXPECT_GT(table.error, 1e-12) << "what it says of itself";
}

TEST(LawTable, IsRefusedWhereNoLawIs) {
  auto const refused = [](std::function<double(double)> w, std::initializer_list<std::string_view> words) {
    expect_all_in(message_of<PlanError>([&] { (void)tabulate({std::move(w), "mine"}); }), words);
  };
  refused([](double t) { return 0.25 + t; }, {"mine", "0.25 at t = 0", "0 at t = 0 and 1 at t = 1"});
  refused([](double t) { return 0.5 * t; }, {"mine", "0.5 at t = 1"});
  refused([](double t) { return t > 0.4 && t < 0.6 ? std::numeric_limits<double>::infinity() : t; },
          {"mine", "not finite at t = 0.40"});
  refused({}, {"no function"});
}

TEST(Laws, BetweenWhatIsNowhereAreRefusedWithTheirLine) {
  PlanOptions options;
  options.volume.laws = {{{"wall", "inlett"}, Law::c1, {}, "case.toml:14"}};
  auto const text = message_of<PlanError>([&] {
    morph(box({5, 4, 6}, Shape::straight, 1), motion({rule({"u_min"}, function_rule(waves(0.1)))}), options);
  });
  expect_all_in(text, {"case.toml:14: ", "'inlett'", "no kind", "u_min"});
}

TEST(Laws, AreSaidWithTheNamesOfTheEndsOfTheirChains) {
  PlanOptions options;
  options.boundary_layers = {{{"u_min"}, BoundaryLayer::Extent::layers, 2, 0, BoundaryLayer::Mode::translate}};
  options.volume.laws = {{{"u_min", "u_max"}, Law::own, {[](double t) { return t * t; }, "square"}}};
  Outcome const r = morph(box({8, 7, 6}, Shape::straight, 1),
                          motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}),
                                  rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})}),
                          options);
  std::string const text = describe(r.plan());
  EXPECT_NE(text.find("'u_min' to 'u_max', law square"), std::string::npos) << text;
  std::string notes;
  for (std::string const& note : r.plan().notes) notes += note + "\n";
  EXPECT_NE(notes.find("law square is kept as 64 cubics"), std::string::npos) << notes;
}

}  // namespace
}  // namespace gridmorph::test
