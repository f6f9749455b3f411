// Wraps and background meshes of walls that others have meshed.
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/classify.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <ostream>

#include "support/morph_run.hpp"
#include "support/shared_mesh.hpp"
#include "support/temporary_folder.hpp"

namespace gridmorph::test {
namespace {

struct Real {
  char const* file;
  char const* wall;  ///< name of a patch, or "wall": all of that kind
  double offset;
  bool tube;
  double turn_deg;  ///< about z (2-D) or x, at the lower end of the walls
  friend std::ostream& operator<<(std::ostream& out, Real const& r) {
    return out << r.file << (r.tube ? " in a tube" : "");
  }
};

class RealWrap : public testing::TestWithParam<Real> {};

TEST_P(RealWrap, HoldsTheWallsAndItsBackgroundMeshCarriesATurn) {
  Real const& real = GetParam();
  std::string const path = shared_mesh(real.file);
  if (path.empty()) GTEST_SKIP() << real.file << " is not there; its stand-in is tested";
  Mesh const mesh = mesh_kind(path) == MeshKind::structured ? as_hexahedra(read_mesh(path)) : read_mesh(path);
  UnstructuredTopology const topology = make_topology(mesh);
  BoundaryFacePatches const face_patches = find_face_patches(mesh, topology);
  std::vector<CsrGraph> walls(1);
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    int const p = face_patches.patch[f];
    if (p < 0) continue;
    Patch const& patch = mesh.patches[p];
    if (patch.name == real.wall || to_string(patch.kind) == real.wall) walls[0].add(topology.boundary.nodes[f]);
  }
  ASSERT_GT(walls[0].size(), 0);
  WrapOptions options;
  options.offset = real.offset;
  options.tube = real.tube;
  gridmorph::Wrap const wrap = make_wrap({}, mesh, walls, options);
  EXPECT_EQ(bool(wrap.tube), real.tube) << wrap.note;
  std::vector<char> is_wall(mesh.n_nodes(), 0);
  double lowest = 1e300;
  for (Index32 const n : walls[0].item) {
    ASSERT_TRUE(wrap.contains(mesh.coordinates[n]));
    is_wall[n] = 1;
    lowest = std::min(lowest, mesh.coordinates[n].z);
  }
  Classification const regions = classify({}, mesh, wrap);
  EXPECT_EQ(regions.n_near + regions.n_partial + regions.n_far, mesh.n_elements());
  EXPECT_GT(regions.n_far, mesh.n_elements() / 10);
  std::vector<Index32> far;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    if (is_wall[n] != 0) {
      EXPECT_EQ(regions.near[n], 1);
    }
    if (regions.near[n] == 0) far.push_back(Index32(n));
  }

  Background background = make_background(wrap);
  FarRows const rows = background_rows({}, background, mesh.coordinates, far);
  EXPECT_EQ(rows.n_outside, 0) << rows.largest_distance;
  PreparedMorph const prepared = prepare_background({}, background);
  auto const& seconds = prepared.seconds;
  EXPECT_LT(seconds.topology + seconds.rules + seconds.plan, 10);
  WrapNodes const nodes = wrap_nodes(background, prepared);
  bool const flat = mesh.dimension == 2;
  RigidTransform const turn =
      rotation_about({0, 0, lowest}, flat ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, real.turn_deg * std::numbers::pi / 180);
  std::vector<Vec3> boundary(prepared.plan().boundary_nodes.size());
  for (std::size_t n = 0; n < nodes.position.size(); ++n)
    boundary[nodes.boundary_node[n]] = turn(nodes.position[n]) - nodes.position[n];
  Morphed const m = run_plan(Kokkos::DefaultHostExecutionSpace(), background.mesh, prepared.plan(), boundary);
  // No node of the far field moves further than the wrap.
  double largest = 0;
  for (Vec3 const& u : boundary) largest = std::max(largest, norm(u));
  EXPECT_GT(largest, 0);
  for (Index r = 0; r < rows.rows.size(); ++r) {
    Vec3 u;
    for (Index k = rows.rows.first[r]; k < rows.rows.first[r + 1]; ++k)
      u += double(rows.rows.weight[k]) * m.displacement[rows.rows.item[k]];
    ASSERT_LT(norm(u), 1.2 * largest);
  }

  // As a file it is a mesh like any other: all interfaces match, all faces are claimed.
  TemporaryFolder const folder;
  std::string const written = folder.file("background.cgns");
  write_mesh(written, background.mesh);
  Mesh again = read_mesh(written);
  EXPECT_EQ(again.interfaces.size(), background.mesh.interfaces.size());
  Links const links = connect_and_check(again, {});
  EXPECT_GT(links.all.size(), 0u);
  write_mesh(folder.file("wrap.cgns"), wrap_mesh(wrap));
  EXPECT_GT(read_mesh(folder.file("wrap.cgns")).n_elements(), 0);
}

INSTANTIATE_TEST_SUITE_P(Walls, RealWrap,
                         testing::Values(Real{"heated_coil.cgns", "Default 1 Side FluidZone Part 1", 0.03, false, 5},
                                         Real{"HeatingCoil.cgns", "Default 1 Side FluidZone Part 1", 0.03, false, 5},
                                         Real{"mesh_vki_turbine.su2", "airfoil", 0.0015, false, 10},
                                         Real{"mdo_tutorial_000_vol.cgns", "wall", 1, false, 20},
                                         Real{"mdo_tutorial_000_vol.cgns", "wall", 1, true, 20},
                                         Real{"717_wl_L2.cgns", "wall", 1, false, 20},
                                         Real{"717_wl_L2.cgns", "wall", 1, true, 20}));

}  // namespace
}  // namespace gridmorph::test
