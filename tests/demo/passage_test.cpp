#include "passage_checks.hpp"

#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

namespace {

using namespace passage_checks;

struct Variant {
  char const* name;
  PassageOptions options;
};

std::vector<Variant> variants() {
  std::vector<Variant> all{{"default", small()},        {"five_zones", small()},  {"placed", small()},
                           {"left_handed", small()},    {"cylindrical", small()}, {"bulged", small()},
                           {"flat_tip", small()},       {"squealer", small()},    {"groove", small()},
                           {"groove_in_zones", small()}};
  all[1].options.layout = PassageOptions::Layout::five_zones;
  all[2].options.placement = skew_placement();
  all[2].options.layout = PassageOptions::Layout::five_zones;
  all[3].options.left_handed = true;
  all[4].options.hub = {0.45, 0.45, 0, 0};
  all[4].options.casing = {0.66, 0.66, 0, 0};
  all[5].options.hub = {0.43, 0.47, 0, 0.01};
  all[5].options.casing = {0.68, 0.65, 0.5, -0.01};
  all[6].options.tip = BladeTip::flat;
  all[7].options.tip = BladeTip::squealer;
  all[7].options.layout = PassageOptions::Layout::five_zones;
  all[8].options.tip = BladeTip::groove;
  all[8].options.left_handed = true;
  all[9].options.tip = BladeTip::groove;
  all[9].options.layout = PassageOptions::Layout::five_zones;
  all[9].options.placement = skew_placement();
  return all;
}

class Passage : public testing::TestWithParam<Variant> {
 protected:
  PassageOptions const& options = GetParam().options;
  Mesh mesh = make_passage(options);
};

/// Smallest and largest of the 8 corner Jacobian determinants over all cells, from edge vectors.
std::pair<double, double> corner_jacobians(Mesh const& mesh) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 const n = mesh.zones[z].extent;
    for_each_node({{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}, [&](Index3 const& c) {
      for (int corner = 0; corner < 8; ++corner) {
        Index3 at = c;
        for (int a = 0; a < 3; ++a) at[a] += (corner >> a) & 1;
        Vec3 edge[3];
        for (int a = 0; a < 3; ++a) {
          Index3 low = at, high = at;
          low[a] = c[a];
          high[a] = c[a] + 1;
          edge[a] = node(mesh, z, high) - node(mesh, z, low);
        }
        double const jacobian = dot(edge[0], cross(edge[1], edge[2]));
        lowest = std::min(lowest, jacobian);
        highest = std::max(highest, jacobian);
      }
    });
  }
  return {lowest, highest};
}

TEST_P(Passage, HasNoInvertedCell) {
  auto const [lowest, highest] = corner_jacobians(mesh);
  if (options.left_handed)
    EXPECT_LT(highest, 0);
  else
    EXPECT_GT(lowest, 0);
}

TEST_P(Passage, HasNearlyAsManyNodesAsAskedFor) { EXPECT_NEAR(double(mesh.n_nodes()), 20'000, 0.05 * 20'000); }

TEST_P(Passage, CoversEveryBoundaryCellFaceOnce) {
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 const n = mesh.zones[z].extent;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        int const plane = side == 0 ? 0 : n[axis] - 1, u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::vector<int> claims;
        claims.resize(std::size_t(n[u]) * n[v]);
        auto const claim = [&](int zone, IndexRange const& r) {
          if (zone != z || r.extent(axis) != 1 || r.begin[axis] != plane) return;
          for (int a = r.begin[u]; a < r.end[u] - 1; ++a)
            for (int b = r.begin[v]; b < r.end[v] - 1; ++b) ++claims[a + std::size_t(n[u]) * b];
        };
        for (auto const& p : mesh.patches) claim(p.zone, p.range);
        for (auto const& i : mesh.interfaces) claim(i.zone, i.range);
        for (int a = 0; a < n[u] - 1; ++a)
          for (int b = 0; b < n[v] - 1; ++b)
            ASSERT_EQ(claims[a + std::size_t(n[u]) * b], 1) << mesh.zones[z].name << " " << face_name(axis, side);
      }
  }
}

TEST_P(Passage, InterfaceNodesCoincideBitForBit) {
  for (auto const& i : mesh.interfaces) {
    if (i.periodic) continue;
    for_each_node(i.range, [&](Index3 const& p) {
      ASSERT_TRUE(node(mesh, i.zone, p) == node(mesh, i.donor_zone, i.to_donor(p))) << i.name;
    });
  }
}

TEST_P(Passage, PeriodicNodesAreRotatedCopies) {
  int periodic = 0;
  for (auto const& i : mesh.interfaces) {
    if (!i.periodic) continue;
    ++periodic;
    for_each_node(i.range, [&](Index3 const& p) {
      Vec3 const copy = i.periodic->declared(node(mesh, i.zone, p));
      ASSERT_LT(distance(copy, node(mesh, i.donor_zone, i.to_donor(p))), 2e-15) << i.name;
    });
    // The angles, applied about x, then y, then z, are the declared rotation by one pitch.
    Vec3 const a = i.periodic->rotation_angle_rad;
    Mat3 const r =
        rotation_matrix({0, 0, 1}, a.z) * (rotation_matrix({0, 1, 0}, a.y) * rotation_matrix({1, 0, 0}, a.x));
    double trace = 0;
    for (int row = 0; row < 3; ++row) {
      trace += r.m[row][row];
      for (int col = 0; col < 3; ++col) EXPECT_NEAR(r.m[row][col], i.periodic->declared.rotation.m[row][col], 1e-14);
    }
    EXPECT_NEAR(std::acos((trace - 1) / 2), 2 * std::numbers::pi / options.blades, 1e-12);
    EXPECT_LT(distance(i.periodic->declared(i.periodic->rotation_center), i.periodic->rotation_center), 1e-15);
  }
  bool const in_layers = options.layout == PassageOptions::Layout::whole_faces && options.tip != BladeTip::none;
  EXPECT_EQ(periodic, 6 * (in_layers ? (options.tip == BladeTip::flat ? 2 : 3) : 1));
}

TEST_P(Passage, StoresEveryInterfaceFromBothSides) {
  for (auto const& i : mesh.interfaces) {
    EXPECT_EQ(i.to_donor.orientation.determinant(), 1) << i.name;
    bool const answered = std::any_of(mesh.interfaces.begin(), mesh.interfaces.end(), [&](Interface1to1 const& o) {
      return o.zone == i.donor_zone && o.donor_zone == i.zone && o.range == i.to_donor(i.range) &&
             o.to_donor(o.range) == i.range && o.to_donor(i.to_donor(i.range.begin)) == i.range.begin &&
             o.to_donor.orientation == i.to_donor.orientation.inverse() && bool(o.periodic) == bool(i.periodic);
    });
    EXPECT_TRUE(answered) << i.name;
  }
}

TEST_P(Passage, InterfaceMapsContinueThroughTheFace) {
  // One node further along the map lies inside the donor, not outside.
  for (auto const& i : mesh.interfaces)
    for (int axis = 0; axis < 3; ++axis) {
      if (i.range.extent(axis) != 1) continue;
      Index3 beyond = i.range.begin;
      beyond[axis] += i.range.begin[axis] == 0 ? -1 : 1;
      Index3 const n = mesh.zones[i.donor_zone].extent;
      EXPECT_TRUE((IndexRange{{0, 0, 0}, n}.contains(i.to_donor(beyond)))) << i.name;
    }
}

TEST_P(Passage, EndWallNodesLieOnTheirSurface) {
  RigidTransform const back = options.placement.inverse();
  int checked = 0;
  for (auto const& p : mesh.patches) {
    bool const hub = p.families.front() == "hub";
    if (!hub && p.families.front() != "case") continue;
    for_each_node(p.range, [&](Index3 const& at) {
      Vec3 const x = back(node(mesh, p.zone, at));
      double const expected = end_wall_radius(hub ? options.hub : options.casing, x.x, options);
      ASSERT_NEAR(std::hypot(x.y, x.z), expected, 3e-15) << describe_patch(mesh, p);
      ++checked;
    });
  }
  EXPECT_GT(checked, 0);
}

TEST_P(Passage, InletAndOutletLieAtTheirAxialPosition) {
  RigidTransform const back = options.placement.inverse();
  for (auto const& p : mesh.patches) {
    if (p.kind != PatchKind::inflow && p.kind != PatchKind::outflow) continue;
    double const expected = p.kind == PatchKind::inflow ? options.inlet : options.outlet;
    for_each_node(p.range, [&](Index3 const& at) { ASSERT_NEAR(back(node(mesh, p.zone, at)).x, expected, 2e-15); });
  }
}

TEST_P(Passage, NamesItsFamiliesWithTheirBoundaryTypes) {
  std::map<std::string, std::set<std::string>> types;
  std::set<std::string> names;
  for (auto const& p : mesh.patches) {
    types[p.families.front()].insert(p.bc_type);
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_LE(p.name.size(), 32u) << "CGNS names";
  }
  std::map<std::string, std::set<std::string>> expected{{"blade", {"BCWallViscous"}},
                                                        {"hub", {"BCWallViscous"}},
                                                        {"case", {"BCWallViscous"}},
                                                        {"inlet", {"BCInflow"}},
                                                        {"outlet", {"BCOutflow"}}};
  for (std::string const& family : blade_families(options.tip)) expected[family] = {"BCWallViscous"};
  EXPECT_EQ(types, expected);
  for (auto const& i : mesh.interfaces) EXPECT_LE(i.name.size(), 32u) << "CGNS names";
  // Zones and families are children of one CGNS node.
  for (auto const& zone : mesh.zones) EXPECT_EQ(expected.count(zone.name), 0u) << zone.name;
}

INSTANTIATE_TEST_SUITE_P(Variants, Passage, testing::ValuesIn(variants()),
                         [](auto const& info) { return std::string(info.param.name); });

TEST(PassageCounts, MeetTheWantedNodesFromTwentyThousandToFortyMillion) {
  for (Index const nodes : {10'000, 20'000, 77'777, 200'000, 1'000'000, 10'000'000, 40'000'000}) {
    PassageCounts const c = passage_counts(small(nodes));
    int const le = c.leading_upper + c.leading_lower, te = c.trailing_upper + c.trailing_lower;
    double section = 0;
    for (int const around : {le, te, c.side, c.side}) section += (around + 1.0) * (c.layers + 1);
    for (int const pitchwise : {c.lower, c.upper}) section += (c.side + c.inlet + c.outlet + 3.0) * (pitchwise + 1);
    section += (c.inlet + 1.0) * (le + 1) + (c.outlet + 1.0) * (te + 1);
    EXPECT_NEAR(section * (c.span + 1) / double(nodes), 1, 0.03) << nodes;
  }
}

TEST(PassageMesh, FirstCellsHaveTheWantedHeightNormalToTheBlade) {
  PassageOptions options = small(200'000);
  options.hub = {0.45, 0.45, 0, 0};
  options.casing = {0.65, 0.65, 0, 0};
  for (auto& s : options.sections) s.chord = 0.12;
  Mesh const mesh = make_passage(options);
  for (char const* name : {"ring_le", "ring_upper", "ring_te", "ring_lower"}) {
    int const z = zone_named(mesh, name);
    Index3 const n = mesh.zones[z].extent;
    for_each_node({{1, 0, 0}, {n[0] - 1, n[1], 1}}, [&](Index3 const& p) {
      Developed const wall = develop(options, node(mesh, z, p)), off = develop(options, node(mesh, z, {p[0], p[1], 1}));
      ASSERT_NEAR(std::hypot(off.x - wall.x, off.y - wall.y), options.first_cell * 0.12,
                  1e-4 * options.first_cell * 0.12);
      // Across a chord of the contour through both neighbours, to the order of its curvature.
      Developed const before = develop(options, node(mesh, z, {p[0] - 1, p[1], 0}));
      Developed const after = develop(options, node(mesh, z, {p[0] + 1, p[1], 0}));
      double const along = (after.x - before.x) * (off.x - wall.x) + (after.y - before.y) * (off.y - wall.y);
      double const across = (after.x - before.x) * (off.y - wall.y) - (after.y - before.y) * (off.x - wall.x);
      ASSERT_LT(std::abs(std::atan2(along, across)), 0.12) << name << " " << p[0];
    });
  }
}

TEST(PassageMesh, FirstCellsOfWallsAndEndWallsAreTheShareOfTheSpanThatIsAskedFor) {
  PassageOptions options = small(20'000);
  options.hub = {0.45, 0.45, 0, 0};
  options.casing = {0.65, 0.65, 0, 0};
  for (auto& s : options.sections) s.chord = 0.12;
  constexpr double span = 0.2, share = 1e-6;
  set_first_cells(options, share);
  Mesh const mesh = make_passage(options);
  int const z = zone_named(mesh, "ring_upper");
  Index3 const n = mesh.zones[z].extent;
  auto const radius = [&](int j) {
    Vec3 const x = node(mesh, z, {1, j, 0});
    return std::hypot(x.y, x.z);
  };
  EXPECT_NEAR(radius(1) - radius(0), share * span, 1e-3 * share * span);
  EXPECT_NEAR(radius(n[1] - 1) - radius(n[1] - 2), share * span, 1e-3 * share * span);
  Developed const wall = develop(options, node(mesh, z, {1, 3, 0})), off = develop(options, node(mesh, z, {1, 3, 1}));
  EXPECT_NEAR(std::hypot(off.x - wall.x, off.y - wall.y), share * span, 1e-3 * share * span);
}

TEST(PassageMesh, RefusesFirstCellsThatFillTheSpan) {
  PassageOptions options = small();
  for (double const share : {0.0, -1e-6, 0.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(set_first_cells(options, share), ConfigError) << share;
}

TEST(PassageMesh, RefusesOptionsThatMakeNoPassageAndNamesThemAll) {
  PassageOptions options = small();
  options.nodes = 12;
  options.blades = 1;
  options.sections[1].chord = -1;
  options.max_growth = std::numeric_limits<double>::quiet_NaN();
  try {
    make_passage(options);
    FAIL() << "accepted";
  } catch (ConfigError const& e) {
    std::string const text = e.what();
    for (char const* part : {"nodes is 12", "blades is 1", "mid-span section chord is -1", "max_growth is nan"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
}

TEST(PassageMesh, RefusesABladeThatDoesNotFit) {
  PassageOptions crowded = small();
  crowded.blades = 200;
  EXPECT_THROW(make_passage(crowded), ConfigError);
  PassageOptions short_domain = small();
  short_domain.inlet = -0.05;
  EXPECT_THROW(make_passage(short_domain), ConfigError);
  PassageOptions closed = small();
  closed.casing.outlet_radius = 0.3;
  EXPECT_THROW(make_passage(closed), ConfigError);
}

}  // namespace
