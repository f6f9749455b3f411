// Displacement mapped from the elements of a structural model, against fields with known answers.
#include "model_support.hpp"

#include <gridmorph/mapping/facet_map.hpp>

namespace gridmorph::test {
namespace {

Vec3 linear(Vec3 const& p) { return {1 + 2 * p.x - p.y, 3 * p.z - 0.5 * p.x, p.x + p.y + p.z - 2}; }
Vec3 wave(Vec3 const& p) { return {std::sin(3 * p.x), p.y * p.z, std::exp(-p.x) * p.y}; }
Vec3 slanted(double s, double t) { return {s, t, 0.3 * s - 0.2 * t}; }
/// Quadrilaterals of all shapes in the plane of slanted().
Vec3 skewed(double s, double t) {
  double const u = s + 0.06 * std::sin(7 * t) * s * (1 - s), v = t + 0.08 * std::sin(5 * s) * t * (1 - t);
  return slanted(u, v);
}

std::vector<Vec3> inside(std::function<Vec3(double, double)> const& place, int n) {
  std::vector<Vec3> out;
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) out.push_back(place((i + 0.31) / (n + 1), (j + 0.17) / (n + 1)));
  return out;
}

std::function<Vec3(Vec3 const&)> rigid_motion(RigidTransform const& motion) {
  return [motion](Vec3 const& p) { return motion(p) - p; };
}

FieldOptions options_of(Extrapolation extrapolation, bool turn = true) {
  FieldOptions options;
  options.extrapolation = extrapolation;
  options.turn_offset = turn;
  return options;
}

TEST(ElementMapping, ReproducesLinearFieldsOnFlatElementsToRoundOff) {
  for (bool const triangles : {false, true}) {
    PointField const field(grid_model(7, 5, skewed, linear, triangles), {});
    EXPECT_LT(largest_error(field, inside(slanted, 23), linear), 1e-13) << triangles;
  }
}

TEST(ElementMapping, GivesTheValuesOfTheFileBitForBitAtItsNodes) {
  auto const model = grid_model(9, 6, quarter_cylinder(1), wave);
  PointField const field(model, {});
  EXPECT_EQ(mapped(field, model.nodes.position), model.nodes.displacement);
  EXPECT_EQ(field.mapping().coincident, 54);
}

TEST(ElementMapping, FollowsTheBilinearFieldOfAWarpedQuadrilateral) {
  auto const saddle = [](double s, double t) { return Vec3{s, t, 0.4 * s * t}; };
  auto const bilinear = [](Vec3 const& p) { return Vec3{p.x * p.y, 1 - 2 * p.x * p.y, p.x}; };
  PointField const field(grid_model(2, 2, saddle, bilinear), options_of(Extrapolation::linear, false));
  for (auto const& p : inside(saddle, 9)) {
    // Off the surface along its normal the closest point is p again.
    Vec3 const n{-0.4 * p.y, -0.4 * p.x, 1};
    for (double const off : {0.0, 0.2, -0.3}) EXPECT_VEC3_NEAR(mapped(field, {p + off * n})[0], bilinear(p), 1e-11);
  }
}

TEST(ElementMapping, ConvergesWithSecondOrderBetweenCurvedSkinsOfDifferentResolution) {
  // The fine skin lies on the true cylinder, the coarse one on its chords.
  auto const fine = inside(quarter_cylinder(1), 40);
  double last = 0;
  for (int const n : {9, 17, 33, 65}) {
    PointField const field(grid_model(n, n, quarter_cylinder(1), wave), {});
    double const error = largest_error(field, fine, wave);
    if (last > 0) {
      EXPECT_LT(error, 0.3 * last) << n;
      EXPECT_GT(error, 0.2 * last) << n;
    }
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

TEST(ElementMapping, CarriesTheOffsetBetweenSkinsThroughLargeRotations) {
  // A skin 20 % outside of the coarse model turns with it, rigidly, by any angle.
  std::vector<Vec3> skin = inside(quarter_cylinder(1.2), 15);
  for (double const angle : {0.01, 0.5, 1.5, 3.0}) {
    RigidTransform const turn = rotation_about({0.3, -1, 2}, {1, 2, -0.5}, angle);
    PointField const field(grid_model(12, 4, quarter_cylinder(1), rigid_motion(turn)), {});
    EXPECT_LT(largest_error(field, skin, rigid_motion(turn)), 2e-13) << angle;
  }
}

TEST(ElementMapping, TranslatesTheOffsetWhenTold) {
  RigidTransform const turn = rotation_about({0, 0, 0}, {1, 0, 0}, 0.4);
  PointField const field(grid_model(5, 5, slanted, rigid_motion(turn)), options_of(Extrapolation::linear, false));
  Vec3 const foot = slanted(0.37, 0.61), normal{-0.3, 0.2, 1};
  EXPECT_VEC3_NEAR(mapped(field, {foot + 0.1 * normal})[0], turn(foot) - foot, 1e-13);
}

TEST(ElementMapping, TurnsThinPlatesIntoSolidBlades) {
  // Bending of a plate, w = c x^2: the skin above it moves to the normal of the bent plate, -z w'(x) along x.
  double const c = 1e-4, half_thickness = 0.05;
  auto const bend = [&](Vec3 const& p) { return Vec3{0, 0, c * p.x * p.x}; };
  auto const plate = [](double s, double t) { return Vec3{s, t, 0}; };
  PointField const field(grid_model(41, 5, plate, bend), {});
  for (double const x : {0.2, 0.5, 0.8}) {
    Vec3 const u = mapped(field, {{x, 0.4, half_thickness}})[0];
    EXPECT_NEAR(u.x, -half_thickness * 2 * c * x, 0.02 * half_thickness * 2 * c * x);
    EXPECT_NEAR(u.z, c * x * x, 1e-7);
  }
}

TEST(ElementMapping, ExtrapolatesBeyondEdgesAsTold) {
  auto const plate = [](double s, double t) { return Vec3{s, t, 0}; };
  auto const stretch = [](Vec3 const& p) { return Vec3{0.1 * p.x, 0, 0}; };
  auto const model = grid_model(5, 5, plate, stretch);
  std::vector<Vec3> const at{{1.1, 0.4, 0}, {1.5, 0.4, 0}, {-0.2, 1.2, 0}};
  PointField const onward(model, options_of(Extrapolation::linear));
  auto const u = mapped(onward, at);
  EXPECT_NEAR(u[0].x, 0.11, 1e-14);
  EXPECT_NEAR(u[1].x, 0.125, 1e-14) << "no farther than one element of 0.25";
  EXPECT_NEAR(u[2].x, -0.02, 1e-14) << "round a corner";
  PointField const held(model, options_of(Extrapolation::nearest));
  auto const v = mapped(held, at);
  EXPECT_NEAR(v[0].x, 0.1, 1e-14);
  EXPECT_NEAR(v[2].x, 0, 1e-14);
  EXPECT_EQ(onward.mapping().extrapolated, 3);
  EXPECT_NEAR(onward.mapping().max_beyond, 0.5, 1e-14);
  EXPECT_EQ(onward.mapping().farthest_beyond, at[1]);
}

TEST(ElementMapping, PositionsOffTheSurfaceButInsideItsEdgesAreNotExtrapolated) {
  PointField const field(grid_model(12, 4, quarter_cylinder(1), wave), {});
  static_cast<void>(mapped(field, inside(quarter_cylinder(1.3), 12)));
  EXPECT_EQ(field.mapping().extrapolated, 0);
  EXPECT_NEAR(field.mapping().max, 0.3, 0.01);
}

TEST(ElementMapping, RefusesPositionsTooFarBeyondTheEdge) {
  FieldOptions options;
  options.max_extrapolation = 0.2;
  PointField const field(grid_model(5, 5, slanted, linear), options);
  EXPECT_NO_THROW(mapped(field, {slanted(1.1, 0.5)}));
  auto const lines = error_lines<MotionError>([&] { mapped(field, {slanted(1.6, 0.5)}); });
  EXPECT_TRUE(reported(lines, "d.csv: ", {"beyond the edge of the elements", "max_extrapolation = 0.2"}));
}

TEST(ElementMapping, ZeroDisplacementGivesExactlyZeroEverywhere) {
  PointField const field(grid_model(9, 5, quarter_cylinder(1), [](Vec3 const&) { return Vec3{}; }), {});
  auto at = inside(quarter_cylinder(1.1), 9);
  at.push_back({3, 0.2, 0.9});
  for (Vec3 const& u : mapped(field, at)) EXPECT_EQ(u, (Vec3{0, 0, 0}));
}

TEST(ElementMapping, ConstantsComeOutExactly) {
  Vec3 const constant{0.1, -0.7, 1e-3};
  PointField const field(grid_model(9, 5, quarter_cylinder(1), [&](Vec3 const&) { return constant; }), {});
  for (Vec3 const& u : mapped(field, inside(quarter_cylinder(1.1), 9))) EXPECT_EQ(u, constant);
}

TEST(ElementMapping, HotToColdToHotReturnsToTheStart) {
  // Hot to cold with the given field; then the cold coarse model carries the opposite field back.
  auto const heat = [](Vec3 const& p) { return Vec3{0.02 * p.x, 0.01 * p.y * p.x, -0.015 * p.z}; };
  double last = 0;
  for (int const n : {9, 17, 33}) {
    auto hot = grid_model(n, n, quarter_cylinder(1), heat);
    auto cold = hot;
    for (std::size_t i = 0; i < hot.nodes.size(); ++i) {
      cold.nodes.position[i] = hot.nodes.position[i] + hot.nodes.displacement[i];
      cold.nodes.displacement[i] = -hot.nodes.displacement[i];
    }
    PointField const down(hot, {}), up(cold, {});
    auto const skin = inside(quarter_cylinder(1.05), 25);
    auto moved = skin;
    auto const u = mapped(down, skin);
    for (std::size_t i = 0; i < skin.size(); ++i) moved[i] = skin[i] + u[i];
    auto const back = mapped(up, moved);
    double worst = 0;
    for (std::size_t i = 0; i < skin.size(); ++i) worst = std::max(worst, distance(moved[i] + back[i], skin[i]));
    EXPECT_LT(worst, 2e-5);
    if (last > 0) {
      EXPECT_LT(worst, 0.75 * last) << n;
    }
    last = worst;
  }
}

TEST(ElementMapping, FindsTheClosestElementAmongMany) {
  // Against a search through all elements, on random triangles.
  StructuralModel model;
  model.nodes.source = "d.csv";
  unsigned state = 1;
  auto const random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24); };
  for (int t = 0; t < 200; ++t) {
    Vec3 const at{random(), random(), random()};
    for (int c = 0; c < 3; ++c) {
      model.nodes.position.push_back(at + Vec3{0.1 * random(), 0.1 * random(), 0.1 * random()});
      model.nodes.displacement.push_back({});
      model.nodes.line.push_back(3 * t + c + 1);
    }
    model.facets.push_back({{3 * t, 3 * t + 1, 3 * t + 2, -1}, t + 1});
  }
  FacetMap const map(model, Extrapolation::nearest, 0);
  for (int n = 0; n < 200; ++n) {
    Vec3 const q{random(), random(), random()};
    // Closest point by brute force over a fine sampling of every triangle: never closer than the answer by more than
    // rounding, and the answer never farther than the sampling allows.
    double sampled = 1e9;
    for (auto const& f : model.facets)
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; i + j <= 20; ++j) {
          Vec3 const p = (i / 20.0) * model.nodes.position[f.node[0]] + (j / 20.0) * model.nodes.position[f.node[1]] +
                         ((20 - i - j) / 20.0) * model.nodes.position[f.node[2]];
          sampled = std::min(sampled, distance(p, q));
        }
    double const found = map.stencil(q).distance;
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 0.01);
  }
}

TEST(ElementMapping, RefusesElementsWithoutArea) {
  auto model = grid_model(
      3, 3,
      [](double s, double) {
        return Vec3{s, 0, 0};
      },
      linear);
  for (std::size_t n = 0; n < model.nodes.size(); ++n) model.nodes.position[n].x += 1e-3 * double(n);
  EXPECT_TRUE(reported(error_lines([&] { PointField(model, {}); }), "e.csv:1: ", {"has no area"}));
}

TEST(ElementMapping, LeaveOneOutShrinksWithTheSquareOfTheSpacingAndBoundsTheError) {
  auto const fine = inside(quarter_cylinder(1), 30);
  double last = 0;
  for (int const n : {17, 33}) {
    PointField const field(grid_model(n, n, quarter_cylinder(1), wave), {});
    auto const estimate = field.leave_one_out();
    EXPECT_EQ(estimate.tried, n * n);
    EXPECT_GT(estimate.max * 1.3, largest_error(field, fine, wave));  // 1.3: the largest displacement
    if (last > 0) {
      EXPECT_LT(estimate.rms, 0.4 * last);
    }
    last = estimate.rms;
  }
}

TEST(NodalRotations, AreThoseOfRigidMotionsUpToNearlyHalfATurn) {
  for (double const angle : {1e-9, 0.3, 2.0, 3.1}) {
    Vec3 const axis = (1 / std::sqrt(14.0)) * Vec3{1, -2, 3};
    auto const turn = rigid_motion(rotation_about({1, 1, 0}, axis, angle));
    auto const model = grid_model(6, 5, quarter_cylinder(1), turn);
    for (Vec3 const& w : nodal_rotations(model, model.nodes.displacement)) EXPECT_VEC3_NEAR(w, angle * axis, 1e-12);
  }
}

}  // namespace
}  // namespace gridmorph::test
