// Targets given by section profiles.
#include <gtest/gtest.h>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/target/section_profile.hpp>

#include "target_cases.hpp"

namespace gridmorph::test {
namespace {

using Mapping = TargetRule::Mapping;

/// Sections of the wing at given spans, n points each, moved.
TargetGeometry sections(std::vector<double> const& spans, int n, Map const& map) {
  TargetGeometry out;
  for (double const h : spans) {
    TargetSection s{"z " + std::to_string(h), {}};
    for (int k = 0; k < n; ++k) s.points.push_back(map(wing(double(k % (n - 1)) / (n - 1), h)));
    out.sections.push_back(std::move(s));
  }
  return out;
}

TargetRule along_z(TargetGeometry geometry) {
  TargetRule rule = rule_of(std::move(geometry));
  rule.span = Vec3{0, 0, 1};
  return rule;
}

/// Span fractions of the rows of wing_mesh(ni, nj).
std::vector<double> rows(int nj) {
  std::vector<double> out;
  for (int j = 0; j < nj; ++j) {
    double const h = double(j) / (nj - 1);
    out.push_back(h * (0.8 + 0.2 * h));
  }
  return out;
}

/// Sections twist about their quarter chord and grow, both along the span.
Vec3 twisted_wing(Vec3 const& x) {
  double const h = x.z / 3, angle = 0.2 * h, size = 1 + 0.1 * h, x0 = 0.5 * h + 0.25;
  double const c = size * std::cos(angle), s = size * std::sin(angle);
  return {x0 + c * (x.x - x0) - s * x.y, s * (x.x - x0) + c * x.y, x.z};
}

TEST(SectionProfile, PositionsSurviveAnyStartAndSense) {
  std::vector<Vec3> points;
  for (int k = 0; k < 80; ++k) points.push_back(airfoil(k / 80.0));
  SectionProfile const straight(points, {0, 0, 1}, {1, 0, 0}, "test");
  auto const at = straight.positions();
  EXPECT_EQ(at[0].stretch, 0);
  EXPECT_NEAR(at[0].fraction, 0, 1e-15);
  std::vector<Vec3> turned(points.begin() + 31, points.end());
  turned.insert(turned.end(), points.begin(), points.begin() + 31);
  std::reverse(turned.begin(), turned.end());
  SectionProfile const other(turned, {0, 0, 1}, {1, 0, 0}, "test");
  for (int k = 0; k < 80; ++k) EXPECT_LT(distance(other.at(at[k]), points[k]), 1e-14) << k;
}

TEST(SectionProfile, CurvesBetweenPointsAtThirdOrderOrBetter) {
  auto const error = [](int n) {
    std::vector<Vec3> points;
    for (int k = 0; k < n; ++k) {
      double const a = 2 * std::numbers::pi * k / n;
      points.push_back({2 * std::cos(a), std::sin(a), 0});
    }
    SectionProfile const profile(points, {0, 0, 1}, {1, 0, 0}, "test");
    double worst = 0;
    for (int k = 0; k < 500; ++k)
      for (int stretch = 0; stretch < 2; ++stretch) {
        Vec3 const p = profile.at({stretch, k / 500.0});
        worst = std::max(worst, std::fabs(0.25 * p.x * p.x + p.y * p.y - 1));
      }
    return worst;
  };
  EXPECT_GT(error(40) / error(80), 7);
}

TEST(SectionProfile, ABluntBaseIsAStretchOfItsOwn) {
  std::vector<Vec3> points;
  for (int k = 4; k <= 76; ++k) points.push_back(airfoil(k / 80.0));  // open: the trailing edge is cut off
  SectionProfile const profile(points, {0, 0, 1}, {1, 0, 0}, "test");
  auto const at = profile.positions();
  EXPECT_LT(distance(profile.at({0, 0}), points.front()), 1e-15);
  EXPECT_LT(distance(profile.at({1, 1}), points.back()), 1e-15);
  EXPECT_LT(distance(profile.at({2, 0.5}), 0.5 * (points.front() + points.back())), 1e-9);
  EXPECT_EQ(at[20].stretch, 0);
  EXPECT_EQ(at[60].stretch, 1);
}

TEST(TargetSections, ATargetThatIsTheBaselineMovesNothing) {
  Mesh const mesh = wing_mesh();
  TargetGeometry same;
  auto const nodes = nodes_of(mesh, 0);
  for (int j = 0; j < 11; ++j)
    same.sections.push_back({std::to_string(j), {nodes.begin() + 61 * j, nodes.begin() + 61 * (j + 1)}});
  TargetRun const run(mesh, along_z(same));
  EXPECT_TRUE(run.stands_still());
  EXPECT_EQ(run.reach().mapping, Mapping::sections);
}

TEST(TargetSections, AMovedCopyOfTheRowsIsReproduced) {
  Mesh const mesh = wing_mesh();
  TargetRun const run(mesh, along_z(sections(rows(11), 61, twisted_wing)));
  EXPECT_LT(run.error(twisted_wing), 1e-12);
  EXPECT_LT(run.reach().max, 1e-12);
}

TEST(TargetSections, AnyStartSenseAndOrderOfSectionsIsTheSameTarget) {
  Mesh const mesh = wing_mesh();
  TargetGeometry mixed = sections(rows(11), 61, twisted_wing);
  for (std::size_t k = 0; k < mixed.sections.size(); ++k) {
    auto& points = mixed.sections[k].points;
    points.pop_back();
    std::rotate(points.begin(), points.begin() + 7 * std::ptrdiff_t(k % 8), points.end());
    if (k % 2 == 1) std::reverse(points.begin(), points.end());
  }
  std::reverse(mixed.sections.begin(), mixed.sections.end());
  EXPECT_LT(TargetRun(mesh, along_z(mixed)).error(twisted_wing), 1e-12);
}

TEST(TargetSections, OtherNumbersOfPointsAndStationsConvergeAtSecondOrder) {
  // Arc lengths of polygons, of the mesh's as of the target's, are second order.
  auto const error = [](int n) {
    std::vector<double> spans;
    for (int k = 0; k <= n / 8; ++k) spans.push_back(8.0 * k / n);
    return TargetRun(wing_mesh(3 * n / 2 + 1, 11), along_z(sections(spans, n + 1, twisted_wing))).error(twisted_wing);
  };
  double const coarse = error(40), fine = error(80), finest = error(160);
  EXPECT_LT(finest, 2e-4);
  EXPECT_GT(coarse / finest, 10) << coarse << " " << fine << " " << finest;
}

TEST(TargetSections, FractionsReachTheEndsOfALongerWingAndPositionsStayWhereTheyAre) {
  Mesh const mesh = wing_mesh();
  Map const longer = [](Vec3 const& x) { return Vec3{x.x, x.y, 1.25 * x.z + 0.5}; };
  TargetRule rule = along_z(sections(rows(11), 61, longer));
  EXPECT_LT(TargetRun(mesh, rule).error(longer), 1e-12);
  rule = along_z(sections(rows(15), 61, [](Vec3 const& x) { return Vec3{x.x, x.y, 1.25 * x.z - 0.2}; }));
  rule.span_match = TargetRule::SpanMatch::position;
  TargetRun const run(mesh, rule);
  for (Vec3 const& u : run.displacement(0)) EXPECT_NEAR(u.z, 0, 1e-12);
}

TEST(TargetSections, FewStationsFarShortOfTheSpanAreAnError) {
  TargetRule rule = along_z(sections({0.2, 0.4, 0.6}, 61, same_place));
  rule.span_match = TargetRule::SpanMatch::position;
  EXPECT_THROW(TargetRun(wing_mesh(), rule), MotionError);
}

TEST(TargetSections, OneSectionShapesAMeshOfParallelSections) {
  Mesh const mesh = wing_mesh();
  TargetGeometry one = sections({0}, 61, same_place);
  TargetRun const run(mesh, along_z(one));
  auto const points = nodes_of(mesh, 0);
  auto const u = run.displacement(0);
  for (std::size_t n = 0; n < points.size(); ++n) {
    Vec3 const wanted = wing(double(n % 61 % 60) / 60, 0);
    EXPECT_NEAR(points[n].x + u[n].x, wanted.x, 1e-12);
    EXPECT_NEAR(points[n].y + u[n].y, wanted.y, 1e-12);
    EXPECT_EQ(points[n].z + u[n].z, points[n].z);
  }
}

TEST(TargetSections, SectionsAroundAnAxisGoByTheRadius) {
  // The wing as a blade: z is the radius from 5, x the axis, y around it.
  auto const rolled = [](Vec3 const& x) {
    double const r = 5 + x.z, a = x.y / 5;
    return Vec3{x.x, r * std::sin(a), r * std::cos(a)};
  };
  MeshBuilder builder("blade");
  Mesh const flat = wing_mesh();
  int const zone = builder.zone("blade", {61, 11, 3},
                                [&](Index3 const& p) { return rolled(flat.coordinates[flat.zones[0].node(p)]); });
  builder.patch("blade", PatchKind::wall, zone, 2, 0);
  Mesh const mesh = builder.finish();
  // Sections turn about the axis and slide along it.
  auto const moved = [](Vec3 const& x) {
    double const h = std::hypot(x.y, x.z) - 5, c = std::cos(0.1 * h), s = std::sin(0.1 * h);
    return Vec3{x.x + 0.05 * h * h, c * x.y - s * x.z, s * x.y + c * x.z};
  };
  TargetGeometry target = sections(rows(11), 61, [&](Vec3 const& x) { return moved(rolled(x)); });
  TargetRun const run(mesh, rule_of(target));
  auto const u = run.displacement(0);
  auto const points = nodes_of(mesh, 0);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(distance(points[n] + u[n], moved(points[n])), 1e-11) << n;
}

TEST(SectionProfile, EdgesOfHMeshesAreThePointsFarthestAlongTheFlow) {
  // An ellipse at 30 degrees: its ends along x are none of its vertices, and where they are is known.
  std::vector<Vec3> points;
  double const turn = std::numbers::pi / 6, c = std::cos(turn), s = std::sin(turn);
  for (int k = 0; k < 200; ++k) {
    double const a = 2 * std::numbers::pi * (k + 0.3) / 200;
    Vec3 const p{2 * std::cos(a), 0.5 * std::sin(a), 0};
    points.push_back({c * p.x - s * p.y, s * p.x + c * p.y, 0});
  }
  double const end = std::hypot(2 * c, 0.5 * s), across = (4 - 0.25) * c * s / end;
  SectionProfile const extreme(points, {0, 0, 1}, {1, 0, 0}, "test", SectionProfile::Edges::extreme);
  EXPECT_LT(distance(extreme.at({0, 1}), {-end, -across, 0}), 2e-3);
  EXPECT_LT(distance(extreme.at({0, 0}), {end, across, 0}), 2e-3);
  SectionProfile const farthest(points, {0, 0, 1}, {1, 0, 0}, "test");
  EXPECT_LT(distance(farthest.at({0, 1}), {-2 * c, -2 * s, 0}), 2e-3);
}

/// The wing as a blade: z is the radius from 5, x the axis, y around it. Or, flat, as it is.
struct Cascade {
  bool flat;
  double pitch;  ///< angle, or length along y

  [[nodiscard]] Vec3 place(Vec3 const& x, double copy = 0) const {
    if (flat) return {x.x, x.y + copy * pitch, x.z};
    double const r = 5 + x.z, a = x.y / 5 + copy * pitch;
    return {x.x, r * std::sin(a), r * std::cos(a)};
  }
  /// H mesh between the upper side of one blade and the lower side of the next.
  [[nodiscard]] Mesh mesh(bool periodic = true) const {
    constexpr int before = 4, along = 30, behind = 5, ni = before + along + behind + 1, nj = 9, nk = 5;
    auto const side = [](int i, double h, bool upper) {
      Vec3 const le = wing(0.5, h), te = wing(0, h);
      if (i < before) return Vec3{le.x - 0.2 * (before - i), le.y, le.z};
      if (i > before + along) return Vec3{te.x + 0.2 * (i - before - along), te.y, te.z};
      int const m = i - before;
      return i == before ? le : i == before + along ? te : wing(double(upper ? along - m : along + m) / (2 * along), h);
    };
    MeshBuilder builder("cascade");
    int const zone = builder.zone("passage", {ni, nj, nk}, [=, this](Index3 const& p) {
      double const h = double(p[1]) / (nj - 1), w = double(p[2]) / (nk - 1);
      // Sides to the bit, so that the baseline's sections are exactly its nodes.
      if (p[2] == 0) return place(side(p[0], h, true));
      if (p[2] == nk - 1) return place(side(p[0], h, false), 1);
      return place((1 - w) * side(p[0], h, true) + w * side(p[0], h, false), w);
    });
    std::optional<Periodic> const copy =
        flat ? periodic_translation({0, pitch, 0}) : rotation({0, 0, 0}, {1, 0, 0}, -pitch);
    for (auto const& [lo, hi] : {std::pair(0, before + 1), std::pair(before + along, ni)}) {
      IndexRange const own{{lo, 0, 0}, {hi, nj, 1}}, other{{lo, 0, nk - 1}, {hi, nj, nk}};
      if (periodic) builder.join(zone, own, zone, other, {}, copy);
    }
    builder.patch("blade", PatchKind::wall, zone, {{before, 0, 0}, {before + along + 1, nj, 1}});
    builder.patch("blade", PatchKind::wall, zone, {{before, 0, nk - 1}, {before + along + 1, nj, nk}});
    return builder.finish();
  }
  [[nodiscard]] TargetRule rule(Map const& map, double copy, int n = 61) const {
    std::vector<double> spans;
    for (int j = 0; j < 9; ++j) spans.push_back(j / 8.0);
    TargetRule out = rule_of(sections(spans, n, [&, this](Vec3 const& x) { return map(place(x, copy)); }));
    if (flat) out.span = Vec3{0, 0, 1};
    return out;
  }
};

TEST(TargetSections, SidesAPitchApartAreOneBlade) {
  // Sections turn about the axis, or rise along the pitch, and slide along the flow: what one copy does, all do.
  auto const turned = [](Vec3 const& x) {
    double const h = std::hypot(x.y, x.z) - 5, c = std::cos(0.03 * h), s = std::sin(0.03 * h);
    return Vec3{x.x + 0.05 * h * h, c * x.y - s * x.z, s * x.y + c * x.z};
  };
  auto const raised = [](Vec3 const& x) { return Vec3{x.x + 0.05 * x.z * x.z, x.y + 0.1 * x.z, x.z}; };
  for (bool const flat : {false, true}) {
    Cascade const row{flat, flat ? 1.4 : 0.3};
    Map const map = flat ? Map(raised) : Map(turned);
    for (double const copy : {0.0, 1.0}) {  // the target is at the one blade or at the other
      TargetRun const run(row.mesh(), row.rule(map, copy));
      EXPECT_LT(run.error(map), 1e-11) << flat << copy;
      EXPECT_LT(run.reach().max, 1e-11) << flat << copy;
      EXPECT_NE(run.surface.notes().front().find("1 of 2 patches are a pitch away"), std::string::npos);
    }
  }
}

TEST(TargetSections, SidesAPitchApartThatAreTheTargetStandStill) {
  Cascade const row{false, 0.3};
  TargetRun const run(row.mesh(), row.rule(same_place, 0));
  EXPECT_LT(run.error(same_place), 2e-15 * run.mesh.size());
  for (Vec3 const& u : run.displacement(0)) EXPECT_TRUE(u == (Vec3{0, 0, 0})) << "the side at home, bit for bit";
}

TEST(TargetSections, SidesThatNothingBringsTogetherAreAnError) {
  Cascade const row{false, 0.3};
  try {
    TargetRun const run(row.mesh(false), row.rule(same_place, 0));
    FAIL() << "two sides a pitch apart, and no interface says so";
  } catch (MotionError const& error) {
    EXPECT_NE(std::string(error.what()).find("periodic interface"), std::string::npos) << error.what();
  }
}

TEST(TargetSections, SidesInBlocksAboveAndBelowAreOneContour) {
  // An H-grid with the wing between two zones; of the lower one i runs upstream.
  MeshBuilder builder("above and below");
  constexpr int along = 30, nj = 9;
  for (bool const upper : {true, false}) {
    int const zone = builder.zone(upper ? "above" : "below", {along + 1, nj, 3}, [=](Index3 const& p) {
      int const m = upper ? p[0] : along - p[0];
      Vec3 const x = wing(double(m == along ? 0
                                 : upper    ? along - m
                                            : along + m) /
                              (2 * along),
                          double(p[1]) / (nj - 1));
      return x + Vec3{0, (upper ? 0.2 : -0.2) * p[2], 0};
    });
    builder.patch("blade", PatchKind::wall, zone, 2, 0);
  }
  std::vector<double> spans;
  for (int j = 0; j < nj; ++j) spans.push_back(double(j) / (nj - 1));
  TargetRun const run(builder.finish(), along_z(sections(spans, 61, twisted_wing)));
  EXPECT_LT(run.error(twisted_wing), 1e-12);
  EXPECT_LT(run.reach().max, 1e-12);
}

TEST(TargetSections, UnusableSectionsAreErrors) {
  Mesh const mesh = wing_mesh();
  EXPECT_THROW(TargetRun(mesh, along_z(sections({0.5, 0.5}, 61, same_place))), MotionError);
  EXPECT_THROW(TargetRun(mesh, along_z(sections({0, 1}, 4, same_place))), MotionError);
  TargetRule rule = along_z(sections({0, 1}, 61, same_place));
  rule.flow = {0, 0, 0};
  EXPECT_THROW(TargetRun(mesh, rule), MotionError);
  rule.flow = {0, 1e-9, 1};
  EXPECT_THROW(TargetRun(mesh, rule), MotionError);
  EXPECT_THROW(TargetRun(shell_mesh(), rule_of(sections({0, 1}, 61, same_place))), MotionError);
}

}  // namespace
}  // namespace gridmorph::test
