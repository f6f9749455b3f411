// Statistics over meshes against plain loops: values, places, handedness, neighbours across interfaces, refusals.
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/quality.hpp>

#include "quality/reference_cell.hpp"
#include "quality/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace gridmorph {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using test::cell_corners;
using test::input_of;

Vec3 swirl(Vec3 const& p) { return p + 0.03 * Vec3{std::sin(6 * p.y), p.x * p.z, std::cos(5 * p.x + p.y)}; }

/// Statistics of one measure by a plain loop.
struct Expected {
  double min = std::numeric_limits<double>::max(), max = std::numeric_limits<double>::lowest(), sum = 0;
  int min_zone = -1, max_zone = -1;
  Index3 min_cell{}, max_cell{};
  Index cells = 0;

  void add(double v, int zone, Index3 const& cell) {
    if (v < min) {
      min = v;
      min_zone = zone;
      min_cell = cell;
    }
    if (v > max) {
      max = v;
      max_zone = zone;
      max_cell = cell;
    }
    sum += v;
    ++cells;
  }
};

void expect_agrees(MeasureStatistics const& s, Expected const& e, bool larger_is_worse, double tolerance) {
  EXPECT_NEAR(s.min, e.min, tolerance);
  EXPECT_NEAR(s.max, e.max, tolerance);
  EXPECT_NEAR(s.mean, e.sum / double(e.cells), tolerance);
  EXPECT_EQ(s.worst, larger_is_worse ? s.max : s.min);
  EXPECT_EQ(s.worst_zone, larger_is_worse ? e.max_zone : e.min_zone);
  EXPECT_EQ(s.worst_cell, larger_is_worse ? e.max_cell : e.min_cell);
}

TEST(MeasureQuality, StatisticsAndWorstCellsAgreeWithPlainLoopsInBothRegions) {
  Mesh const mesh = test::two_zones(test::all_orientations()[13], false);
  Coordinates const after = test::moved(mesh, swirl);
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> near_field("near_field", mesh.n_cells());
  for (Index c = 0; c < mesh.n_cells(); ++c) near_field(c) = c % 3 == 0 ? 1 : 0;
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  input.near_field = near_field;
  QualityReport const report = measure_quality(Exec(), mesh, input);

  std::vector<int> const handedness = zone_handedness(Exec(), mesh, views(mesh.coordinates));
  std::array<std::map<Measure, Expected>, 2> expected;
  Index number = 0;
  test::each_cell(mesh, [&](int zone, Index3 const& cell) {
    auto& e = expected[number++ % 3 == 0 ? 0 : 1];
    auto const corners = cell_corners(mesh, after, zone, cell);
    test::ReferenceCell const r = test::reference(corners, handedness[zone]);
    e[Measure::aspect_ratio].add(r.aspect_ratio, zone, cell);
    e[Measure::determinant_2x2x2].add(r.determinant_2x2x2, zone, cell);
    e[Measure::determinant_3x3x3].add(r.determinant_3x3x3, zone, cell);
    e[Measure::minimum_angle_deg].add(r.minimum_angle_deg, zone, cell);
    e[Measure::equiangle_skewness].add(r.equiangle_skewness, zone, cell);
    e[Measure::volume].add(r.volume, zone, cell);
    e[Measure::relative_displacement].add(
        test::reference_relative_displacement(cell_corners(mesh, mesh.coordinates, zone, cell), corners), zone, cell);
  });
  int const regions = 2;
  for (int r = 0; r < regions; ++r) {
    QualityRegion const& region = r == 0 ? report.near_field : report.far_field;
    EXPECT_EQ(region.inverted, 0);
    EXPECT_EQ(region.collapsed, 0);
    for (auto const& [measure, e] : expected[r]) {
      SCOPED_TRACE(to_string(measure));
      EXPECT_EQ(region.cells, e.cells);
      expect_agrees(region[measure], e, larger_is_worse(measure), 1e-10);
    }
  }
  EXPECT_TRUE(report.against_baseline);
  EXPECT_EQ(report.zone_names, (std::vector<std::string>{"first", "second"}));
}

/// Neighbours found by comparing the four corner points of every face of every cell.
std::vector<double> volume_ratios_by_matching_faces(Mesh const& mesh, std::vector<int> const& handedness) {
  using Key = std::array<std::array<long, 3>, 4>;
  std::map<Key, std::vector<Index>> cells_of_face;
  std::vector<double> volumes;
  test::each_cell(mesh, [&](int zone, Index3 const& cell) {
    auto const c = cell_corners(mesh, mesh.coordinates, zone, cell);
    for (auto const& face : test::face_corners) {
      Key key;
      for (int n = 0; n < 4; ++n) {
        Vec3 const& p = c[face[n]];
        key[n] = {std::lround(p.x * 1e9), std::lround(p.y * 1e9), std::lround(p.z * 1e9)};
      }
      std::sort(key.begin(), key.end());
      cells_of_face[key].push_back(Index(volumes.size()));
    }
    volumes.push_back(test::gauss_volume(c, handedness[zone]));
  });
  std::vector<double> ratios(volumes.size(), 1);
  for (auto const& [key, cells] : cells_of_face)
    if (cells.size() == 2) {
      double const a = volumes[cells[0]], b = volumes[cells[1]], ratio = std::max(a, b) / std::min(a, b);
      for (Index const c : cells) ratios[c] = std::max(ratios[c], ratio);
    }
  return ratios;
}

TEST(MeasureQuality, VolumeRatiosCrossInterfacesOfEveryOrientation) {
  for (Orientation const& orientation : test::all_orientations())
    for (bool const both_sides : {false, true}) {
      Mesh const mesh = test::two_zones(orientation, both_sides);
      std::vector<int> const handedness = zone_handedness(Exec(), mesh, views(mesh.coordinates));
      std::vector<double> const expected = volume_ratios_by_matching_faces(mesh, handedness);
      Measure const wanted[] = {Measure::volume_ratio};
      auto const fields = cell_fields(Exec(), mesh, input_of(mesh), std::span<Measure const>(wanted));
      for (std::size_t c = 0; c < expected.size(); ++c) ASSERT_NEAR(fields[0](c), expected[c], 1e-12) << "cell " << c;
      QualityReport const report = measure_quality(Exec(), mesh, input_of(mesh));
      EXPECT_EQ(report.far_field[Measure::volume_ratio].max,
                *std::max_element(fields[0].data(), fields[0].data() + fields[0].extent(0)));
    }
}

TEST(MeasureQuality, DoesNotDependOnTheOrientationOfZones) {
  QualityReport const plain = measure_quality(Exec(), test::two_zones({}, true), input_of(test::two_zones({}, true)));
  for (Orientation const& orientation : test::all_orientations()) {
    Mesh const mesh = test::two_zones(orientation, true);
    QualityReport const report = measure_quality(Exec(), mesh, input_of(mesh));
    EXPECT_EQ(report.left_handed_zones, orientation.determinant() < 0 ? 1 : 0);
    EXPECT_EQ(report.far_field.inverted, 0);
    for (std::size_t m = 0; m < n_measures; ++m) {
      EXPECT_NEAR(report.far_field.measure[m].min, plain.far_field.measure[m].min, 1e-11);
      EXPECT_NEAR(report.far_field.measure[m].mean, plain.far_field.measure[m].mean, 1e-11);
      EXPECT_NEAR(report.far_field.measure[m].max, plain.far_field.measure[m].max, 1e-11);
    }
  }
}

TEST(MeasureQuality, ZoneTurnedInsideOutByMorphingIsInvertedEverywhere) {
  Mesh const mesh = test::two_zones({}, true);
  Coordinates const mirrored = test::moved(mesh, [](Vec3 const& p) { return Vec3{-p.x, p.y, p.z}; });
  auto input = input_of(mesh);
  input.coordinates = views(mirrored);
  EXPECT_EQ(measure_quality(Exec(), mesh, input).far_field.inverted, 0);  // as a baseline: a left-handed mesh
  input.baseline = views(mesh.coordinates);
  QualityReport const report = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(report.far_field.inverted, mesh.n_cells());
  EXPECT_EQ(report.far_field.newly_inverted, mesh.n_cells());
}

TEST(MeasureQuality, InvertedCellOfTheBaselineIsNotCountedAsNew) {
  Mesh mesh = test::one_zone({5, 5, 5}, [](Index3 const& p) { return Vec3{double(p[0]), double(p[1]), double(p[2])}; });
  Index const node = mesh.zones[0].node({2, 2, 2});
  mesh.coordinates.set(node, {0.5, 2, 2});  // beyond the neighbouring node: inverts the four cells behind it
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) { return 2 * p; });
  auto input = input_of(mesh);
  QualityReport const before = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(before.far_field.inverted, 4);
  EXPECT_EQ(before.far_field.newly_inverted, 0);
  input.baseline = input.coordinates;
  input.coordinates = views(after);
  QualityReport const report = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(report.far_field.inverted, 4);
  EXPECT_EQ(report.far_field.newly_inverted, 0);
}

Vec3 index_position(Index3 const& p) { return {double(p[0]), double(p[1]), double(p[2])}; }

TEST(MeasureQuality, FlatCellsAreCountedAndRoundOffInThemInvertsNothing) {
  Mesh mesh = test::one_zone({4, 4, 4}, [](Index3 const& p) {
    Vec3 const x = index_position(p);
    return p[2] == 3 ? Vec3{x.x, x.y, 2 + 1e-15 * ((p[0] + p[1]) % 2)} : x;  // the last layer has no height
  });
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) {
    return p + Vec3{1e-3 * std::sin(p.y), 0, p.z > 2 ? -3e-15 : 0};
  });
  auto input = input_of(mesh);
  QualityReport const before = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(before.far_field.flat, 9);
  EXPECT_EQ(before.far_field.inverted, 0);
  EXPECT_EQ(before.far_field[Measure::determinant_3x3x3].min, 0);
  input.baseline = input.coordinates;
  input.coordinates = views(after);
  for (bool const fast : {false, true}) {
    input.fast = fast;
    QualityReport const report = measure_quality(Exec(), mesh, input);
    EXPECT_EQ(report.far_field.flat, 9);
    EXPECT_EQ(report.far_field.inverted, 0);
    for (FallenCells const& fallen : report.far_field.fallen) EXPECT_EQ(fallen.cells, 0);
  }
  // Beyond round-off the layer is inverted, and a layer pressed flat has lost its volume.
  Coordinates const through = test::moved(mesh, [](Vec3 const& p) {
    return Vec3{p.x, p.y, p.z > 1.5 ? p.z - (p.z > 2 ? 1e-3 : 0) : p.z == 1 ? 0 : p.z};
  });
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.zones[0].index(n)[2] == 3) through.z(n) = 2 - 1e-3;
  input.coordinates = views(through);
  for (bool const fast : {false, true}) {
    input.fast = fast;
    QualityReport const report = measure_quality(Exec(), mesh, input);
    EXPECT_EQ(report.far_field.inverted, 9);
    EXPECT_EQ(report.far_field.flat, 9);
    EXPECT_EQ(report.far_field.newly_inverted, 18);
  }
}

TEST(MeasureQuality, AWedgeOfLeftHandedCellsIsSound) {
  // One cell from the axis outwards: its corner (0, 0, 0) has no Jacobian.
  Mesh const mesh = test::one_zone({2, 7, 3}, [](Index3 const& p) {
    double const angle = -0.2 * p[1];
    return Vec3{0.1 + p[0] * std::cos(angle), 0.3 + p[0] * std::sin(angle), double(p[2])};
  });
  QualityReport const report = measure_quality(Exec(), mesh, input_of(mesh));
  EXPECT_EQ(report.left_handed_zones, 1);
  EXPECT_EQ(report.far_field.inverted, 0);
}

/// A box whose cell columns at j = 2 are sheared along i by `shear` cells, and whose node (1, 1, 1) is moved.
struct Sheared {
  Mesh mesh = test::one_zone({9, 6, 5}, [](Index3 const& p) { return index_position(p); });
  Coordinates after;

  explicit Sheared(double shear, Vec3 const& corner = {0, 0, 0}) {
    after = test::moved(mesh, [&](Vec3 const& p) { return p.y > 2.5 ? p + Vec3{shear, 0, 0} : p; });
    Index const n = mesh.zones[0].node({1, 1, 1});
    after.set(n, after[n] + corner);
  }
  [[nodiscard]] QualityRegion measure(CellLimits const& limits, bool fast = false) const {
    auto input = input_of(mesh);
    input.baseline = input.coordinates;
    input.coordinates = views(after);
    input.limits = limits;
    input.fast = fast;
    return measure_quality(Exec(), mesh, input).far_field;
  }
};

TEST(MeasureQuality, AngleSkewnessAndLossSeeWhatDeterminantsDoNot) {
  double const shear = 20, angle = std::atan(1 / shear) * 180 / std::acos(-1.0);
  Sheared const box(shear);
  Index const column = 8 * 4;
  QualityRegion const r = box.measure({0.05, 5, 0.95, 0.9});
  EXPECT_EQ(r[Fall::inverted].cells, 0);
  EXPECT_EQ(r[Fall::determinant].cells, 0);
  EXPECT_NEAR(r[Measure::determinant_3x3x3].min, 1, 1e-14);
  EXPECT_EQ(r[Fall::angle].cells, column);
  EXPECT_NEAR(r[Fall::angle].worst, angle, 1e-10);
  EXPECT_EQ(r[Fall::angle].worst_cell, (Index3{0, 2, 0}));
  EXPECT_EQ(r[Fall::skewness].cells, column);
  EXPECT_NEAR(r[Fall::skewness].worst, 1 - angle / 90, 1e-12);
  EXPECT_EQ(r[Fall::loss].cells, column);
  EXPECT_NEAR(r[Fall::loss].worst, 1 - angle / 90, 1e-12);
  QualityRegion const mild = box.measure({0.05, 2, 0.99, 0.99});
  for (FallenCells const& fallen : mild.fallen) EXPECT_EQ(fallen.cells, 0);
}

TEST(MeasureQuality, WhatTheBaselineWasShortOfIsNoFallUnlessMuchIsLost) {
  Sheared box(20);
  std::swap(box.mesh.coordinates, box.after);  // the baseline is the sheared one
  box.after = test::moved(box.mesh, [](Vec3 const& p) { return p.y > 2.5 ? p + Vec3{2, 0, 0} : p; });
  QualityRegion const r = box.measure({0.05, 5, 0.95, 0.9});
  EXPECT_LT(r[Measure::minimum_angle_deg].min, 5);
  for (FallenCells const& fallen : r.fallen) EXPECT_EQ(fallen.cells, 0);
  EXPECT_EQ(box.measure({0.05, 5, 0.95, 0.05})[Fall::loss].cells, 8 * 4);
}

TEST(MeasureQuality, AVerdictSaysWhatTheFullMeasurementSays) {
  for (Vec3 const corner : {Vec3{0, 0, 0}, Vec3{1.9, 0, 0}, Vec3{0.97, 0, 0}, Vec3{-1, 0, 0}, Vec3{30, 1, 2}}) {
    Sheared const box(9, corner);
    CellLimits const limits{0.1, 7, 0.9, 0.8};
    QualityRegion const full = box.measure(limits), fast = box.measure(limits, true);
    EXPECT_EQ(fast.cells, full.cells);
    EXPECT_EQ(fast.inverted, full.inverted);
    EXPECT_EQ(fast.newly_inverted, full.newly_inverted);
    EXPECT_EQ(fast.flat, full.flat);
    EXPECT_EQ(fast.collapsed, full.collapsed);
    for (std::size_t f = 0; f < n_falls; ++f) {
      EXPECT_EQ(fast.fallen[f].cells, full.fallen[f].cells) << to_string(Fall(f));
      EXPECT_EQ(fast.fallen[f].worst, full.fallen[f].worst) << to_string(Fall(f));
      EXPECT_EQ(fast.fallen[f].worst_cell, full.fallen[f].worst_cell) << to_string(Fall(f));
    }
    for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg}) {
      EXPECT_EQ(fast[m].min, full[m].min);
      EXPECT_EQ(fast[m].worst_cell, full[m].worst_cell);
    }
    EXPECT_EQ(fast[Measure::aspect_ratio].worst_zone, -1);
  }
  // The worst cell of a motion that is far too large is told by more than -1.
  EXPECT_LT(Sheared(0, {30, 0, 0}).measure({})[Fall::inverted].worst, -10);
}

TEST(MeasureQuality, EdgesThatLoseTheirLengthAreFound) {
  Sheared const box(0, {-1, 0, 0});  // onto the neighbouring node
  for (bool const fast : {false, true}) EXPECT_EQ(box.measure({}, fast)[Fall::collapsed].cells, 4);
}

TEST(MeasureQuality, ZeroMotionHasNoRelativeDisplacement) {
  Mesh const mesh = test::two_zones({}, true);
  auto input = input_of(mesh);
  input.baseline = views(mesh.coordinates);
  QualityReport const report = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(report.far_field[Measure::relative_displacement].max, 0);
  EXPECT_EQ(report.near_field.cells, 0);
}

// A sector with its axis: the cells at the axis are wedges and valid.
TEST(MeasureQuality, CellsAtAPoleAreCollapsedButNotInverted) {
  Mesh const mesh = test::one_zone({4, 6, 3}, [](Index3 const& p) {
    double const angle = 0.2 * p[1];
    return Vec3{p[0] * std::cos(angle), p[0] * std::sin(angle), double(p[2])};
  });
  QualityReport const report = measure_quality(Exec(), mesh, input_of(mesh));
  EXPECT_EQ(report.far_field.collapsed, 5 * 2);
  EXPECT_EQ(report.far_field.inverted, 0);
  EXPECT_GT(report.far_field[Measure::determinant_3x3x3].min, 0.45);
  for (MeasureStatistics const& s : report.far_field.measure) {
    EXPECT_TRUE(std::isfinite(s.mean));
    EXPECT_TRUE(std::isfinite(s.max));
  }
}

TEST(MeasureQuality, NodesThatAreNotFiniteShowAsInvertedCells) {
  Mesh const mesh = test::one_zone({4, 4, 4}, [](Index3 const& p) {
    return Vec3{double(p[0]), double(p[1]), double(p[2])};
  });
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) { return p; });
  after.x(mesh.zones[0].node({1, 1, 1})) = std::nan("");
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  QualityReport const report = measure_quality(Exec(), mesh, input);
  EXPECT_EQ(report.far_field.inverted, 8);
  EXPECT_EQ(report.far_field[Measure::determinant_3x3x3].min, -1);
  for (MeasureStatistics const& s : report.far_field.measure) EXPECT_FALSE(std::isnan(s.mean));
}

TEST(CellFields, HoldTheValuesThatTheReportSummarises) {
  Mesh const mesh = test::two_zones(test::all_orientations()[30], true);
  Coordinates const after = test::moved(mesh, swirl);
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  std::vector<Measure> all;
  for (std::size_t m = 0; m < n_measures; ++m) all.push_back(Measure(n_measures - 1 - m));
  auto const fields = cell_fields(Exec(), mesh, input, std::span<Measure const>(all));
  QualityReport const report = measure_quality(Exec(), mesh, input);
  std::vector<Index> const first = first_cells(mesh);
  ASSERT_EQ(fields.size(), all.size());
  for (std::size_t f = 0; f < all.size(); ++f) {
    ASSERT_EQ(Index(fields[f].extent(0)), mesh.n_cells());
    auto const [lo, hi] = std::minmax_element(fields[f].data(), fields[f].data() + mesh.n_cells());
    MeasureStatistics const& s = report.far_field[all[f]];
    EXPECT_EQ(*lo, s.min);
    EXPECT_EQ(*hi, s.max);
    if (all[f] == Measure::non_orthogonality_deg || all[f] == Measure::face_skewness) {
      EXPECT_EQ(s.worst_zone, -1) << "measured on elements alone";
      continue;
    }
    Index3 const n = mesh.zones[s.worst_zone].extent;
    Index const worst =
        first[s.worst_zone] + s.worst_cell[0] + Index(n[0] - 1) * (s.worst_cell[1] + Index(n[1] - 1) * s.worst_cell[2]);
    EXPECT_EQ(fields[f](worst), s.worst);
  }
}

TEST(MinDeterminant, FindsTheSmallestCellOfTheBoxesAndOnlyOfThem) {
  Mesh const mesh = test::two_zones(test::all_orientations()[5], true);
  std::vector<int> const handedness = zone_handedness(Exec(), mesh, views(mesh.coordinates));
  std::vector<CellBox> const boxes{
      {1, {{0, 1, 0}, {2, 3, 4}}}, {0, {{1, 0, 2}, {3, 5, 4}}}, {0, {{0, 0, 0}, {0, 0, 0}}}};
  Expected expected;
  for (CellBox const& b : boxes)
    for (int k = b.cells.begin[2]; k < b.cells.end[2]; ++k)
      for (int j = b.cells.begin[1]; j < b.cells.end[1]; ++j)
        for (int i = b.cells.begin[0]; i < b.cells.end[0]; ++i)
          expected.add(test::reference(cell_corners(mesh, mesh.coordinates, b.zone, {i, j, k}), handedness[b.zone])
                           .determinant_3x3x3,
                       b.zone, {i, j, k});
  CellValue const found = min_determinant(Exec(), mesh, views(mesh.coordinates), std::span<int const>(handedness),
                                          std::span<CellBox const>(boxes));
  EXPECT_NEAR(found.value, expected.min, 1e-13);
  EXPECT_EQ(found.zone, expected.min_zone);
  EXPECT_EQ(found.cell, expected.min_cell);
  EXPECT_EQ(min_determinant(Exec(), mesh, views(mesh.coordinates), std::span<int const>(handedness), {}).zone, -1);
}

TEST(MinDeterminant, RefusesABoxOutsideItsZoneByName) {
  Mesh const mesh = test::two_zones({}, true);
  std::vector<int> const handedness{1, 1};
  std::vector<CellBox> const boxes{{1, {{0, 0, 0}, {99, 1, 1}}}};
  try {
    min_determinant(Exec(), mesh, views(mesh.coordinates), std::span<int const>(handedness),
                    std::span<CellBox const>(boxes));
    FAIL() << "no error";
  } catch (MeshError const& error) {
    EXPECT_NE(std::string(error.what()).find("zone 'second'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("[1:99"), std::string::npos);
  }
}

TEST(MeasureQuality, RefusesInputThatDoesNotFitTheMesh) {
  Mesh mesh = test::two_zones({}, true);
  Coordinates const small(10);
  auto input = input_of(mesh);
  input.coordinates = views(small);
  EXPECT_THROW(measure_quality(Exec(), mesh, input), MeshError);
  input = input_of(mesh);
  input.baseline = views(small);
  EXPECT_THROW(measure_quality(Exec(), mesh, input), MeshError);
  input = input_of(mesh);
  input.near_field = Kokkos::View<std::uint8_t*, Kokkos::HostSpace>("near_field", 3);
  EXPECT_THROW(measure_quality(Exec(), mesh, input), MeshError);
  mesh.interfaces[0].to_donor.donor_origin = {50, 0, 0};
  EXPECT_THROW(measure_quality(Exec(), mesh, input_of(mesh)), MeshError);
  mesh = test::two_zones({}, true);
  mesh.interfaces[0].to_donor.orientation.axis = {0, 1, 1};
  EXPECT_THROW(measure_quality(Exec(), mesh, input_of(mesh)), MeshError);
}

}  // namespace
}  // namespace gridmorph
