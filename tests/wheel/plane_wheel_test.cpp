// Wheels and straight rows of plane passages, whose sides follow their blades.
#include "support/plane_cascade.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

#include <gridmorph/wheel/row_pitch.hpp>

#include <nlohmann/json.hpp>

#include <numbers>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 9;

/// Round: all blades of a wheel about z; straight: as many of a row, whose axis stands on the plane too.
class PlaneWheel : public WheelTest, public ::testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    mesh = round() ? plane_cascade(section_of_wheel(n_blades), turned_sides(2 * std::numbers::pi / n_blades))
                   : plane_cascade(straight_section(), periodic_translation({0, plane_cascade_pitch, 0}));
    write_mesh(folder.file("passage.cgns"), mesh);
  }
  [[nodiscard]] static bool round() { return GetParam(); }
  [[nodiscard]] static RowPitch pitch() {
    return round() ? RowPitch(Axis{{0, 0, 0}, {0, 0, 1}}, n_blades) : RowPitch(Vec3{0, plane_cascade_pitch, 0});
  }
  [[nodiscard]] static std::string case_of(double twist_deg) {
    return R"([mesh]
input  = "passage.cgns"
output = "morphed.cgns"
axis   = "z"
[[motion]]
patches   = "blade"
rule      = "sections"
twist_deg = )" +
           std::to_string(twist_deg) + row_followers;
  }
  [[nodiscard]] Coordinates morphed(double twist_deg) const {
    folder.write("one.toml", case_of(twist_deg));
    EXPECT_LE(gridmorph("morph one.toml"), 1) << text("err");
    return read_mesh(folder.file("morphed.cgns")).coordinates;
  }
  [[nodiscard]] ElementWheelFile wheel(double twist_deg, std::string const& keys) const {
    folder.write("wheel.toml", case_of(twist_deg) + "[wheel]\noutput = \"wheel.cgns\"\n" +
                                   (round() ? "" : "passages = " + std::to_string(n_blades) + "\n") + keys);
    EXPECT_EQ(gridmorph("wheel wheel.toml --report wheel.json"), 0) << text("out") << text("err");
    return ElementWheelFile(folder.file("wheel.cgns"));
  }
  /// A node of passage p, taken back to where the input stands.
  static Vec3 at(ElementWheelFile const& file, int p, Index n) {
    return pitch().times(-p)(file.zones.at(name("passage", p)).at(n));
  }
  template <class Visit>
  void for_nodes(std::string const& patch, Visit&& visit) const {
    for (Patch const& p : mesh.patches)
      for (Index f = 0; p.name == patch && f < p.faces.size(); ++f)
        for (Index32 const n : p.faces[f]) visit(n);
  }
  void expect_closed(ElementWheelFile const& file) const {
    file.expect_same_bits();
    EXPECT_EQ(file.n_periodic(), round() ? 0 : 4);
    FaceCount const faces = file.count_faces();
    EXPECT_EQ(faces.open, 0);
    EXPECT_EQ(faces.claimed, 0);
  }
  void expect_nothing_inverted() const {
    auto const report = nlohmann::json::parse(text("wheel.json"));
    ASSERT_GT(report.at("passages").size(), 0u);
    for (auto const& passage : report.at("passages")) {
      auto const& quality = passage.at("quality");
      EXPECT_TRUE(quality.contains("near_field") || quality.contains("far_field"));
      for (auto const* region : {"near_field", "far_field"})
        if (quality.contains(region)) {
          EXPECT_EQ(quality.at(region).at("inverted"), 0) << passage.at("passage");
        }
    }
  }

  Mesh mesh;
};

INSTANTIATE_TEST_SUITE_P(Of, PlaneWheel, ::testing::Bool(),
                         [](auto const& info) { return info.param ? "ARound" : "AStraightRow"; });

TEST_P(PlaneWheel, OfEqualBladesIsTheMorphedPassagePlacedNTimes) {
  ElementWheelFile const file = wheel(4, "");
  expect_closed(file);
  expect_nothing_inverted();
  Coordinates const one = morphed(4);
  double worst = 0, moved = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved = std::max(moved, distance(one[n], mesh.coordinates[n]));
  for (int p = 0; p < n_blades; ++p)
    for (Index n = 0; n < mesh.n_nodes(); ++n) worst = std::max(worst, distance(at(file, p, n), one[n]));
  EXPECT_GT(moved, 0.01);
  EXPECT_LT(worst, 1e-14 * mesh.size());
}

TEST_P(PlaneWheel, OfDifferentBladesHasOnEveryBladeItsOwnMotion) {
  std::array<double, n_blades> const factor{1, -0.5, 0, 0, 0.75, 1, 1, -1, 0.25};
  ElementWheelFile const file = wheel(4, "factors = [1, -0.5, 0, 0, 0.75, 1, 1, -1, 0.25]\n");
  expect_closed(file);
  expect_nothing_inverted();
  double worst = 0;
  for (double const f : {1.0, -0.5, 0.0, 0.75, -1.0, 0.25}) {
    Coordinates const one = morphed(4 * f);
    for (int p = 0; p < n_blades; ++p)
      for_nodes("blade", [&](Index n) {
        // H mesh: on the lower side blade p, on the upper one the next.
        bool const upper = n >= mesh.n_nodes() / 2;
        if (factor[(p + (upper ? 1 : 0)) % n_blades] != f) return;
        worst = std::max(worst, distance(at(file, p, n), one[n]));
      });
  }
  EXPECT_LT(worst, 1e-13 * mesh.size());
}

/// Between two blades a node of inlet or exit takes its share of what the one and the other say, by its place between
/// them.
TEST_P(PlaneWheel, SharesInletAndExitBetweenTheBladesBesideThem) {
  std::array<double, n_blades> const factor{1, 0, 0, 0, 0, 0, 0, 0, 0};
  ElementWheelFile const file = wheel(4, "factors = [1, 0, 0, 0, 0, 0, 0, 0, 0]\n");
  Coordinates const one = morphed(4);
  RowPitch const row = pitch();
  for (std::string const end : {"inlet", "outlet"}) {
    Index first = -1;
    for_nodes(end, [&](Index n) { first = first < 0 ? n : std::min(first, n); });
    auto const along = [&](Vec3 const& p) { return row.place(p).along; };
    double const whole = along(one[first]) - along(mesh.coordinates[first]);
    EXPECT_GT(std::abs(whole), 1e-3);
    for (int p = 0; p < n_blades; ++p)
      for_nodes(end, [&](Index n) {
        Vec3 const x = mesh.coordinates[n];
        double const w = along(x) - along(mesh.coordinates[first]);
        double const share = (1 - w) * factor[p] + w * factor[(p + 1) % n_blades];
        EXPECT_NEAR(along(at(file, p, n)) - along(x), share * whole, 1e-12) << end << p;
        EXPECT_NEAR(row.place(at(file, p, n)).first, row.place(x).first, 1e-13);
        EXPECT_NEAR(row.place(at(file, p, n)).second, row.place(x).second, 1e-13);
      });
  }
}

// Blocks of one cell across, in three dimensions with symmetry planes or of a 2-D base, make the wheel that plane
// elements make.
TEST_P(PlaneWheel, OfBlocksOneCellThickHasTheSameBoundaries) {
  std::string const factors = "factors = [1, -0.5, 0, 0, 0.75, 1, 1, -1, 0.25]\n";
  ElementWheelFile const of_elements = wheel(4, factors);
  std::vector<Index> nodes;
  for (std::string const name : {"inlet", "outlet", "blade"}) for_nodes(name, [&](Index n) { nodes.push_back(n); });
  for (Connection const& c : mesh.connections) {
    nodes.insert(nodes.end(), c.nodes.begin(), c.nodes.end());
    nodes.insert(nodes.end(), c.donor_nodes.begin(), c.donor_nodes.end());
  }
  auto const section = round() ? section_of_wheel(n_blades) : straight_section();
  Periodic const sides =
      round() ? turned_sides(2 * std::numbers::pi / n_blades) : periodic_translation({0, plane_cascade_pitch, 0});
  for (bool const of_a_2d_base : {false, true}) {
    Mesh const blocks = of_a_2d_base ? plane_cascade_block(section, sides)
                                     : cascade_between_planes(section, sides, 0.1, 2, PatchKind::symmetry);
    write_mesh(folder.file("passage.cgns"), blocks);
    folder.write("wheel.toml", case_of(4) + "[wheel]\noutput = \"blocks.cgns\"\n" +
                                   (round() ? "" : "passages = " + std::to_string(n_blades) + "\n") + factors);
    ASSERT_EQ(gridmorph("wheel wheel.toml --report wheel.json"), 0) << text("out") << text("err");
    expect_nothing_inverted();
    Mesh const made = read_mesh(folder.file("blocks.cgns"));
    EXPECT_EQ(made.dimension, of_a_2d_base ? 2 : 3);
    ASSERT_EQ(made.zones.size(), std::size_t(n_blades));
    Index const ni = blocks.zones[0].extent[0];
    double worst = 0, moved = 0;
    for (int p = 0; p < n_blades; ++p) {
      Zone const& zone = made.zones[p];
      ASSERT_EQ(zone.name, name("passage", p));
      for (Index const n : nodes) {
        Index const own = of_a_2d_base ? n : n % ni + 2 * ni * (n / ni);
        Vec3 const place = pitch().times(-p)(made.coordinates[zone.first_node + own]), wanted = at(of_elements, p, n);
        worst = std::max(worst, distance(place, wanted));
        moved = std::max(moved, distance(place, mesh.coordinates[n]));
      }
    }
    EXPECT_GT(moved, 0.01);
    EXPECT_LT(worst, 1e-10 * mesh.size()) << of_a_2d_base;
  }
}

}  // namespace
}  // namespace gridmorph::test
