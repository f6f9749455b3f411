#include "hybrid_checks.hpp"
#include "support/reduced.hpp"

#include <generators/ball.hpp>
#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

namespace {

using namespace hybrid_checks;

struct Variant {
  char const* name;
  BallOptions options;
  double determinant;  ///< smallest: thin ropes and few layers have long tetrahedra
};

BallOptions with(Index elements, LayerElements layers) {
  BallOptions options;
  options.elements = elements;
  options.layer_elements = layers;
  return options;
}

std::vector<Variant> variants() {
  std::vector<Variant> all{{"mixed", with(50'000, LayerElements::mixed), 0.005},
                           {"prisms", with(60'000, LayerElements::prisms), 0.005},
                           {"hexahedra", with(70'000, LayerElements::hexahedra), 0.005},
                           {"plain", with(120'000, LayerElements::mixed), 0.005},
                           {"thin_long_rope", with(150'000, LayerElements::mixed), 0.005},
                           {"thick_short_rope", with(90'000, LayerElements::prisms), 0.005}};
  all[3].options.jitter = 0;
  all[3].options.shuffle = false;
  all[3].options.radius = 0.4;
  all[4].options.rope_radius = 0.08;
  all[4].options.rope_length = 9;
  all[4].options.first_cell = 1e-5;
  all[4].determinant = 0.001;
  all[5].options.rope_radius = 0.4;
  all[5].options.rope_length = 2.5;
  all[5].options.layers = 8;
  all[5].options.first_cell = 5e-3;
  return all;
}

/// All tests look at the same meshes.
class Ball : public testing::TestWithParam<Variant> {
 public:
  static void TearDownTestSuite() { made_.clear(); }

 protected:
  BallOptions const& options = GetParam().options;
  Mesh const& mesh = made(GetParam());

 private:
  static Mesh const& made(Variant const& variant) {
    auto const [at, is_new] = made_.try_emplace(variant.name);
    if (is_new) at->second = make_ball(variant.options);
    return at->second;
  }
  static inline std::map<std::string, Mesh> made_;
};

TEST_P(Ball, FacesAreSharedByTwoElementsOrBelongToOnePatch) { expect_conforming_and_covered(mesh); }

TEST_P(Ball, ElementsAreSoundAndFillTheBoundary) {
  Soundness const x = soundness(mesh);
  EXPECT_GT(x.smallest_volume, 0);
  EXPECT_GT(x.smallest_determinant, GetParam().determinant);
  EXPECT_NEAR(x.volume, enclosed_volume(mesh), 1e-9 * x.volume);
}

TEST_P(Ball, HasNearlyAsManyElementsAsAskedFor) {
  EXPECT_NEAR(double(mesh.n_elements()), double(options.elements), 0.1 * double(options.elements));
}

TEST_P(Ball, NodesLieOnSphereAndCylinder) {
  double const r = options.radius, rope = options.rope_radius * r,
               neck = std::sqrt(1 - options.rope_radius * options.rope_radius) * r;
  for (Index32 const n : patch_nodes(patch(mesh, "ball"))) {
    ASSERT_NEAR(norm(mesh.coordinates[n]), r, 1e-14 * r);
    ASSERT_LT(mesh.coordinates[n].z, neck * (1 + 1e-12));
  }
  double lowest = kernels::unbounded, highest = -kernels::unbounded;
  for (Index32 const n : patch_nodes(patch(mesh, "rope"))) {
    Vec3 const p = mesh.coordinates[n];
    ASSERT_NEAR(std::hypot(p.x, p.y), rope, 1e-14 * r);
    lowest = std::min(lowest, p.z);
    highest = std::max(highest, p.z);
  }
  EXPECT_NEAR(lowest, neck, 1e-14 * r);
  EXPECT_EQ(highest, rope_end(options));
}

TEST_P(Ball, RopeHangsFromTheCrane) {
  auto const on_rope = patch_nodes(patch(mesh, "rope")), on_crane = patch_nodes(patch(mesh, "crane"));
  std::vector<Index32> shared;
  std::set_intersection(on_rope.begin(), on_rope.end(), on_crane.begin(), on_crane.end(), std::back_inserter(shared));
  EXPECT_GE(shared.size(), 16U);
  for (Index32 const n : shared) EXPECT_EQ(mesh.coordinates[n].z, rope_end(options));
}

TEST_P(Ball, BoxFacesAreInTheirPlanes) {
  double const r = options.radius;
  struct Side {
    char const* name;
    double Vec3::*component;
    double at;
  };
  BallOptions const& o = options;
  double const top = 1 + o.rope_length + o.jib_height + o.above;
  for (Side const& side :
       {Side{"box_x_min", &Vec3::x, -o.behind}, Side{"box_x_max", &Vec3::x, o.mast_distance + o.mast_width + o.beyond},
        Side{"box_y_min", &Vec3::y, -o.beside}, Side{"box_y_max", &Vec3::y, o.beside},
        Side{"box_z_min", &Vec3::z, -o.below}, Side{"box_z_max", &Vec3::z, top}})
    for (Index32 const n : patch_nodes(patch(mesh, side.name)))
      ASSERT_NEAR(mesh.coordinates[n].*side.component, side.at * r, 1e-12 * r) << side.name;
}

TEST_P(Ball, LayersAreMadeOfTheElementsAskedFor) {
  auto const counts = count_types(mesh);
  auto const of = [&](ElementType type) { return counts[std::size_t(type)]; };
  EXPECT_GT(of(ElementType::tetrahedron), 0);
  EXPECT_EQ(of(ElementType::prism) > 0, options.layer_elements != LayerElements::hexahedra);
  EXPECT_EQ(of(ElementType::hexahedron) > 0, options.layer_elements != LayerElements::prisms);
  EXPECT_EQ(of(ElementType::pyramid) > 0, options.layer_elements != LayerElements::prisms);
}

TEST_P(Ball, FirstCellsAreAsHighAsAskedFor) {
  // Along the upper part of the rope, where the columns stand upright.
  double const wall = options.rope_radius * options.radius;
  double nearest = kernels::unbounded;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    double const height = std::hypot(p.x, p.y) - wall;
    if (p.z > 0.75 * rope_end(options) && p.z <= rope_end(options) && height > 1e-12 * wall)
      nearest = std::min(nearest, height);
  }
  EXPECT_NEAR(nearest, options.first_cell * options.radius, 1e-9 * options.radius);
}

TEST_P(Ball, IsTheSameEachTime) {
  Mesh const again = make_ball(options);
  EXPECT_TRUE(same_coordinates(mesh, again));
  EXPECT_EQ(mesh.elements.type, again.elements.type);
  EXPECT_TRUE(same_lists(mesh.elements.nodes, again.elements.nodes));
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_TRUE(same_lists(mesh.patches[p].faces, again.patches[p].faces)) << mesh.patches[p].name;
}

INSTANTIATE_TEST_SUITE_P(Options, Ball, testing::ValuesIn(variants()),
                         [](testing::TestParamInfo<Variant> const& info) { return std::string(info.param.name); });

TEST(BallMesh, AspectRatiosReachHundreds) {
  EXPECT_GT(soundness(make_ball(with(300'000, LayerElements::prisms))).largest_aspect_ratio, 500);
}

TEST(BallMesh, MeetsEverySizeAskedFor) {
  for (Index const wanted : {50'000, 100'000, 250'000, 600'000, 1'500'000}) {
    if (gridmorph::test::reduced() && wanted > 250'000) break;
    Mesh const mesh = make_ball(with(wanted, LayerElements::mixed));
    EXPECT_NEAR(double(mesh.n_elements()), double(wanted), 0.1 * double(wanted));
    EXPECT_GT(soundness(mesh).smallest_volume, 0) << wanted;
  }
}

TEST(BallMesh, ShiftsNodesOfTetrahedraAlone) {
  BallOptions options = with(80'000, LayerElements::mixed);
  options.shuffle = false;
  Mesh const shifted = make_ball(options);
  options.jitter = 0;
  Mesh const plain = make_ball(options);
  ASSERT_TRUE(same_lists(shifted.elements.nodes, plain.elements.nodes));
  std::vector<char> held(plain.n_nodes(), 0);
  for (Index e = 0; e < plain.n_elements(); ++e)
    if (plain.elements.type[e] != ElementType::tetrahedron)
      for (Index32 const n : plain.elements.nodes[e]) held[n] = 1;
  for (auto const& p : plain.patches)
    for (Index32 const n : p.faces.item) held[n] = 1;
  Index moved = 0, free = 0;
  for (Index n = 0; n < plain.n_nodes(); ++n) {
    bool const same = plain.coordinates[n] == shifted.coordinates[n];
    if (held[n] != 0) {
      ASSERT_TRUE(same) << n;
    }
    free += held[n] == 0 ? 1 : 0;
    moved += same ? 0 : 1;
  }
  EXPECT_GT(moved, free * 9 / 10);
}

TEST(BallMesh, ShuffledIsTheSameMeshInAnotherOrder) {
  BallOptions options = with(60'000, LayerElements::mixed);
  Mesh const shuffled = make_ball(options);
  options.shuffle = false;
  Mesh const ordered = make_ball(options);
  EXPECT_EQ(count_types(shuffled), count_types(ordered));
  auto const sorted = [](Mesh const& mesh) {
    std::vector<std::array<double, 3>> points;
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      points.push_back({mesh.coordinates.x(n), mesh.coordinates.y(n), mesh.coordinates.z(n)});
    std::sort(points.begin(), points.end());
    return points;
  };
  EXPECT_EQ(sorted(shuffled), sorted(ordered));
  EXPECT_FALSE(same_coordinates(shuffled, ordered));
  EXPECT_NEAR(soundness(shuffled).volume, soundness(ordered).volume, 1e-9 * soundness(ordered).volume);
}

std::string message_of(BallOptions const& options) {
  try {
    (void)make_ball(options);
  } catch (ConfigError const& error) {
    return error.what();
  }
  return "no error";
}

TEST(BallMesh, NamesEveryOptionThatIsWrong) {
  BallOptions options;
  options.rope_radius = 0.9;
  options.growth = 0.5;
  options.radius = -1;
  std::string const message = message_of(options);
  for (auto const* word : {"rope_radius is 0.9", "growth is 0.5", "radius is -1"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
  EXPECT_NE(message_of(with(2000, LayerElements::prisms)).find("2000 elements"), std::string::npos);
  options = {};
  options.layers = 60;
  EXPECT_NE(message_of(options).find("60 layers"), std::string::npos);
}

}  // namespace
