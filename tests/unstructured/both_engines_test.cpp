// Structured meshes from outside, through both engines: as blocks, and as hexahedra. The boundary must move alike; the
// volume is carried in different ways, and neither may turn a cell over.
#include "support/morph_run.hpp"
#include "support/unstructured_case.hpp"

#include "../io/io_support.hpp"

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace gridmorph::test {
namespace {

struct Pair {
  char const* case_file;  ///< of the examples
  char const* mesh;
};

class BothEngines : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Examples, BothEngines,
                         testing::Values(Pair{"wing_38_blocks.toml", "mdo_tutorial_000_vol.cgns"},
                                         Pair{"winglet.toml", "717_wl_L2.cgns"}),
                         [](auto const& info) {
                           std::string const name = info.param.case_file;
                           return name.substr(0, name.find('.'));
                         });

QualityRegion all_cells(Mesh const& mesh, Coordinates const& x) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(x);
  input.baseline = views(mesh.coordinates);
  return measure_quality(Kokkos::DefaultHostExecutionSpace(), mesh, input).far_field;
}

TEST_P(BothEngines, MoveTheBoundaryAlikeAndTurnNothingOver) {
  auto const path = shared_mesh(GetParam().mesh);
  CaseFile const file = read_case_file(std::string(GRIDMORPH_EXAMPLES "/") + GetParam().case_file);
  Mesh blocks = read_mesh(path);
  UnstructuredCase const hexahedra(as_hexahedra(blocks));
  PreparedMorph const prepared = prepare(blocks, file.motion, file.plan);
  Coordinates const structured =
      run_plan(Kokkos::DefaultHostExecutionSpace(), blocks, prepared.plan(), prepared.boundary_displacement()).position;
  PlanOptions options;
  options.boundary_layers = file.plan.boundary_layers;
  options.elements = file.plan.elements;
  UnstructuredMorphed const other = hexahedra.guarded_morph(file.motion, options);
  EXPECT_EQ(hexahedra.largest_miss(other), 0);

  double wall = 0, largest = 0, farthest = 0;
  for (std::size_t k = 0; k < other.boundary.size(); ++k) {
    Index32 const n = other.prepared.plan.known[k];
    wall = std::max(wall, distance(structured[n], other.x[n]));
    largest = std::max(largest, norm(other.boundary[k]));
  }
  for (Index n = 0; n < blocks.n_nodes(); ++n)
    farthest = std::max(farthest, distance(other.x[n], blocks.coordinates[n]));
  EXPECT_LT(wall, 1e-12 * blocks.size());
  // What is near a wall that turns moves farther than the wall.
  EXPECT_LT(farthest, 1.6 * largest);
  double const sound = all_cells(blocks, blocks.coordinates)[Measure::determinant_3x3x3].min;
  for (Coordinates const& x : {structured, other.x}) {
    QualityRegion const quality = all_cells(blocks, x);
    EXPECT_EQ(quality.newly_inverted, 0);
    EXPECT_GT(quality[Measure::determinant_3x3x3].min, 0.3 * sound);
  }
}

// Its tip and trailing edge are thin, and the faces there turn differently: 0.055 once, columns went all the way with
// the mean of their turns.
TEST(Elements, OfAWingThatBendsKeepTheirShapeAsWithoutRotations) {
  CaseFile const file = read_case_file(GRIDMORPH_EXAMPLES "/wing_38_blocks.toml");
  UnstructuredCase const wing(as_hexahedra(read_mesh(shared_mesh("mdo_tutorial_000_vol.cgns"))));
  double smallest[2];
  for (auto const mode : {BoundaryLayer::Mode::rotate, BoundaryLayer::Mode::translate}) {
    PlanOptions options;
    options.boundary_layers.push_back(
        {.walls = {"wall"}, .extent = BoundaryLayer::Extent::layers, .layers = 12, .mode = mode});
    auto const m = wing.guarded_morph(file.motion, options);
    smallest[mode == BoundaryLayer::Mode::rotate ? 0 : 1] = wing.quality(m.x)[Measure::determinant_3x3x3].min;
  }
  EXPECT_GT(smallest[0], 0.9 * smallest[1]);
}

}  // namespace
}  // namespace gridmorph::test
