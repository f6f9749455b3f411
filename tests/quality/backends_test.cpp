// The same results on all execution spaces; run with different numbers of threads by the build system.
// Also what the measurement allocates, and under which names.
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include "quality/test_meshes.hpp"
#include "support/every_space.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

#include <algorithm>
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

/// Two meshes of one topology where an execution space reads them.
template <class Exec>
struct Measured {
  using Memory = typename Exec::memory_space;
  test::DeviceField<Memory> before, after;
  QualityInput<Memory> input;

  Measured(Mesh const& mesh, Coordinates const& moved) : before(mesh.coordinates), after(moved) {
    input.baseline = {before.x, before.y, before.z};
    input.coordinates = {after.x, after.y, after.z};
    Kokkos::View<std::uint8_t*, Kokkos::HostSpace> near_field("near_field", mesh.n_cells());
    for (Index c = 0; c < mesh.n_cells(); ++c) near_field(c) = c % 7 < 2 ? 1 : 0;
    input.near_field = Kokkos::create_mirror_view_and_copy(Memory(), near_field);
    input.walls = {{0, {{0, 0, 0}, {61, 42, 1}}, 2, 0}, {0, {{0, 0, 22}, {61, 42, 23}}, 2, 1}};
  }
};

/// To the bit on the host, and on devices, which have sines of their own, to some roundings; what was not measured is
/// no number.
template <class Exec>
void expect_equal(double a, double b) {
  if (std::isnan(b)) {
    EXPECT_TRUE(std::isnan(a)) << a;
  } else if constexpr (test::on_host<Exec>) {
    EXPECT_EQ(a, b);
  } else {
    EXPECT_NEAR(a, b, 1e-12 * std::max(1.0, std::abs(b)));
  }
}

template <class Exec>
void expect_same(QualityRegion const& a, QualityRegion const& b) {
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.inverted, b.inverted);
  for (std::size_t f = 0; f < n_falls; ++f) {
    EXPECT_EQ(a.fallen[f].cells, b.fallen[f].cells) << f;
    expect_equal<Exec>(a.fallen[f].worst, b.fallen[f].worst);
    EXPECT_EQ(a.fallen[f].number, b.fallen[f].number) << f;
  }
  for (std::size_t m = 0; m < n_measures; ++m) {
    SCOPED_TRACE(to_string(Measure(m)));
    expect_equal<Exec>(a.measure[m].min, b.measure[m].min);
    expect_equal<Exec>(a.measure[m].mean, b.measure[m].mean);
    expect_equal<Exec>(a.measure[m].max, b.measure[m].max);
    expect_equal<Exec>(a.measure[m].worst, b.measure[m].worst);
    EXPECT_EQ(a.measure[m].worst_zone, b.measure[m].worst_zone);
    EXPECT_EQ(a.measure[m].worst_cell, b.measure[m].worst_cell);
  }
}

/// measure_quality() on every execution space against the host's default.
template <class Change>
QualityReport expect_same_on_every_space(Mesh const& mesh, Change const& change) {
  Coordinates const after = swirled(mesh);
  auto const report_on = [&]<class Exec>(Exec const& exec) {
    Measured<Exec> of(mesh, after);
    change(of.input);
    return measure_quality(exec, mesh, of.input);
  };
  QualityReport const reference = report_on(Kokkos::DefaultHostExecutionSpace());
  test::on_every_space([&]<class Exec>(Exec const& exec, char const* name) {
    SCOPED_TRACE(name);
    QualityReport const found = report_on(exec);
    expect_same<Exec>(found.near_field, reference.near_field);
    expect_same<Exec>(found.far_field, reference.far_field);
    EXPECT_EQ(found.wall.nodes, reference.wall.nodes);
    expect_equal<Exec>(found.wall.first_height_mean, reference.wall.first_height_mean);
    expect_equal<Exec>(found.wall.orthogonality_deg_mean, reference.wall.orthogonality_deg_mean);
    expect_equal<Exec>(found.wall.height_change_max, reference.wall.height_change_max);
    EXPECT_EQ(found.wall.height_change_worst.node, reference.wall.height_change_worst.node);
  });
  return reference;
}

TEST(QualityBackends, AllExecutionSpacesAgree) {
  expect_same_on_every_space(large_mesh(), [](auto&) {});
}

TEST(QualityBackends, VerdictsAgreeOnAllExecutionSpaces) {
  QualityReport const report = expect_same_on_every_space(large_mesh(), [](auto& input) {
    input.fast = true;
    input.limits = {0.95, 80, 0.1, 0.02};
  });
  for (QualityRegion const& region : {report.near_field, report.far_field})
    for (Fall const fall : {Fall::determinant, Fall::angle, Fall::skewness, Fall::loss})
      EXPECT_GT(region[fall].cells, 0) << to_string(fall);
}

TEST(QualityBackends, CertificatesAgreeOnAllExecutionSpaces) {
  Mesh const mesh = large_mesh();
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) {
    return p + 0.12 * Vec3{std::sin(9 * p.y), std::sin(7 * p.x * p.z), p.x};
  });
  auto const certificate_on = [&]<class Exec>(Exec const& exec) {
    Measured<Exec> const of(mesh, after);
    return certify(exec, mesh, {of.input.coordinates, of.input.baseline});
  };
  Certificate const reference = certificate_on(Kokkos::DefaultHostExecutionSpace());
  EXPECT_GT(reference.broken.cells, 0);
  test::on_every_space([&]<class Exec>(Exec const& exec, char const* name) {
    SCOPED_TRACE(name);
    Certificate const found = certificate_on(exec);
    EXPECT_EQ(found.cells, reference.cells);
    EXPECT_EQ(found.zero, reference.zero);
    EXPECT_EQ(found.negative, reference.negative);
    EXPECT_EQ(found.undecided, reference.undecided);
    EXPECT_EQ(found.broken.cells, reference.broken.cells);
    EXPECT_EQ(found.broken.number, reference.broken.number);
  });
}

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
  Measured<Kokkos::DefaultHostExecutionSpace> of(mesh, after);
  of.input.walls.clear();
  allocations = {};
  Kokkos::Tools::Experimental::set_allocate_data_callback(on_allocate);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(on_deallocate);
  measure_quality(Kokkos::DefaultHostExecutionSpace(), mesh, of.input);
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
