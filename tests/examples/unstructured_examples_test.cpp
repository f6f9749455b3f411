// The examples with unstructured meshes: walls where the case file asks for them, neighbours of a wall as one, nothing
// inverted.
#include "example_run.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace gridmorph::test {
namespace {

class UnstructuredExample : public Example {
 protected:
  /// Runs the example; nothing may be inverted.
  void run(std::string const& name, std::string const& mesh_file, std::string const& morphed_file) {
    ASSERT_NO_FATAL_FAILURE(Example::run(name));
    mesh = read_mesh(mesh_of(name, mesh_file));
    moved = read_mesh(path(name + "/" + morphed_file)).coordinates;
    ASSERT_EQ(mesh.n_nodes(), moved.size());
  }

  [[nodiscard]] std::vector<Index32> nodes_of(std::string const& patch_name) const {
    for (auto const& patch : mesh.patches)
      if (patch.name == patch_name) return patch_nodes(patch);
    ADD_FAILURE() << "no patch " << patch_name;
    return {};
  }
  [[nodiscard]] Vec3 displacement(Index32 n) const { return moved[n] - mesh.coordinates[n]; }

  Mesh mesh;
  Coordinates moved;
};

using CoilExample = StandInTest<UnstructuredExample>;
INSTANTIATE_TEST_SUITE_P(Meshes, CoilExample, ::testing::Bool(), stand_in_or_not);

TEST_P(CoilExample, HeatingCoilSagsAsABeamInBothZonesAlikeAndItsDuctSlidesOnItsCylinders) {
  ASSERT_NO_FATAL_FAILURE(run("heating_coil", "heated_coil.cgns", "heating_coil_morphed.cgns"));
  std::map<std::tuple<double, double, double>, Vec3> outside;
  double lowest = 0;
  for (auto const& wall : {"Default 1 Side FluidZone Part 1", "Default 1 Side SolidZone Part 2"})
    for (Index32 const n : nodes_of(wall)) {
      Vec3 const x = mesh.coordinates[n];
      double const s = x.y < 0.65 ? (0.65 - x.y) / 1.5 : 0;
      // The file keeps single precision.
      EXPECT_NEAR(moved.z(n), x.z + 0.2 * (1.5 * s * s - 0.5 * s * s * s), 2e-7) << describe_node(mesh, n);
      EXPECT_EQ(moved.x(n), x.x);
      EXPECT_EQ(moved.y(n), x.y);
      lowest = std::max(lowest, moved.z(n) - x.z);
      Vec3 const& first = outside.emplace(std::tuple(x.x, x.y, x.z), moved[n]).first->second;
      EXPECT_TRUE(first == moved[n]) << describe_node(mesh, n);
    }
  EXPECT_EQ(outside.size(), GetParam() ? 1752u : 2261u);
  EXPECT_GT(lowest, GetParam() ? 0.19 : 0.199);

  // A duct of radius 1, and a body of radius 0.5 in it whose middle is read off the mesh. The stand-in's is held by a
  // strut, whose sides are planes.
  std::vector<Index32> duct, body, strut;
  for (Index32 const n : nodes_of("FluidZone Default")) {
    double const x = mesh.coordinates.x(n), y = mesh.coordinates.y(n), r = std::hypot(x, y);
    if (GetParam() && y > 0 && std::abs(std::abs(x) - y * std::tan(std::acos(-1.0) / 18)) < 1e-6)
      strut.push_back(n);
    else
      (r > 0.9 ? duct : body).push_back(n);
  }
  EXPECT_EQ(strut.empty(), !GetParam());
  // Nodes of the edges where the strut meets body and duct may slide on along these.
  for (Index32 const n : strut) {
    double const r = std::hypot(moved.x(n), moved.y(n));
    EXPECT_LT(std::min({std::abs(std::abs(moved.x(n)) - moved.y(n) * std::tan(std::acos(-1.0) / 18)), std::abs(r - 0.5),
                        std::abs(r - 1)}),
              2e-4)
        << describe_node(mesh, n);
  }
  double low = 1, high = -1;
  for (Index32 const n : body) {
    low = std::min(low, mesh.coordinates.y(n));
    high = std::max(high, mesh.coordinates.y(n));
  }
  double slid = 0;
  auto const expect_on = [&](std::vector<Index32> const& nodes, double y, double radius) {
    ASSERT_GT(nodes.size(), 500u);
    for (Index32 const n : nodes) {
      ASSERT_NEAR(std::hypot(mesh.coordinates.x(n), mesh.coordinates.y(n) - y), radius, 1e-3);
      // Smooth through facets as wide as an eighth of the radius.
      EXPECT_NEAR(std::hypot(moved.x(n), moved.y(n) - y), std::hypot(mesh.coordinates.x(n), mesh.coordinates.y(n) - y),
                  2e-4)
          << describe_node(mesh, n);
      slid = std::max(slid, norm(displacement(n)));
    }
  };
  expect_on(duct, 0, 1);
  expect_on(body, GetParam() ? 0 : (low + high) / 2, 0.5);
  EXPECT_GT(slid, 0.1);
  for (auto const* end : {"inflow", "outflow"})
    for (Index32 const n : nodes_of(end)) EXPECT_TRUE(displacement(n) == Vec3()) << end;
}

TEST_F(UnstructuredExample, TurbineBladeTurnsRigidlyAndPeriodicSidesMoveAsOne) {
  ASSERT_NO_FATAL_FAILURE(run("vki_restagger", "mesh_vki_turbine.su2", "vki_restagger_morphed.su2"));
  double const c = std::cos(5 * std::acos(-1.0) / 180), s = std::sin(5 * std::acos(-1.0) / 180);
  auto const blade = nodes_of("airfoil");
  EXPECT_EQ(blade.size(), 240u);
  for (Index32 const n : blade) {
    double const x = mesh.coordinates.x(n) - 0.018, y = mesh.coordinates.y(n) + 0.02;
    EXPECT_NEAR(moved.x(n), 0.018 + c * x - s * y, 1e-16);
    EXPECT_NEAR(moved.y(n), -0.02 + s * x + c * y, 1e-16);
  }
  double most = 0;
  for (auto const& connection : mesh.connections)
    for (std::size_t k = 0; k < connection.nodes.size(); ++k) {
      Vec3 const a = displacement(connection.nodes[k]), b = displacement(connection.donor_nodes[k]);
      EXPECT_LT(distance(a, b), 1e-16) << describe_node(mesh, connection.nodes[k]);
      most = std::max(most, norm(a));
    }
  EXPECT_GT(most, 1e-4);
  for (auto const* end : {"inflow", "outflow"})
    for (Index32 const n : nodes_of(end)) EXPECT_TRUE(displacement(n) == Vec3()) << end;
}

/// Signed, of a plane element around its corners.
double area(Mesh const& mesh, Index element) {
  auto const corners = mesh.elements.corners(element);
  double twice = 0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    Vec3 const a = mesh.coordinates[corners[c]], b = mesh.coordinates[corners[(c + 1) % corners.size()]];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

TEST_F(UnstructuredExample, FivePassagesOfARowCoverItAndNoneCoversAnother) {
  ASSERT_EQ(shell(run_command(meshes_, "vki_row")), 0) << contents(path("out")) << contents(path("vki_row/log.txt"));
  Mesh const row = read_mesh(path("vki_row/vki_row.cgns")), one = read_mesh(mesh_of("vki_row", "mesh_vki_turbine.su2"));
  EXPECT_EQ(row.dimension, 2);
  // Of elements that lie a pitch apart the file has both; a passage has one.
  Vec3 pitch;
  for (Connection const& sides : one.connections)
    if (sides.periodic) pitch = sides.periodic->declared(Vec3{});
  ASSERT_GT(norm(pitch), 0);
  std::set<std::pair<long, long>> places;
  double of_passage = 0;
  for (Index e = 0; e < one.n_elements(); ++e) {
    Vec3 middle;
    auto const corners = one.elements.corners(e);
    for (Index32 const n : corners) middle += (1.0 / double(corners.size())) * one.coordinates[n];
    auto const place = [](Vec3 const& p) { return std::pair(std::lround(p.x * 1e8), std::lround(p.y * 1e8)); };
    bool const again = places.contains(place(middle + pitch)) || places.contains(place(middle - pitch));
    places.insert(place(middle));
    if (!again) of_passage += std::abs(area(one, e));
  }
  double whole = 0;
  for (Index e = 0; e < row.n_elements(); ++e) whole += std::abs(area(row, e));
  // Blades turn, and nothing else moves but along the pitch.
  EXPECT_NEAR(whole / (5 * of_passage), 1, 1e-7);
}

TEST_F(UnstructuredExample, TheRowOfATurbineBladeGoesAlongWithIt) {
  ASSERT_NO_FATAL_FAILURE(run("vki_cascade", "mesh_vki_turbine.su2", "vki_cascade_morphed.su2"));
  // The chord is the longest distance on the blade.
  auto const chord = [&](Coordinates const& x) {
    double longest = 0;
    for (Index32 const a : nodes_of("airfoil"))
      for (Index32 const b : nodes_of("airfoil")) longest = std::max(longest, distance(x[a], x[b]));
    return longest;
  };
  EXPECT_NEAR(chord(moved) / chord(mesh.coordinates), 0.95, 1e-3);
  std::vector<double> slid;
  for (auto const* end : {"inflow", "outflow"}) {
    Vec3 const first = displacement(nodes_of(end).front());
    slid.push_back(first.y);
    for (Index32 const n : nodes_of(end)) {
      EXPECT_EQ(displacement(n).x, 0) << end;
      EXPECT_NEAR(displacement(n).y, first.y, 1e-16) << end;
    }
  }
  // The blade turns about mid chord: its edges go opposite ways.
  EXPECT_LT(slid[0] * slid[1], 0);
  for (auto const& connection : mesh.connections)
    for (std::size_t k = 0; k < connection.nodes.size(); ++k)
      EXPECT_LT(distance(displacement(connection.nodes[k]), displacement(connection.donor_nodes[k])), 1e-15);
}

/// What the case file gives the blade.
Vec3 grown_blade(Vec3 const& p) {
  double const h = p.z / 1.5, turn = 12 * h * std::acos(-1.0) / 180, grow = 1 + 0.15 * h;
  return {p.x * grow * std::cos(turn) - p.y * std::sin(turn),
          p.x * grow * std::sin(turn) + p.y * std::cos(turn) + 0.25 * h * h, p.z};
}

/// How much longer or shorter the ways between places become, at most.
double distortion(std::vector<Vec3> const& before, std::vector<Vec3> const& after) {
  double most = 0;
  for (std::size_t n = 0; n < before.size(); ++n)
    for (std::size_t m = 0; m < n; ++m)
      most = std::max(most, std::abs(distance(after[n], after[m]) / distance(before[n], before[m]) - 1));
  return most;
}

TEST_F(UnstructuredExample, CooledBladeKeepsTheShapesOfItsFeatures) {
  if (!has_gmsh()) GTEST_SKIP() << "Gmsh, which makes the mesh, is not there";
  ASSERT_NO_FATAL_FAILURE(run("cooled_blade", "cooled_blade.msh", "cooled_blade_morphed.msh"));
  double most = 0;
  for (auto const& [patch, count] : {std::pair("holes", 6u), {"shroud", 2u}, {"squealer", 1u}}) {
    std::map<std::pair<int, bool>, std::vector<Index32>> features;  // by height and side
    bool const one = count == 1;
    for (Index32 const n : nodes_of(patch))
      features[{one ? 0 : int(std::lround((mesh.coordinates.z(n) - 0.3) / 0.45)), one || mesh.coordinates.y(n) > 0}]
          .push_back(n);
    EXPECT_EQ(features.size(), count) << patch;
    for (auto const& [place, nodes] : features) {
      std::vector<Vec3> x, y, by_blade;
      double farthest = 0;
      for (Index32 const n : nodes) {
        x.push_back(mesh.coordinates[n]);
        y.push_back(moved[n]);
        by_blade.push_back(grown_blade(x.back()));
        farthest = std::max(farthest, distance(x.back(), y.back()));
      }
      EXPECT_LT(distortion(x, y), 1e-10) << patch << " at " << place.first;
      most = std::max(most, distortion(x, by_blade));
      EXPECT_GT(farthest, 0.003);
    }
  }
  EXPECT_GT(most, 0.05) << "what the blade would do to them";
  std::size_t as_told = 0;
  for (Index32 const n : nodes_of("blade")) {
    double const off = distance(moved[n], grown_blade(mesh.coordinates[n]));
    EXPECT_LT(off, 0.08);
    as_told += off < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(as_told, nodes_of("blade").size() / 4);
}

}  // namespace
}  // namespace gridmorph::test
