// Real unstructured meshes from outside, and real structured ones converted.
#include "io/io_support.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>

namespace gridmorph::test {
namespace {

Index count(Mesh const& mesh, ElementType type, int zone = -1) { return count_types(mesh, zone)[std::size_t(type)]; }

/// The coil of others where it is there, and the stand-in for it.
struct Coil {
  char const* file;
  Index prisms, pyramids, fluid_tetrahedra;
};
class RealCoil : public testing::TestWithParam<Coil> {
 protected:
  void SetUp() override {
    path = shared_mesh(GetParam().file);
    if (path.empty()) GTEST_SKIP() << GetParam().file << " is not there; its stand-in is tested";
  }
  std::string path;
};
INSTANTIATE_TEST_SUITE_P(Meshes, RealCoil,
                         testing::Values(Coil{"heated_coil.cgns", 16320, 240, 66048},
                                         Coil{"HeatingCoil.cgns", 33476, 558, 59193}),
                         [](auto const& info) { return info.index == 0 ? "stand_in" : "of_others"; });

TEST_P(RealCoil, IsReadWholeAndClosed) {
  EXPECT_EQ(mesh_kind(path), MeshKind::unstructured);
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.zones.size(), 2u);
  EXPECT_EQ(mesh.zones[0].name, "FluidZone");
  EXPECT_EQ(count(mesh, ElementType::prism), GetParam().prisms);
  EXPECT_EQ(count(mesh, ElementType::pyramid), GetParam().pyramids);
  EXPECT_EQ(count(mesh, ElementType::tetrahedron, 0), GetParam().fluid_tetrahedra);
  EXPECT_TRUE(negative_elements(mesh).empty());
  auto const topology = make_topology(mesh);
  EXPECT_EQ(topology.crowded_sides, 0);
  auto const face_patches = find_face_patches(mesh, topology);
  for (auto const& p : face_patches.problems) ADD_FAILURE() << p;
  ASSERT_EQ(mesh.patches.size(), 6u);
  auto const is_list = [](std::string const& note) { return note.find("is a list of nodes") != std::string::npos; };
  EXPECT_EQ(std::count_if(mesh.notes.begin(), mesh.notes.end(), is_list), 6);
  auto const is_null = [](Patch const& patch) { return patch.bc_type == "Null"; };
  EXPECT_EQ(std::count_if(mesh.patches.begin(), mesh.patches.end(), is_null), 3);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    EXPECT_GT(face_patches.faces_of_patch[p], 0) << mesh.patches[p].name;
    EXPECT_EQ(face_patches.faces_of_patch[p], mesh.patches[p].faces.size()) << mesh.patches[p].name;
  }
  // The coil is in both zones, though the file does not say that they touch.
  auto const touching = undeclared_connections(mesh, 1e-6 * mesh.size());
  ASSERT_EQ(touching.size(), 1u);
  EXPECT_EQ(mesh.patches[touching[0].patch].name, "Default 1 Side FluidZone Part 1");
  EXPECT_EQ(mesh.patches[touching[0].other].name, "Default 1 Side SolidZone Part 2");
  // Volume and surface agree, zone by zone (Gauss).
  UnstructuredQualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  Measure const volume[] = {Measure::volume};
  auto const volumes = cell_fields(Kokkos::DefaultHostExecutionSpace(), mesh, topology, input, volume).front();
  for (auto const& zone : mesh.zones) {
    double sum = 0, flux = 0;
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) sum += volumes(e);
    for (Index f = 0; f < topology.boundary.size(); ++f) {
      Index const e = topology.boundary.element[f];
      if (e < zone.first_element || e >= zone.first_element + zone.n_elements) continue;
      auto const n = topology.boundary.nodes[f];
      auto const x = [&](std::size_t k) { return mesh.coordinates[n[k]]; };
      for (std::size_t k = 2; k < n.size(); ++k) flux += dot(x(0), cross(x(k - 1), x(k))) / 6;
    }
    EXPECT_NEAR(sum, flux, 1e-3 * sum) << zone.name;  // warped quadrilaterals are split one way here
  }
}

TEST_P(RealCoil, ComesThroughUnchangedButForItsCoordinates) {
  TemporaryFolder const folder;
  auto const out = folder.file("out.cgns");
  auto const mesh = read_mesh(path);
  write_morphed(path, out, mesh, mesh.coordinates);
  auto const before = dump_tree(path);
  EXPECT_EQ(dump_tree(out), before);
  Coordinates after(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) after.set(n, mesh.coordinates[n] + Vec3{0.25, 0, 0});
  write_morphed(path, out, mesh, after);
  for (auto const& [node, text] : dump_tree(out))
    EXPECT_EQ(before.at(node) == text, node.find("/CoordinateX") == std::string::npos) << node;
}

TEST(RealUnstructured, TurbineCascadeIsReadWholeWithItsPeriodicPoints) {
  auto const path = shared_mesh("mesh_vki_turbine.su2");
  auto const mesh = read_mesh(path);
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.n_nodes(), 16009);
  EXPECT_EQ(count(mesh, ElementType::quadrilateral), 15714);
  ASSERT_EQ(mesh.patches.size(), 5u);
  EXPECT_EQ(mesh.patches[0].name, "airfoil");
  EXPECT_EQ(mesh.patches[0].kind, PatchKind::wall);
  EXPECT_EQ(mesh.patches[0].faces.size(), 240);
  Index pairs = 0;
  for (auto const& c : mesh.connections) {
    pairs += Index(c.nodes.size());
    ASSERT_TRUE(c.periodic);
    EXPECT_LT(largest_mismatch(mesh, c), 1e-7);
  }
  EXPECT_EQ(pairs, 294);
  auto const topology = make_topology(mesh);
  auto const face_patches = find_face_patches(mesh, topology);
  EXPECT_TRUE(face_patches.problems.empty());
  // A layer of elements beyond periodic_2 repeats those inside periodic_1: that marker lies inside the mesh, and the
  // edges around the layer belong to the connection.
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(face_patches.faces_of_patch[p], mesh.patches[p].name == "periodic_2" ? 0 : mesh.patches[p].faces.size())
        << mesh.patches[p].name;
  EXPECT_TRUE(negative_elements(mesh).empty());
  TemporaryFolder const folder;
  write_morphed(path, folder.file("out.su2"), mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(folder.file("out.su2")), bytes_of(path));
}

class RealConverted : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, RealConverted,
                         testing::Values("axial_turbine_stage_H.cgns", "water_turbine.cgns", "axialTurbine_7blk.cgns",
                                         "mdo_tutorial_000_vol.cgns", "717_wl_L2.cgns"),
                         [](auto const& info) {
                           std::string name = info.param;
                           name.resize(name.find('.'));
                           return name;
                         });

TEST_P(RealConverted, HexahedraMeasureLikeTheCells) {
  auto const path = shared_mesh(GetParam());
  if (path.empty()) GTEST_SKIP() << GetParam() << " is not there; its stand-in is tested";
  Mesh const structured = read_mesh(path);
  auto const mesh = to_hexahedra(structured);
  check_mesh(mesh);
  EXPECT_TRUE(negative_elements(mesh).empty());
  auto const topology = make_topology(mesh);
  auto const face_patches = find_face_patches(mesh, topology);
  Kokkos::DefaultHostExecutionSpace const exec;
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(structured.coordinates);
  UnstructuredQualityInput<Kokkos::HostSpace> same;
  same.coordinates = views(mesh.coordinates);
  auto const expected = measure_quality(exec, structured, input).far_field;
  auto const found = measure_quality(exec, mesh, topology, face_patches, same).far_field;
  EXPECT_EQ(found.cells, expected.cells);
  EXPECT_EQ(found.inverted, expected.inverted);
  EXPECT_EQ(found.collapsed, expected.collapsed);
  for (auto const m : {Measure::aspect_ratio, Measure::determinant_2x2x2, Measure::determinant_3x3x3,
                       Measure::minimum_angle_deg, Measure::equiangle_skewness, Measure::volume}) {
    SCOPED_TRACE(to_string(m));
    EXPECT_NEAR(found[m].min, expected[m].min, 1e-8 * std::abs(expected[m].min) + 1e-13 * expected[m].max);
    EXPECT_NEAR(found[m].max, expected[m].max, 1e-8 * std::abs(expected[m].max));
    EXPECT_NEAR(found[m].mean, expected[m].mean, 1e-8 * std::abs(expected[m].mean));
  }
}

}  // namespace
}  // namespace gridmorph::test
