// Features that keep their shape on walls that do not.
#include "plate_with_holes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

/// Bends and stretches the plate, and leaves its sides.
Vec3 bent(Vec3 const& p) {
  double const s = std::sin(std::numbers::pi * p.x / 16), t = std::sin(std::numbers::pi * p.y / 10);
  return {0.9 * s * s * t * t, 0.3 * s * s * t * t, 0.8 * s * s * t * t};
}

/// The rules of a mesh of blocks, or of the same cells as elements.
struct Rules {
  UnstructuredCase elements;
  std::optional<BoundaryMotion> of;

  Rules(Mesh const& mesh, bool blocks, Motion const& motion) : elements(to_hexahedra(mesh)) {
    if (blocks)
      of.emplace(mesh, resolve(mesh, motion));
    else
      of.emplace(std::make_shared<Boundary const>(elements.mesh, elements.topology, elements.face_patches),
                 resolve(elements.mesh, motion));
  }

  struct Nodes {
    std::vector<Vec3> x, u;
  };
  /// Of all patches of a family, by its rule.
  [[nodiscard]] Nodes nodes(std::string const& family) const {
    Nodes out;
    for (std::size_t p = 0; p < of->boundary().patches().size(); ++p) {
      if (of->boundary().patches()[p].families.front() != family) continue;
      std::vector<Vec3> const x = of->boundary().points(int(p));
      std::vector<Vec3> u(x.size());
      of->displacement(of->motion().patch[p].rule, x, u);
      out.x.insert(out.x.end(), x.begin(), x.end());
      out.u.insert(out.u.end(), u.begin(), u.end());
    }
    return out;
  }
};

Motion carried(VectorField const& field, CarryRule const& carry = {{"plate"}}) {
  return motion({rule({"plate"}, function_rule(field)), rule({"hole_*"}, carry)});
}

bool on_rim(Vec3 const& x, double middle) {
  return std::abs(std::hypot(x.x - middle, x.y - 5) - 1) < 1e-9 && std::abs(x.z) < 1e-9;
}

TEST(Carry, FeaturesKeepTheirShapeAndWallsMeetThem) {
  Mesh const mesh = plate_with_holes();
  for (bool const blocks : {true, false}) {
    Rules const rules(mesh, blocks, carried(bent));
    auto const plate = rules.nodes("plate");
    for (auto const& [name, middle] : {std::pair("hole_1", 5.0), std::pair("hole_2", 11.0)}) {
      auto const hole = rules.nodes(name);
      ASSERT_GT(hole.x.size(), 50u);
      double moved = 0;
      for (std::size_t n = 0; n < hole.x.size(); ++n) {
        moved = std::max(moved, norm(hole.u[n]));
        for (std::size_t m = 0; m < n; m += 7)
          ASSERT_NEAR(distance(hole.x[n] + hole.u[n], hole.x[m] + hole.u[m]), distance(hole.x[n], hole.x[m]), 1e-13);
        for (std::size_t m = 0; m < plate.x.size(); ++m)
          if (distance(hole.x[n], plate.x[m]) < 1e-9) {
            ASSERT_EQ(hole.u[n], plate.u[m]) << "the rim is the hole's";
          }
      }
      EXPECT_GT(moved, 0.5);
      int rim = 0;
      for (Vec3 const& x : plate.x) rim += on_rim(x, middle) ? 1 : 0;
      EXPECT_GE(rim, 16);
    }
    // Holes are as far apart as four radii: each has one radius of the plate around it.
    for (std::size_t m = 0; m < plate.x.size(); ++m) {
      double const away =
          std::min(std::hypot(plate.x[m].x - 5, plate.x[m].y - 5), std::hypot(plate.x[m].x - 11, plate.x[m].y - 5));
      if (away > 2.01)
        EXPECT_EQ(plate.u[m], bent(plate.x[m]));
      else
        EXPECT_LT(distance(plate.u[m], bent(plate.x[m])), 0.3);
    }
  }
}

TEST(Carry, AMotionOfTheWallsThatIsRigidIsTheirs) {
  Mesh const mesh = plate_with_holes();
  Mat3 const turn = rotation_by({0.4, -1.1, 0.7});
  VectorField const field = [&](Vec3 const& p) { return turn * p - p + Vec3{1, 2, 3}; };
  for (bool const blocks : {true, false}) {
    Rules const rules(mesh, blocks, carried(field));
    for (char const* family : {"plate", "hole_1", "hole_2"}) {
      auto const nodes = rules.nodes(family);
      for (std::size_t n = 0; n < nodes.x.size(); ++n) ASSERT_LT(distance(nodes.u[n], field(nodes.x[n])), 1e-13);
    }
    Rules const still(mesh, blocks, carried([](Vec3 const&) { return Vec3{}; }));
    for (char const* family : {"plate", "hole_1"})
      for (Vec3 const& u : still.nodes(family).u) ASSERT_EQ(u, Vec3{});
  }
}

// Of a strain about a place in a wall that is the same on all sides of a hole nothing is left but what its middle does.
TEST(Carry, AStrainTakesAFeatureWhereItsMiddleGoesWithoutATurn) {
  VectorField const field = [](Vec3 const& p) { return Vec3{0.2 * (p.x - 2), -0.1 * (p.y - 4), 0}; };
  for (bool const blocks : {true, false}) {
    Rules const rules(plate_with_holes(), blocks, carried(field));
    for (Vec3 const& u : rules.nodes("hole_1").u) ASSERT_LT(distance(u, {0.6, -0.1, 0}), 1e-13);
    for (Vec3 const& u : rules.nodes("hole_2").u) ASSERT_LT(distance(u, {1.8, -0.1, 0}), 1e-13);
  }
}

// Where rules meet on a rim, and beside it, one goes on as the other.
TEST(Carry, WallsOfTwoRulesCarryAsOneWallDoes) {
  Mesh mesh = plate_with_holes();
  Rules const one(mesh, false, carried(bent));
  for (Patch& patch : mesh.patches)
    if (patch.zone == 0 && patch.families.front() == "plate") patch.name = patch.families.front() = "strip";
  Rules const two(mesh, false,
                  motion({rule({"plate"}, function_rule(bent)), rule({"strip"}, function_rule(bent)),
                          rule({"hole_*"}, CarryRule{{"plate", "strip"}})}));
  auto const whole = one.nodes("plate");
  for (char const* family : {"plate", "strip"}) {
    auto const part = two.nodes(family);
    ASSERT_FALSE(part.x.empty());
    for (std::size_t n = 0; n < part.x.size(); ++n)
      for (std::size_t m = 0; m < whole.x.size(); ++m)
        if (part.x[n] == whole.x[m]) {
          ASSERT_LT(distance(part.u[n], whole.u[m]), 1e-13) << family;
        }
  }
}

TEST(Carry, TheDistanceOfTheFadeCanBeGivenAndEndsHalfWayToTheNextFeature) {
  CarryRule carry{{"plate"}};
  for (double const fade : {0.3, 50.0}) {
    carry.fade = fade;
    Rules const rules(plate_with_holes(), false, carried(bent, carry));
    auto const plate = rules.nodes("plate");
    for (std::size_t m = 0; m < plate.x.size(); ++m) {
      Vec3 const x = plate.x[m];
      bool const rim = on_rim(x, 5) || on_rim(x, 11);
      bool const changed = !(plate.u[m] == bent(x));
      if (fade < 0.5) {
        EXPECT_EQ(changed, rim) << "edges are longer than the fade";
      }
      EXPECT_FALSE(changed && std::abs(x.x - 8) < 1e-9) << "half way";
    }
  }
}

TEST(Carry, APlaneIsKeptWhereThatIsAskedFor) {
  CarryRule carry{{"plate"}, FreeRule::Constraint::plane};
  for (bool const blocks : {true, false}) {
    Rules const rules(plate_with_holes(), blocks, carried(bent, carry));
    auto const hole = rules.nodes("hole_1");
    for (std::size_t n = 0; n < hole.u.size(); ++n) {
      ASSERT_NEAR(hole.u[n].z, 0, 1e-13);
      ASSERT_GT(norm(hole.u[n]), 0.3);
      ASSERT_NEAR(distance(hole.x[n] + hole.u[n], hole.x[0] + hole.u[0]), distance(hole.x[n], hole.x[0]), 1e-13);
    }
  }
  carry.constraint = FreeRule::Constraint::axial;
  Motion m = carried(bent, carry);
  m.axis = {{0, 0, 0}, {2, 0, 0}};
  for (Vec3 const& u : Rules(plate_with_holes(), false, m).nodes("hole_1").u) ASSERT_NEAR(u.x, 0, 1e-13);
}

TEST(Carry, LinesOfAPlaneMeshKeepTheirShapeToo) {
  Mesh mesh = flat_box(20, 6, 3);
  Patch wall = mesh.patches[2], sensor = wall;
  wall.faces = sensor.faces = {};
  for (Index32 k = 0; k < 20; ++k) (k < 8 || k >= 12 ? wall : sensor).faces.add(std::array{k, k + 1});
  sensor.name = "sensor";
  mesh.patches[2] = wall;
  mesh.patches.push_back(sensor);
  UnstructuredCase const c(std::move(mesh));
  VectorField const field = [](Vec3 const& p) {
    double const s = p.x * (20 - p.x) / 100;
    return Vec3{0.3 * s * s, 0.1 * p.x * s * s, 0};
  };
  auto const morphed = c.morph(motion({rule({"j_min"}, function_rule(field)), rule({"sensor"}, CarryRule{{"j_min"}}),
                                       rule({"i_*", "j_max"}, FixedRule{})}));
  EXPECT_EQ(c.inverted(morphed.x), 0);
  for (Index n = 8; n <= 12; ++n) {
    EXPECT_EQ(morphed.x.z(n), 0);
    EXPECT_NEAR(distance(morphed.x[n], morphed.x[8]), double(n - 8), 1e-13);
  }
  EXPECT_GT(morphed.x.y(10), 0.5);
}

TEST(Carry, ASoundMeshComesOfIt) {
  Mesh const mesh = plate_with_holes();
  Motion m = carried(bent);
  m.rules.push_back(rule({"u_*", "v_*", "w_max"}, FixedRule{}));
  UnstructuredCase const elements(to_hexahedra(mesh));
  EXPECT_EQ(elements.inverted(morph(mesh, m).morphed.position), 0) << "of blocks";
  if (reduced()) return;
  auto const morphed = elements.morph(m);
  EXPECT_EQ(elements.inverted(morphed.x), 0);
  EXPECT_EQ(elements.largest_miss(morphed), 0);
}

TEST(Carry, AttachedWhatPartsFromAWallThatBendsIsToldOfOtherRules) {
  Mesh const mesh = plate_with_holes();
  Motion m = motion({rule({"plate"}, function_rule(bent)), rule({"hole_*"}, AttachedRule{{"plate"}}),
                     rule({"u_*", "v_*", "w_max"}, FixedRule{})});
  UnstructuredCase const elements(to_hexahedra(mesh));
  expect_all_in(message_of<MotionError>([&] { (void)elements.morph(m); }),
                {"'plate' and 'hole_1' disagree", "how = \"nearest\"", "rule = \"carry\""});
}

TEST(Carry, FeaturesWithoutAWallThatCarriesThemAreRefused) {
  Mesh const mesh = plate_with_holes();
  auto const refused = [&](Motion const& m) {
    return message_of<MotionError>([&] { BoundaryMotion(mesh, resolve(mesh, m)); });
  };
  expect_all_in(refused(motion({rule({"w_max"}, function_rule(bent)), rule({"hole_*"}, CarryRule{{"w_max"}})})),
                {"rule 2 (carry, test)", "'hole_1'", "around (5, 5,", "no node in common", "'hole_2'"});
  expect_all_in(refused(motion({rule({"hole_*"}, CarryRule{{"plate"}})})), {"of: no rule names 'plate'"});
  expect_all_in(refused(motion({rule({"plate"}, SlipRule{}), rule({"hole_*"}, CarryRule{{"plate"}})})),
                {"'plate' has the rule 'slip'", "not known beforehand"});
  // A strut from wall to wall, one of which moves away.
  Mesh strut = box({5, 5, 5}, Shape::straight, 1);
  Motion const parting = motion({rule({"u_min"}, RigidRule{{}, {0.2, 0, 0}}), rule({"u_max"}, FixedRule{}),
                                 rule({"v_min"}, CarryRule{{"u_min", "u_max"}})});
  expect_all_in(message_of<MotionError>([&] { BoundaryMotion(strut, resolve(strut, parting)); }),
                {"'v_min'", "walls of different motion", "rule free"});
  CarryRule keep{{"plate"}, FreeRule::Constraint::plane};
  Motion const two_planes =
      motion({rule({"u_min"}, function_rule(bent)), rule({"v_min", "w_min"}, CarryRule{{"u_min"}, keep.constraint})});
  expect_all_in(message_of<MotionError>([&] { BoundaryMotion(strut, resolve(strut, two_planes)); }),
                {"flat patches across", "cannot both be kept"});
  keep.fade = -1;
  expect_all_in(refused(carried(bent, keep)), {"fades is -1.0"});
}

}  // namespace
}  // namespace gridmorph::test
