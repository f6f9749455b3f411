// Fillets: against the circle between two lines, and what must hold of the mesh of a passage.
#include "support/expect_error.hpp"
#include "support/reduced.hpp"
#include "support/scramble.hpp"
#include "wedge.hpp"

#include <generators/passage.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace gridmorph {
namespace {

using test::between;
using test::expect_all_in;
using test::grown;
using test::message_of;

constexpr double pi = std::numbers::pi;

Mesh wedge(double angle_rad, double lean = 0, Index3 extent = {7, 25, 25}) {
  return test::wedge({.angle_rad = angle_rad, .lean = lean, .extent = extent});
}

FilletResult fillet_of(Mesh mesh, FilletOptions const& options) {
  Links const links = connect_and_check(mesh, {});
  return make_fillet(mesh, links, options);
}

/// Conformal and valid: what must hold of every result.
QualityReport expect_sound(Mesh const& mesh) {
  auto const wrong = test::flaws(mesh, 1e-9 * mesh.size());
  EXPECT_TRUE(wrong.empty()) << wrong.front() << ", and " << wrong.size() - 1 << " more";
  Mesh checked = mesh;
  EXPECT_NO_THROW((void)connect_and_check(checked, {}));
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  QualityReport quality = measure_quality(Kokkos::DefaultHostExecutionSpace(), mesh, input);
  EXPECT_EQ(quality.far_field.inverted, 0);
  return quality;
}

/// Positions of the nodes of all patches of a family.
std::vector<Vec3> nodes_of(Mesh const& mesh, std::string const& family) {
  std::vector<Vec3> out;
  for (Patch const& patch : mesh.patches) {
    if (std::find(patch.families.begin(), patch.families.end(), family) == patch.families.end()) continue;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
          out.push_back(mesh.coordinates[mesh.zones[patch.zone].node({i, j, k})]);
  }
  return out;
}

/// Cells around their middle, each face around its own: the same however they are numbered.
double volume_of(Mesh const& mesh) {
  double volume = 0;
  for (Zone const& zone : mesh.zones)
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i) {
          double cell = 0;
          for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
              std::array<Vec3, 4> face;
              Vec3 middle;
              for (int n = 0; n < 4; ++n) {
                Index3 p{i, j, k};
                p[axis] += side;
                p[(axis + 1) % 3] += n == 1 || n == 2 ? 1 : 0;
                p[(axis + 2) % 3] += n >= 2 ? 1 : 0;
                face[n] = mesh.coordinates[zone.node(p)];
                middle += 0.25 * face[n];
              }
              for (std::size_t n = 0; n < 4; ++n)
                cell += (side == 0 ? -1 : 1) * dot(middle, cross(face[n], face[(n + 1) % 4])) / 6;
            }
          volume += std::abs(cell);
        }
  return volume;
}

class Wedges : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Angles, Wedges, ::testing::Values(60, 90, 120),
                         [](auto const& info) { return std::to_string(int(info.param)); });

TEST_P(Wedges, WallsAreLinesAndTheCircleThatTouchesThem) {
  double const angle = GetParam() * pi / 180, radius = 0.06, contact = radius / std::tan(angle / 2);
  Vec3 const blade{std::cos(angle), std::sin(angle), 0};
  Vec3 const centre = radius / std::sin(angle / 2) * Vec3{std::cos(angle / 2), std::sin(angle / 2), 0};
  Mesh const mesh = wedge(angle);
  FilletResult const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  Mesh const& made = result.split.mesh;
  (void)expect_sound(made);
  EXPECT_EQ(result.stations, 7);
  EXPECT_NEAR(result.arc_angle_deg[0], 180 - GetParam(), 1e-9);
  int on_arc = 0;
  for (std::string const wall : {"blade", "hub"})
    for (Vec3 const& p : nodes_of(made, wall)) {
      Vec3 const q{p.x, p.y, 0};
      double const on_blade = dot(q, blade), off_blade = norm(q - on_blade * blade);
      bool const straight =
          (p.x >= contact - 1e-12 && std::abs(p.y) < 1e-12) || (on_blade >= contact - 1e-12 && off_blade < 1e-12);
      on_arc += straight ? 0 : 1;
      EXPECT_TRUE(straight || std::abs(distance(q, centre) - radius) < 1e-9 * radius) << p.x << " " << p.y;
    }
  EXPECT_GE(on_arc, 7 * 4);
  // What the fillet takes from the flow, up to chords instead of arcs.
  double const filled = 1.2 * radius * radius * (1 / std::tan(angle / 2) - (pi - angle) / 2);
  EXPECT_NEAR(volume_of(mesh) - volume_of(made), filled, 0.2 * filled);
  EXPECT_LT(result.wall_deviation, 1e-12);
}

TEST_P(Wedges, FirstCellsKeepTheirHeights) {
  double const angle = GetParam() * pi / 180, radius = 0.06;
  Mesh const mesh = wedge(angle);
  FilletResult const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  double const first = grown(1, 24, 1.15);
  for (std::size_t z = 0; z < result.split.zones.size(); ++z) {
    if (result.split.zones[z].sheet < 0) continue;
    Zone const& zone = result.split.mesh.zones[z];
    bool const blade = zone.name.find("_blade") != std::string::npos;
    for (int n = 0; n < zone.extent[blade ? 2 : 1]; ++n) {
      auto const at = [&](int layer) {
        return result.split.mesh.coordinates[zone.node(blade ? Index3{3, layer, n} : Index3{3, n, layer})];
      };
      EXPECT_NEAR(distance(at(0), at(1)), first, 0.02 * first) << zone.name << " " << n;
    }
  }
}

TEST(Fillet, LeaningLinesComeToTheSameArc) {
  double const radius = 0.05;
  for (double const lean : {0.6, -1.5}) {
    Mesh const mesh = wedge(pi / 2, lean, {41, 25, 25});
    auto options = between(mesh, {"blade"}, {"hub"}, 0);
    options.layers = {9, 9};
    options.radius = [radius](Vec3 const& p) {  // lines leave the ends of the corner
      double const t = std::min(1.0, std::min(p.z, 1.2 - p.z) / 0.4);
      return radius * t * t * (3 - 2 * t);
    };
    FilletResult const result = fillet_of(mesh, options);
    (void)expect_sound(result.split.mesh);
    // Where the radius is constant.
    for (std::string const wall : {"blade", "hub"})
      for (Vec3 const& p : nodes_of(result.split.mesh, wall)) {
        if (p.z < 0.52 || p.z > 0.68) continue;
        bool const straight =
            (p.x >= radius - 1e-6 && std::abs(p.y) < 1e-9) || (p.y >= radius - 1e-6 && std::abs(p.x) < 1e-9);
        EXPECT_TRUE(straight || std::abs(std::hypot(p.x - radius, p.y - radius) - radius) < 1e-6 * radius)
            << p.x << " " << p.y << " " << p.z;
      }
  }
}

TEST_P(Wedges, ArcsHaveAFamilyOfTheirOwnThatIsTheBladesToo) {
  double const angle = GetParam() * pi / 180, radius = 0.06, contact = radius / std::tan(angle / 2);
  Mesh const mesh = wedge(angle);
  Mesh const made = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius)).split.mesh;
  int on_arc = 0;
  for (Patch const& patch : made.patches)
    if (patch.families.front() == "blade_fillet") {
      EXPECT_EQ(patch.families, (std::vector<std::string>{"blade_fillet", "blade"}));
      EXPECT_EQ(patch.kind, PatchKind::wall);
      ++on_arc;
    }
  EXPECT_EQ(on_arc, 2) << "from either wall";
  for (Vec3 const& p : nodes_of(made, "hub")) EXPECT_LT(std::abs(p.y), 1e-12);
  for (Patch const& patch : made.patches) {
    if (patch.families.front() != "blade") continue;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j) {
        Vec3 const p = made.coordinates[made.zones[patch.zone].node({patch.range.begin[0], j, k})];
        EXPECT_LT(std::abs(p.y * std::cos(angle) - p.x * std::sin(angle)), 1e-9);
        EXPECT_GE(std::hypot(p.x, p.y), contact - 1e-9);
      }
  }
  EXPECT_TRUE(std::find(made.families.begin(), made.families.end(), "blade_fillet") != made.families.end());
}

TEST(Fillet, NoRadiusLeavesTheWallsAndTheVolume) {
  Mesh const mesh = wedge(pi / 2);
  auto options = between(mesh, {"blade"}, {"hub"}, 0);
  options.layers = {6, 4};
  FilletResult const result = fillet_of(mesh, options);
  (void)expect_sound(result.split.mesh);
  EXPECT_EQ(result.stations, 0);
  EXPECT_NEAR(volume_of(result.split.mesh), volume_of(mesh), 1e-9);
  for (Vec3 const& p : nodes_of(result.split.mesh, "hub")) EXPECT_LT(std::abs(p.y), 1e-12);
  for (Vec3 const& p : nodes_of(result.split.mesh, "blade")) EXPECT_LT(std::abs(p.x), 1e-12);
}

TEST(Fillet, OneTopologyServesAllRadii) {
  Mesh const mesh = wedge(pi / 2);
  std::optional<SplitMesh> first;
  for (double const radius : {0.0, 0.03, 0.06}) {
    auto options = between(mesh, {"blade"}, {"hub"}, radius);
    options.layers = {9, 7};
    FilletResult result = fillet_of(mesh, options);
    (void)expect_sound(result.split.mesh);
    if (first)
      EXPECT_EQ(result.split.zones, first->zones);
    else
      first = std::move(result.split);
  }
}

TEST(Fillet, CellsFarAwayStayBitForBit) {
  Mesh const mesh = wedge(pi / 2);
  auto options = between(mesh, {"blade"}, {"hub"}, 0.03);
  options.layers = {8, 8};
  FilletResult const result = fillet_of(mesh, options);
  int same = 0;
  for (std::size_t z = 0; z < result.split.zones.size(); ++z) {
    SplitZone const& part = result.split.zones[z];
    Zone const &zone = result.split.mesh.zones[z], &old = mesh.zones[part.zone];
    for (Index n = 0; n < zone.size(); ++n) {
      Index3 p = zone.index(zone.first_node + n);
      for (int axis = 0; axis < 3; ++axis) p[axis] += part.box.begin[axis];
      Vec3 const was = mesh.coordinates[old.node(p)], is = result.split.mesh.coordinates[zone.first_node + n];
      if (part.sheet < 0 || std::max(p[1], p[2]) > 23) {
        EXPECT_EQ(was, is);
        ++same;
      }
    }
  }
  EXPECT_GT(same, 7 * 16 * 16);
}

TEST(Fillet, ARadiusThatDoesNotFitComesWithOneThatDoes) {
  Mesh const mesh = wedge(pi / 2);
  std::string const message =
      message_of<MotionError>([&] { (void)fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 1.5)); });
  expect_all_in(message, {"does not fit", "1.5", "would do"});
  std::size_t const at = message.find("about ") + 6;
  double const fits = std::stod(message.substr(at));
  EXPECT_GT(fits, 0.05);
  (void)expect_sound(fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.95 * fits)).split.mesh);
}

TEST(Fillet, RunsOutBeforeItsOwnEndsAlone) {
  // A channel between two blades over a hub, the one on the left a quarter as long as the channel: its end lies across
  // from the middle of the other one, nearer than the fillet runs out over.
  Index3 const extent{33, 41, 21};
  double const radius = 0.03, width = 0.2;
  test::MeshBuilder builder("channel");
  builder.zone("channel", extent, [&](Index3 const& p) {
    double const t = double(p[1]) / (extent[1] - 1);
    double const across = t < 0.5 ? 0.5 * grown(p[1], 20, 1.1) : 1 - 0.5 * grown(40 - p[1], 20, 1.1);
    return Vec3{double(p[0]) / (extent[0] - 1), width * across, 0.5 * grown(p[2], extent[2] - 1, 1.1)};
  });
  for (int axis : {0, 2})
    for (int side : {0, 1})
      builder.patch(axis == 2 && side == 0 ? "hub" : "far",
                    axis == 2 && side == 0 ? PatchKind::wall : PatchKind::farfield, 0, axis, side);
  auto const along_side = [&](std::string const& name, PatchKind kind, int side, int begin, int end) {
    IndexRange range = test::face_of({{0, 0, 0}, extent}, 1, side);
    range.begin[0] = begin;
    range.end[0] = end;
    builder.patch(name, kind, 0, range);
  };
  along_side("blade", PatchKind::wall, 0, 0, 9);
  along_side("side", PatchKind::symmetry, 0, 8, 33);
  along_side("blade", PatchKind::wall, 1, 0, 33);
  Mesh const mesh = builder.finish();
  FilletResult const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
  (void)expect_sound(result.split.mesh);
  EXPECT_EQ(result.open_ends, 1);
  int on_arc = 0;
  for (Vec3 const& p : nodes_of(result.split.mesh, "blade")) {
    if (p.y < width / 2) continue;
    double const off_arc = std::hypot(width - radius - p.y, p.z - radius) - radius;
    // Faces of the arc end on the hub.
    bool const straight = (std::abs(p.y - width) < 1e-9 && p.z > radius - 1e-9) || std::abs(p.z) < 1e-9;
    EXPECT_TRUE(straight || std::abs(off_arc) < 1e-6 * radius) << p.x << " " << p.y << " " << p.z;
    on_arc += straight ? 0 : 1;
  }
  EXPECT_GE(on_arc, 33);
}

TEST(Fillet, WhatCannotBeFilledIsRefused) {
  Mesh const mesh = wedge(pi / 2);
  expect_all_in(message_of<MeshError>([&] { (void)fillet_of(mesh, between(mesh, {"side"}, {"side"}, 0.01)); }),
                {"meet in no corner"});
  auto options = between(mesh, {"blade"}, {"hub"}, 0.01);
  options.layers = {23, 3};
  expect_all_in(message_of<MeshError>([&] { (void)fillet_of(mesh, options); }),
                {"'wedge'", "24 cells", "23 are asked for"});
  expect_all_in(message_of<MotionError>([&] { (void)fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, -1)); }),
                {"-1", "radius"});
  // Once filled, the corner has blocks of its own.
  Mesh const filled = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.03)).split.mesh;
  expect_all_in(message_of<MeshError>([&] { (void)fillet_of(filled, between(filled, {"blade"}, {"hub"}, 0.03)); }),
                {"meet in no corner"});
}

TEST(Fillet, PolesAreRefusedWhereLayersWouldBeLaidAroundThem) {
  Mesh mesh = wedge(pi / 2);
  Zone const& zone = mesh.zones.front();
  for (int k = 0; k < zone.extent[2]; ++k)
    mesh.coordinates.set(zone.node({0, 3, k}), mesh.coordinates[zone.node({0, 2, k})]);
  expect_all_in(message_of<MeshError>([&] { (void)fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.03)); }),
                {"two nodes", "pole"});
}

class FilledPassage : public ::testing::Test {
 protected:
  static Mesh passage(PassageOptions::Layout layout) {
    PassageOptions options;
    options.nodes = test::reduced() ? 30'000 : 120'000;
    options.layout = layout;
    return make_passage(options);
  }
};

TEST_F(FilledPassage, HubAndCaseAreFilledInEitherLayout) {
  for (auto const layout : {PassageOptions::Layout::whole_faces, PassageOptions::Layout::five_zones}) {
    Mesh const mesh = passage(layout);
    FilletResult const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub", "case"}, 0.002));
    QualityReport const quality = expect_sound(result.split.mesh);
    EXPECT_EQ(result.open_ends, 0);
    EXPECT_LT(result.wall_deviation, 1e-7);
    EXPECT_GT(result.arc_angle_deg[0], 75);
    EXPECT_LT(result.arc_angle_deg[1], 105);
  }
}

TEST_F(FilledPassage, CoarseEndWallsGetSmallerCells) {
  for (Index const nodes : {10'000, 30'000}) {
    PassageOptions options;
    options.nodes = nodes;
    Mesh const mesh = make_passage(options);
    for (double const radius : {0.001, 0.002}) {
      FilletResult const result = fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, radius));
      (void)expect_sound(result.split.mesh);
      EXPECT_FALSE(result.first_cells_kept);
    }
  }
}

TEST_F(FilledPassage, TheSameHowEverZonesAreStored) {
  Mesh const mesh = passage(PassageOptions::Layout::whole_faces);
  double const volume = volume_of(fillet_of(mesh, between(mesh, {"blade"}, {"hub"}, 0.002)).split.mesh);
  for (unsigned const seed : {1U, 2U, 3U}) {
    Mesh const other = test::scramble(mesh, {.seed = seed}).mesh;
    FilletResult const result = fillet_of(other, between(other, {"blade"}, {"hub"}, 0.002));
    (void)expect_sound(result.split.mesh);
    EXPECT_NEAR(volume_of(result.split.mesh), volume, 1e-9 * volume) << seed;
  }
}

TEST_F(FilledPassage, TheRadiusMayChangeAlongTheCorner) {
  Mesh const mesh = passage(PassageOptions::Layout::whole_faces);
  auto options = between(mesh, {"blade"}, {"hub"}, 0);
  options.radius = [](Vec3 const& p) { return 0.002 + 0.01 * p.x; };
  FilletResult const result = fillet_of(mesh, options);
  (void)expect_sound(result.split.mesh);
  EXPECT_NEAR(result.smallest_radius, 0.0015, 1e-4);
  EXPECT_NEAR(result.largest_radius, 0.0025, 1e-4);
}

}  // namespace
}  // namespace gridmorph
