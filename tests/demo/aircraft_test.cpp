#include <generators/aircraft.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace gridmorph;

AircraftOptions with(Index nodes, double first_cell, bool oriented = false) {
  AircraftOptions options;
  options.nodes = nodes;
  options.first_cell = first_cell;
  options.oriented = oriented;
  return options;
}

template <class F>
void for_each_node(IndexRange const& r, F const& f) {
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) f(Index3{i, j, k});
}

int normal_of(IndexRange const& r) {
  int normal = 0;
  while (r.extent(normal) != 1) ++normal;
  return normal;
}

class Aircraft : public testing::TestWithParam<AircraftOptions> {
 public:
  static void TearDownTestSuite() { made_.clear(); }

 protected:
  Mesh const& mesh = made(GetParam());

  static Mesh const& made(AircraftOptions const& options) {
    auto const key = std::pair(options.nodes, options.oriented);
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(key, make_aircraft(options)).first;
    return found->second;
  }

 private:
  static inline std::map<std::pair<Index, bool>, Mesh> made_;
};

INSTANTIATE_TEST_SUITE_P(Sizes, Aircraft,
                         testing::Values(with(100'000, 1e-3), with(150'000, 4e-4, true), with(400'000, 1e-4)));

TEST_P(Aircraft, HasSeveralHundredZonesAndAboutTheNodesAskedFor) {
  EXPECT_GT(mesh.zones.size(), 300u);
  EXPECT_LT(mesh.zones.size(), 700u);
  EXPECT_NEAR(double(mesh.n_nodes()), double(GetParam().nodes), 0.15 * double(GetParam().nodes));
}

TEST_P(Aircraft, EveryCellIsSound) {
  Kokkos::DefaultHostExecutionSpace const exec;
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  input.baseline = views(mesh.coordinates);
  QualityReport const report = measure_quality(exec, mesh, input);
  EXPECT_EQ(report.far_field.inverted + report.far_field.flat, 0);
  EXPECT_GT(report.far_field[Measure::determinant_3x3x3].min, 0.1);
  EXPECT_GT(report.far_field[Measure::minimum_angle_deg].min, 4);
}

TEST_P(Aircraft, EveryFaceIsJoinedOnceOrHasOnePatchAndJointsCoincideBitForBit) {
  Mesh checked = mesh;
  EXPECT_NO_THROW(connect_and_check(checked, TopologyOptions{}));
  EXPECT_EQ(checked.patches.size(), mesh.patches.size());
  Index joined = 0;
  for (Interface1to1 const& face : mesh.interfaces)
    for_each_node(face.range, [&](Index3 const& p) {
      Vec3 const own = mesh.coordinates[mesh.zones[face.zone].node(p)];
      Vec3 const other = mesh.coordinates[mesh.zones[face.donor_zone].node(face.to_donor(p))];
      ASSERT_TRUE(own == other) << face.name;
      ++joined;
    });
  EXPECT_GT(joined, mesh.n_nodes() / 4);
}

TEST_P(Aircraft, HasItsFamiliesWithSymmetryOnThePlaneAndFarFieldFarAway) {
  std::set<std::string> families;
  for (Patch const& patch : mesh.patches) {
    ASSERT_EQ(patch.families.size(), 1u);
    families.insert(patch.families[0]);
    Zone const& zone = mesh.zones[patch.zone];
    for_each_node(patch.range, [&](Index3 const& p) {
      Vec3 const x = mesh.coordinates[zone.node(p)];
      if (patch.kind == PatchKind::symmetry) {
        ASSERT_EQ(x.y, 0);
      } else if (patch.kind == PatchKind::farfield) {
        ASSERT_GE(std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}), 170 - 1e-9);
      } else {
        ASSERT_EQ(patch.kind, PatchKind::wall);
        ASSERT_LT(std::abs(x.x - 18.15), 18.15 + 1e-9);
        ASSERT_LT(x.y, 17.2);
      }
    });
  }
  EXPECT_EQ(families, std::set<std::string>(mesh.families.begin(), mesh.families.end()));
  EXPECT_EQ(families.size(), 8u);
}

TEST_P(Aircraft, FirstCellsAreAsLongAsAskedForAlongTheirLines) {
  for (Patch const& patch : mesh.patches) {
    if (patch.kind != PatchKind::wall) continue;
    Zone const& zone = mesh.zones[patch.zone];
    int const normal = normal_of(patch.range), inwards = patch.range.begin[normal] == 0 ? 1 : -1;
    for_each_node(patch.range, [&](Index3 const& p) {
      Index3 next = p;
      next[normal] += inwards;
      ASSERT_NEAR(distance(mesh.coordinates[zone.node(p)], mesh.coordinates[zone.node(next)]), GetParam().first_cell,
                  1e-3 * GetParam().first_cell);
    });
  }
}

TEST_P(Aircraft, BodiesAreRoundAndTheAileronHangsAtItsHingeLine) {
  double radius = 0, lowest = 1e9;
  int on_hinge = 0;
  for (Patch const& patch : mesh.patches) {
    Zone const& zone = mesh.zones[patch.zone];
    for_each_node(patch.range, [&](Index3 const& p) {
      Vec3 const x = mesh.coordinates[zone.node(p)];
      if (patch.families[0] == "fuselage" && x.x > 5 && x.x < 24) {
        ASSERT_NEAR(std::hypot(x.y, x.z), 2, 1e-12);
        radius = std::max(radius, x.y);
      }
      if (patch.families[0] != "aileron") return;
      double const leading = 12.5 + (x.y - 2) * 7.64 / 15, chord = 6.6 - (x.y - 2) * 4.9 / 15;
      double const share = (x.x - leading) / chord;
      ASSERT_GT(share, 0.75 - 1e-12);
      ASSERT_LT(share, 1 + 1e-12);
      lowest = std::min(lowest, x.y);
      if (std::abs(share - 0.75) < 1e-12) ++on_hinge;
    });
  }
  EXPECT_NEAR(radius, 2, 0.02);
  EXPECT_NEAR(lowest, 11.8, 1e-12);
  EXPECT_GT(on_hinge, 4);
}

TEST_P(Aircraft, ZonesAreTurnedAndMirroredInManyWays) {
  Kokkos::DefaultHostExecutionSpace const exec;
  auto const handedness = zone_handedness(exec, mesh, views(mesh.coordinates));
  auto const left = std::count(handedness.begin(), handedness.end(), -1);
  std::set<std::pair<std::array<int, 3>, std::array<int, 3>>> orientations;
  for (Interface1to1 const& face : mesh.interfaces)
    orientations.insert({face.to_donor.orientation.axis, face.to_donor.orientation.sign});
  if (GetParam().oriented) {
    EXPECT_LT(orientations.size(), 30u);
  } else {
    EXPECT_GT(left, 200);
    EXPECT_LT(left, 400);
    EXPECT_EQ(orientations.size(), 48u);
  }
}

TEST(AircraftOptions, OutOfRangeAreRefused) {
  EXPECT_THROW(make_aircraft(with(99'999, 1e-3)), ConfigError);
  EXPECT_THROW(make_aircraft(with(200'000, 0)), ConfigError);
  EXPECT_THROW(make_aircraft(with(200'000, std::nan(""))), ConfigError);
}

}  // namespace
