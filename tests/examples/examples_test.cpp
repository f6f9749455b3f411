// Every example runs through and does what its case file says, measured with the formulas of the case files written
// anew.
#include "example_run.hpp"
#include "motion/plain_splines.hpp"
#include "support/reduced.hpp"

#include <gridmorph/motion/motion.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr double deg = 0.017453292519943295;

TEST_F(Example, TurbineStageTurnsEachRowByItsOwnAngleAndSlidesOnItsEnds) {
  ASSERT_NO_FATAL_FAILURE(morph("turbine_stage", "axial_turbine_stage_H.cgns"));
  auto const expect_turn = [&](std::string const& blade, double mid, double stagger, auto const& turn) {
    for_patch(blade, "", [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 0), u = motion(n, 0);
      double const wanted = (x.axial - mid) / x.r * (std::tan((stagger + turn(x.r)) * deg) - std::tan(stagger * deg));
      EXPECT_NEAR(u.theta, wanted, 1e-14);
      EXPECT_NEAR(u.axial, 0, 1e-15);
      EXPECT_NEAR(u.r, 0, 1e-15);
    });
  };
  expect_turn("BLADE1", 0.05, -41.5, [](double) { return 6.0; });
  expect_turn("BLADE2", 0.21, 38.6, [](double r) { return 3 + 4 * (r - 0.92) / 0.15; });

  expect_periodic_copies_move_alike(0);
  // The motion is purely circumferential; on hub and case near fields turn with the blades, along profiles that rise by
  // less than a half.
  for (std::string const wall : {"HUB", "SHROUD", "INLET", "OUTLET", "MIXING"})
    for_patch(wall, "", [&](Index n) {
      Cylindrical const u = motion(n, 0);
      bool const turns = wall == "HUB" || wall == "SHROUD";
      EXPECT_NEAR(u.r, 0, 2e-15 + (turns ? 0.5 * std::abs(u.axial) : 0)) << wall;
      EXPECT_NEAR(u.axial, 0, turns ? 1e-3 : 1e-15) << wall;
    });

  double vane = 0, rotor = 0;
  for_patch("mixing_out", "row1", [&](Index n) { vane = std::max(vane, motion(n, 0).theta); });
  for_patch("mixing_in", "row2", [&](Index n) { rotor = std::min(rotor, motion(n, 0).theta); });
  EXPECT_GT(vane, 0.4 * deg);
  EXPECT_LT(rotor, -0.4 * deg);
}

using StandInExample = StandInTest<Example>;
INSTANTIATE_TEST_SUITE_P(Meshes, StandInExample, ::testing::Bool(), stand_in_or_not);

TEST_P(StandInExample, KaplanTurnsVanesAndRunnerOnItsCylindersAndLeavesTheDraftTube) {
  ASSERT_NO_FATAL_FAILURE(morph("kaplan_7_blocks", "water_turbine.cgns"));
  auto const expect_turn = [&](std::string const& side, std::string const& zone, double spindle, double at,
                               double turn) {
    double const c = std::cos(turn * deg) - 1, s = std::sin(turn * deg);
    for_patch(side, zone, [&](Index n) {
      Cylindrical const x = cylindrical(before.coordinates[n], 2), u = motion(n, 2);
      double const a = x.axial - spindle, b = wrapped(x.theta - at * deg);
      // Periodic copies of the baseline are 1.5e-10 apart; one of them decides for both.
      EXPECT_NEAR(u.axial, a * c - x.r * b * s, 1e-10);
      EXPECT_NEAR(u.theta, a / x.r * s + b * c, 1e-9);
      EXPECT_NEAR(u.r, 0, 1e-11);
    });
  };
  expect_turn("ps", "GV_vane", 0.14, -43, -10);
  expect_turn("ss", "GV_vane", 0.14, 29, -10);
  expect_turn("ps", "RU_blade", 0, -54.7, 8);
  expect_turn("ss", "RU_blade", 0, 17.3, 8);

  expect_periodic_copies_move_alike(2);
  for (std::string const wall : {"HUB", "SHROUD"})
    for_patch(wall, "", [&](Index n) { EXPECT_NEAR(motion(n, 2).r, 0, 1e-11) << wall; });
  for (std::string const plane : {"INLET", "OUTLET", "MIXING"})
    for_patch(plane, "", [&](Index n) { EXPECT_NEAR(motion(n, 2).axial, 0, 1e-15) << plane; });
  Zone const* tube = nullptr;
  for (auto const& zone : before.zones) tube = zone.name == "DT" ? &zone : tube;
  ASSERT_NE(tube, nullptr);
  for (Index n = tube->first_node; n < tube->first_node + tube->size(); ++n)
    EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]);
}

TEST_P(StandInExample, SlatMovesRigidlyInItsPlaneAndTheOtherElementsKeepTheirFirstCells) {
  ASSERT_NO_FATAL_FAILURE(morph("slat", "slotted_airfoil.cgns"));
  double const c = std::cos(-10 * deg), s = std::sin(-10 * deg);
  expect_motion("Klo_Seg   2", "Zone   3", [&](Vec3 const& p) {
    double const x = p.x - 0.0272575, z = p.z - 0.0204985;
    return Vec3{c * x + s * z - x - 0.02, 0, -s * x + c * z - z + 0.01};
  });
  for (std::string const zone : {"Zone   1", "Zone   2"}) {
    int walls = 0;
    for (auto const& patch : before.patches) {
      if (patch.name != "Klo_Seg   2" || before.zones[patch.zone].name != zone) continue;
      ++walls;
      IndexRange layers = patch.range;
      layers.end[2] = 17;  // 16 cells off the wall
      for_nodes(before.zones[patch.zone], layers,
                [&](Index n, Index3 const&) { EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]); });
    }
    EXPECT_GT(walls, 0) << zone;
  }

  for (auto const& zone : before.zones)
    for_nodes(zone, {{0, 0, 0}, {1, zone.extent[1], zone.extent[2]}}, [&](Index n, Index3 const&) {
      EXPECT_EQ(after.coordinates.y(n), before.coordinates.y(n));
      EXPECT_EQ(after.coordinates.y(n + 1), before.coordinates.y(n + 1));
      EXPECT_EQ(after.coordinates.x(n + 1) - after.coordinates.x(n), 0);
      EXPECT_EQ(after.coordinates.z(n + 1) - after.coordinates.z(n), 0);
    });
}

TEST_F(Example, WingBendsAndTwistsAsItsFormulaSays) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_38_blocks", "mdo_tutorial_000_vol.cgns"));
  expect_motion("wall", "", [](Vec3 const& p) {
    double const t = p.z / 14, angle = -5 * deg * t * t, x = p.x - 1.25 - 0.473 * p.z;
    double const c = std::cos(angle), s = std::sin(angle);
    return Vec3{x * c - p.y * s - x, x * s + p.y * c - p.y + 2.1 * t * t, 0};
  });
  expect_fixed("far");
  for_patch("sym", "", [&](Index n) { EXPECT_NEAR(after.coordinates.z(n), before.coordinates.z(n), 1e-15); });
}

TEST_F(Example, AircraftBendsItsWingDeflectsItsAileronTrimsItsTailAndCarriesItsNacelle) {
  ASSERT_NO_FATAL_FAILURE(morph("aircraft", "aircraft.cgns"));
  auto const bent = [](Vec3 const& p) {
    double const s = p.y - 2, t = std::max(p.y - 2.2, 0.0) / 14.9, angle = -2 * deg * t * t;
    double const x = p.x - (14.15 + (7.64 - 1.225) / 15 * s), z = p.z - (-0.7 + 1.312 / 15 * s);
    double const c = std::cos(angle) - 1, sn = std::sin(angle);
    return Vec3{x * c + z * sn, -2 * z * t / 14.9, -x * sn + z * c + t * t};
  };
  expect_motion("wing", "", bent);
  double lowest = 0;
  expect_motion("aileron", "", [&](Vec3 const& p) {
    auto const rise = [](double t) { return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t); };
    double const behind = p.x - (17.45 + (7.64 - 0.75 * 4.9) / 15 * (p.y - 2));
    double const angle = 12 * deg * rise((p.y - 11.8) / 1.6) * rise((16 - p.y) / 1.6);
    double const above = rise(behind / 0.4) * (p.z - (-0.7 + 1.312 / 15 * (p.y - 2)));
    double const c = std::cos(angle) - 1, sn = std::sin(angle);
    lowest = std::min(lowest, -behind * sn);
    return bent(p) + Vec3{behind * c + above * sn, 0, -behind * sn + above * c};
  });
  EXPECT_LT(lowest, -0.1);
  // The nacelle as a whole: distances from one of its nodes stay; it rises with the wing above it.
  Index first = -1;
  for_patch("nacelle", "", [&](Index n) {
    if (first < 0) first = n;
    EXPECT_NEAR(distance(after.coordinates[n], after.coordinates[first]),
                distance(before.coordinates[n], before.coordinates[first]), 1e-12);
    EXPECT_NEAR(after.coordinates.z(n) - before.coordinates.z(n), 0.065, 0.05);
  });
  // The tail plane turns as a whole but where it slides on the fuselage.
  double const c = std::cos(-2 * deg), sn = std::sin(-2 * deg);
  Index turned = 0;
  for_patch("htail", "", [&](Index n) {
    Vec3 const p = before.coordinates[n], q = after.coordinates[n];
    if (p.y < 1.45) return;
    double const x = p.x - 33.5, z = p.z - 0.8;
    EXPECT_LT(distance(q, {33.5 + c * x + sn * z, p.y, 0.8 - sn * x + c * z}), 1e-12);
    ++turned;
  });
  EXPECT_GT(turned, 100);
  for_patch("fuselage", "", [&](Index n) {
    Vec3 const q = after.coordinates[n];
    if (q.x > 5 && q.x < 24) {
      EXPECT_NEAR(std::hypot(q.y, q.z), 2, 1e-3);
    }
  });
  expect_fixed("vtail");
  expect_fixed("farfield");
  for_patch("symmetry", "", [&](Index n) { EXPECT_NEAR(after.coordinates.y(n), 0, 1e-14); });
}

TEST_F(Example, WingReachesItsTargetSurface) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_target", "mdo_tutorial_000_vol.cgns"));
  auto const report = nlohmann::json::parse(contents(path("wing_target/wing_target.json")));
  ASSERT_EQ(report["targets"].size(), 1u);
  EXPECT_EQ(report["targets"][0]["mapping"], "projection");
  EXPECT_LT(report["targets"][0]["distance"]["max"], 1e-13 * 14);
  EXPECT_EQ(contents(path("wing_target/log.txt")).find("fold"), std::string::npos);
  // The root stays the root; the corners of the trailing edge's base at the tip go to the target's: where the formula
  // puts them.
  int corners = 0;
  for_patch("wall", "", [&](Index n) {
    Vec3 const p = before.coordinates[n];
    if (p.z == 0) {
      EXPECT_LT(distance(after.coordinates[n], p), 1e-12);
    }
    if (p.x < 8.9999 || std::fabs(p.z - 14) > 1e-6 || std::fabs(p.y) < 0.003) return;
    ++corners;
    double const c = std::cos(-5 * deg), s = std::sin(-5 * deg), x = p.x - 1.25 - 0.473 * p.z;
    EXPECT_LT(distance(after.coordinates[n], p + Vec3{x * c - p.y * s - x, x * s + p.y * c - p.y + 2.1, 0}), 1e-9);
  });
  EXPECT_GE(corners, 2);
  expect_fixed("far");
}

TEST_F(Example, WingletCantsAndTheWingInboardStays) {
  ASSERT_NO_FATAL_FAILURE(morph("winglet", "717_wl_L2.cgns"));
  Index inboard = 0;
  expect_motion("wall", "", [&](Vec3 const& p) {
    double const t = std::clamp((p.z - 9) / 2.2, 0.0, 1.0), angle = -10 * deg * t * t * (3 - 2 * t);
    double const y = p.y - 0.1, z = p.z - 10;
    inboard += p.z < 9 ? 1 : 0;
    return Vec3{0, y * std::cos(angle) + z * std::sin(angle) - y, z * std::cos(angle) - y * std::sin(angle) - z};
  });
  EXPECT_GT(inboard, 0);
  expect_fixed("Far");
  for_patch("Sym", "",
            [&](Index n) { EXPECT_NEAR(after.coordinates.z(n), before.coordinates.z(n), 1e-10 * before.size()); });
}

/// Leading and trailing edge of each spanwise station of an H mesh's blade side, hub to case.
struct EdgeNodes {
  std::vector<Index> leading, trailing;
};

EdgeNodes edge_nodes(Mesh const& mesh, std::string const& family, std::string const& side, int axis) {
  EdgeNodes nodes;
  for (auto const& patch : mesh.patches) {
    if (patch.name != side || patch.families.empty() || patch.families.front() != family) continue;
    Zone const& zone = mesh.zones[patch.zone];
    auto const at = [&](int along, int i, int across, int j) {
      Index3 p{patch.range.begin[0], patch.range.begin[1], patch.range.begin[2]};
      p[along] += i;
      p[across] += j;
      return zone.node(p);
    };
    std::array<int, 2> directions{};
    for (int d = 0, n = 0; d < 3; ++d)
      if (patch.range.extent(d) > 1) directions[n++] = d;
    auto const r = [&](Index n) { return cylindrical(mesh.coordinates[n], axis).r; };
    // Along the span the radius changes.
    int const n0 = patch.range.extent(directions[0]) - 1;
    bool const first_is_span =
        std::abs(r(at(directions[0], n0, directions[1], 0)) - r(at(directions[0], 0, directions[1], 0))) >
        std::abs(r(at(directions[1], patch.range.extent(directions[1]) - 1, directions[0], 0)) -
                 r(at(directions[1], 0, directions[0], 0)));
    int const span = directions[first_is_span ? 0 : 1], flow = directions[first_is_span ? 1 : 0];
    int const n = patch.range.extent(span) - 1, m = patch.range.extent(flow) - 1;
    bool const outwards = r(at(span, n, flow, 0)) > r(at(span, 0, flow, 0));
    bool const downstream = cylindrical(mesh.coordinates[at(span, 0, flow, m)], axis).axial >
                            cylindrical(mesh.coordinates[at(span, 0, flow, 0)], axis).axial;
    for (int j = 0; j <= n; ++j) {
      nodes.leading.push_back(at(span, outwards ? j : n - j, flow, downstream ? 0 : m));
      nodes.trailing.push_back(at(span, outwards ? j : n - j, flow, downstream ? m : 0));
    }
  }
  EXPECT_FALSE(nodes.leading.empty()) << family << " " << side;
  return nodes;
}

/// Chord line between two nodes in the surface developed with the mean of their baseline radii.
struct Chord {
  double length, stagger_deg;
};
Chord chord_between(Mesh const& mesh, Index leading, Index trailing, double radius, int axis) {
  Cylindrical const a = cylindrical(mesh.coordinates[leading], axis), b = cylindrical(mesh.coordinates[trailing], axis);
  double const s = b.axial - a.axial, t = radius * wrapped(b.theta - a.theta);
  return {std::hypot(s, t), std::atan2(t, s) / deg};
}
double mean_radius(Mesh const& mesh, Index a, Index b, int axis) {
  return 0.5 * (cylindrical(mesh.coordinates[a], axis).r + cylindrical(mesh.coordinates[b], axis).r);
}

TEST_F(Example, StageRedesignBowsTheVaneAndKeepsItsAxialPositionsAndEnds) {
  if (test::reduced()) GTEST_SKIP() << "the stage takes long, and other tests have it";
  ASSERT_NO_FATAL_FAILURE(morph("stage_redesign", "axial_turbine_stage_H.cgns"));
  for_patch("BLADE1", "", [&](Index n) { EXPECT_NEAR(motion(n, 0).axial, 0, 1e-15); });
  EdgeNodes const edges = edge_nodes(before, "BLADE1", "blade_ps", 0);
  std::size_t const n = edges.leading.size() - 1;
  double const r0 = mean_radius(before, edges.leading[0], edges.trailing[0], 0);
  double const height = mean_radius(before, edges.leading[n], edges.trailing[n], 0) - r0;
  for (std::size_t j = 0; j <= n; ++j) {
    double const r = mean_radius(before, edges.leading[j], edges.trailing[j], 0), h = (r - r0) / height;
    double const shift = 0.5 * r * (motion(edges.leading[j], 0).theta + motion(edges.trailing[j], 0).theta);
    // The integral of tan(12 - 24 h degrees); leading and trailing edge move against each other by the stagger.
    double const wanted =
        height * (std::log(std::cos((12 - 24 * h) * deg)) - std::log(std::cos(12 * deg))) / (24 * deg);
    EXPECT_NEAR(shift, wanted, 0.03 * wanted + 1e-9) << h;  // the height of the annulus changes along the chord
    Chord const chord_before = chord_between(before, edges.leading[j], edges.trailing[j], r, 0);
    Chord const chord_after = chord_between(after, edges.leading[j], edges.trailing[j], r, 0);
    double const turned = chord_after.stagger_deg - chord_before.stagger_deg;
    if (j == 0 || j == n)
      EXPECT_NEAR(turned, 0, 1e-9);
    else
      EXPECT_GT(turned, 0);
    if (std::abs(h - 0.5) < 0.01) {
      EXPECT_NEAR(turned, 2, 0.2);  // of the line between the end nodes, which lies beside the chord line
    }
  }
}

TEST_F(Example, StageRedesignChangesTheChordOfTheRotorAsInThePaper) {
  if (test::reduced()) GTEST_SKIP() << "the stage takes long, and other tests have it";
  ASSERT_NO_FATAL_FAILURE(morph("stage_redesign", "axial_turbine_stage_H.cgns"));
  expect_periodic_copies_move_alike(0);
  EdgeNodes const edges = edge_nodes(before, "BLADE2", "blade_ps", 0);
  std::size_t const n = edges.leading.size() - 1;
  double const r0 = mean_radius(before, edges.leading[0], edges.trailing[0], 0);
  double const height = mean_radius(before, edges.leading[n], edges.trailing[n], 0) - r0;
  double least = 1, most = 1;
  for (std::size_t j = 0; j <= n; ++j) {
    double const r = mean_radius(before, edges.leading[j], edges.trailing[j], 0), h = (r - r0) / height;
    Chord const chord_before = chord_between(before, edges.leading[j], edges.trailing[j], r, 0);
    Chord const chord_after = chord_between(after, edges.leading[j], edges.trailing[j], r, 0);
    double const factor = chord_after.length / chord_before.length;
    // The line between the end nodes lies 3 degrees beside the chord line, which ends in the round nose.
    EXPECT_NEAR(chord_after.stagger_deg, chord_before.stagger_deg, 0.4);
    if (h < 0.16 || h > 0.89) {
      EXPECT_NEAR(factor, 0.9, 2e-3) << h;
    }
    if (std::abs(h - 0.5) < 0.01) {
      EXPECT_NEAR(factor, 1.1, 2e-3) << h;
    }
    least = std::min(least, factor);
    most = std::max(most, factor);
  }
  EXPECT_NEAR(least, 0.9, 2e-3);
  EXPECT_NEAR(most, 1.1, 2e-3);
  // Between hub and case at every axial position: both are in the baseline's profile.
  for (std::string const wall : {"HUB", "SHROUD"}) {
    std::map<double, double> profile;
    for_patch(wall, "", [&](Index m) {
      Cylindrical const x = cylindrical(before.coordinates[m], 0);
      profile[x.axial] = x.r;
    });
    double worst = 0;
    for_patch(wall, "", [&](Index m) {
      Cylindrical const x = cylindrical(after.coordinates[m], 0);
      auto const above = profile.lower_bound(x.axial);
      if (above == profile.begin() || above == profile.end()) return;
      auto const below = std::prev(above);
      double const t = (x.axial - below->first) / (above->first - below->first);
      worst = std::max(worst, std::abs(x.r - (1 - t) * below->second - t * above->second));
    });
    EXPECT_LT(worst, 1e-4) << wall;  // straight pieces between the nodes of the profile
  }
}

TEST_P(StandInExample, KaplanRedesignTurnsItsBladesInTheirCylinders) {
  ASSERT_NO_FATAL_FAILURE(morph("kaplan_redesign", "water_turbine.cgns"));
  expect_periodic_copies_move_alike(2);
  auto const each_station = [&](std::string const& family, auto const& check) {
    for (std::string const side : {"ps", "ss"}) {
      EdgeNodes const edges = edge_nodes(before, family, side, 2);
      std::size_t const n = edges.leading.size() - 1;
      double const r0 = mean_radius(before, edges.leading[0], edges.trailing[0], 2);
      double const r1 = mean_radius(before, edges.leading[n], edges.trailing[n], 2);
      for (std::size_t j = 0; j <= n; ++j) {
        double const r = mean_radius(before, edges.leading[j], edges.trailing[j], 2);
        Chord const a = chord_between(before, edges.leading[j], edges.trailing[j], r, 2);
        Chord const b = chord_between(after, edges.leading[j], edges.trailing[j], r, 2);
        check((r - r0) / (r1 - r0), b.length / a.length, b.stagger_deg - a.stagger_deg,
              0.5 * r * (motion(edges.leading[j], 2).theta + motion(edges.trailing[j], 2).theta));
      }
    }
  };
  each_station("BLADE_GV", [](double h, double factor, double turned, double shift) {
    EXPECT_NEAR(turned, -5, 1e-6) << h;
    EXPECT_NEAR(factor, 1, 1e-7) << h;
    EXPECT_NEAR(shift, 0, 1e-8) << h;
  });
  each_station("BLADE_RU", [](double h, double factor, double turned, double shift) {
    EXPECT_NEAR(turned, 6 * h, 1e-3) << h;
    EXPECT_NEAR(shift, 0.01 * h, 1e-6) << h;
    EXPECT_GT(factor, 1 - 1e-4) << h;
    if (std::abs(h - 0.5) < 0.02) {
      EXPECT_NEAR(factor, 1.1, 1e-3);
    }
  });
  for (std::string const wall : {"HUB", "SHROUD"})
    for_patch(wall, "", [&](Index n) { EXPECT_NEAR(motion(n, 2).r, 0, 1e-11) << wall; });
}

TEST_F(Example, WingRedesignChangesChordAlongTheSpanAndLeavesTheRoot) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_redesign", "mdo_tutorial_000_vol.cgns"));
  expect_fixed("far");
  for_patch("sym", "", [&](Index n) { EXPECT_NEAR(after.coordinates.z(n), before.coordinates.z(n), 1e-15); });
  std::vector<Index> nodes;
  for_patch("wall", "", [&](Index n) {
    EXPECT_EQ(after.coordinates.z(n), before.coordinates.z(n));
    nodes.push_back(n);
  });
  std::sort(nodes.begin(), nodes.end(),
            [&](Index a, Index b) { return before.coordinates.z(a) < before.coordinates.z(b); });
  std::vector<std::vector<Index>> sections;  // nodes at about one spanwise position
  for (Index const n : nodes) {
    double const last = sections.empty() ? -1 : before.coordinates.z(sections.back().back());
    if (before.coordinates.z(n) - last > 0.01) sections.emplace_back();
    sections.back().push_back(n);
  }
  auto const longest = [](Mesh const& mesh, std::vector<Index> const& section) {
    double most = 0;
    for (Index const a : section)
      for (Index const b : section) most = std::max(most, distance(mesh.coordinates[a], mesh.coordinates[b]));
    return most;
  };
  for (Index const n : sections.front()) EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]);
  SpanwiseTable const chord{{{0, 0}, {0.15, -0.1}, {0.5, 0.1}, {0.9, -0.1}, {1, -0.1}}};
  int checked = 0;
  for (auto const& section : sections) {
    double const h = before.coordinates.z(section.front()) / 14;
    if (section.size() < 40 || h > 0.99) continue;  // the tip cap has lines of its own
    EXPECT_NEAR(longest(after, section) / longest(before, section), 1 + chord.at(h), 5e-3) << h;
    ++checked;
  }
  EXPECT_GT(checked, 5);
}

TEST_F(Example, WingGoesWithItsLatticeOfControlPoints) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_ffd", "mdo_tutorial_000_vol.cgns"));
  // The lattice: x from the leading edge on, y across, z along the span; chords shrink linearly with z.
  auto const chord = [](double z) { return 5 - 0.25 * z; };
  auto const control_point = [&](int i, int j, int k) {
    double const z = 2.86 * k, c = chord(z);
    return Vec3{0.53 * z - 0.06 * c + 0.28 * c * i, (j == 0 ? -0.13 : 0.13) * c, z};
  };
  auto const displaced = [&](int i, int j, int k) {
    Vec3 const p = control_point(i, j, k);
    Vec3 d{};
    auto const turn = [&](double x0, double angle, Vec3 const& shift) {
      double const c = std::cos(angle * deg) - 1, s = std::sin(angle * deg), x = p.x - x0;
      d += Vec3{c * x - s * p.y, s * x + c * p.y, 0} + shift;
    };
    if (k == 5) turn(7.9, -6, {0.8, 0.6, 0});
    if (k == 4) turn(6.7, -3, {0.2, 0.2, 0});
    if ((i == 1 || i == 2) && k >= 1 && k <= 3) d += Vec3{0, j == 1 ? 0.12 : -0.06, 0};
    return d;
  };
  // Cubic B-splines of 5 and 6 points: one knot between, and two.
  auto const along_chord = [](int n, double s) { return test::plain_splines(test::plain_knots(5, 3), 3, s)[n]; };
  auto const along_span = [](int n, double w) { return test::plain_splines(test::plain_knots(6, 3), 3, w)[n]; };
  auto const solve = [](auto const& rising, double value) {
    double low = 0, high = 1;
    for (int n = 0; n < 60; ++n) (rising(0.5 * (low + high)) < value ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  };
  expect_motion("wall", "", [&](Vec3 const& p) {
    double const c = chord(p.z), at = (p.x - 0.53 * p.z + 0.06 * c) / (0.28 * c), t = 0.5 + p.y / (0.26 * c);
    double const s = solve(
        [&](double v) {
          double sum = 0;
          for (int i = 0; i < 5; ++i) sum += i * along_chord(i, v);
          return sum;
        },
        at);
    double const w = solve(
        [&](double v) {
          double sum = 0;
          for (int k = 0; k < 6; ++k) sum += 2.86 * k * along_span(k, v);
          return sum;
        },
        p.z);
    EXPECT_TRUE(at > 0 && at < 4 && t > 0 && t < 1 && p.z < 14.3);
    Vec3 u{};
    for (int k = 0; k < 6; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 5; ++i)
          u += along_chord(i, s) * (j == 0 ? 1 - t : t) * along_span(k, w) * displaced(i, j, k);
    return u;
  });
  expect_fixed("far");
  for_patch("sym", "", [&](Index n) { EXPECT_NEAR(after.coordinates.z(n), before.coordinates.z(n), 1e-15); });
}

TEST_F(Example, TipVortexCellsGoAlongWithTheTipAndKeepTheirSpacing) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_tip_vortex", "mdo_tutorial_000_vol.cgns"));
  expect_fixed("far");
  auto const u = [&](Index n) { return after.coordinates[n] - before.coordinates[n]; };
  Vec3 shift;
  int count = 0;
  for_patch("wall", "", [&](Index n) {
    if (distance(before.coordinates[n], {8.4, 0, 14}) > 0.5) return;
    shift += u(n);
    ++count;
  });
  ASSERT_GT(count, 10);
  shift = (1.0 / count) * shift;
  EXPECT_GT(shift.y, 1.9);
  Index inside = 0;
  for (Zone const& zone : before.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i) {
          Vec3 middle;
          for (int c = 0; c < 8; ++c)
            middle += 0.125 * before.coordinates[zone.node({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)})];
          bool const in =
              10 <= middle.x && middle.x <= 16 && std::abs(middle.y) <= 0.6 && 13.6 <= middle.z && middle.z <= 15;
          if (!in) continue;
          ++inside;
          for (int c = 0; c < 8; ++c)
            EXPECT_LE(distance(u(zone.node({i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)})), shift), 1e-13);
        }
  EXPECT_GT(inside, 20);
}

TEST_F(Example, RotorstatorIsRefusedInterfaceByInterfaceWithoutATolerance) {
  link_meshes();
  std::string const morph_without = "sed '/^matching_tolerance/d' '" GRIDMORPH_EXAMPLES "/rotorstator.toml' >'" +
                                    path("case.toml") + "' && '" GRIDMORPH_EXECUTABLE "' morph '" + path("case.toml") +
                                    "'";
  EXPECT_EQ(shell(morph_without), 2);
  std::string const message = contents(path("err"));
  for (std::string const name : {"b8a", "b9a", "b10a", "b11a", "b12a", "b13a", "b14a"})
    EXPECT_NE(message.find("interface '" + name + "'"), std::string::npos) << name << " not in " << message;
  EXPECT_NE(message.find("matching_tolerance"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("rotorstator_morphed.cgns")));
}

TEST_F(Example, RotorstatorIsRefusedFaceByFaceWithoutOpenFaces) {
  link_meshes();
  std::string const morph_without =
      "sed -e '/^open_faces/d' -e 's/, \"open\"//' '" GRIDMORPH_EXAMPLES "/rotorstator.toml' >'" + path("case.toml") +
      "' && '" GRIDMORPH_EXECUTABLE "' morph '" + path("case.toml") + "'";
  EXPECT_EQ(shell(morph_without), 2);
  std::string const message = contents(path("err"));
  for (int block = 1; block <= 14; ++block)
    EXPECT_NE(message.find("zone 'blk" + std::to_string(block) + "'"), std::string::npos)
        << block << " not in " << message;
  EXPECT_NE(message.find("open_faces"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("rotorstator_morphed.cgns")));
}

TEST_F(Example, RotorstatorMovesAllRotorBladesTogether) {
  ASSERT_NO_FATAL_FAILURE(morph("rotorstator", "rotorstator.cgns"));
  for (std::string const zone : {"blk8", "blk10", "blk12", "blk14"})
    expect_motion("K0_1_bc2004", zone, [](Vec3 const&) { return Vec3{0, 0.606, 0}; });
  for (std::string const zone : {"blk2", "blk4", "blk6"}) expect_fixed("K0_1_bc2004", zone);
}

TEST_F(Example, WingFlutterFollowsTheBeamThatItsPlateWasMadeBy) {
  ASSERT_NO_FATAL_FAILURE(morph("wing_flutter", "mdo_tutorial_000_vol.cgns"));
  expect_fixed("wall");  // the series keeps the baseline as its first grid
  ASSERT_EQ(
      shell("cd '" + path("wing_flutter") + "' && '" GRIDMORPH_EXECUTABLE "' morph wing_flutter.toml -o s_{step}.cgns"),
      0)
      << contents(path("err"));
  // First step: bending alone. A thin wing turns its skin with the slope of the beam; the plate has 8 elements along
  // the span, whose chords are off the beam by their length squared times its curvature over 8: 0.007.
  after = read_mesh(path("wing_flutter/s_01.cgns"));
  constexpr double beta = 1.8751040687, sigma = 0.7340955137;
  for_patch("wall", "", [&](Index n) {
    Vec3 const x = before.coordinates[n], u = after.coordinates[n] - x;
    double const h = x.z / 14, b = beta * h;
    double const w = (std::cosh(b) - std::cos(b) - sigma * (std::sinh(b) - std::sin(b))) / 2;
    double const slope = beta / 14 * (std::sinh(b) + std::sin(b) - sigma * (std::cosh(b) - std::cos(b))) / 2;
    EXPECT_NEAR(u.y, w, 0.015) << describe_node(before, n);
    EXPECT_NEAR(u.z, -x.y * slope, 0.01) << describe_node(before, n);
    EXPECT_NEAR(u.x, 0, 0.003) << describe_node(before, n);
  });
  expect_interfaces_closed();
  expect_fixed("far");
}

TEST_F(Example, TurbineFlutterKeepsBladesPeriodicAndTheVanesStill) {
  if (test::reduced()) GTEST_SKIP() << "the stage takes long, and other tests have it";
  ASSERT_NO_FATAL_FAILURE(morph("turbine_flutter", "axial_turbine_stage_H.cgns"));
  ASSERT_EQ(shell("cd '" + path("turbine_flutter") +
                  "' && '" GRIDMORPH_EXECUTABLE "' morph turbine_flutter.toml -o s_{step}.cgns"),
            0)
      << contents(path("err"));
  for (std::string const step : {"03", "09"}) {
    after = read_mesh(path("turbine_flutter/s_" + step + ".cgns"));
    expect_periodic_copies_move_alike(0);
    expect_fixed("BLADE1");
    double tip = 0;
    for_patch("BLADE2", "",
              [&](Index n) { tip = std::max(tip, distance(after.coordinates[n], before.coordinates[n])); });
    EXPECT_GT(tip, 0.002);
    EXPECT_LT(tip, 0.01);
  }
}

TEST_F(Example, HotToColdTurnsTheRotorBackAndKeepsItPeriodic) {
  if (test::reduced()) GTEST_SKIP() << "the stage takes long, and other tests have it";
  ASSERT_NO_FATAL_FAILURE(morph("turbine_hot_to_cold", "axial_turbine_stage_H.cgns"));
  expect_periodic_copies_move_alike(0);
  expect_fixed("BLADE1");
  double tip = 0;
  for_patch("BLADE2", "", [&](Index n) { tip = std::max(tip, distance(after.coordinates[n], before.coordinates[n])); });
  EXPECT_GT(tip, 0.002);
  EXPECT_LT(tip, 0.004);
}

/// From a clone in an empty folder: nothing beside it, nothing in the environment.
TEST_F(Example, EveryCaseFindsItsMeshInTheProjectOrMakesIt) {
  for (auto const& entry : std::filesystem::directory_iterator(GRIDMORPH_EXAMPLES)) {
    if (entry.path().extension() != ".toml") continue;
    std::string const text = contents(entry.path());
    auto const begin = text.find("input  = \"") + 10;
    auto const mesh = text.substr(begin, text.find('"', begin) - begin);
    std::string const geometry = "# mesh: gmsh ";
    auto const of_gmsh = text.find(geometry);
    if (of_gmsh != std::string::npos) {
      auto const name = of_gmsh + geometry.size();
      EXPECT_TRUE(
          std::filesystem::exists(entry.path().parent_path() / text.substr(name, text.find('\n', name) - name)));
    }
    bool const made = of_gmsh != std::string::npos || text.find("# mesh: gridmorph demo ") != std::string::npos;
    EXPECT_NE(made, std::filesystem::exists(entry.path().parent_path() / mesh)) << entry.path() << " needs " << mesh;
  }
}

TEST_F(Example, ScriptSaysSoWhenAMeshIsMissing) {
  std::filesystem::copy(GRIDMORPH_EXAMPLES "/run", path("run"));
  std::filesystem::copy(GRIDMORPH_EXAMPLES "/winglet.toml", path("winglet.toml"));
  EXPECT_EQ(
      shell("'" + path("run") + "' --gridmorph '" GRIDMORPH_EXECUTABLE "' --out '" + path("out_folder") + "' winglet"),
      2);
  EXPECT_NE(contents(path("out")).find("skipped: no meshes/717_wl_L2.cgns"), std::string::npos)
      << contents(path("out"));
  EXPECT_NE(contents(path("err")).find("none of the meshes"), std::string::npos) << contents(path("err"));
}

TEST_F(Example, DemosAreWhereTheyWere) {
  std::string const command = "'" GRIDMORPH_EXECUTABLE "' demo ";
  ASSERT_EQ(shell(command + "passage -q -n 20000 -d '" + path("passage") + "'"), 0) << contents(path("err"));
  for (std::string const motion : {"rotation", "chord"})
    expect_as_before("demo_" + motion, read_mesh(path("passage/passage_" + motion + ".cgns")));
  ASSERT_LE(shell(command + "ball -q -e 50000 -d '" + path("ball") + "'"), 1) << contents(path("err"));
  expect_as_before("demo_ball", read_mesh(path("ball/ball_swing.cgns")));
}

}  // namespace
}  // namespace gridmorph::test
