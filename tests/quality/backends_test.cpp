// Bit-identical results of Serial and OpenMP; run with different numbers of threads by the build system.
// Also what the measurement allocates, and under which names.
#include <gridmorph/quality/quality.hpp>

#include "quality/test_meshes.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph {
namespace {

Mesh large_mesh() {
  return test::one_zone({61, 42, 23}, [](Index3 const& p) {
    return test::wavy({0.05 * p[0], 0.06 * p[1], 0.01 * p[2] * (1 + 0.3 * p[2])}, 0.01);
  });
}

Coordinates swirled(Mesh const& mesh) {
  return test::moved(mesh, [](Vec3 const& p) {
    return p + 0.02 * Vec3{std::sin(9 * p.y), std::sin(7 * p.x * p.z), p.x};
  });
}

QualityInput<Kokkos::HostSpace> large_input(Mesh const& mesh, Coordinates const& after) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> near_field("near_field", mesh.n_cells());
  for (Index c = 0; c < mesh.n_cells(); ++c) near_field(c) = c % 7 < 2 ? 1 : 0;
  input.near_field = near_field;
  input.walls = {{0, {{0, 0, 0}, {61, 42, 1}}, 2, 0}, {0, {{0, 0, 22}, {61, 42, 23}}, 2, 1}};
  return input;
}

void expect_same(QualityRegion const& a, QualityRegion const& b) {
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.inverted, b.inverted);
  for (std::size_t f = 0; f < n_falls; ++f) {
    EXPECT_EQ(a.fallen[f].cells, b.fallen[f].cells);
    EXPECT_EQ(a.fallen[f].worst, b.fallen[f].worst);
    EXPECT_EQ(a.fallen[f].number, b.fallen[f].number);
  }
  for (std::size_t m = 0; m < n_measures; ++m) {
    EXPECT_EQ(a.measure[m].min, b.measure[m].min);
    EXPECT_EQ(a.measure[m].mean, b.measure[m].mean);
    EXPECT_EQ(a.measure[m].max, b.measure[m].max);
    EXPECT_EQ(a.measure[m].worst, b.measure[m].worst);
    EXPECT_EQ(a.measure[m].worst_zone, b.measure[m].worst_zone);
    EXPECT_EQ(a.measure[m].worst_cell, b.measure[m].worst_cell);
  }
}

#if defined(KOKKOS_ENABLE_SERIAL) && defined(KOKKOS_ENABLE_OPENMP)
TEST(QualityBackends, SerialAndOpenMPAgreeBitForBit) {
  Mesh const mesh = large_mesh();
  Coordinates const after = swirled(mesh);
  auto const input = large_input(mesh, after);
  QualityReport const serial = measure_quality(Kokkos::Serial(), mesh, input);
  QualityReport const openmp = measure_quality(Kokkos::OpenMP(), mesh, input);
  expect_same(serial.near_field, openmp.near_field);
  expect_same(serial.far_field, openmp.far_field);
  EXPECT_EQ(serial.wall.nodes, openmp.wall.nodes);
  EXPECT_EQ(serial.wall.first_height_mean, openmp.wall.first_height_mean);
  EXPECT_EQ(serial.wall.orthogonality_deg_mean, openmp.wall.orthogonality_deg_mean);
  EXPECT_EQ(serial.wall.height_change_max, openmp.wall.height_change_max);
  EXPECT_EQ(serial.wall.height_change_worst.node, openmp.wall.height_change_worst.node);
}

TEST(QualityBackends, VerdictsAgreeBitForBit) {
  Mesh const mesh = large_mesh();
  Coordinates const after = swirled(mesh);
  auto input = large_input(mesh, after);
  input.fast = true;
  input.limits = {0.95, 80, 0.1, 0.02};
  QualityReport const serial = measure_quality(Kokkos::Serial(), mesh, input);
  QualityReport const openmp = measure_quality(Kokkos::OpenMP(), mesh, input);
  for (auto const region : {&QualityReport::near_field, &QualityReport::far_field}) {
    QualityRegion const &a = serial.*region, &b = openmp.*region;
    EXPECT_EQ(a.cells, b.cells);
    for (Fall const fall : {Fall::determinant, Fall::angle, Fall::skewness, Fall::loss}) {
      EXPECT_GT(a[fall].cells, 0) << to_string(fall);
      EXPECT_EQ(a[fall].cells, b[fall].cells);
      EXPECT_EQ(a[fall].worst, b[fall].worst);
      EXPECT_EQ(a[fall].number, b[fall].number);
    }
    for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg}) {
      EXPECT_EQ(a[m].min, b[m].min);
      EXPECT_EQ(a[m].worst_cell, b[m].worst_cell);
    }
  }
}
#endif

struct Allocations {
  std::int64_t now = 0, peak = 0;
  std::vector<std::string> labels;
};
Allocations allocations;

void on_allocate(Kokkos::Tools::SpaceHandle, char const* label, void const*, std::uint64_t size) {
  allocations.now += std::int64_t(size);
  allocations.peak = std::max(allocations.peak, allocations.now);
  allocations.labels.emplace_back(label);
}
void on_deallocate(Kokkos::Tools::SpaceHandle, char const*, void const*, std::uint64_t size) {
  allocations.now -= std::int64_t(size);
}

TEST(QualityMemory, StaysBelowOneAndAHalfCoordinateArraysAndNamesWhatItAllocates) {
  Mesh const mesh = large_mesh();
  Coordinates const after = swirled(mesh);
  auto input = large_input(mesh, after);
  input.walls.clear();
  allocations = {};
  Kokkos::Tools::Experimental::set_allocate_data_callback(on_allocate);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(on_deallocate);
  measure_quality(Kokkos::DefaultHostExecutionSpace(), mesh, input);
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(nullptr);
  EXPECT_GT(allocations.peak, 0);
  EXPECT_LT(double(allocations.peak), 1.5 * 8 * double(mesh.n_nodes()));
  EXPECT_EQ(allocations.now, 0);
  for (std::string const& label : allocations.labels)
    EXPECT_TRUE(label.starts_with("gridmorph::") || label.starts_with("Kokkos::")) << label;
}

}  // namespace
}  // namespace gridmorph
