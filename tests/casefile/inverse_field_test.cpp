// Displacements taken back by iteration, and models in another coordinate system or at their deformed position.
#include "model_support.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mapping/inverse_field.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/mapping/point_field.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <random>

namespace gridmorph::test {
namespace {

using Map = std::function<Vec3(Vec3 const&)>;

InverseField::Field field_of(Map const& u) {
  return [u](std::span<Vec3 const> x, std::span<Vec3> out, bool) {
    for (std::size_t n = 0; n < x.size(); ++n) out[n] = u(x[n]);
  };
}

/// Nodes in a box that is no multiple of anything.
std::vector<Vec3> nodes() {
  std::vector<Vec3> out;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 3; ++k) out.push_back({0.1 + 0.21 * i, -0.3 + 0.17 * j, 0.05 + 0.31 * k});
  return out;
}

std::vector<Vec3> apply(InverseField const& inverse, Map const& u, std::vector<Vec3> const& x, double share = 1) {
  std::vector<Vec3> out(x.size());
  inverse(field_of(u), share, x, out);
  return out;
}

/// Linear, with eigenvalues 0.2 (1 + i), 0.2 (1 - i) and 0.1.
Vec3 linear(Vec3 const& x) { return {0.2 * x.x - 0.2 * x.y + 0.01, 0.2 * x.x + 0.2 * x.y - 0.02, 0.1 * x.z + 0.03}; }

TEST(InverseField, FindsTheColdPlaceOfEveryHotNodeOfALinearField) {
  InverseField const inverse("u", 1e-13, 100);
  auto const cold = nodes();
  std::vector<Vec3> hot;
  for (Vec3 const& x : cold) hot.push_back(x + linear(x));
  auto const u = apply(inverse, linear, hot);
  for (std::size_t n = 0; n < hot.size(); ++n) EXPECT_LT(distance(hot[n] + u[n], cold[n]), 2e-13) << n;
  InverseReport const report = inverse.report();
  EXPECT_EQ(report.evaluated, Index(hot.size()));
  EXPECT_LE(report.residual, 1e-13);
  // The residual falls by 0.2 sqrt(2) per iteration.
  double const first = 0.5, rate = 0.2 * std::sqrt(2.0);
  EXPECT_LE(report.iterations, int(std::ceil(std::log(1e-13 / first) / std::log(rate))) + 1);
  EXPECT_GE(report.iterations, 18);
}

TEST(InverseField, SaysWhatOneStepAloneLeaves) {
  InverseField const inverse("u", 1e-12, 100);
  auto const hot = nodes();
  (void)apply(inverse, linear, hot);
  double wanted = 0;  // of X = x - u(x): u(x - u(x)) - u(x)
  for (Vec3 const& x : hot) wanted = std::max(wanted, norm(linear(x - linear(x)) - linear(x)));
  EXPECT_NEAR(inverse.report().one_step, wanted, 1e-15);
  EXPECT_GT(wanted, 1e-2);
  auto const json = inverse_json(inverse);
  EXPECT_NEAR(double(json["residual_of_one_step"]), wanted, 1e-15);
  EXPECT_LE(double(json["residual"]), 1e-12);
  test::expect_all_in(describe_inverse(inverse), {"taken back by iteration", "tolerance 1e-12", "60 node positions"});
}

TEST(InverseField, TakesTurnsAndSharesOfThemBack) {
  RigidTransform const turn = rotation_about({0.2, 0.1, 0}, {0, 0.6, 0.8}, 0.6);
  Map const u = [&](Vec3 const& x) { return turn(x) - x; };
  InverseField const inverse("u", 1e-13, 200);
  auto const cold = nodes();
  for (double const share : {1.0, 0.5, -0.25, 0.0}) {
    std::vector<Vec3> hot;
    for (Vec3 const& x : cold) hot.push_back(x + share * u(x));
    auto const back = apply(inverse, u, hot, share);
    for (std::size_t n = 0; n < hot.size(); ++n) EXPECT_LT(distance(hot[n] + back[n], cold[n]), 4e-13) << share;
  }
}

TEST(InverseField, GivesEqualNodesEqualResultsWhateverTheyComeWith) {
  InverseField const inverse("u", 1e-9, 100);
  auto const all = nodes();
  auto const together = apply(inverse, linear, all);
  for (std::size_t n = 0; n < all.size(); ++n) EXPECT_TRUE(apply(inverse, linear, {all[n]})[0] == together[n]) << n;
}

TEST(InverseField, IsRefusedWhereItDoesNotContractWithTheResidual) {
  // X + u(X) = -0.5 X: there is one X, but iterations run away from it.
  InverseField const inverse("far.csv", 1e-9, 100);
  test::expect_all_in(test::message_of<MotionError>([&] {
                        (void)apply(
                            inverse, [](Vec3 const& x) { return -1.5 * x; }, nodes());
                      }),
                      {"far.csv", "X + u(X)", "after 8 iterations", "before"});
  InverseField const few("far.csv", 1e-12, 3);
  test::expect_all_in(test::message_of<MotionError>([&] { (void)apply(few, linear, nodes()); }),
                      {"after 3 iterations", "tolerance 1e-12", "raise inverse_iterations"});
}

/// A shell of 7 x 9 nodes, curved, and its untwist by 4 degrees from root to tip; places off it by up to a tenth of its
/// size.
class CoarseShell {
 public:
  explicit CoarseShell(unsigned seed) : random_(seed) {
    double const curve = between(-1.2, 1.2), chord = between(0.5, 2), twist = between(0.065, 0.075) / (2 * chord);
    size = 2 * chord;
    model = grid_model(
        7, 9,
        [&](double s, double t) {
          double const x = s - 0.5;
          return chord * Vec3{x, curve * (0.25 - x * x) + 0.05 * std::sin(3 * t), 2 * t};
        },
        [&](Vec3 const& x) {
          double const c = std::cos(twist * x.z), d = std::sin(twist * x.z);
          return Vec3{c * x.x - d * x.y, d * x.x + c * x.y, 1.002 * x.z} - x;
        },
        seed % 2 == 0);
    for (int n = 0; n < 2000; ++n)
      cold.push_back(chord * Vec3{between(-0.5, 0.5), 0.25 * curve + between(-0.3, 0.3), 2 * between(0, 1)});
  }

  StructuralModel model;
  std::vector<Vec3> cold;
  double size = 0;

 private:
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  std::mt19937 random_;
};

/// Places of which every other one is the hot place of a cold one, the rest anywhere: some of these lie in gaps that
/// the field leaves.
TEST(InverseField, ComesBackFromCoarseShellsWhereIterationsWouldGoToAndFro) {
  constexpr double all = 1;
  Index held = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CoarseShell const shell(seed);
    PointField const field(shell.model, FieldOptions{});
    auto const u = [&](std::span<Vec3 const> x, std::span<Vec3> out, bool iterates) {
      field.evaluate({&all, 1}, x, out, iterates);
    };
    std::vector<Vec3> hot(shell.cold.size()), back(hot.size()), again(hot.size());
    u(shell.cold, hot, true);
    double largest = 0;
    for (std::size_t n = 0; n < hot.size(); ++n) {
      largest = std::max(largest, norm(hot[n]));
      hot[n] = shell.cold[n] + (n % 2 == 0 ? 1.0 : 0.0) * hot[n];
    }
    double const tolerance = 1e-9 * shell.size;
    InverseField const inverse("shell.csv", tolerance, 100);
    ASSERT_NO_THROW(inverse(u, 1, hot, back, [&](auto places, auto anchors, std::span<Vec3> out) {
      field.held({&all, 1}, places, anchors, out);
    })) << seed;
    for (std::size_t n = 0; n < hot.size(); ++n) back[n] += hot[n];
    u(back, again, true);  // there once more
    InverseReport const report = inverse.report();
    Index in_gaps = 0;
    for (std::size_t n = 0; n < hot.size(); ++n) {
      double const off = distance(back[n] + again[n], hot[n]);
      in_gaps += off > 1.001 * tolerance ? 1 : 0;
      EXPECT_LT(off, 1.001 * std::max(tolerance, n % 2 == 0 ? 0 : report.jump)) << seed << " " << n;
    }
    EXPECT_LE(report.residual, tolerance) << seed;
    EXPECT_LT(report.jump, 0.01 * largest) << seed;
    EXPECT_LE(in_gaps, report.held) << seed;
    EXPECT_LT(report.held, Index(hot.size()) / 50) << seed;
    held += report.held;
  }
  EXPECT_GT(held, 0) << "no shell needs it";
}

class PlacedField : public ::testing::Test {
 protected:
  /// A cloud through the box, so that linear fields come out to round-off.
  void write_cloud(std::string const& name, Map const& place, Map const& u) const {
    std::string text = "x,y,z,dx,dy,dz\n";
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < 7; ++j)
        for (int k = 0; k < 7; ++k) {
          Vec3 const x{-0.4 + 0.37 * i, -0.9 + 0.31 * j, -0.5 + 0.34 * k}, p = place(x), d = u(x);
          text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", p.x, p.y, p.z, d.x, d.y, d.z);
        }
    folder.write(name, text);
  }
  [[nodiscard]] CaseFile read(std::string const& keys) const {
    return parse_case_file(
        "[mesh]\ninput = \"in.cgns\"\naxis = \"x\"\n[[motion]]\npatches = \"blade\"\nrule = \"field\"\n" + keys,
        folder.file("case.toml"));
  }
  [[nodiscard]] std::vector<Vec3> displacement(std::string const& keys, std::vector<Vec3> const& x) const {
    CaseFile const case_file = read(keys);
    std::vector<Vec3> out(x.size());
    std::get<FunctionRule>(case_file.motion.rules[0].rule).function(x, out);
    return out;
  }
  static Vec3 same(Vec3 const& x) { return x; }
  TemporaryFolder folder;
};

TEST_F(PlacedField, ColdFromHotIsThereAndBack) {
  write_cloud("u.csv", same, linear);
  auto const cold = nodes();
  auto const u = displacement("file = \"u.csv\"\n", cold);
  std::vector<Vec3> hot;
  for (std::size_t n = 0; n < cold.size(); ++n) hot.push_back(cold[n] + u[n]);
  auto const back = displacement("file = \"u.csv\"\ninverse = true\ninverse_tolerance = 1e-12\n", hot);
  double one_step = 0;
  auto const first_order = displacement("file = \"u.csv\"\nfactor = -1\n", hot);
  for (std::size_t n = 0; n < cold.size(); ++n) {
    EXPECT_LT(distance(hot[n] + back[n], cold[n]), 2e-12);
    one_step = std::max(one_step, distance(hot[n] + first_order[n], cold[n]));
  }
  EXPECT_GT(one_step, 1e-2) << "one step is of first order";
}

TEST_F(PlacedField, ColdFromHotTakesLoadsAndSharesTogether) {
  write_cloud("speed.csv", same, linear);
  write_cloud("heat.csv", same, [](Vec3 const& x) { return 0.05 * x; });
  auto const cold = nodes();
  std::vector<Vec3> hot;
  for (Vec3 const& x : cold) hot.push_back(x + 0.5 * (0.81 * linear(x) + 2 * (0.05 * x)));
  auto const back = displacement(
      "loads = [ { file = \"speed.csv\", factor = 0.81 }, { file = \"heat.csv\", factor = 2 } ]\namplitude = "
      "0.5\ninverse = true\ninverse_tolerance = 1e-12\n",
      hot);
  for (std::size_t n = 0; n < cold.size(); ++n) EXPECT_LT(distance(hot[n] + back[n], cold[n]), 2e-12);
}

TEST_F(PlacedField, ColdFromHotOfACoarseShellIsThereAndBackHoweverItIsGiven) {
  CoarseShell const shell(3);
  double const tolerance = 1e-9 * shell.size;
  std::string points = "x,y,z,dx,dy,dz\n", elements;
  for (std::size_t n = 0; n < shell.model.nodes.size(); ++n) {
    Vec3 const x = shell.model.nodes.position[n], u = shell.model.nodes.displacement[n];
    points += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", x.x, x.y, x.z, u.x, u.y, u.z);
  }
  for (std::size_t f = 0; f < shell.model.facets.size(); ++f) {
    elements += std::to_string(f + 1);
    for (std::int32_t const n : shell.model.facets[f].node) elements += "," + std::to_string(n + 1);
    elements += "\n";
  }
  folder.write("shell.csv", points);
  folder.write("elements.csv", elements);
  for (std::string const& keys : {std::string("file = \"shell.csv\"\nelements = \"elements.csv\"\n"),
                                  std::string("loads = [ { file = \"shell.csv\", elements = \"elements.csv\" } ]\n")}) {
    auto const there = displacement(keys, shell.cold);
    std::vector<Vec3> hot;
    for (std::size_t n = 0; n < there.size(); ++n) hot.push_back(shell.cold[n] + there[n]);
    auto back = displacement(keys + fmt::format("inverse = true\ninverse_tolerance = {}\n", tolerance), hot);
    for (std::size_t n = 0; n < hot.size(); ++n) back[n] += hot[n];
    auto const again = displacement(keys, back);
    for (std::size_t n = 0; n < hot.size(); ++n)
      EXPECT_LT(distance(back[n] + again[n], hot[n]), 1.001 * tolerance) << keys << n;
  }
}

TEST_F(PlacedField, AModelOfItsOwnCoordinatesIsTurnedAndShiftedIntoThoseOfTheMesh) {
  // The model's x runs along the mesh's z, in millimetres, about another origin.
  RigidTransform const to_mesh = rotation_about({0.3, -0.1, 0.2}, {0.6, 0, 0.8}, 0.7);
  Vec3 const shift{0.4, 0.02, -0.3};
  Map const to_model = [&](Vec3 const& x) { return 1e3 * to_mesh.inverse()(x - shift); };
  Map const turned = [&](Vec3 const& x) {
    Vec3 const origin = to_mesh.inverse()({0, 0, 0});
    return 1e3 * (to_mesh.inverse()(linear(x)) - origin);
  };
  write_cloud("own.csv", to_model, turned);
  write_cloud("plain.csv", same, linear);
  std::string const frame = fmt::format(
      "length_scale = 1e-3\nframe = {{ rotation = {{ axis = [0.6, 0, 0.8], origin = [0.3, -0.1, 0.2], angle_deg = "
      "{:.17g} }}, "
      "translation = [0.4, 0.02, -0.3] }}\n",
      0.7 * 180 / std::numbers::pi);
  auto const own = displacement("file = \"own.csv\"\n" + frame, nodes());
  auto const plain = displacement("file = \"plain.csv\"\n", nodes());
  auto const as_mode = displacement("modes = [ { file = \"own.csv\" } ]\n" + frame, nodes());
  for (std::size_t n = 0; n < own.size(); ++n) {
    EXPECT_LT(distance(own[n], plain[n]), 1e-12);
    EXPECT_LT(distance(as_mode[n], plain[n]), 1e-12);
    EXPECT_LT(distance(own[n], linear(nodes()[n])), 1e-12);
  }
}

TEST_F(PlacedField, AModelAtItsDeformedPositionBelongsToTheColdOne) {
  write_cloud(
      "hot.csv", [](Vec3 const& x) { return x + linear(x); }, linear);
  write_cloud(
      "mode.csv", [](Vec3 const& x) { return x + linear(x); },
      [](Vec3 const& x) {
        return Vec3{0, 0.1 * x.x, 0};
      });
  auto const cold = nodes();
  auto const u = displacement("file = \"hot.csv\"\npositions = \"deformed\"\n", cold);
  auto const with_mode =
      displacement("file = \"hot.csv\"\npositions = \"deformed\"\nmodes = [ { file = \"mode.csv\" } ]\n", cold);
  // Taken as it stands the displacement belongs to the hot position.
  std::vector<Vec3> hot;
  for (Vec3 const& x : cold) hot.push_back(x + linear(x));
  auto const at_hot = displacement("file = \"hot.csv\"\n", hot);
  for (std::size_t n = 0; n < cold.size(); ++n) {
    EXPECT_LT(distance(u[n], linear(cold[n])), 1e-12);
    EXPECT_LT(distance(with_mode[n], linear(cold[n]) + Vec3{0, 0.1 * cold[n].x, 0}), 1e-12);
    EXPECT_LT(distance(at_hot[n], linear(cold[n])), 1e-12);
  }
}

TEST_F(PlacedField, IsRefusedWithWhatWouldDo) {
  write_cloud("u.csv", same, linear);
  write_cloud(
      "other.csv", [](Vec3 const& x) { return 2 * x; }, linear);
  auto const refused = [&](std::string const& keys) {
    return test::message_of<ConfigError>([&] { (void)read(keys); });
  };
  test::expect_all_in(refused("file = \"u.csv\"\ninverse_iterations = 3\n"), {"inverse_iterations", "inverse = true"});
  test::expect_all_in(refused("file = \"u.csv\"\ninverse = true\ninverse_tolerance = 0\n"),
                      {"inverse_tolerance", "positive"});
  test::expect_all_in(refused("modes = [ { file = \"u.csv\" } ]\npositions = \"deformed\"\n"),
                      {"positions", "add file"});
  test::expect_all_in(refused("file = \"u.csv\"\npositions = \"deformed\"\nloads = [ { file = \"other.csv\" } ]\n"),
                      {"positions", "other.csv", "at the points of file"});
  test::expect_all_in(refused("file = \"u.csv\"\nframe = { }\n"), {"frame", "rotation", "translation"});
}

}  // namespace
}  // namespace gridmorph::test
