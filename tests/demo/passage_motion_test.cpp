#include "passage_checks.hpp"

#include <generators/passage_motion.hpp>
#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace passage_checks;

/// Chord line of one spanwise station: from the leading-edge to the trailing-edge node, in the developed surface.
struct ChordLine {
  double span, length, angle, middle_x, middle_y;
};

template <class Position>
ChordLine chord_line(PassageOptions const& options, Mesh const& mesh, int j, Position position) {
  PassageCounts const c = passage_counts(options);
  Developed const le = develop(options, position(node(mesh, zone_named(mesh, "ring_le"), {c.leading_lower, j, 0})));
  Developed const te = develop(options, position(node(mesh, zone_named(mesh, "ring_te"), {c.trailing_upper, j, 0})));
  return {le.span, std::hypot(te.x - le.x, te.y - le.y), std::atan2(te.y - le.y, te.x - le.x), 0.5 * (le.x + te.x),
          0.5 * (le.y + te.y)};
}

struct Moved {
  PassageOptions options;
  PassageMotion motion;
  Vec3 operator()(Vec3 const& p) const { return p + passage_displacement(options, motion, p); }
};

TEST(PassageMotion, RotatedSectionsTurnByTenDegreesAndLoseFivePercentOfTheirChord) {
  PassageOptions const options = small();
  Mesh const mesh = make_passage(options);
  Moved const moved{options, rotated_sections()};
  for (int j = 0; j < mesh.zones[0].extent[1]; ++j) {
    ChordLine const before = chord_line(options, mesh, j, [](Vec3 const& p) { return p; });
    ChordLine const after = chord_line(options, mesh, j, moved);
    EXPECT_NEAR(after.span, before.span, 1e-14);
    EXPECT_NEAR(after.length / before.length, 0.95, 1e-12);
    EXPECT_NEAR((after.angle - before.angle) * 180 / std::numbers::pi, -10, 1e-10);
    EXPECT_NEAR(after.middle_x, before.middle_x, 1e-14);
    EXPECT_NEAR(after.middle_y, before.middle_y, 1e-14);
  }
}

TEST(PassageMotion, ChordRedesignChangesTheChordAsPrescribedAlongTheSpan) {
  PassageOptions const options = small(1'000'000);
  Mesh const mesh = make_passage(options);
  Moved const moved{options, chord_redesign()};
  double smallest = 2, largest = 0, at_half = 0;
  for (int j = 0; j < mesh.zones[0].extent[1]; ++j) {
    ChordLine const before = chord_line(options, mesh, j, [](Vec3 const& p) { return p; });
    ChordLine const after = chord_line(options, mesh, j, moved);
    double const factor = after.length / before.length;
    EXPECT_NEAR(after.angle, before.angle, 1e-12);
    smallest = std::min(smallest, factor);
    if (factor > largest) {
      largest = factor;
      at_half = before.span;
    }
  }
  EXPECT_NEAR(smallest, 0.9, 2e-3);
  EXPECT_GE(smallest, 0.9 - 1e-12);
  EXPECT_NEAR(largest, 1.1, 2e-3);
  EXPECT_LE(largest, 1.1 + 1e-12);
  EXPECT_NEAR(at_half, 0.5, 0.05);
}

TEST(PassageMotion, ChordFactorMeetsItsStationsAndIsSmooth) {
  PassageMotion const motion = chord_redesign();
  EXPECT_EQ(chord_factor(motion, 0), 1);
  EXPECT_NEAR(chord_factor(motion, 0.15), 0.9, 1e-15);
  EXPECT_NEAR(chord_factor(motion, 0.5), 1.1, 1e-15);
  EXPECT_NEAR(chord_factor(motion, 0.9), 0.9, 1e-15);
  EXPECT_EQ(chord_factor(motion, 1), 1);
  double const h = 1e-6;
  for (double span = 0.01; span < 0.99; span += 0.01) {
    double const left = chord_factor(motion, span) - chord_factor(motion, span - h);
    double const right = chord_factor(motion, span + h) - chord_factor(motion, span);
    EXPECT_NEAR(left / h, right / h, 1e-3) << "kink at span " << span;
  }
  EXPECT_EQ(chord_factor({"none", 0, {}}, 0.3), 1);
}

TEST(PassageMotion, ThicknessIsKept) {
  PassageOptions const options = small();
  Mesh const mesh = make_passage(options);
  PassageCounts const c = passage_counts(options);
  Moved const moved{options, rotated_sections()};
  auto const distance_from_chord_line = [&](Vec3 const& p, ChordLine const& line, auto position) {
    Developed const d = develop(options, position(p));
    return -(d.x - line.middle_x) * std::sin(line.angle) + (d.y - line.middle_y) * std::cos(line.angle);
  };
  auto const still = [](Vec3 const& p) { return p; };
  int const upper = zone_named(mesh, "ring_upper");
  for (int j = 0; j < mesh.zones[upper].extent[1]; ++j) {
    ChordLine const before = chord_line(options, mesh, j, still), after = chord_line(options, mesh, j, moved);
    for (int i = 0; i <= c.side; ++i) {
      Vec3 const p = node(mesh, upper, {i, j, 0});
      EXPECT_NEAR(distance_from_chord_line(p, before, still), distance_from_chord_line(p, after, moved), 1e-14);
    }
  }
}

class PassageMotions : public testing::TestWithParam<char const*> {};

TEST_P(PassageMotions, BladeEdgesStayOnHubAndCase) {
  PassageOptions options = small();
  options.hub.bulge = 0.008;
  options.placement = skew_placement();
  Mesh const mesh = make_passage(options);
  Moved const moved{options, passage_motion(GetParam())};
  RigidTransform const back = options.placement.inverse();
  for (auto const& patch : mesh.patches) {
    if (patch.families.front() != "blade") continue;
    for_each_node(patch.range, [&](Index3 const& at) {
      bool const hub = at[1] == 0;
      if (!hub && at[1] != patch.range.end[1] - 1) return;
      Vec3 const x = back(moved(node(mesh, patch.zone, at)));
      ASSERT_NEAR(std::hypot(x.y, x.z), end_wall_radius(hub ? options.hub : options.casing, x.x, options), 5e-15);
    });
  }
}

TEST_P(PassageMotions, DisplacementTurnsWithTheMachine) {
  PassageOptions const plain = small();
  PassageOptions placed = plain;
  placed.placement = skew_placement();
  PassageMotion const motion = passage_motion(GetParam());
  Mesh const mesh = make_passage(plain);
  int const z = zone_named(mesh, "ring_lower");
  for_each_node({{0, 0, 0}, {5, mesh.zones[z].extent[1], 1}}, [&](Index3 const& at) {
    Vec3 const p = node(mesh, z, at);
    Vec3 const expected = placed.placement.rotation * passage_displacement(plain, motion, p);
    EXPECT_LT(distance(passage_displacement(placed, motion, placed.placement(p)), expected), 1e-14);
  });
}

INSTANTIATE_TEST_SUITE_P(Both, PassageMotions, testing::Values("rotation", "chord"),
                         [](auto const& info) { return std::string(info.param); });

TEST(PassageMotion, ChordRedesignLeavesHubAndCaseSectionsWhereTheyAre) {
  PassageOptions const options = small();
  Mesh const mesh = make_passage(options);
  for (auto const& patch : mesh.patches) {
    if (patch.families.front() != "blade") continue;
    for_each_node(patch.range, [&](Index3 const& at) {
      if (at[1] != 0 && at[1] != patch.range.end[1] - 1) return;
      EXPECT_LT(norm(passage_displacement(options, chord_redesign(), node(mesh, patch.zone, at))), 1e-15);
    });
  }
}

TEST(PassageMotion, UnknownNameIsAnErrorThatListsTheNames) {
  try {
    passage_motion("wobble");
    FAIL() << "accepted";
  } catch (ConfigError const& e) {
    EXPECT_NE(std::string(e.what()).find("'rotation', 'chord' or 'gap'"), std::string::npos) << e.what();
  }
}

}  // namespace
