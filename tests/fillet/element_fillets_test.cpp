// Fillets on elements: against the circle between two lines, and what must hold of meshes of hexahedra and prisms.
#include "support/expect_error.hpp"
#include "support/reduced.hpp"
#include "support/shared_mesh.hpp"
#include "wedge.hpp"

#include <generators/passage.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/fillet/fillet_elements.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

using test::between;
using test::expect_all_in;
using test::grown;
using test::message_of;
using test::wedge;
using test::Wedge;

constexpr double pi = std::numbers::pi;

Mesh hexahedra_of(Mesh blocks) {
  (void)connect_and_check(blocks, {});
  return as_hexahedra(blocks);
}

ElementFillet fillet_of(Mesh const& mesh, FilletOptions const& options) {
  UnstructuredTopology const topology = make_topology(mesh);
  return make_fillet(mesh, topology, find_face_patches(mesh, topology), options);
}

/// Closed and valid: what must hold of every result.
QualityReport expect_sound(Mesh const& mesh) {
  EXPECT_NO_THROW(check_mesh(mesh));
  UnstructuredTopology const topology = make_topology(mesh);
  EXPECT_EQ(topology.crowded_sides, 0);
  BoundaryFacePatches const faces = find_face_patches(mesh, topology);
  EXPECT_TRUE(faces.problems.empty()) << faces.problems.front();
  UnstructuredQualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  QualityReport quality = measure_quality(Kokkos::DefaultHostExecutionSpace(), mesh, topology, faces, input);
  EXPECT_EQ(quality.far_field.inverted, 0);
  return quality;
}

/// Nodes on the faces of patches of a name.
std::vector<Index32> nodes_on(Mesh const& mesh, std::string const& name) {
  std::vector<Index32> out;
  for (Patch const& patch : mesh.patches)
    if (patch.name == name || std::find(patch.families.begin(), patch.families.end(), name) != patch.families.end())
      for (Index32 const n : patch_nodes(patch)) out.push_back(n);
  return out;
}

/// By the divergence theorem over the faces of every element, each split around its middle.
double volume_of(Mesh const& mesh) {
  double volume = 0;
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    double element = 0;
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const side = side_nodes(mesh, e, s, room);
      Vec3 middle;
      for (Index32 const n : side) middle += (1 / double(side.size())) * mesh.coordinates[n];
      for (std::size_t k = 0; k < side.size(); ++k)
        element += dot(middle, cross(mesh.coordinates[side[k]], mesh.coordinates[side[(k + 1) % side.size()]])) / 6;
    }
    volume += std::abs(element);
  }
  return volume;
}

class ElementWedges : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Angles, ElementWedges, ::testing::Values(60, 90, 120),
                         [](auto const& info) { return std::to_string(int(info.param)); });

TEST_P(ElementWedges, WallsAreLinesAndTheCircleThatTouchesThem) {
  double const angle = GetParam() * pi / 180, radius = 0.06, contact = radius / std::tan(angle / 2);
  Mesh const mesh = hexahedra_of(wedge({.angle_rad = angle}));
  ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  (void)expect_sound(result.mesh);
  EXPECT_EQ(result.stations, 7);
  EXPECT_EQ(result.open_ends, 0);
  EXPECT_GT(result.cut_elements, 6 * 5);
  EXPECT_EQ(result.mesh.n_elements(), mesh.n_elements() + result.cut_elements);
  EXPECT_NEAR(result.arc_angle_deg[0], 180 - GetParam(), 0.01);
  int on_arc = 0;
  for (std::string const wall : {"blade", "hub"})
    for (Index32 const n : nodes_on(result.mesh, wall)) {
      Vec3 const p = result.mesh.coordinates[n];
      on_arc += std::max(p.x, p.y / std::sin(angle)) < contact - 1e-5 ? 1 : 0;
      EXPECT_TRUE(test::on_filled_wedge(p, angle, radius, 1e-5)) << p.x << " " << p.y;
      EXPECT_NEAR(p.z, mesh.coordinates[n].z, 1e-9);
    }
  EXPECT_GE(on_arc, 7 * 4);
  // What the fillet takes from the flow, up to chords instead of arcs.
  double const filled = 1.2 * radius * radius * (1 / std::tan(angle / 2) - (pi - angle) / 2);
  EXPECT_NEAR(volume_of(mesh) - volume_of(result.mesh), filled, 0.2 * filled);
}

TEST_P(ElementWedges, FirstCellsKeepTheirHeights) {
  double const angle = GetParam() * pi / 180, radius = 0.06;
  Wedge const shape{.angle_rad = angle};
  Mesh const mesh = hexahedra_of(wedge(shape));
  ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  double const first = grown(1, 24, 1.15) * std::sin(angle);
  Vec3 const centre = radius / std::sin(angle / 2) * Vec3{std::cos(angle / 2), std::sin(angle / 2), 0};
  Vec3 const blade_normal{std::sin(angle), -std::cos(angle), 0};
  int checked = 0;
  // Nodes of the block are those of the hexahedra, i fastest. Off the new walls, which are lines and an arc.
  auto const node = [&](int j, int k) { return Index(3 + 7 * (j + 25 * k)); };
  for (int m = 3; m < 24; ++m)
    for (int wall = 0; wall < 2; ++wall) {
      Vec3 const foot = result.mesh.coordinates[wall == 0 ? node(0, m) : node(m, 0)];
      Vec3 const over = result.mesh.coordinates[wall == 0 ? node(1, m) : node(m, 1)];
      double const off_line = wall == 0 ? dot(over, blade_normal) : over.y;
      double const off_arc = radius - norm(Vec3{over.x - centre.x, over.y - centre.y, 0});
      bool const on_arc = std::abs(distance({foot.x, foot.y, 0}, centre) - radius) < 1e-4 * radius;
      EXPECT_NEAR(on_arc ? off_arc : off_line, first, 0.02 * first) << wall << " " << m;
      ++checked;
    }
  EXPECT_EQ(checked, 42);
}

TEST(ElementFillet, LayersOfDifferentHeightsMeet) {
  // First cells off the blade are 1 / 40 as high as those off the hub.
  Mesh const mesh = hexahedra_of(wedge({.extent = {5, 41, 31}, .growth = {1.2, 1.1}}));
  for (double const radius : {0.03, 0.1}) {
    ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
    QualityReport const quality = expect_sound(result.mesh);
    EXPECT_GT(quality.far_field[Measure::determinant_3x3x3].min, 0.1) << radius;
    EXPECT_GT(result.layers.old[0], result.layers.old[1]);
  }
}

TEST(ElementFillet, LeaningLinesComeToTheSameArc) {
  double const radius = 0.05;
  for (double const lean : {0.6, -1.5}) {
    Mesh const mesh = hexahedra_of(wedge({.lean = lean, .extent = {41, 25, 25}}));
    auto options = between(mesh, {"blade"}, {"hub"}, 0);
    options.radius = [radius](Vec3 const& p) {  // lines leave the ends of the corner
      double const t = std::min(1.0, std::min(p.z, 1.2 - p.z) / 0.4);
      return radius * t * t * (3 - 2 * t);
    };
    ElementFillet const result = fillet_of(mesh, options);
    (void)expect_sound(result.mesh);
    // Where the radius is constant.
    for (std::string const wall : {"blade", "hub"})
      for (Index32 const n : nodes_on(result.mesh, wall)) {
        Vec3 const p = result.mesh.coordinates[n];
        if (p.z < 0.52 || p.z > 0.68) continue;
        EXPECT_TRUE(test::on_filled_wedge(p, pi / 2, radius, 1e-5)) << p.x << " " << p.y << " " << p.z;
      }
  }
}

TEST(ElementFillet, LayersThatMeetInAMitreStayWhatTheyAre) {
  Mesh const sharp = hexahedra_of(wedge({}));
  auto cut = between(sharp, {"blade"}, {"hub"}, 0);
  cut.layers = {9, 9};
  Mesh const mesh = fillet_of(sharp, cut).mesh;  // prisms on either side of the mitre
  EXPECT_NEAR(volume_of(mesh), volume_of(sharp), 1e-12);
  double const radius = 0.06;
  ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  (void)expect_sound(result.mesh);
  EXPECT_EQ(result.cut_elements, 0);
  EXPECT_EQ(result.mesh.elements.nodes.item, mesh.elements.nodes.item);
  for (std::string const wall : {"blade", "hub"})
    for (Index32 const n : nodes_on(result.mesh, wall)) {
      Vec3 const p = result.mesh.coordinates[n];
      EXPECT_TRUE(test::on_filled_wedge(p, pi / 2, radius, 1e-5)) << p.x << " " << p.y;
    }
}

TEST(ElementFillet, OneTopologyServesAllRadii) {
  Mesh const mesh = hexahedra_of(wedge({}));
  std::vector<Index32> first;
  for (double const radius : {0.0, 0.03, 0.06}) {
    auto options = between(mesh, {"blade"}, {"hub"}, radius);
    options.layers = {10, 10};
    ElementFillet const result = fillet_of(mesh, options);
    (void)expect_sound(result.mesh);
    if (first.empty()) first = result.mesh.elements.nodes.item;
    EXPECT_EQ(result.mesh.elements.nodes.item, first);
    if (radius > 0) continue;
    for (Index n = 0; n < mesh.n_nodes(); ++n) ASSERT_EQ(result.mesh.coordinates[n], mesh.coordinates[n]);
  }
}

TEST(ElementFillet, NodesFarAwayStayBitForBit) {
  Mesh const mesh = hexahedra_of(wedge({}));
  ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.03));
  int same = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    if (std::max(p.x, p.y) < 0.091) continue;
    EXPECT_EQ(result.mesh.coordinates[n], p) << p.x << " " << p.y;
    ++same;
  }
  EXPECT_GT(same, 7 * 16 * 16);
}

TEST(ElementFillet, ARadiusThatDoesNotFitComesWithOneThatDoes) {
  Mesh const mesh = hexahedra_of(wedge({}));
  std::string const message =
      message_of<MotionError>([&] { (void)fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.95)); });
  expect_all_in(message, {"does not fit", "0.95", "would do"});
  double const fits = std::stod(message.substr(message.find("about ") + 6));
  EXPECT_GT(fits, 0.3);
  (void)expect_sound(fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.95 * fits)).mesh);
}

/// Every hexahedron as six tetrahedra around the diagonal from its first corner, which cuts faces of neighbours alike.
Mesh tetrahedra_of(Mesh const& mesh) {
  Mesh out = mesh;
  out.elements = {};
  for (Zone& zone : out.zones) zone.first_element = 6 * zone.first_element, zone.n_elements *= 6;
  constexpr int path[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const c = mesh.elements.corners(e);
    for (auto const& [a, b] : path) {
      std::array<Index32, 4> const nodes{c[0], c[a], c[b], c[6]};
      out.elements.type.push_back(ElementType::tetrahedron);
      out.elements.nodes.add(nodes);
    }
  }
  // Boundary faces are cut along diagonals from their corner 0 or 6, whichever they have.
  UnstructuredTopology const topology = make_topology(mesh);
  for (Patch& patch : out.patches) {
    CsrGraph faces;
    for (Index f = 0; f < patch.faces.size(); ++f) {
      auto const face = patch.faces[f];
      Index32 const side = find_boundary_face(topology, face);
      auto const c = mesh.elements.corners(topology.boundary.element[side]);
      std::size_t const from = std::size_t(
          std::find_if(face.begin(), face.end(), [&](Index32 n) { return n == c[0] || n == c[6]; }) - face.begin());
      auto const at = [&](std::size_t k) { return face[(from + k) % 4]; };
      faces.add(std::array<Index32, 3>{at(0), at(1), at(2)});
      faces.add(std::array<Index32, 3>{at(0), at(2), at(3)});
    }
    patch.faces = faces;
  }
  return out;
}

TEST(ElementFillet, WhatCannotBeFilledIsRefused) {
  Mesh const mesh = hexahedra_of(wedge({}));
  expect_all_in(message_of<MeshError>([&] { (void)fillet_of(mesh, between(mesh, {"side"}, {"side"}, 0.01)); }),
                {"edge in common", "--blade"});
  expect_all_in(message_of<MotionError>([&] { (void)fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, -1)); }),
                {"-1", "radius"});
  Mesh const tetrahedra = tetrahedra_of(mesh);
  ASSERT_NO_THROW(check_mesh(tetrahedra));
  std::string const message =
      message_of<MeshError>([&] { (void)fillet_of(tetrahedra, between(tetrahedra, {"hub"}, {"side"}, 0.01)); });
  expect_all_in(message, {"tetrahedron", "a face on the blade and one on the end wall"});
}

TEST(ElementFillet, ArcsHaveAFamilyOfTheirOwnThatIsTheBladesToo) {
  double const radius = 0.06;
  Mesh const mesh = hexahedra_of(wedge({}));
  Mesh const made = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius)).mesh;
  int arcs = 0;
  for (Patch const& patch : made.patches) {
    bool const arc = patch.families.front() == "blade_fillet";
    arcs += arc ? 1 : 0;
    if (arc) {
      EXPECT_EQ(patch.families, (std::vector<std::string>{"blade_fillet", "blade"}));
    }
    for (Index32 const n : patch_nodes(patch)) {
      Vec3 const p = made.coordinates[n];
      if (!arc && patch.families.front() != "far" && patch.families.front() != "side") {
        EXPECT_LT(std::abs(patch.families.front() == "hub" ? p.y : p.x), 1e-9);
      }
    }
  }
  EXPECT_EQ(arcs, 2) << "from either wall";
}

TEST(ElementFillet, ASecondFilletOverACoarseOneIsRefused) {
  Mesh const mesh = hexahedra_of(wedge({.extent = {5, 9, 9}, .growth = {1.01, 1.01}}));
  auto options = between(mesh, {"blade"}, {"hub"}, 0.5);
  Mesh filled = fillet_of(mesh, options).mesh;
  // As other programs would name them: arcs belong to the walls they are cut from.
  for (Patch& patch : filled.patches)
    if (patch.families.front() == "blade_fillet") {
      double x = 0, y = 0;
      for (Index32 const n : patch_nodes(patch)) x += filled.coordinates[n].x, y += filled.coordinates[n].y;
      patch.families = {x > y ? "hub" : "blade"};
    }
  for (double const radius : {0.1, 0.4, 0.6})
    expect_all_in(
        message_of<MotionError>([&] { (void)fillet_of(filled, between(filled, {"blade"}, {"hub"}, radius)); }),
        {"degrees", "already"});
}

TEST(ElementFillet, WallsOfTetrahedraAreRefused) {
  Mesh const tetrahedra = tetrahedra_of(hexahedra_of(wedge({})));
  for (auto const& [blade, wall] : {std::pair("blade", "hub"), std::pair("hub", "blade"), std::pair("hub", "side")})
    expect_all_in(
        message_of<MeshError>([&] { (void)fillet_of(tetrahedra, between(tetrahedra, {blade}, {wall}, 0.03)); }),
        {"tetrahedron"});
}

class FilledElements : public ::testing::Test {
 protected:
  static Mesh passage(Index nodes, PassageOptions::Layout layout = PassageOptions::Layout::whole_faces) {
    PassageOptions options;
    options.nodes = nodes;
    options.layout = layout;
    return hexahedra_of(make_passage(options));
  }
};

TEST_F(FilledElements, HubAndCaseOfAPassageAreFilledInEitherLayout) {
  for (auto const layout : {PassageOptions::Layout::whole_faces, PassageOptions::Layout::five_zones}) {
    Mesh const mesh = passage(test::reduced() ? 60'000 : 120'000, layout);
    ElementFillet const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub", "case"}, 0.003));
    (void)expect_sound(result.mesh);
    EXPECT_EQ(result.open_ends, 0);
    EXPECT_GT(result.arc_angle_deg[0], 75);
    EXPECT_LT(result.arc_angle_deg[1], 105);
    // Nodes that zones share stay together.
    for (Connection const& c : mesh.connections) {
      if (c.periodic) continue;
      for (std::size_t n = 0; n < c.nodes.size(); ++n)
        ASSERT_LT(distance(result.mesh.coordinates[c.nodes[n]], result.mesh.coordinates[c.donor_nodes[n]]), 1e-12);
    }
  }
}

/// Nodes of each zone and elements in another order.
Mesh renumbered(Mesh const& mesh) {
  Mesh out = mesh;
  out.coordinates = Coordinates(mesh.n_nodes());
  std::vector<Index32> number(mesh.n_nodes());
  for (Zone const& zone : mesh.zones)
    for (Index n = 0; n < zone.size(); ++n)
      number[zone.first_node + n] = Index32(zone.first_node + (n * 7919) % zone.size());
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.coordinates.set(number[n], mesh.coordinates[n]);
  auto const renumber = [&](auto& list) {
    for (Index32& n : list) n = number[n];
  };
  renumber(out.elements.nodes.item);
  for (Patch& patch : out.patches) renumber(patch.faces.item);
  for (Connection& c : out.connections) {
    renumber(c.nodes);
    renumber(c.donor_nodes);
  }
  return out;
}

TEST_F(FilledElements, TheSameHowEverNodesAreNumbered) {
  Mesh const mesh = passage(30'000);
  for (Zone const& zone : mesh.zones) ASSERT_NE(zone.size() % 7919, 0);
  Mesh const other = renumbered(mesh);
  auto const options = [](Mesh const& m) { return between(m, {"blade"}, {"hub"}, 0.002); };
  double const filled = volume_of(fillet_of(mesh, options(mesh)).mesh);
  EXPECT_NEAR(volume_of(fillet_of(other, options(other)).mesh), filled, 1e-9 * filled);
}

TEST_F(FilledElements, TheRadiusMayChangeAlongTheCorner) {
  Mesh const mesh = passage(test::reduced() ? 60'000 : 120'000);
  auto options = between(mesh, {"blade"}, {"hub"}, 0);
  options.radius = [](Vec3 const& p) { return 0.003 + 0.01 * p.x; };
  ElementFillet const result = fillet_of(mesh, options);
  (void)expect_sound(result.mesh);
  EXPECT_NEAR(result.smallest_radius, 0.0025, 1e-4);
  EXPECT_NEAR(result.largest_radius, 0.0035, 1e-4);
}

struct RealElementFillet {
  std::string name, file, blade;
  std::vector<std::string> walls;
  double radius, least_determinant;
};

class RealElementFillets : public ::testing::TestWithParam<RealElementFillet> {};
INSTANTIATE_TEST_SUITE_P(
    Meshes, RealElementFillets,
    ::testing::Values(
        RealElementFillet{"StageVane", "axial_turbine_stage_H.cgns", "BLADE1", {"HUB", "SHROUD"}, 0.004, 0.1},
        RealElementFillet{"StageRotor", "axial_turbine_stage_H.cgns", "BLADE2", {"HUB"}, 0.004, 0.1},
        RealElementFillet{"WaterTurbine", "water_turbine.cgns", "BLADE_RU", {"HUB"}, 0.006, 0.1},
        RealElementFillet{"SevenBlocks", "axialTurbine_7blk.cgns", "BLADE_RU", {"HUB"}, 0.006, 0.3}),
    [](auto const& info) { return info.param.name; });

TEST_P(RealElementFillets, AreClosedAndValidAndRunOutAtTheEdges) {
  RealElementFillet const& of = GetParam();
  std::string const file = test::shared_mesh(of.file);
  if (file.empty()) GTEST_SKIP() << of.file << " is not at hand";
  Mesh const mesh = hexahedra_of(read_mesh(file));
  ElementFillet const result = fillet_of(mesh, between(mesh, {of.blade}, of.walls, of.radius));
  QualityReport const quality = expect_sound(result.mesh);
  EXPECT_GT(quality.far_field[Measure::determinant_3x3x3].min, of.least_determinant);
  EXPECT_GT(result.open_ends, 0);
  EXPECT_LT(result.smallest_radius, 0.5 * of.radius);
}

}  // namespace
}  // namespace gridmorph
