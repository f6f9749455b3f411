// Flow solutions out of CGNS files, as the mesh numbers its nodes and cells.
#include "io_support.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/read_solution.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/motion/shock/shock_shift.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::test {
namespace {

double at(Vec3 const& p) { return 1 + p.x - 3 * p.y + 0.5 * p.z; }

std::vector<Vec3> middles(Mesh const& mesh) {
  std::vector<Vec3> out;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    Vec3 sum;
    for (Index32 const n : mesh.elements.corners(e)) sum += mesh.coordinates[n];
    out.push_back((1.0 / double(mesh.elements.corners(e).size())) * sum);
  }
  if (!out.empty()) return out;
  for (Zone const& zone : mesh.zones)
    for (int k = 1; k < zone.extent[2]; ++k)
      for (int j = 1; j < zone.extent[1]; ++j)
        for (int i = 1; i < zone.extent[0]; ++i) {
          Vec3 sum;
          for (int n = 0; n < 8; ++n)
            sum += mesh.coordinates[zone.node({i - 1 + (n & 1), j - 1 + (n >> 1 & 1), k - 1 + (n >> 2)})];
          out.push_back(0.125 * sum);
        }
  return out;
}

/// Pressure at nodes or in cells as a function of the place.
void write_with_pressure(std::string const& path, Mesh const& mesh, bool nodes) {
  OutputFields fields;
  std::vector<double> values;
  if (nodes)
    for (Index n = 0; n < mesh.n_nodes(); ++n) values.push_back(at(mesh.coordinates[n]));
  else
    for (Vec3 const& p : middles(mesh)) values.push_back(at(p));
  if (nodes)
    fields.nodes.push_back({"Pressure", values});
  else
    fields.cells.push_back({"Pressure", values});
  write_mesh(path, mesh, mesh.coordinates, fields);
}

void expect_pressure_at_places(std::string const& path, Mesh const& mesh, bool nodes) {
  FlowSolution const found = read_flow_solution(path, mesh, {{"Pressure", "Density"}});
  EXPECT_EQ(found.at_nodes, nodes);
  EXPECT_EQ(found.find("Density"), nullptr);
  ASSERT_NE(found.find("Pressure"), nullptr);
  std::vector<double> const& p = *found.find("Pressure");
  std::vector<Vec3> places;
  if (nodes)
    for (Index n = 0; n < mesh.n_nodes(); ++n) places.push_back(mesh.coordinates[n]);
  else
    places = middles(mesh);
  ASSERT_EQ(p.size(), places.size());
  for (std::size_t n = 0; n < p.size(); ++n) EXPECT_NEAR(p[n], at(places[n]), 1e-12);
}

TEST(Solution, EveryNodeAndCellGetsItsValueInBlocksAndElementsInWhateverOrder) {
  TemporaryFolder const folder;
  std::string const path = (folder / "flow.cgns").string();
  for (Mesh const& mesh : {bricks_with_t_junctions(2), to_hexahedra(bricks_with_t_junctions(2)),
                           to_prisms_and_tetrahedra(box({9, 8, 7}, Shape::curved, 3), 3), flat_box(6, 5, 2)})
    for (bool const nodes : {true, false}) {
      write_with_pressure(path, mesh, nodes);
      Mesh read = read_mesh(path);
      expect_pressure_at_places(path, read, nodes);
      if (read.is_structured()) continue;
      FileOrder order;
      for (auto [list, size] : {std::pair(&order.node, read.n_nodes()), std::pair(&order.element, read.n_elements())})
        for (Index n = size; n-- > 0;) list->push_back(Index32(n));
      if (read.zones.size() == 1) {
        reorder(read, order);
        expect_pressure_at_places(path, read, nodes);
      }
    }
}

TEST(Solution, WhatDoesNotFitIsSaidZoneByZone) {
  TemporaryFolder const folder;
  std::string const path = (folder / "flow.cgns").string(), bare = (folder / "bare.cgns").string();
  Mesh const mesh = bricks_with_t_junctions(2);
  write_with_pressure(path, mesh, true);
  write_mesh(bare, mesh);
  auto const says = [&](std::string const& file, Mesh const& of, SolutionWanted const& wanted) {
    return message_of<IoError>([&] { read_flow_solution(file, of, wanted); });
  };
  EXPECT_NE(says(bare, mesh, {{"Pressure"}}).find("no flow solution"), std::string::npos);
  EXPECT_NE(says(path, mesh, {{"Pressure"}, "Time 3"}).find("no solution 'Time 3'; those there are 'MorphNodes'"),
            std::string::npos);
  Mesh other = mesh;
  other.zones[0].name = "elsewhere";
  other.zones[1].extent[0] += 1;
  std::string const text = says(path, other, {{"Pressure"}});
  for (std::string const part : {"zone 'elsewhere' of the mesh is not there; the zones are", "nodes, but the mesh has"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  Mesh const read = read_mesh(path);
  FlowSolution const none = read_flow_solution(path, read, {{"Mach"}});
  EXPECT_TRUE(none.values.empty());
  EXPECT_EQ(none.available, std::vector<std::string>{"Pressure"});
}

/// Cells with rind planes on all sides: the wing's solution, with the flow far ahead of it at Mach 0.8.
TEST(Solution, RindPlanesOfARealFileArePassedOver) {
  auto const path = shared_mesh("mdo_tutorial_000_vol.cgns");
  if (path.empty()) GTEST_SKIP() << "no mesh";
  Mesh const mesh = read_mesh(path);
  FlowSolution const flow = read_flow_solution(path, mesh, {{"Pressure", "Density", "VelocityX", "Mach"}});
  EXPECT_FALSE(flow.at_nodes);
  EXPECT_EQ(flow.available.size(), 6U);
  EXPECT_FALSE(flow.has({"Mach"}));
  ASSERT_TRUE(flow.has({"Pressure", "Density", "VelocityX"}));
  std::vector<Vec3> const places = middles(mesh);
  auto const &p = *flow.find("Pressure"), &rho = *flow.find("Density"), &u = *flow.find("VelocityX");
  ASSERT_EQ(p.size(), places.size());
  // Far away it is the free stream; a shift by a rind plane would put other cells there.
  Index far = 0;
  for (std::size_t c = 0; c < places.size(); ++c) {
    if (norm(places[c]) < 100) continue;
    ++far;
    EXPECT_NEAR(p[c], 1, 0.02);
    EXPECT_NEAR(u[c] / std::sqrt(1.4 * p[c] / rho[c]), 0.8, 0.03);
  }
  EXPECT_GT(far, 1000);
  EXPECT_NEAR(*std::min_element(p.begin(), p.end()), 0.61, 0.01);
}

/// Coarse cells: the shock on the upper side, from 4 m behind the nose at the root to 8 m near the tip, is spread so
/// far that the normal Mach number stays below 1.
TEST(Solution, TheShockOfTheWingIsOneSheetAndItsWayIsThatOfTheMesh) {
  std::string const path = shared_mesh("mdo_tutorial_000_vol.cgns");
  Mesh const mesh = read_mesh(path);
  ShockSearch search;
  FlowSolution const flow = read_flow_solution(path, mesh, {shock_variables(search)});
  InnerRegion above;
  above.holds = [](Vec3 const& p) { return p.x > 2 && p.x < 10 && p.y > 0.1 && p.y < 3 && p.z < 13; };
  std::vector<std::uint8_t> const looked_at = cells_looked_at(mesh, above);
  std::string const text = message_of<MotionError>([&] { find_shock(mesh, flow, search, looked_at); });
  EXPECT_NE(text.find("normal Mach number is 0.9"), std::string::npos) << text;
  search.threshold = 0.85;
  ShockCells const shock = find_shock(mesh, flow, search, looked_at);
  EXPECT_GT(shock.points.size(), 50U);
  EXPECT_LT(shock.points.size(), 200U);
  EXPECT_NE(shock.summary.find("in 1 group"), std::string::npos) << shock.summary;
  EXPECT_GT(shock.direction.x, 0.8);
  for (ShockPoint const& p : shock.points) EXPECT_NEAR(p.place.x, 4.3 + 0.29 * p.place.z, 0.8);
  // The same flow on a mesh that was moved as a whole.
  Mesh moved = mesh;
  moved.coordinates = Coordinates(mesh.n_nodes());
  Vec3 const way{0.1, 0, 0};
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.coordinates.set(n, mesh.coordinates[n] + way);
  ShockCells const later = find_shock(moved, flow, search, looked_at);
  ShockShift const shift(shock.points, later.points, {1, 0, 0}, 0.1 * extent_across(shock.points, {1, 0, 0}));
  EXPECT_NEAR(shift.least(), way.x, 1e-9);
  EXPECT_NEAR(shift.greatest(), way.x, 1e-9);
}

}  // namespace
}  // namespace gridmorph::test
