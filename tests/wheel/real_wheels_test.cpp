// Wheels of meshes of others: H meshes, whose blades stand on the periodic sides.
#include "support/expect_error.hpp"
#include "support/shared_mesh.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

namespace gridmorph::test {
namespace {

class RealWheel : public WheelTest {
 protected:
  /// Puts a mesh into the folder, under another name if one is given; false where it is not there.
  bool use(std::string const& mesh, std::string const& as = "") const {
    auto const path = shared_mesh(mesh);
    if (path.empty()) return false;
    std::filesystem::create_symlink(path, folder / (as.empty() ? mesh : as));
    return true;
  }
  /// The same wheel of its passage as hexahedra, which may fall short of the limits of quality; as blocks found in
  /// these, or as elements.
  [[nodiscard]] ElementWheelFile as_hexahedra_of(std::string const& mesh, std::string const& case_file,
                                                 std::string const& keys, bool blocks_found) const {
    write_mesh(folder.file("elements.cgns"), as_hexahedra(read_mesh(folder.file(mesh))));
    std::string rules = text(case_file);
    rules.replace(rules.find(mesh), mesh.size(), "elements.cgns");
    if (!blocks_found) rules.insert(rules.find("[mesh]\n") + 7, "blocks = \"off\"\n");
    folder.write("elements.toml", rules + "\n[wheel]\noutput = \"element_wheel.cgns\"\n" + keys);
    EXPECT_LE(gridmorph("wheel elements.toml"), 1) << text("out") << text("err");
    return ElementWheelFile(folder.file("element_wheel.cgns"));
  }
  static void expect_closed(ElementWheelFile const& wheel) {
    EXPECT_EQ(wheel.n_periodic(), 0);
    wheel.expect_same_bits();
    FaceCount const faces = wheel.count_faces();
    EXPECT_EQ(faces.open, 0);
    EXPECT_EQ(faces.ends, 0);
    EXPECT_EQ(faces.claimed, 0);
    EXPECT_GT(faces.seams, 0);
  }
  /// Passages of the wheel of a zone, from the angle of its periodic interface.
  static int wheel_of(Mesh const& mesh, int zone) {
    for (auto const& face : mesh.interfaces)
      if (face.zone == zone && face.periodic)
        return int(std::lround(2 * std::acos(-1.0) / norm(face.periodic->rotation_angle_rad)));
    return 0;
  }
};

constexpr char const* stage = R"case([mesh]
input  = "axial_turbine_stage_H.cgns"
output = "morphed.cgns"
axis   = "x"
[[motion]]
patches = "BLADE1"
rule    = "formula"
dtheta  = "0.3 * (axial - 0.05)"
[[motion]]
patches = "BLADE2"
rule    = "formula"
dtheta  = "0.2 * (axial - 0.21)"
[[motion]]
patches = ["INLET", "row1/mixing_out"]
rule    = "circumferential-slide"
of      = "BLADE1"
[[motion]]
patches = ["OUTLET", "row2/mixing_in"]
rule    = "circumferential-slide"
of      = "BLADE2"
[[motion]]
patches = "row1/per*"
rule    = "follow"
of      = "BLADE1"
[[motion]]
patches = "row2/per*"
rule    = "follow"
of      = "BLADE2"
[[motion]]
patches = ["HUB", "SHROUD"]
rule    = "slip"
surface = "revolution"
[boundary_layer]
walls  = ["BLADE1", "BLADE2"]
extent = { layers = 4 }
)case";

TEST_F(RealWheel, TurbineStagePutsEachBladeBetweenItsTwoPassages) {
  use("axial_turbine_stage_H.cgns");
  folder.write("stage.toml", stage);
  WheelFile const wheel = this->wheel("stage.toml", R"([[wheel.row]]
zones    = "row1"
passages = 4
factors  = [1, 0.5, 0, -1]
[[wheel.row]]
zones    = "row2"
passages = 3
)");
  EXPECT_EQ(wheel.zones.size(), 7U);
  wheel.expect_watertight();
  Mesh const mesh = read_mesh(folder.file("axial_turbine_stage_H.cgns"));
  double const factor[] = {1, 0.5, 0, -1};
  Index lower = 0, upper = 0;
  for (auto const& patch : mesh.patches) {
    if (patch.families.empty() || patch.families.front() != "BLADE1") continue;
    auto const& zone = mesh.zones[patch.zone];
    bool const high = patch.range.begin[2] > 0;
    for (int p = 0; p < 4; ++p)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const n = zone.node({i, j, patch.range.begin[2]});
          Vec3 const x = mesh.coordinates[n],
                     y = wheel.zones.at(name(zone.name, p)).at(std::size_t(n - zone.first_node));
          double const turned = cylindrical(y).angle - cylindrical(x).angle;
          double const moved = std::remainder(turned, 2 * std::acos(-1.0) / wheel_of(mesh, patch.zone));
          // One of the two sides of a passage belongs to the next blade.
          double const own = factor[p], next = factor[(p + 1) % 4];
          bool const is_own = std::abs(moved - own * 0.3 * (x.x - 0.05)) < 1e-13,
                     is_next = std::abs(moved - next * 0.3 * (x.x - 0.05)) < 1e-13;
          EXPECT_TRUE(is_own || is_next) << n << " in passage " << p;
          if (is_own != is_next) ((high ? upper : lower) += is_own ? 1 : -1);
        }
  }
  EXPECT_NE(lower, 0);
  EXPECT_LT(lower * upper, 0) << "both sides of the passages have their own blade, or both the next";
}

TEST_F(RealWheel, TurbineStageMakesBothWheels) {
  use("axial_turbine_stage_H.cgns");
  folder.write("stage.toml", stage);
  WheelFile const wheel = this->wheel("stage.toml", "");
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_watertight();
}

TEST_F(RealWheel, TurbineStageOfElementsMovesItsBoundariesAsTheBlocks) {
  use("axial_turbine_stage_H.cgns");
  folder.write("stage.toml", stage);
  // By elements the thin cells at the leading edges bear less than by blocks.
  std::string const keys = R"([[wheel.row]]
zones    = "row1"
passages = 4
factors  = [0.3, 0.15, 0, -0.3]
[[wheel.row]]
zones    = "row2"
passages = 3
factors  = [0.3]
)";
  WheelFile const of_blocks = wheel("stage.toml", keys);
  ElementWheelFile const of_elements = as_hexahedra_of("axial_turbine_stage_H.cgns", "stage.toml", keys, false);
  of_elements.expect_same_bits();
  EXPECT_EQ(of_elements.n_periodic(), of_blocks.n_periodic());
  expect_same_boundaries(read_mesh(folder.file("axial_turbine_stage_H.cgns")), {"HUB", "SHROUD"}, of_blocks,
                         of_elements, true);
  expect_same_nodes(of_blocks, as_hexahedra_of("axial_turbine_stage_H.cgns", "stage.toml", keys, true),
                    1e-9 * read_mesh(folder.file("axial_turbine_stage_H.cgns")).size());
}

class KaplanWheel : public RealWheel, public ::testing::WithParamInterface<char const*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, KaplanWheel, ::testing::Values("water_turbine.cgns", "axialTurbine_7blk.cgns"),
                         [](auto const& info) { return info.index == 0 ? "stand_in" : "of_others"; });

TEST_P(KaplanWheel, OfSevenZonesClosesWithDifferentBlades) {
  if (!use(GetParam(), "water_turbine.cgns")) GTEST_SKIP() << GetParam() << " is not there; its stand-in is tested";
  std::string rules = bytes_of(std::filesystem::path(GRIDMORPH_EXAMPLES) / "kaplan_7_blocks.toml");
  folder.write("kaplan.toml", rules);
  WheelFile const equal = wheel("kaplan.toml", "");
  EXPECT_EQ(equal.zones.size(), 35U);
  EXPECT_EQ(equal.n_periodic(), 0);
  equal.expect_watertight();
  WheelFile const mixed = wheel("kaplan.toml", "factors = [1, 0.9, 0.5, 0.7, 1.1]\n");
  mixed.expect_watertight();
  auto const of_elements = [&](bool blocks_found) {
    return as_hexahedra_of("water_turbine.cgns", "kaplan.toml", "factors = [1, 0.9, 0.5, 0.7, 1.1]\n", blocks_found);
  };
  ElementWheelFile const as_elements = of_elements(false), as_blocks = of_elements(true);
  expect_closed(as_elements);
  expect_closed(as_blocks);
  expect_same_boundaries(read_mesh(folder.file("water_turbine.cgns")), {"HUB", "SHROUD"}, mixed, as_elements, true);
  expect_same_nodes(mixed, as_blocks, 1e-9 * read_mesh(folder.file("water_turbine.cgns")).size());
}

}  // namespace
}  // namespace gridmorph::test
