#include "case_text.hpp"

#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/mapping/point_field.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace gridmorph::test {
namespace {

Vec3 at(PointField const& field, Vec3 const& p) {
  std::array<Vec3, 1> const points{p};
  std::array<Vec3, 1> out{};
  field(points, out);
  return out[0];
}

PointCloud cloud_of(std::vector<Vec3> positions, std::function<Vec3(Vec3 const&)> const& u) {
  PointCloud cloud;
  cloud.source = "d.csv";
  for (Vec3 const& p : positions) {
    cloud.position.push_back(p);
    cloud.displacement.push_back(u(p));
    cloud.line.push_back(std::int64_t(cloud.line.size()) + 1);
  }
  return cloud;
}

/// A patch of a cylinder of radius 1 about x: nu points around, nv along.
std::vector<Vec3> cylinder(int nu, int nv, double length = 1) {
  std::vector<Vec3> out;
  for (int v = 0; v < nv; ++v)
    for (int u = 0; u < nu; ++u) {
      double const t = std::numbers::pi / 2 * u / (nu - 1);
      out.push_back({length * v / (nv - 1), std::cos(t), std::sin(t)});
    }
  return out;
}

std::vector<Vec3> random_points(int n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) {
    double const x = uniform(engine), y = uniform(engine), z = uniform(engine);
    out.push_back({x, y, z});
  }
  return out;
}

Vec3 wave(Vec3 const& p) { return {std::sin(3 * p.x), p.y * p.z, std::exp(-p.x) * p.y}; }
Vec3 linear(Vec3 const& p) { return {1 + 2 * p.x - p.y, 3 * p.z - 0.5 * p.x, p.x + p.y + p.z - 2}; }

TEST(PointField, GivesTheValuesOfTheFileBitForBitOnItsPoints) {
  auto const points = random_points(500, 1);
  PointField const field(cloud_of(points, wave), {});
  for (Vec3 const& p : points) EXPECT_EQ(at(field, p), wave(p));
  EXPECT_EQ(field.mapping().coincident, 500);
  EXPECT_EQ(field.mapping().max, 0);
}

TEST(PointField, IsExactForPositionsWrittenWithEightDigits) {
  auto const points = random_points(500, 2);
  PointCloud rounded = cloud_of(points, wave);
  for (Vec3& p : rounded.position)
    for (double* c : {&p.x, &p.y, &p.z}) {
      char text[32];
      std::snprintf(text, sizeof text, "%.7e", *c);
      *c = std::strtod(text, nullptr);
    }
  PointField const field(rounded, {});
  for (Vec3 const& p : points) EXPECT_EQ(at(field, p), wave(p));
  EXPECT_EQ(field.mapping().coincident, 500);
}

TEST(PointField, ReproducesConstantsExactlyEverywhere) {
  Vec3 const constant{0.1, -0.7, 1e-3};
  auto const u = [&](Vec3 const&) { return constant; };
  std::vector<std::vector<Vec3>> const clouds{
      random_points(300, 3), cylinder(20, 20), cylinder(200, 3), {{0, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}};
  for (auto const& points : clouds) {
    PointField const field(cloud_of(points, u), {});
    for (Vec3 const& q : random_points(100, 4)) EXPECT_EQ(at(field, q), constant);
  }
}

TEST(PointField, ReproducesLinearFieldsInsideACloudThatFillsSpace) {
  PointField const field(cloud_of(random_points(2000, 5), linear), {});
  for (Vec3 const& q : random_points(200, 6)) EXPECT_VEC3_NEAR(at(field, q), linear(q), 1e-9);
}

TEST(PointField, ReproducesLinearFieldsOnAPlaneOfPoints) {
  std::vector<Vec3> points;
  for (int j = 0; j < 15; ++j)
    for (int i = 0; i < 15; ++i) points.push_back({0.1 * i, 0.07 * j, 0.3 * 0.1 * i - 0.2 * 0.07 * j});
  PointField const field(cloud_of(points, linear), {});
  for (Vec3 q : random_points(100, 7)) {
    q.z = 0.3 * q.x - 0.2 * q.y;
    if (q.y > 0.98) continue;  // beyond the edge
    EXPECT_VEC3_NEAR(at(field, q), linear(q), 1e-9);
  }
}

TEST(PointField, ReproducesLinearFieldsOnSurfacesStretchedAHundredfold) {
  // 401 points around, 5 along: the nearest neighbours of any position all lie on one ring.
  PointField const field(cloud_of(cylinder(401, 5, 4), linear), {});
  for (int n = 0; n < 50; ++n) {
    double const t = 0.05 + 1.4 * n / 50;
    Vec3 const q{0.5 + 2.9 * n / 50, std::cos(t), std::sin(t)};
    EXPECT_VEC3_NEAR(at(field, q), linear(q), 0.02);  // zero gradient between rings would be off by 1
  }
}

TEST(PointField, ConvergesWithSecondOrderOnACurvedSurface) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    int const n = level == 0 ? 21 : 41;
    PointField const field(cloud_of(cylinder(n, n), wave), {});
    error[level] = 0;
    for (int s = 0; s < 400; ++s) {
      double const t = 0.2 + 1.1 * ((s * 37) % 400) / 400.0;
      Vec3 const q{0.1 + 0.8 * s / 400, std::cos(t), std::sin(t)};
      error[level] = std::max(error[level], distance(at(field, q), wave(q)));
    }
  }
  EXPECT_LT(error[0], 1e-2);  // spacing^2 times the largest second derivative (9) / 8
  EXPECT_LT(error[1], 0.4 * error[0]);
}

TEST(PointField, IsContinuousWhereItMeetsThePoints) {
  auto const points = random_points(200, 8);
  PointField const field(cloud_of(points, wave), {});
  for (Vec3 const& p : points) {
    double last = 1;
    for (double const d : {1e-2, 1e-4, 1e-6}) {
      double const jump = distance(at(field, p + Vec3{d, -d, 0.5 * d}), wave(p));
      EXPECT_LT(jump, 20 * d);
      EXPECT_LE(jump, last);
      last = jump;
    }
  }
}

TEST(PointField, DoesNotExtrapolateFarOffASurface) {
  auto const steep = [](Vec3 const& p) { return Vec3{100 * p.z, 0, 0}; };
  PointField const field(cloud_of(cylinder(30, 30), steep), {});
  for (double const off : {0.5, 2.0, 100.0}) {
    Vec3 const u = at(field, {0.5, off * std::cos(0.7), off * std::sin(0.7)});
    EXPECT_GT(u.x, -100) << off;
    EXPECT_LT(u.x, 200) << off;
  }
}

TEST(PointField, ReportsTheMappingDistance) {
  PointField const field(cloud_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, linear), {});
  std::vector<Vec3> const q{{0, 0, 0}, {1, 0, 0.3}, {0, 1, -0.1}};
  std::vector<Vec3> u(3);
  field(q, u);
  auto const m = field.mapping();
  EXPECT_EQ(m.evaluated, 3);
  EXPECT_EQ(m.coincident, 1);
  EXPECT_DOUBLE_EQ(m.max, 0.3);
  EXPECT_DOUBLE_EQ(m.mean, 0.4 / 3);
  EXPECT_EQ(m.farthest, q[1]);
  EXPECT_NE(describe_mapping(field).find("1 of 3"), std::string::npos);
}

TEST(PointField, GoesOnBeyondTheEdgeOrNotAsTold) {
  std::vector<Vec3> plane;
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 11; ++i) plane.push_back({0.1 * i, 0.1 * j, 0});
  auto const slope = [](Vec3 const& p) { return Vec3{p.x, 0, 0}; };
  FieldOptions options;
  PointField const onward(cloud_of(plane, slope), options);
  EXPECT_NEAR(at(onward, {1.05, 0.52, 0}).x, 1.05, 1e-10);
  EXPECT_EQ(onward.mapping().extrapolated, 1);
  EXPECT_NEAR(onward.mapping().max_beyond, 0.05, 1e-12);
  options.extrapolation = Extrapolation::nearest;
  PointField const held(cloud_of(plane, slope), options);
  EXPECT_NEAR(at(held, {1.05, 0.52, 0}).x, 1, 1e-10);
  EXPECT_NEAR(at(held, {0.52, 0.48, 0}).x, 0.52, 1e-10) << "inside nothing changes";
  EXPECT_EQ(held.mapping().extrapolated, 1);
  options.max_extrapolation = 0.02;
  PointField const strict(cloud_of(plane, slope), options);
  EXPECT_NO_THROW(at(strict, {1.01, 0.52, 0}));
  auto const lines = error_lines<MotionError>([&] { at(strict, {1.05, 0.52, 0}); });
  EXPECT_TRUE(reported(lines, "d.csv: ", {"beyond the edge of the points", "max_extrapolation = 0.02"}));
}

TEST(PointField, PositionsBetweenThePointsAreNotExtrapolated) {
  PointField const field(cloud_of(cylinder(31, 31), wave), {});
  for (int s = 0; s < 200; ++s) {
    double const t = 0.05 + 1.45 * ((s * 37) % 200) / 200.0;
    at(field, {0.02 + 0.96 * s / 200, 1.01 * std::cos(t), 1.01 * std::sin(t)});
  }
  EXPECT_EQ(field.mapping().extrapolated, 0);
}

TEST(PointField, LeaveOneOutFindsThePointThatDoesNotFit) {
  auto cloud = cloud_of(random_points(500, 11), linear);
  EXPECT_LT(PointField(cloud, {}).leave_one_out().rms, 5e-3);
  cloud.displacement[123] += Vec3{0, 5, 0};
  auto const e = PointField(cloud, {}).leave_one_out();
  EXPECT_EQ(e.tried, 500);
  EXPECT_LT(distance(cloud.position[e.worst], cloud.position[123]), 0.25) << "the point itself, or one fitted with it";
  EXPECT_GT(e.max, 0.3);
}

TEST(PointField, ScalesLengthsAndAmplitudes) {
  FieldOptions options;
  options.length_scale = 1e-3;
  options.factor = 2;
  PointField const field(cloud_of({{1000, 0, 0}, {0, 1000, 0}}, [](Vec3 const&) { return Vec3{1, 2, 3}; }), options);
  EXPECT_VEC3_NEAR(at(field, {1, 0, 0}), (Vec3{2e-3, 4e-3, 6e-3}), 1e-18);
}

TEST(PointField, RefusesPositionsBeyondTheLargestDistance) {
  FieldOptions options;
  options.max_distance = 0.1;
  PointField const field(cloud_of({{0, 0, 0}, {1, 0, 0}}, linear), options);
  EXPECT_NO_THROW(at(field, {0.05, 0, 0}));
  auto const lines = error_lines<MotionError>([&] { at(field, {0.5, 0, 0}); });
  EXPECT_TRUE(reported(lines, "d.csv: ", {"(0.5, 0, 0)", "0.5", "max_distance = 0.1"}));
}

/// A blade 0.25 high and 0.1 long of 101 x 61 nodes, off the origin and finer towards its edges.
std::vector<Vec3> skin_of_blade(double thickness = 0.02) {
  std::vector<Vec3> out;
  for (int v = 0; v <= 60; ++v)
    for (int u = 0; u <= 100; ++u) {
      double const t = std::numbers::pi * u / 50, s = 0.5 - 0.5 * std::cos(std::numbers::pi * v / 60);
      out.push_back({0.05 * std::cos(t), 0.5 * thickness * std::sin(t) + 0.02 * s, 0.3 + 0.25 * s});
    }
  return out;
}

std::vector<Vec3> mapped(std::vector<Vec3> points, std::function<Vec3(Vec3 const&)> const& map) {
  for (Vec3& p : points) p = map(p);
  return points;
}

std::string refusal_of(std::vector<Vec3> const& points, FieldOptions const& options = {},
                       std::vector<Vec3> const& skin = skin_of_blade()) {
  try {
    PointField(cloud_of(points, wave), options).expect(skin);
  } catch (MotionError const& e) {
    return e.what();
  }
  return {};
}

TEST(PointField, RefusesPointsThatLieElsewhereThanTheNodes) {
  auto const skin = skin_of_blade();
  EXPECT_EQ(refusal_of(skin), "");
  std::string const mm = refusal_of(mapped(skin, [](Vec3 const& p) { return 1000 * p; }));
  EXPECT_NE(mm.find("length_scale = 0.001 would fit"), std::string::npos) << mm;
  EXPECT_NE(mm.find("max_distance"), std::string::npos) << mm;
  std::string const inch = refusal_of(mapped(skin, [](Vec3 const& p) { return 1 / 0.0254 * p; }));
  EXPECT_NE(inch.find("inch"), std::string::npos) << inch;
  EXPECT_NE(refusal_of(mapped(skin, [](Vec3 const& p) { return Vec3{p.x, p.z, p.y}; })), "") << "y and z swapped";
  EXPECT_NE(refusal_of(mapped(skin, [](Vec3 const& p) { return Vec3{p.x, p.y, -p.z}; })), "") << "another sign";
  EXPECT_NE(refusal_of({skin.begin(), skin.begin() + std::ptrdiff_t(skin.size() / 2)}), "") << "half of the rows";
  EXPECT_NE(refusal_of({skin.begin(), skin.begin() + std::ptrdiff_t(skin.size() / 100)}), "") << "1 % of the rows";
}

TEST(PointField, RefusesRowsOfOneSideOfAThinBlade) {
  // The other side is nearer than 5 % of the size, and has points all around.
  auto const skin = skin_of_blade(0.012);
  std::vector<Vec3> side;
  for (std::size_t n = 0; n < skin.size(); ++n)
    if (n % 101 <= 50) side.push_back(skin[n]);
  std::string const said = refusal_of(side, {}, skin);
  EXPECT_NE(said.find("farther than two spacings from its points"), std::string::npos) << said;
}

/// Every so many nodes along and across.
std::vector<Vec3> thinned(std::vector<Vec3> const& skin, std::size_t along, std::size_t across) {
  std::vector<Vec3> out;
  for (std::size_t n = 0; n < skin.size(); ++n)
    if (n / 101 % across == 0 && n % 101 % along == 0) out.push_back(skin[n]);
  return out;
}

TEST(PointField, TakesCoarserPointsAndThoseOfAnotherSkin) {
  auto const skin = skin_of_blade();
  for (std::size_t const along : {1, 2, 3})
    for (std::size_t const across : {1, 2, 3}) EXPECT_EQ(refusal_of(thinned(skin, along, across)), "");
  auto const coarse = thinned(skin, 4, 2);
  EXPECT_EQ(refusal_of(coarse), "");
  EXPECT_EQ(refusal_of(mapped(coarse, [](Vec3 const& p) { return p + Vec3{0.001, 0.0005, 0}; })), "");
}

TEST(PointField, TakesPointsAsFarAsTheLargestDistanceAllows) {
  FieldOptions options;
  options.max_distance = 2;
  EXPECT_EQ(refusal_of(mapped(skin_of_blade(), [](Vec3 const& p) { return Vec3{p.x, p.y, -p.z}; }), options), "");
}

TEST(PointField, SaysWhichNodesAreFarFromItsPoints) {
  auto const skin = skin_of_blade();
  auto const reached = [](Vec3 const& p) { return p.z < 0.3 + 0.25 * 0.97; };
  std::vector<Vec3> points;
  for (Vec3 const& p : skin)
    if (reached(p)) points.push_back(p);
  PointField const field(cloud_of(points, wave), {});
  field.expect(skin);
  std::vector<Vec3> u(skin.size());
  field(skin, u);
  field.judge();
  std::string const text = far_from_model(field);
  EXPECT_NE(text.find("% of the size of its patches"), std::string::npos) << text;

  PointField const whole(cloud_of(skin, wave), {});
  whole.expect(skin);
  whole(skin, u);
  EXPECT_EQ(far_from_model(whole), "");
}

TEST(PointField, RefusesPositionsThatAreNotFinite) {
  PointField const field(cloud_of({{0, 0, 0}, {1, 0, 0}}, linear), {});
  EXPECT_TRUE(reported(error_lines<MotionError>([&] { at(field, {NAN, 0, 0}); }), "d.csv: ", {"nan", "not finite"}));
}

TEST(PointField, ReportsBothLinesOfAPointWithTwoDisplacements) {
  auto const lines =
      error_lines([&] { PointField(parse_point_cloud("0,0,0,1,0,0\n1,0,0,0,0,0\n0,0,0,2,0,0\n", "d.csv"), {}); });
  EXPECT_TRUE(reported(lines, "d.csv:3: ", {"(0, 0, 0)", "(2, 0, 0)", "(1, 0, 0)", "line 1"}));
}

TEST(PointField, KeepsPointsGivenTwiceAlikeOnce) {
  PointField const field(parse_point_cloud("0,0,0,1,0,0\n1,0,0,0,0,0\n0,0,0,1,0,0\n", "d.csv"), {});
  EXPECT_EQ(field.size(), 2u);
  EXPECT_EQ(at(field, {0, 0, 0}), (Vec3{1, 0, 0}));
}

TEST(PointField, DoesNotDependOnTheOrderOfEvaluation) {
  PointField const field(cloud_of(random_points(300, 9), wave), {});
  auto const q = random_points(50, 10);
  std::vector<Vec3> together(q.size());
  field(q, together);
  for (std::size_t n = q.size(); n-- > 0;) EXPECT_EQ(at(field, q[n]), together[n]);
}

}  // namespace
}  // namespace gridmorph::test
