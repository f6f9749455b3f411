// Predictions against what comes out, on every mesh that the invariants are checked on.
#include "invariants/cases.hpp"

#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/scramble.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/prediction.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace gridmorph::test {
namespace {

kernels::HexCell cell_at(Coordinates const& x, Zone const& zone, Index3 const& p) {
  kernels::HexCell cell;
  for (int n = 0; n < 8; ++n) cell.corner[n] = x[zone.node({p[0] + n % 2, p[1] + n / 2 % 2, p[2] + n / 4})];
  return cell;
}

/// From three edges at each corner by itself; poles have corners without three edges.
double reference_scaled_jacobian(kernels::HexCell const& cell, int handedness) {
  double smallest = 1, longest = 0;
  for (int a = 0; a < 8; ++a)
    for (int const axis : {1, 2, 4}) longest = std::max(longest, norm(cell.corner[a ^ axis] - cell.corner[a]));
  for (int n = 0; n < 8; ++n) {
    std::array<Vec3, 3> edge{};
    double product = 1, shortest = longest;
    for (int d = 0; d < 3; ++d) {
      int const other = n ^ (1 << d);
      edge[d] = ((n >> d) % 2 == 0 ? 1.0 : -1.0) * (cell.corner[other] - cell.corner[n]);
      product *= norm(edge[d]);
      shortest = std::min(shortest, norm(edge[d]));
    }
    if (shortest > 1e-12 * longest)
      smallest = std::min(smallest, handedness * dot(cross(edge[0], edge[1]), edge[2]) / product);
  }
  return smallest;
}

/// What can be asked of all cells of a mesh before and after.
struct AllCells {
  Mesh const& mesh;
  Coordinates const& morphed;
  std::vector<int> handedness;

  AllCells(Mesh const& m, Coordinates const& after)
      : mesh(m),
        morphed(after),
        handedness(zone_handedness(Kokkos::DefaultHostExecutionSpace(), m, views(m.coordinates))) {}

  [[nodiscard]] kernels::HexCell after(int z, Index3 const& p) const { return cell_at(morphed, mesh.zones[z], p); }
  [[nodiscard]] double scaled_jacobian(int z, Index3 const& p) const {
    return reference_scaled_jacobian(after(z, p), handedness[z]);
  }
  [[nodiscard]] double relative(int z, Index3 const& p, int direction) const {
    Vec3 const r =
        kernels::relative_displacement(cell_at(mesh.coordinates, mesh.zones[z], p), cell_at(morphed, mesh.zones[z], p));
    return direction == 0 ? r.x : direction == 1 ? r.y : r.z;
  }
  [[nodiscard]] double smallest(std::function<double(int, Index3 const&)> const& value) const {
    double out = std::numeric_limits<double>::infinity();
    for (int z = 0; z < int(mesh.zones.size()); ++z) {
      Index3 const n = mesh.zones[z].extent;
      Index3 p{};
      for (p[2] = 0; p[2] + 1 < n[2]; ++p[2])
        for (p[1] = 0; p[1] + 1 < n[1]; ++p[1])
          for (p[0] = 0; p[0] + 1 < n[0]; ++p[0]) out = std::min(out, value(z, p));
    }
    return out;
  }
};

/// Whether near fields turn: their walls' tangents are then those between sampled nodes.
bool turns(Case const& c) {
  return std::any_of(c.options.boundary_layers.begin(), c.options.boundary_layers.end(),
                     [](BoundaryLayer const& layer) { return layer.mode == BoundaryLayer::Mode::rotate; });
}

class Predictions : public ::testing::TestWithParam<Case> {};

TEST_P(Predictions, OfAllCellsAreWhatComesOut) {
  Case const& c = GetParam();
  Mesh const mesh = c.mesh();
  MorphPlan const plan(mesh, c.motion(1), c.options);
  Prediction const p = predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement(), {1});
  Outcome const run = morph(mesh, c.motion(1), c.options);
  AllCells const cells(run.mesh, run.morphed.position);
  EXPECT_EQ(p.every, 1);
  EXPECT_EQ(p.n_cells, run.mesh.n_cells());
  EXPECT_EQ(p.all.cells, run.mesh.n_cells());
  double const tolerance = 1e-8;
  EXPECT_NEAR(p.all.scaled_jacobian.value,
              cells.smallest([&](int z, Index3 const& at) { return cells.scaled_jacobian(z, at); }), tolerance);
  EXPECT_NEAR(p.all.determinant.value, cells.smallest([&](int z, Index3 const& at) {
    return kernels::determinant_3x3x3(cells.after(z, at), cells.handedness[z]);
  }),
              tolerance);
  auto const& [worst, zone, at] = p.all.determinant;
  EXPECT_NEAR(
      p.all.determinant_before,
      kernels::determinant_3x3x3(cell_at(run.mesh.coordinates, run.mesh.zones[zone], at), cells.handedness[zone]),
      1e-12);
  for (int d = 0; d < 3; ++d) {
    double const largest = -cells.smallest([&](int z, Index3 const& at) { return -cells.relative(z, at, d); });
    EXPECT_NEAR(p.all.relative_displacement[d].value, largest, tolerance * (1 + largest));
  }
  Index counted = 0;
  for (PredictedGroup const& chain : p.groups) counted += chain.cells.cells;
  EXPECT_EQ(counted, p.all.cells);
  EXPECT_EQ(p.groups.front().cells.scaled_jacobian.value, p.all.scaled_jacobian.value);
}

TEST_P(Predictions, OfSomeCellsAreTrueOfTheseAndBoundTheWorst) {
  Case const& c = GetParam();
  Mesh const mesh = c.mesh();
  MorphPlan const plan(mesh, c.motion(1), c.options);
  Outcome const run = morph(mesh, c.motion(1), c.options);
  AllCells const cells(run.mesh, run.morphed.position);
  Prediction const p = predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement(), {3});
  EXPECT_LE(p.all.cells, run.mesh.n_cells());
  double const tolerance = 0.02;  // residuals and tangents between samples
  double const worst = cells.smallest([&](int z, Index3 const& at) { return cells.scaled_jacobian(z, at); });
  EXPECT_GE(p.all.scaled_jacobian.value, worst - tolerance);
  for (PredictedGroup const& chain : p.groups) {
    CellValue const& at = chain.cells.scaled_jacobian;
    EXPECT_NEAR(at.value, cells.scaled_jacobian(at.zone, at.cell), tolerance) << chain.name;
    EXPECT_NEAR(chain.cells.scaled_jacobian_before,
                reference_scaled_jacobian(cell_at(run.mesh.coordinates, run.mesh.zones[at.zone], at.cell),
                                          cells.handedness[at.zone]),
                1e-12);
    if (turns(c)) continue;  // what is between the samples counts: only bounded above
    for (int d = 0; d < 3; ++d) {
      CellValue const& relative = chain.cells.relative_displacement[d];
      EXPECT_NEAR(relative.value, cells.relative(relative.zone, relative.cell, d), 0.05 * (0.05 + relative.value));
    }
  }
}

TEST_P(Predictions, DoNotDependOnHowZonesAreTurnedAndNumbered) {
  Case const& c = GetParam();
  Mesh const mesh = c.mesh();
  auto const prediction_of = [&](Mesh const& m) {
    MorphPlan const plan(m, c.motion(1), c.options);
    return predict(HostInstance(), IndexedMesh(m), plan, plan.boundary_displacement(), {3});
  };
  Prediction const plain = prediction_of(mesh);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Prediction const other = prediction_of(scramble(mesh, {seed, 0, true, true, true}).mesh);
    EXPECT_EQ(other.all.cells, plain.all.cells);
    EXPECT_EQ(other.all.inverted, plain.all.inverted);
    EXPECT_NEAR(other.all.scaled_jacobian.value, plain.all.scaled_jacobian.value, 1e-9);
  }
}

TEST(Prediction, NeedsADisplacementForEachBoundaryNode) {
  Mesh const mesh = box({5, 4, 3}, Shape::straight, 1);
  MorphPlan const plan(mesh, motion({rule({"*"}, FixedRule{})}));
  std::vector<Vec3> const fewer(plan.boundary_nodes().size() - 1);
  EXPECT_THROW((void)predict(HostInstance(), IndexedMesh(mesh), plan, fewer), ConfigError);
}

TEST_P(Predictions, OfNoMotionAreTheBaseline) {
  Case const& c = GetParam();
  Mesh const mesh = c.mesh();
  MorphPlan const plan(mesh, c.motion(0), c.options);
  Prediction const p = predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement(), {2});
  EXPECT_EQ(p.all.scaled_jacobian.value, p.all.scaled_jacobian_before);
  for (CellValue const& relative : p.all.relative_displacement) EXPECT_EQ(relative.value, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, Predictions, ::testing::ValuesIn(make_cases()),
                         [](auto const& test) { return test.param.name; });

}  // namespace
}  // namespace gridmorph::test
